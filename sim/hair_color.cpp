#include "sim/hair_color.h"

#include <algorithm>
#include <cmath>

namespace coif
{

static constexpr float kDarkest = 1e-20f; // of a channel: a float has its logarithm, and light has none left

double color_per_root_absorption(float azimuthal)
{
    const double n = std::clamp(azimuthal, 0.0f, 1.0f);
    return 5.969 + n * (-0.215 + n * (2.532 + n * (-10.73 + n * (5.574 + n * 0.245))));
}

glm::vec3 absorption_of_color(const glm::vec3& color, float azimuthal)
{
    const double by = color_per_root_absorption(azimuthal);
    glm::vec3 absorption;
    for (int c = 0; c < 3; ++c)
    {
        const double root = std::log(double(std::clamp(color[c], kDarkest, 1.0f))) / by;
        absorption[c] = float(root * root);
    }
    return absorption;
}

glm::vec3 color_of_absorption(const glm::vec3& absorption, float azimuthal)
{
    const double by = color_per_root_absorption(azimuthal);
    glm::vec3 color;
    for (int c = 0; c < 3; ++c)
        color[c] = std::max(kDarkest, float(std::exp(-by * std::sqrt(std::max(0.0, double(absorption[c]))))));
    return color;
}

glm::vec3 absorption_of_melanin(float eumelanin, float pheomelanin)
{
    return eumelanin * glm::vec3(0.419f, 0.697f, 1.37f) + pheomelanin * glm::vec3(0.187f, 0.4f, 1.05f);
}

void take_pigment(HairParams& p)
{
    constexpr int kMelanin = 1; // in look.pigment
    if (p.look_pigment != kMelanin)
        return;
    const glm::vec3 absorption = absorption_of_melanin(p.look_eumelanin, p.look_pheomelanin);
    const auto dye = [&](float more)
    {
        const glm::vec3 color = color_of_absorption(more * absorption, p.look_azimuthal_roughness);
        return F4(color.x, color.y, color.z, 1.0f);
    };
    p.look_root_color = dye(1.0f + p.look_root_darkening);
    p.look_tip_color = dye(1.0f - 0.5f * p.look_root_darkening);
}

} // namespace coif

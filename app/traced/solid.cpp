#include "app/traced/solid.h"

#include "kernels/look.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr double kPi = std::numbers::pi;
static constexpr double kWidth = double(SKIN_ROUGH) * SKIN_ROUGH, kWidth2 = kWidth * kWidth; // alpha of GGX
static constexpr double kFlattest = 1e-3; // cosine that what is seen at less is reckoned with, as the kernel does

static double fresnel(double cosine) // Schlick. An inexpensive BRDF model for physically-based rendering. 1994
{
    return SKIN_MIRRORS + (1.0 - SKIN_MIRRORS) * std::pow(1.0 - std::clamp(cosine, 0.0, 1.0), 5.0);
}

// Of the facets, those that face `half`; Walter eq. 33.
static double facets(double half_z)
{
    const double d = half_z * half_z * (kWidth2 - 1.0) + 1.0;
    return kWidth2 / (kPi * d * d);
}

// Smith's mask of one way, as twice the cosine over it; Walter eq. 34.
static double over_mask(double z) { return z + std::sqrt(kWidth2 + (1.0 - kWidth2) * z * z); }

// Radiance of a whole coat per irradiance on a plane across the light, and how likely facet_way() is to choose it.
static double mirrored(const glm::dvec3& eye, const glm::dvec3& light)
{
    const glm::dvec3 half = glm::normalize(eye + light);
    const double masked = light.z * std::sqrt(kWidth2 + (1.0 - kWidth2) * eye.z * eye.z) +
                          eye.z * std::sqrt(kWidth2 + (1.0 - kWidth2) * light.z * light.z);
    return fresnel(glm::dot(eye, half)) * facets(half.z) * 0.5 * light.z / std::max(masked, 1e-12);
}
static double facet_pdf(const glm::dvec3& eye, const glm::dvec3& light)
{
    return facets(glm::normalize(eye + light).z) / (2.0 * over_mask(eye.z));
}

// The mirrored way off a facet that the eye sees. Heitz. Sampling the GGX distribution of visible normals. 2018.
static glm::dvec3 facet_way(const glm::dvec3& eye, double first, double second)
{
    const glm::dvec3 v = glm::normalize(glm::dvec3(kWidth * eye.x, kWidth * eye.y, eye.z));
    const double across = v.x * v.x + v.y * v.y;
    const glm::dvec3 x = across > 1e-20 ? glm::dvec3(-v.y, v.x, 0.0) / std::sqrt(across) : glm::dvec3(1, 0, 0);
    const glm::dvec3 y = glm::cross(v, x);
    const double radius = std::sqrt(first), turn = 2.0 * kPi * second, side = 0.5 * (1.0 + v.z);
    const double a = radius * std::cos(turn);
    const double b = (1.0 - side) * std::sqrt(std::max(0.0, 1.0 - a * a)) + side * radius * std::sin(turn);
    const glm::dvec3 n = a * x + b * y + std::sqrt(std::max(0.0, 1.0 - a * a - b * b)) * v;
    const glm::dvec3 facet = glm::normalize(glm::dvec3(kWidth * n.x, kWidth * n.y, std::max(1e-9, n.z)));
    return glm::normalize(2.0 * glm::dot(eye, facet) * facet - eye);
}

namespace
{
// mirrored_share() at even steps of the root of the cosine, for it bends most where the surface is seen flat.
struct CoatTable
{
    static constexpr int kSteps = 48, kPlaces = 64;
    std::array<double, kSteps + 1> share;
    double mean = 0.0; // over light from all around

    CoatTable()
    {
        for (int i = 0; i <= kSteps; ++i)
        {
            const double root = double(i) / kSteps, cosine = std::max(root * root, kFlattest);
            const glm::dvec3 eye(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
            double sum = 0.0;
            for (int j = 0; j < kPlaces * kPlaces; ++j)
            {
                const glm::dvec3 light = facet_way(eye, (j / kPlaces + 0.5) / kPlaces, (j % kPlaces + 0.5) / kPlaces);
                if (light.z > 0.0)
                    sum += mirrored(eye, light) / facet_pdf(eye, light);
            }
            share[size_t(i)] = sum / (kPlaces * kPlaces);
        }
        constexpr int kParts = 4096;
        for (int i = 0; i < kParts; ++i)
        {
            const double cosine = (i + 0.5) / kParts;
            mean += 2.0 * cosine * at(cosine) / kParts;
        }
    }
    double at(double cosine) const
    {
        const double place = kSteps * std::sqrt(std::clamp(cosine, 0.0, 1.0));
        const size_t i = std::min(size_t(place), size_t(kSteps - 1));
        return glm::mix(share[i], share[i + 1], place - double(i));
    }
};
} // namespace

static const CoatTable& coat()
{
    static const CoatTable table;
    return table;
}

double mirrored_share(double cosine) { return coat().at(cosine); }

// Smooth normals may turn away from an eye that sees the surface.
static glm::dvec3 seen_from(const glm::dvec3& to_eye)
{
    return to_eye.z >= kFlattest ? to_eye : glm::normalize(glm::dvec3(to_eye.x, to_eye.y, kFlattest));
}

static glm::dvec3 under_coat(const SolidLook& look, const glm::dvec3& eye)
{
    if (!(look.gloss > 0.0))
        return look.albedo;
    return look.albedo * ((1.0 - look.gloss * coat().at(eye.z)) / (1.0 - look.gloss * coat().mean));
}

glm::dvec3 scatter(const SolidLook& look, const glm::dvec3& to_eye, const glm::dvec3& to_light)
{
    if (!(to_light.z > 0.0))
        return glm::dvec3(0.0);
    const glm::dvec3 eye = seen_from(to_eye);
    const glm::dvec3 matt = under_coat(look, eye) * (to_light.z / kPi);
    if (!(look.gloss > 0.0))
        return matt;
    return matt * (1.0 - look.gloss * coat().at(to_light.z)) + look.gloss * mirrored(eye, to_light);
}

SolidSample sample(const SolidLook& look, const glm::dvec3& to_eye, const std::array<double, 3>& random)
{
    const double turn = 2.0 * kPi * random[1];
    const glm::dvec3 evenly(std::sqrt(random[0]) * std::cos(turn), std::sqrt(random[0]) * std::sin(turn),
                            std::sqrt(1.0 - random[0]));
    if (!(look.gloss > 0.0))
        return {evenly, look.albedo};
    // About as much light comes by each of the two, and either may have chosen the way.
    const glm::dvec3 eye = seen_from(to_eye), under = under_coat(look, eye);
    const double shine = look.gloss * coat().at(eye.z), matt = (under.x + under.y + under.z) / 3.0;
    const double chance = shine / (shine + matt);
    SolidSample found;
    found.to_light = random[2] < chance ? facet_way(eye, random[0], random[1]) : evenly;
    if (!(found.to_light.z > 0.0))
        return found;
    const double pdf = chance * facet_pdf(eye, found.to_light) + (1.0 - chance) * found.to_light.z / kPi;
    if (pdf > 0.0)
        found.weight = scatter(look, eye, found.to_light) / pdf;
    return found;
}

} // namespace coif

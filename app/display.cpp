#include "app/display.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

// kernels/display.h in C++.
namespace display
{
using glm::vec3, glm::abs, glm::clamp, glm::greaterThan, glm::lessThanEqual, glm::log2, glm::max, glm::min, glm::mix,
    glm::pow, glm::sqrt;

#define DISPLAY_FUNCTION static inline
#include "kernels/display.h"
} // namespace display

Display display_of(const HairParams& params)
{
    const int by_itself = params.look_level == LOOK_KAJIYA_KAY ? DISPLAY_NONE : DISPLAY_NEUTRAL;
    return {std::exp2(params.look_exposure), params.look_display == 0 ? by_itself : params.look_display};
}

glm::vec3 shown(const glm::vec3& light, const Display& d) { return display::shown(light, d.gain, d.choice); }

Image displayed(const LinearImage& linear, const HairParams& params)
{
    const Display d = display_of(params);
    Image image{linear.width, linear.height, std::vector<unsigned char>(linear.pixels.size())};
    const auto byte = [](float v) { return static_cast<unsigned char>(255.0f * v + 0.5f); };
    for (size_t i = 0; i + 3 < linear.pixels.size(); i += 4)
    {
        const float* p = &linear.pixels[i];
        const float alpha = std::isfinite(p[3]) ? std::clamp(p[3], 0.0f, 1.0f) : 1.0f;
        const glm::vec3 color = shown(glm::vec3(p[0], p[1], p[2]) / std::max(alpha, 1e-4f), d);
        for (int c = 0; c < 3; ++c)
            image.pixels[i + size_t(c)] = byte(color[c]);
        image.pixels[i + 3] = byte(alpha);
    }
    return image;
}

} // namespace coif

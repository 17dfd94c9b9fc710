// What solid things look like, for whatever draws or traces them. Parameters as the device reads them; colours linear.
#pragma once
#include "sim/params.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace coif
{

constexpr glm::vec3 kObstacleAlbedo(0.30f, 0.34f, 0.40f);

// `roots`: how much of a place on the skin hair grows on. shaders/surface.vert says it again.
inline glm::vec3 skin_albedo(const HairParams& p, float roots)
{
    const glm::vec3 skin(p.head_color.x, p.head_color.y, p.head_color.z);
    const glm::vec3 root(p.look_root_color.x, p.look_root_color.y, p.look_root_color.z);
    return glm::mix(skin, 0.6f * root, p.head_scalp_tint * roots);
}

} // namespace coif

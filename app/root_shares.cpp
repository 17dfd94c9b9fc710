#include "app/root_shares.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>

namespace coif
{

std::vector<float> shares_of_roots(const Assets& assets, const HairParams& p)
{
    const glm::vec3 offset(p.head_offset.x, p.head_offset.y, p.head_offset.z);
    const Scalp& scalp = assets.scalp;
    const float near = 0.02f * scalp.extent, far = 0.07f * scalp.extent;
    std::vector<glm::vec4> balls; // about each triangle, to skip those out of reach
    for (const glm::uvec3& t : scalp.triangles)
    {
        const glm::vec3 middle = (scalp.positions[t.x] + scalp.positions[t.y] + scalp.positions[t.z]) / 3.0f;
        float radius = 0.0f;
        for (int k = 0; k < 3; ++k)
            radius = std::max(radius, glm::distance(middle, scalp.positions[t[k]]));
        balls.emplace_back(middle, radius);
    }
    std::vector<float> shares;
    shares.reserve(assets.head.positions.size());
    for (const glm::vec3& position : assets.head.positions)
    {
        const glm::vec3 at = position * p.head_mesh_scale + offset;
        float nearest = far;
        for (size_t t = 0; t < balls.size(); ++t)
        {
            if (glm::distance(at, glm::vec3(balls[t])) - balls[t].w > nearest)
                continue;
            const glm::uvec3 corner = scalp.triangles[t];
            nearest = std::min(nearest, triangle_distance(at, scalp.positions[corner.x], scalp.positions[corner.y],
                                                          scalp.positions[corner.z]));
        }
        shares.push_back(1.0f - glm::smoothstep(near, far, nearest));
    }
    return shares;
}

} // namespace coif

#include "app/ground.h"

#include "app/renderer.h"
#include "sim/strand_shapes.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

// Height of the lowest point of head and resting hair while the head stands upright at the world's origin, m.
static float lowest_point(const FrameInput& frame)
{
    const HairParams& p = frame.params;
    const Solver& solver = frame.simulation->solver();
    const Assets& assets = frame.simulation->assets();
    float lowest =
        assets.head.positions.empty() ? (assets.scalp.center.y - assets.scalp.radius) * p.head_scale : INFINITY;
    for (const glm::vec3& at : assets.head.positions)
        lowest = std::min(lowest, (at.y * p.head_mesh_scale + p.head_offset.y) * p.head_scale);
    const Groom& groom = solver.groom();
    for (int g = 0; g < groom.guides; ++g)
        for (int k = 1; k < groom.nodes; ++k)
            lowest = std::min(lowest, float(vector_at(solver.rest_positions().data(), g, k, groom.nodes).y));
    return lowest;
}

std::optional<Ground> ground_of(const FrameInput& frame)
{
    if (frame.params.look_ground == 0)
        return std::nullopt;
    const Solver& solver = frame.simulation->solver();
    const float4 backdrop = device_params(frame.params).look_background;
    Ground ground;
    ground.height = lowest_point(frame);
    ground.radius = 6.0f * solver.groom().extent + 2.0f * solver.groom().longest;
    ground.moved = glm::vec3(solver.jumped() - solver.head().origin);
    ground.albedo = {backdrop.x, backdrop.y, backdrop.z};
    return ground;
}

double ground_cover(double share_of_radius) { return 1.0 - glm::smoothstep(0.35, 1.0, share_of_radius); }

} // namespace coif

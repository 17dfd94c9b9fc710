#include "sim/health.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

static double depth_in(const std::vector<Capsule>& colliders, const Solver& solver, glm::vec3 p)
{
    const glm::vec3 on_head(glm::conjugate(solver.head().turn) * glm::dvec3(p));
    double deepest = std::max(0.0, double(-distance_to(solver.body(), on_head)));
    for (const Capsule& c : colliders)
    {
        const glm::vec3 center(c.center.x, c.center.y, c.center.z), axis(c.axis.x, c.axis.y, c.axis.z);
        const glm::vec3 nearest = center + axis * std::clamp(glm::dot(p - center, axis) * c.axis.w, 0.0f, 1.0f);
        deepest = std::max(deepest, double(c.center.w - glm::distance(p, nearest)));
    }
    return deepest;
}

Health measure_health(const Solver& solver, const HairParams& params, bool drawn)
{
    Health health;
    const Groom& groom = solver.groom();
    const std::vector<Capsule> colliders = solver.placed_colliders();
    const Mapped guides = solver.guide_positions();
    const float* x = guides.as<float>();
    double sum = 0.0;
    for (int g = 0; g < groom.guides; ++g)
    {
        const auto node = [&](int k)
        {
            return glm::vec3(x[strand_value(g, k, 0, groom.nodes)], x[strand_value(g, k, 1, groom.nodes)],
                             x[strand_value(g, k, 2, groom.nodes)]);
        };
        const double rest = double(groom.segment_length[size_t(g)]) * params.strand_spacing;
        for (int k = 2; k < groom.nodes; ++k)
        {
            const glm::vec3 p = node(k);
            const double stretch = std::abs(double(glm::distance(p, node(k - 1))) / rest - 1.0);
            health.finite &= std::isfinite(stretch);
            health.stretch_max = std::max(health.stretch_max, stretch);
            health.penetration_max = std::max(health.penetration_max, depth_in(colliders, solver, p));
            sum += stretch;
        }
    }
    health.stretch_mean = sum / std::max(1, groom.guides * (groom.nodes - 2));
    if (!drawn)
        return health;
    const Mapped nodes = solver.drawn_positions();
    const float4* d = nodes.as<float4>();
    for (size_t s = 0; s < groom.drawn.size(); ++s)
        for (int k = 2; k < groom.nodes; ++k)
        {
            const float4 p = d[s * size_t(groom.nodes) + size_t(k)];
            health.finite &= std::isfinite(p.x + p.y + p.z + p.w);
            health.drawn_penetration_max =
                std::max(health.drawn_penetration_max, depth_in(colliders, solver, {p.x, p.y, p.z}));
        }
    return health;
}

} // namespace coif

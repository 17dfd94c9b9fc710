#include "sim/health.h"

#include "sim/bodies.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

Health measure_health(const Solver& solver, const HairParams& params, bool drawn)
{
    Health health;
    const Groom& groom = solver.groom();
    const std::vector<Capsule> colliders = solver.placed_colliders();
    const auto depth = [&](glm::vec3 p) { return depth_in(colliders, solver.body(), solver.head().turn, p); };
    const Mapped guides = solver.guide_positions();
    const float* x = guides.as<float>();
    double sum = 0.0;
    for (int g = 0; g < groom.guides; ++g)
    {
        const auto node = [&](int k) { return glm::vec3(vector_at(x, g, k, groom.nodes)); };
        const double rest = double(groom.segment_length[size_t(g)]) * params.strand_spacing;
        for (int k = 2; k < groom.nodes; ++k)
        {
            const glm::vec3 p = node(k);
            const double stretch = std::abs(double(glm::distance(p, node(k - 1))) / rest - 1.0);
            health.finite &= std::isfinite(stretch);
            health.stretch_max = std::max(health.stretch_max, stretch);
            health.penetration_max = std::max(health.penetration_max, depth(p));
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
            health.drawn_penetration_max = std::max(health.drawn_penetration_max, depth({p.x, p.y, p.z}));
        }
    return health;
}

std::vector<Reset> find_resets(const Solver& solver, std::vector<int>& seen)
{
    std::vector<int> now = solver.resets();
    seen.resize(now.size());
    std::vector<Reset> found;
    if (now == seen)
        return found;
    const std::vector<int> faults = solver.faults();
    for (size_t s = 0; s < now.size(); ++s)
        if (now[s] > seen[s]) // new hair counts from zero again
            found.push_back({int(s), now[s] - seen[s], faults[s]});
    seen = std::move(now);
    return found;
}

std::string likely_cause(const Reset& reset, const StepInfo& info)
{
    if (reset.fault == FAULT_POSITION)
        return "a position was not a number before the step, or 1000 km away: memory was written to from outside";
    if (reset.fault == FAULT_VELOCITY)
        return "a velocity or tension was not a number before the step: memory was written to from outside";
    const double gravity = std::abs(double(info.gravity));
    const double wind = double(info.wind.w) * (1.0 + double(info.gust_origin.w));
    const double head = std::max(0.0, double(info.acceleration) - gravity - wind); // only the direct solver is told
    const char* strongest = wind >= gravity && wind >= head ? "the wind" : gravity >= head ? "gravity" : "the head";
    return fmt::format("its forces flung it away or were not finite; the strongest was {}, {:.3g} m/s^2", strongest,
                       std::max({gravity, wind, head}));
}

} // namespace coif

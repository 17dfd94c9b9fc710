#include "app/stress/watch.h"

#include "sim/bodies.h"
#include "sim/health.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif::stress
{

static constexpr double kUlps = 8.0 * 0x1p-24; // what rounding of two positions can make of a length, a coordinate

void add(Figures& sum, const Figures& more)
{
    if (more.stretch > sum.stretch || sum.where.empty())
        sum.where = more.where;
    if (more.penetration > sum.penetration)
        sum.where_inside = more.where_inside;
    sum.stretch = std::max(sum.stretch, more.stretch);
    sum.penetration = std::max(sum.penetration, more.penetration);
    sum.reach = std::max(sum.reach, more.reach);
    sum.finite &= more.finite;
    sum.resets += more.resets;
    sum.looks += more.looks;
    if (sum.fault.empty())
        sum.fault = more.fault;
}

static double depth_in(const std::vector<Capsule>& bodies, const Solver& solver, glm::dvec3 p)
{
    return depth_in(bodies, solver.body(), solver.head().turn, p);
}

// The shortest straight way out of the union of all bodies, about: along the ways out of each and the axes.
static double way_out(const std::vector<Capsule>& bodies, const Solver& solver, glm::dvec3 p)
{
    if (depth_in(bodies, solver, p) <= 0.0)
        return 0.0;
    std::vector<glm::dvec3> ways = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const Capsule& b : bodies)
    {
        const glm::dvec3 out = p - glm::dvec3(nearest_on_axis(b, p));
        if (glm::length(out) < b.center.w && glm::length(out) > 1e-9)
            ways.push_back(glm::normalize(out));
    }
    double shortest = INFINITY;
    for (const glm::dvec3& way : ways)
    {
        double t = 0.0;
        for (double depth = depth_in(bodies, solver, p); depth > 0.0 && t < shortest;
             depth = depth_in(bodies, solver, p + t * way))
            t += depth + 1e-5;
        shortest = std::min(shortest, t);
    }
    return shortest;
}

void look(Watch& watch, const Solver& solver, const HairParams& params, double seconds)
{
    const Groom& groom = solver.groom();
    const std::vector<Capsule> bodies = solver.placed_colliders();
    const bool any = !bodies.empty() || solver.body().grid;
    const Mapped view = solver.guide_positions();
    const float* x = view.as<float>();
    Figures& worst = watch.worst;
    const bool first = watch.grace.size() != size_t(groom.guides);
    // A teleport takes hair into whatever stands there; one that turns the head leaves its origin.
    const glm::dquat turn = solver.head().turn;
    const bool jumped = watch.jumped != solver.jumped() || solver.info().teleport ||
                        std::abs(glm::dot(turn, watch.turn)) < std::cos(0.7);
    watch.jumped = solver.jumped();
    watch.turn = turn;
    watch.grace.resize(size_t(groom.guides));
    watch.root_out.resize(size_t(groom.guides));
    watch.time += seconds;
    worst.reach = 0.0;
    ++worst.looks;
    for (int g = 0; g < groom.guides; ++g)
    {
        const auto node = [&](int k) { return vector_at(x, g, k, groom.nodes); };
        const double rest = double(groom.segment_length[size_t(g)]) * params.strand_spacing;
        const glm::dvec3 root = node(1);
        const double out = any ? way_out(bodies, solver, root) : 0.0;
        double deepest = out;
        if (any && (first || jumped))
            for (int k = 2; k < groom.nodes; ++k)
                deepest = std::max(deepest, way_out(bodies, solver, node(k)));
        double& grace = watch.grace[size_t(g)];
        if (first || jumped || out > watch.root_out[size_t(g)] + 1e-6)
            grace = std::max(grace, watch.time + deepest / double(kPushOut) + 0.1);
        watch.root_out[size_t(g)] = out;
        glm::dvec3 before = root;
        double depth_before = out;
        for (int k = 1; k < groom.nodes; ++k)
        {
            const glm::dvec3 p = node(k);
            worst.finite &= std::isfinite(p.x + p.y + p.z);
            if (k == 1)
                continue;
            const double most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
            const double length = glm::distance(p, before);
            // Of no length: the device takes a nanometre for it.
            const double stretch = rest > 1e-7 ? std::max(0.0, std::abs(length / rest - 1.0) - kUlps * most / rest)
                                               : std::max(0.0, length - 1e-6) / 1e-6;
            if (stretch > worst.stretch || !std::isfinite(stretch))
                worst.where = fmt::format("strand {}, node {}, {:.3f} s", g, k, watch.time);
            worst.stretch = std::max(worst.stretch, std::isfinite(stretch) ? stretch : INFINITY);
            worst.reach =
                std::max(worst.reach, (glm::distance(p, root) - 2.0 * out) / std::max((groom.nodes - 2) * rest, 1e-6));
            if (watch.time > grace && any)
            {
                const double depth = depth_in(bodies, solver, p);
                if (depth > worst.penetration && (k - 1) * rest > 1.5 * out + 1e-3 && depth_before < 0.5 * rest)
                {
                    worst.penetration = depth;
                    worst.where_inside = fmt::format("strand {}, node {}, {:.3f} s", g, k, watch.time);
                }
                depth_before = depth;
            }
            before = p;
        }
    }
    for (const Reset& reset : find_resets(solver, watch.resets))
    {
        worst.resets += reset.times;
        if (worst.fault.empty())
            worst.fault =
                fmt::format("strand {} at {:.3f} s: {}", reset.strand, watch.time, likely_cause(reset, solver.info()));
    }
}

bool finite_everywhere(const Device& device, const Solver& solver, bool drawn, std::string& which)
{
    const Groom& groom = solver.groom();
    const size_t strands = size_t(groom.blocks) * LANES, values = strands * size_t(groom.nodes) * 3;
    std::vector<std::pair<const char*, size_t>> all = {{"position", values}, {"velocity", values}};
    all.emplace_back("multiplier", values / 3);
    all.emplace_back("tension", strands);
    all.emplace_back("gradient", solver.buffers().at("gradient").getInfo<CL_MEM_SIZE>() / sizeof(float));
    if (drawn && !groom.drawn.empty())
        for (const char* name : {"drawn_position", "drawn_frame"})
            all.emplace_back(name, groom.drawn.size() * size_t(groom.nodes) * 4);
    for (const auto& [name, count] : all)
    {
        const std::vector<float> all_values = read<float>(device, solver.buffers().at(name), count);
        if (!std::all_of(all_values.begin(), all_values.end(), [](float v) { return std::isfinite(v); }))
        {
            which = fmt::format("a value of '{}' is not finite", name);
            return false;
        }
    }
    return true;
}

} // namespace coif::stress

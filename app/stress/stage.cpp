#include "app/stress/stage.h"

#include "sim/error.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace coif::stress
{

static void set_guide(Groom& groom, int guide, glm::dvec3 root, glm::dvec3 direction, double segment)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const size_t at = size_t(strand_value(guide, 0, axis, 1));
        groom.root_position[at] = float(root[axis]);
        groom.root_direction[at] = float(direction[axis]);
    }
    groom.segment_length[size_t(guide)] = float(segment);
}

static Groom empty(int guides, int nodes, double length)
{
    Groom groom;
    groom.guides = guides;
    groom.nodes = nodes;
    groom.blocks = (guides + LANES - 1) / LANES;
    groom.root_position.resize(size_t(groom.blocks) * LANES * 3);
    groom.root_direction.resize(groom.root_position.size());
    groom.segment_length.resize(size_t(groom.blocks) * LANES);
    groom.longest = float(length);
    groom.extent = 0.2f;
    groom.farthest = 0.1f;
    return groom;
}

Groom ball(int guides, int nodes, double length, int seed)
{
    Groom groom = empty(guides, nodes, length);
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        const int g = s < guides ? s : 0;
        // Fibonacci's sphere, and a lean that hangs on the seed.
        const double y = 1.0 - 2.0 * (g + 0.5) / guides, ring = std::sqrt(1.0 - y * y), turn = 2.399963229728653 * g;
        const glm::dvec3 out(ring * std::cos(turn), y, ring * std::sin(turn));
        const glm::dvec3 lean(random01(seed, g, 1) - 0.5, random01(seed, g, 2) - 0.5, random01(seed, g, 3) - 0.5);
        set_guide(groom, s, 0.1 * out, glm::normalize(out + lean), length / (nodes - 2));
    }
    return groom;
}

Groom row(int guides, int nodes, double length, glm::vec3 direction)
{
    Groom groom = empty(guides, nodes, length);
    for (int s = 0; s < groom.blocks * LANES; ++s)
        set_guide(groom, s, {0.02 * (s < guides ? s : 0), 0.0, 0.0}, glm::dvec3(glm::normalize(direction)),
                  length / (nodes - 2));
    groom.farthest = 0.02f * float(guides);
    return groom;
}

HairParams lone(int kind)
{
    HairParams params;
    params.solver_kind = kind;
    params.forces_repulsion = 0.0f;
    params.look_self_shadow = 0.0f;
    params.interpolation_strands = 0;
    return params;
}

Trial::Trial(const Ground& ground, const HairParams& p, const Groom& groom, const std::vector<Collider>& colliders,
             const Pose& head)
    : params(p), solver(ground.device, p, groom, head)
{
    solver.set_colliders(colliders);
    look(watch, solver, params, 0.0);
}

void Trial::step(const Pose& head, float seconds)
{
    time += seconds > 0.0f ? double(seconds) : 0.0;
    solver.step({{head, time, seconds}});
    look(watch, solver, params, seconds > 0.0f ? double(seconds) : 0.0);
    if (watch.worst.looks % 16 == 0)
        solver.take_times(); // lets the queue's uploads go
}

void Trial::rest(int steps)
{
    for (int i = 0; i < steps; ++i)
        step(solver.head());
}

std::vector<glm::dvec3> Trial::nodes() const
{
    const Groom& groom = solver.groom();
    const Mapped view = solver.guide_positions();
    const float* x = view.as<float>();
    std::vector<glm::dvec3> all;
    for (int g = 0; g < groom.guides; ++g)
        for (int k = 0; k < groom.nodes; ++k)
            all.push_back(vector_at(x, g, k, groom.nodes));
    return all;
}

void expect(Outcome& outcome, bool good, const std::string& fault)
{
    if (!good)
        outcome.faults.push_back(fault);
}

void judge(Outcome& outcome, int kind, const std::string& what, const Figures& figures, const Bounds& bounds)
{
    const std::string who = fmt::format("{}, {}: ", kSolvers[kind], what);
    expect(outcome, figures.finite, who + "not finite; " + figures.fault);
    expect(outcome, figures.resets <= bounds.resets,
           fmt::format("{}{} resets; {}", who, figures.resets, figures.fault));
    if (kind == 0)
    {
        expect(outcome, figures.stretch <= bounds.stretch,
               fmt::format("{}stretch {:.3g} % ({})", who, 100.0 * figures.stretch, figures.where));
        expect(outcome, figures.penetration <= bounds.penetration,
               fmt::format("{}penetration {:.3g} mm ({})", who, 1e3 * figures.penetration, figures.where_inside));
    }
    else
        expect(outcome, figures.reach <= bounds.reach,
               fmt::format("{}still {:.3g} times as long as it is at the end", who, figures.reach));
    add(outcome.figures[kind], figures);
}

void judge(Outcome& outcome, const std::string& what, Trial& trial, const Bounds& bounds)
{
    std::string which;
    if (!finite_everywhere(trial.solver.device(), trial.solver, false, which))
    {
        trial.watch.worst.finite = false;
        trial.watch.worst.fault += which;
    }
    judge(outcome, trial.params.solver_kind, what, trial.watch.worst, bounds);
}

} // namespace coif::stress

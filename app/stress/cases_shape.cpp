// Strands of every size and number, and the grid that they stand in.
#include "app/stress/cases.h"
#include "sim/error.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace coif::stress
{

static void shake(Trial& trial, int steps = 60)
{
    for (int i = 1; i <= steps; ++i)
        trial.step(pose({0.1 * std::sin(0.2 * i), 0, 0}, 0.5 * std::sin(0.1 * i)));
    trial.rest(10);
}

Outcome no_length(const Ground& ground)
{
    Outcome outcome;
    const std::vector<Collider> head = {{{0, 0, 0}, 0.1f, true}};
    for (const int kind : {0, 1})
    {
        HairParams params = lone(kind);
        params.forces_wind = F4(10.0f, 0.0f, 0.0f, 0.0f);
        const Bounds anywhere = {.penetration = 1.0, .reach = INFINITY}; // of a nanometre, or none
        Groom groom = ball(17, 16, 0.3);
        for (size_t s = 0; s < groom.segment_length.size(); s += 2)
            groom.segment_length[s] = 0.0f;
        Trial some(ground, params, groom, head);
        shake(some);
        judge(outcome, "every other strand of no length", some, anywhere);

        Trial none(ground, params, ball(17, 16, 0.0), head);
        shake(none);
        judge(outcome, "no length at all", none, anywhere);

        HairParams shrunk = params;
        shrunk.strand_spacing = 0.0f;
        Trial spacing(ground, shrunk, ball(17, 16, 0.3), head);
        shake(spacing);
        judge(outcome, "spacing 0", spacing, anywhere);

        groom = ball(17, 16, 0.3); // a rest shape whose nodes lie upon each other
        groom.rest_position.resize(size_t(groom.blocks) * LANES * 16 * 3);
        for (int s = 0; s < groom.blocks * LANES; ++s)
            for (int k = 0; k < 16; ++k)
                for (int axis = 0; axis < 3; ++axis)
                    groom.rest_position[size_t(strand_value(s, k, axis, 16))] =
                        groom.root_position[size_t(strand_value(s, 0, axis, 1))];
        Trial folded(ground, params, groom, head);
        shake(folded);
        judge(outcome, "nodes upon each other at rest", folded);

        groom = ball(17, 16, 0.3); // a head of scale 0
        for (float& v : groom.root_position)
            v = 0.0f;
        groom.extent = groom.farthest = 0.0f;
        HairParams crowded = params;
        crowded.forces_repulsion = 10.0f;
        crowded.grid_resolution = 8;
        Trial point(ground, crowded, groom);
        shake(point);
        judge(outcome, "a head of no size", point);

        for (float& v : groom.root_direction)
            v = 0.0f;
        Trial nowhere(ground, params, groom);
        shake(nowhere);
        judge(outcome, "roots without direction", nowhere, {.stretch = 1.01}); // at rest all lies in the root
    }
    return outcome;
}

Outcome node_counts(const Ground& ground)
{
    Outcome outcome;
    const std::vector<int> counts = ground.quick ? std::vector{3, 64} : std::vector{3, 4, 5, 8, 33, 64, 128, 256};
    for (const int kind : {0, 1})
        for (const int nodes : counts)
        {
            ground.say(fmt::format("{} nodes", nodes));
            HairParams params = lone(kind);
            Trial trial(ground, params, ball(17, nodes, 0.3), {{{0, 0, 0}, 0.1f, true}});
            shake(trial);
            judge(outcome, fmt::format("{} nodes", nodes), trial);
        }
    return outcome;
}

Outcome strand_counts(const Ground& ground)
{
    Outcome outcome;
    const std::vector<int> counts = ground.quick ? std::vector{1, 17, 1000} : std::vector{1, 15, 16, 17, 1000, 200000};
    for (const int kind : {0, 1})
        for (const int guides : counts)
        {
            ground.say(fmt::format("{} strands", guides));
            HairParams params = lone(kind);
            Trial trial(ground, params, ball(guides, 16, 0.3));
            shake(trial, guides > 10000 ? 3 : 30);
            // Shaken for three steps, pbd has had no time to recover.
            judge(outcome, fmt::format("{} strands", guides), trial, {.reach = guides > 10000 ? 2.0 : 1.5});
        }
    // More than any device has: refused in words.
    Groom endless = ball(16, 16, 0.3);
    endless.blocks = 1 << 30;
    endless.guides = std::numeric_limits<int>::max();
    try
    {
        Solver solver(ground.device, lone(0), endless, {});
        outcome.faults.push_back("two thousand million strands were taken");
    }
    catch (const Error& e)
    {
        outcome.note = e.what();
    }
    return outcome;
}

// All lengths times s, all times by its root: the same path times s.
Outcome scale(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        std::vector<glm::dvec3> unit;
        for (const double s : {1.0, 0x1p-14, 0x1p-6, 1e-4, 1e-2, 1e2, 1e4})
        {
            HairParams params = lone(kind);
            params.forces_drag = float(3.0 / std::sqrt(s));
            Groom groom = row(4, 16, 0.3, {0.3, -1, 0.1});
            for (std::vector<float>* all : {&groom.root_position, &groom.segment_length})
                for (float& v : *all)
                    v *= float(s);
            for (float* v : {&groom.longest, &groom.extent, &groom.farthest})
                *v *= float(s);
            Trial trial(ground, params, groom);
            for (int i = 1; i <= 60; ++i) // the head turns only: a jump is one beyond 0.25 m at any scale
                trial.step(pose({0, 0, 0}, 0.5 * std::sin(0.1 * i)), float(std::sqrt(s) / 60.0));
            judge(outcome, fmt::format("scale {:g}", s), trial);
            std::vector<glm::dvec3> now = trial.nodes();
            double off = 0.0;
            for (size_t i = 0; i < now.size(); ++i)
            {
                now[i] /= s;
                if (!unit.empty())
                    off = std::max(off, glm::distance(now[i], unit[i]) / 0.3);
            }
            if (unit.empty())
                unit = now;
            expect(outcome, off <= 1e-3,
                   fmt::format("{}: scale {:g} is off by {:.3g} of its length", kSolvers[kind], s, off));
            outcome.note += fmt::format("{} {:g}: {:.1g}  ", kSolvers[kind], s, off);
        }
    }
    return outcome;
}

// ms that the solver's pass took, at least, over some steps.
static double quickest(Trial& trial)
{
    double least = INFINITY;
    trial.solver.take_times();
    for (int i = 0; i < 30; ++i)
    {
        trial.solver.step({{trial.solver.head(), trial.time, 1.0f / 60.0f}});
        for (const auto& [pass, ms] : trial.solver.take_times())
            if (pass.starts_with("simulate"))
                least = std::min(least, ms);
    }
    return least;
}

Outcome grid(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        HairParams params = lone(kind);
        params.forces_repulsion = 20.0f;
        params.grid_resolution = 8;
        params.grid_blur = 0.05f;
        Trial tiny(ground, params, ball(64, 16, 0.3), {{{0, 0, 0}, 0.1f, true}});
        shake(tiny);
        judge(outcome, "a grid of 8", tiny);

        // Strands longer than the grid was made for.
        Groom groom = ball(64, 16, 0.3);
        groom.longest = groom.farthest = 0.01f;
        Trial outside(ground, params, groom);
        shake(outside);
        judge(outcome, "hair outside of the grid", outside);

        // And flung out of everything: 100 km away, still numbers.
        const size_t values = size_t(groom.blocks) * LANES * 16 * 3;
        write(ground.device, outside.solver.buffers().at("position"), std::vector<float>(values, 1e5f));
        outside.rest(1);
        outside.watch.worst = {};
        outside.rest(60);
        judge(outcome, "hair flung out of the grid", outside);

        HairParams bare = lone(kind);
        bare.forces_gravity = 0.0f;
        bare.forces_drag = 0.0f;
        Trial normal(ground, bare, ball(4096, 16, 0.3)), small(ground, bare, ball(4096, 16, 0.3));
        const size_t many = size_t(256) * LANES * 16 * 3;
        for (Trial* trial : {&normal, &small})
            write(ground.device, trial->solver.buffers().at("velocity"),
                  std::vector<float>(many, trial == &small ? 1e-39f : 0.0f));
        const double ms_normal = quickest(normal), ms_small = quickest(small);
        expect(outcome, ms_small <= 2.0 * ms_normal + 0.5,
               fmt::format("{}: denormal velocities take {:.2f} ms instead of {:.2f}", kSolvers[kind], ms_small,
                           ms_normal));
        judge(outcome, "denormal velocities", small);
    }
    return outcome;
}

Outcome widths(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
        for (const int width : {1, 8, 16})
        {
            if (ground.device.is_gpu && width > 1)
                continue;
            Ground narrow = ground;
            narrow.device.width = width;
            HairParams params = lone(kind);
            params.forces_wind = F4(10.0f, 0.0f, 5.0f, 0.0f);
            Trial trial(narrow, params, ball(33, 16, 0.3),
                        {{{0, 0, 0}, 0.1f, true}, {{0.2f, -0.1f, 0.0f}, 0.08f, false}});
            shake(trial);
            judge(outcome, fmt::format("{} strands a work-item", width), trial);
        }
    return outcome;
}

} // namespace coif::stress

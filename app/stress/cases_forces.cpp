// Forces and strengths at and beyond the ends of their ranges.
#include "app/stress/cases.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace coif::stress
{

// How far strands lie along a direction: mean cosine of root to tip.
static double along(const Trial& trial, glm::dvec3 direction)
{
    const std::vector<glm::dvec3> x = trial.nodes();
    const size_t nodes = size_t(trial.solver.groom().nodes), guides = x.size() / nodes;
    double sum = 0.0;
    for (size_t g = 0; g < guides; ++g)
        sum += glm::dot(glm::normalize(x[g * nodes + nodes - 1] - x[g * nodes + 1]), glm::normalize(direction));
    return sum / double(guides);
}

Outcome gravity(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
        for (const float g : {0.0f, -2.0f, 10.0f, 100.0f, 1e4f})
        {
            HairParams params = lone(kind);
            params.forces_gravity = g;
            Trial trial(ground, params, ball(32, 16, 0.3));
            for (int i = 1; i <= 30; ++i)
                trial.step(pose({0.1 * std::sin(0.3 * i), 0, 0}));
            trial.rest(90);
            judge(outcome, fmt::format("{:g} g", g), trial);
            if (g >= 100.0f)
                expect(outcome, along(trial, {0, -1, 0}) > 0.9,
                       fmt::format("{}: under {:g} g hair does not hang: {:.2f}", kSolvers[kind], g,
                                   along(trial, {0, -1, 0})));
        }
    return outcome;
}

Outcome wind(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
        for (const float w : {1e-30f, 1.0f, 100.0f, 1e4f})
        {
            HairParams params = lone(kind);
            params.forces_wind = F4(w, 0.0f, 0.5f * w, 0.0f);
            params.forces_turbulence = w > 100.0f ? 0.3f : 4.0f;
            Trial trial(ground, params, ball(32, 16, 0.3));
            trial.rest(120);
            judge(outcome, fmt::format("wind of {:g} m/s^2", w), trial);
            if (w > 100.0f)
                expect(outcome, along(trial, {1, 0, 0.5}) > 0.7,
                       fmt::format("{}: in {:g} m/s^2 hair does not lie along the wind: {:.2f}", kSolvers[kind], w,
                                   along(trial, {1, 0, 0.5})));
        }
    return outcome;
}

// Of the guides' nodes, per mass, m^2/s^2.
static double kinetic(const Ground& ground, const Trial& trial)
{
    const Groom& groom = trial.solver.groom();
    const size_t count = size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3;
    double sum = 0.0;
    for (const float v : read<float>(ground.device, trial.solver.buffers().at("velocity"), count))
        sum += 0.5 * double(v) * double(v);
    return sum;
}

// Without other forces the air only takes; lengths do no work.
Outcome drag(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
        for (const float b : {0.0f, 1.0f, 100.0f, 1e4f, 1e6f})
        {
            HairParams params = lone(kind);
            params.forces_gravity = 0.0f;
            params.forces_drag = b;
            params.solver_bending = 0.0f;
            params.bending_droop = 1e4f;
            Trial trial(ground, params, row(16, 16, 0.3, {0.3, -1, 0}));
            double start = 0.0;
            for (int i = 1; i <= 12; ++i)
            {
                trial.step(pose({0.1 * (1.0 - std::cos(0.26 * i)), 0, 0}));
                start =
                    std::max(start, 1e-3 * kinetic(ground, trial)); // what pbd's lengths may still right themselves by
            }
            const double floor = start;
            trial.rest(2);
            start = std::max(start, kinetic(ground, trial));
            double most = 0.0, when = 0.0;
            for (int i = 1; i <= 60; ++i)
            {
                trial.rest(1);
                // Exactly it were exp(-2 b t). Half of that, and half as much again, leave room for the ends of whips,
                // whose speed is the mean of a substep.
                const double now = kinetic(ground, trial) / std::max(floor, start * std::exp(-double(b) * i / 60.0));
                when = now > most ? i / 60.0 : when;
                most = std::max(most, now);
            }
            expect(outcome, most <= 1.5,
                   fmt::format("{}: drag {:g}: {:.3g} times the energy that may be left after {:.2f} s", kSolvers[kind],
                               b, most, when));
            judge(outcome, fmt::format("drag of {:g} 1/s", b), trial);
        }
    return outcome;
}

static void play_with(Outcome& outcome, const Ground& ground, const HairParams& params, const std::string& what,
                      const Bounds& bounds = {})
{
    Trial trial(ground, params, ball(17, 16, 0.3), {{{0, 0, 0}, 0.1f, true}, {{0.1f, -0.1f, 0.0f}, 0.08f, true}});
    for (int i = 1; i <= 60; ++i)
        trial.step(pose({0.2 * std::sin(0.2 * i), 0, 0}, 0.8 * std::sin(0.1 * i)));
    trial.rest(30);
    judge(outcome, what, trial, bounds);
}

Outcome iterations(const Ground& ground)
{
    Outcome outcome;
    for (const int count : {-1, 0, 1, 3, 10, 100, 1000})
        for (const int sweeps : {0, 1})
        {
            HairParams params = lone(1);
            params.solver_iterations = count;
            params.solver_sweeps = sweeps;
            play_with(outcome, ground, params, fmt::format("{} sweeps", count));
        }
    for (const int count : {-1, 0, 1, 7, 16, 1000})
        for (const float courant : {-1.0f, 0.0f, 0.05f, 1.8f, 100.0f})
        {
            if (ground.quick && count != 0 && courant != 0.0f)
                continue;
            HairParams params = lone(0);
            params.solver_substeps = count;
            params.solver_courant = courant;
            play_with(outcome, ground, params, fmt::format("{} substeps, courant {}", count, courant));
        }
    return outcome;
}

Outcome stiffness(const Ground& ground)
{
    Outcome outcome;
    for (const float k : {-1.0f, 0.0f, 0.5f, 1.0f, 2.0f})
    {
        HairParams params = lone(1);
        params.solver_stretching = k;
        // Rubber is long; what it is bounded by is MOST_RUBBER of kernels/simulate_pbd.cl.
        play_with(outcome, ground, params, fmt::format("stretching {}", k), {.reach = k < 1.0f ? 4.1 : 1.5});
        params = lone(1);
        params.solver_bending = k;
        play_with(outcome, ground, params, fmt::format("bending {}", k));
        params.solver_bending_attenuation = 0.0f;
        params.solver_bending_scale = 2.0f;
        play_with(outcome, ground, params, fmt::format("brush of {}", k), {.reach = 3.0});
    }
    for (const float droop : {1e-6f, 0.01f, 1.0f, 100.0f, 1e4f, 1e9f})
    {
        HairParams params = lone(0);
        params.bending_droop = droop;
        play_with(outcome, ground, params, fmt::format("droop number {:g}", droop));
    }
    for (const float modulus : {1e-6f, 1.0f, 100.0f})
        for (const float diameter : {1.0f, 80.0f, 2000.0f})
        {
            if (ground.quick && diameter == 80.0f)
                continue;
            HairParams params = lone(0);
            params.bending_modulus = modulus;
            params.bending_diameter = diameter;
            params.bending_attenuation = modulus > 50.0f ? 8.0f : 0.0f;
            play_with(outcome, ground, params, fmt::format("{:g} GPa, {:g} um", modulus, diameter));
        }
    return outcome;
}

} // namespace coif::stress

// The head and the bodies in motion.
#include "app/options.h"
#include "app/stress/cases.h"
#include "sim/material.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif::stress
{

static double farthest(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b)
{
    double most = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        most = std::max(most, glm::distance(a[i], b[i]));
    return most;
}

Outcome teleport(const Ground& ground)
{
    Outcome outcome;
    const struct
    {
        const char* what;
        glm::dvec3 by;
        double turn;
    } jumps[] = {{"0.26 m", {0.26, 0, 0}, 0.0},
                 {"1 km", {1000.0, -1000.0, 500.0}, 0.0},
                 {"91 degrees", {0, 0, 0}, 91.0 * std::numbers::pi / 180.0},
                 {"1 km and about", {1000.0, 0, 0}, std::numbers::pi},
                 {"1e6 km", {1e9, 0, 0}, 0.0}};
    for (const int kind : {0, 1})
        for (const auto& jump : jumps)
        {
            Trial trial(ground, lone(kind), ball(32, 16, 0.3), {{{0, 0, 0}, 0.1f, true}});
            Trial stayed(ground, lone(kind), ball(32, 16, 0.3), {{{0, 0, 0}, 0.1f, true}});
            for (Trial* each : {&trial, &stayed})
                for (int i = 1; i <= 30; ++i)
                    each->step(pose({0.1 * std::sin(0.2 * i), 0, 0}));
            trial.step(pose(jump.by, jump.turn));
            stayed.rest(1);
            if (jump.turn == 0.0) // rigidly: as if nothing had happened
                expect(outcome, farthest(trial.nodes(), stayed.nodes()) <= 0.003,
                       fmt::format("{}: a jump of {} moves hair by {:.2g} m against its head", kSolvers[kind],
                                   jump.what, farthest(trial.nodes(), stayed.nodes())));
            trial.rest(30);
            judge(outcome, fmt::format("jump of {}", jump.what), trial);
        }
    return outcome;
}

namespace
{
struct Energy // of the nodes on average, J/kg
{
    double motion, weight;
};
} // namespace

static Energy energy_of_a_step(Trial& trial)
{
    const std::vector<glm::dvec3> before = trial.nodes();
    trial.rest(1);
    const std::vector<glm::dvec3> after = trial.nodes();
    Energy energy{0.0, 0.0};
    for (size_t i = 0; i < after.size(); ++i)
    {
        const glm::dvec3 velocity = 60.0 * (after[i] - before[i]);
        energy.motion += 0.5 * glm::dot(velocity, velocity) / double(after.size());
        energy.weight += kGravity * after[i].y / double(after.size());
    }
    return energy;
}

Outcome spin(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
        for (const double turns : {5.0, 10.0, 14.9, 20.0, 29.9, 100.0}) // a second
        {
            Trial trial(ground, lone(kind), ball(32, 16, 0.3), {{{0, 0, 0}, 0.1f, true}});
            for (int i = 1; i <= 60; ++i)
            {
                // As scripts do: the solver sees the way between.
                const double from = (i - 1) / 60.0, h = 1.0 / 60.0, rate = 2.0 * std::numbers::pi * turns;
                const auto way = [=](double share) { return pose({0, 0, 0}, rate * (from + share * h)); };
                trial.time += h;
                trial.solver.step({{way(1.0), trial.time, float(h), way}});
                look(trial.watch, trial.solver, trial.params, h);
            }
            const Energy spun = energy_of_a_step(trial);
            trial.rest(59);
            const Energy later = energy_of_a_step(trial);
            judge(outcome, fmt::format("{} rev/s", turns), trial);
            // The head stands still: drag takes its share, and only the weight gives.
            const double most = std::exp(-2.0 * double(trial.params.forces_drag)) * spun.motion +
                                std::max(0.0, spun.weight - later.weight);
            expect(outcome, later.motion < most,
                   fmt::format("{}: {:.3g} J/kg a second after {} rev/s, where drag and weight leave {:.3g}",
                               kSolvers[kind], later.motion, turns, most));
            trial.rest(120);
            const std::vector<glm::dvec3> before = trial.nodes();
            trial.rest(1);
            const double speed = 60.0 * farthest(before, trial.nodes());
            expect(outcome, speed < 0.5,
                   fmt::format("{}: {:.3g} m/s three seconds after {} rev/s", kSolvers[kind], speed, turns));
        }
    return outcome;
}

Outcome world_offset(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        HairParams params = lone(kind);
        params.forces_wind = F4(5.0f, 0.0f, 3.0f, 0.0f);
        params.forces_turbulence = 0.0f; // gusts belong to places
        const glm::dvec3 far(1e4, -1e4, 1e4);
        const std::vector<Collider> head = {{{0, 0, 0}, 0.1f, true}};
        Trial here(ground, params, ball(20, 16, 0.3), head), there(ground, params, ball(20, 16, 0.3), head, pose(far));
        for (int i = 1; i <= 60; ++i)
        {
            const glm::dvec3 at(0.1 * std::sin(0.1 * i), 0.1 * std::sin(0.17 * i), 0.0);
            here.step(pose(at, 0.5 * std::sin(0.1 * i)));
            there.step(pose(far + at, 0.5 * std::sin(0.1 * i)));
        }
        const double off = farthest(here.nodes(), there.nodes()) / 0.3;
        expect(outcome, off <= 1e-4,
               fmt::format("{}: 10 km away hair is off by {:.2g} of its length", kSolvers[kind], off));
        outcome.note += fmt::format("{} {:.1g}  ", kSolvers[kind], off);
        judge(outcome, "10 km away", there);
    }
    return outcome;
}

// A hand that is seen ten times a second: up to a quarter of a metre between two steps, and back.
Outcome coarse_drags(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
        for (const double amplitude : {0.1, 0.5, 1.4})
            for (const bool smooth : {true, false})
            {
                Trial trial(
                    ground, lone(kind), ball(48, 16, 0.3),
                    {{{0, 0, 0}, 0.1f, true}, {{0, -0.12f, 0.02f}, 0.06f, true}, {{0.35f, -0.1f, 0}, 0.1f, false}});
                const auto hand = [&](double t) { return amplitude * std::sin(2.0 * std::numbers::pi * 1.3 * t); };
                for (int i = 1; i <= 120; ++i)
                {
                    const double t = i / 60.0, frame = std::floor(t * 10.0 + 1e-9) / 10.0;
                    const double share = smooth ? (t - frame) * 10.0 : 0.0; // lerp as the editor, or all at once
                    const double x = hand(frame) + share * (hand(frame + 0.1) - hand(frame));
                    trial.step(pose({x, 0, 0}, 0.6 * x));
                }
                trial.rest(60);
                judge(outcome, fmt::format("drag of {} m at 10 fps, {}", amplitude, smooth ? "led" : "thrown"), trial);
            }
    return outcome;
}

Outcome overlap(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        const auto play =
            [&](const std::string& what, const std::vector<Collider>& bodies, double by, const Bounds& bounds = {})
        {
            Trial trial(ground, lone(kind), ball(48, 16, 0.3), bodies);
            for (int i = 1; i <= 90; ++i)
                trial.step(pose({by * std::sin(0.1 * i), 0, 0}));
            trial.rest(60);
            judge(outcome, what, trial, bounds);
        };
        play("two that overlap", {{{-0.06f, -0.2f, 0}, 0.1f, true}, {{0.06f, -0.2f, 0}, 0.1f, true}}, 0.0);
        play("a heap",
             {{{0, 0, 0}, 0.1f, true},
              {{0.05f, -0.05f, 0.05f}, 0.08f, true},
              {{-0.05f, -0.07f, 0.03f}, 0.07f, true},
              {{0.02f, 0.06f, -0.06f}, 0.09f, true}},
             0.2);
        play("one within another", {{{0, -0.15f, 0}, 0.1f, true}, {{0, -0.15f, 0.01f}, 0.05f, true}}, 0.1);
        play("the same twice", {{{0, -0.15f, 0}, 0.1f, true}, {{0, -0.15f, 0}, 0.1f, true}}, 0.1);
        play("one that holds all roots", {{{0, 0, 0}, 0.15f, true}}, 0.1);
        play("one that holds all hair", {{{0, 0, 0}, 10.0f, true}}, 0.1, {.penetration = 20.0});
        play("a wall", {{{0.0f, -100.2f, 0.0f}, 100.0f, false}}, 0.2);
        play("a squeeze", {{{-0.2f, -0.2f, 0}, 0.18f, false}, {{0.2f, -0.2f, 0}, 0.18f, false}}, 0.1);
        play("dust", {{{0.1f, -0.1f, 0}, 1e-5f, true}, {{0, -0.15f, 0}, 0.0f, true}}, 0.1);

        // Bodies that sweep hair into the creases between them.
        Trial swept(ground, lone(kind), ball(32, 9, 0.25),
                    {{{0, 0, 0}, 0.1f, true}, {{0.3f, -0.05f, 0}, 0.1f, false}, {{0, 0.05f, -0.3f}, 0.1f, true}});
        for (int i = 1; i <= 60; ++i)
            swept.step(pose({0, 0, 0}, 0.436 * i));
        swept.rest(60);
        judge(outcome, "a spin among bodies", swept);

        Trial held(ground, lone(kind), row(16, 16, 0.3, {0, -1, 0})); // a node at the very centre
        const glm::vec3 node(held.nodes()[9]);
        held.solver.set_colliders({{node, 0.03f, true}});
        held.rest(90);
        judge(outcome, "a node at the centre", held);

        Trial struck(ground, lone(kind), row(16, 16, 0.3, {0, -1, 0}), {{{0, 0, 0}, 0.05f, false}});
        for (int i = 1; i <= 120; ++i) // a body that goes through the hair at 6 m/s, and back
        {
            struck.solver.set_colliders({{{float(1.0 * std::sin(0.1 * i)), -0.15f, 0.0f}, 0.05f, false}});
            struck.rest(1);
        }
        struck.rest(30);
        // It moves between steps: hair finds itself inside, and leaves at its own pace.
        judge(outcome, "a body thrown through", struck, {.penetration = 0.06});
    }
    return outcome;
}

Outcome presets(const Ground& ground)
{
    Outcome outcome;
    const std::vector<std::filesystem::path> files = preset_files();
    const std::vector<const char*> motions = {"shake", "turn", "teleport", "drag", "gust"};
    for (size_t i = 0; i < files.size() && (i < 2 || !ground.quick); ++i)
        for (const int kind : {0, 1})
        {
            ground.say(files[i].stem().string());
            Hairstyle style = load_hairstyle(files[i]);
            style.params.solver_kind = kind;
            style.params.interpolation_strands = 64;
            style.params.grid_resolution = 16; // one set of kernels for all
            Simulation simulation(ground.device, style);
            Watch watch;
            look(watch, simulation.solver(), style.params, 0.0);
            for (size_t m = 0; m < (ground.quick ? 1 : motions.size()); ++m)
            {
                simulation.play(find_motion(motions[m]));
                for (int step = 0; step < 90; ++step)
                {
                    simulation.step(simulation.hand());
                    look(watch, simulation.solver(), style.params, simulation.step_seconds());
                    if (step % 16 == 0)
                        simulation.solver().take_times();
                }
            }
            simulation.play(std::nullopt);
            for (int step = 0; step < 60; ++step)
                simulation.step(simulation.hand());
            look(watch, simulation.solver(), style.params, simulation.step_seconds());
            simulation.solver().draw();
            std::string which;
            watch.worst.finite &= finite_everywhere(ground.device, simulation.solver(), true, which);
            judge(outcome, kind, style.name(), watch.worst, {.reach = 2.0});
        }
    return outcome;
}

} // namespace coif::stress

// Time: steps of every length, none at all, and time that stands still.
#include "app/stress/cases.h"

#include "sim/health.h"
#include "sim/material.h"

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace coif::stress
{

Outcome frame_lengths(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        const HairParams params = lone(kind);
        for (const float seconds : {0.0f, -1.0f, NAN, -INFINITY})
        {
            Trial trial(ground, params, ball(17, 16, 0.3), {{{0, 0, 0}, 0.1f, true}});
            trial.rest(3);
            const std::vector<glm::dvec3> before = trial.nodes();
            trial.step(pose({0.1, 0, 0}, 0.3), seconds);
            expect(outcome, trial.nodes() == before,
                   fmt::format("{}: a step of {} s moved hair", kSolvers[kind], seconds));
        }
        for (const float seconds : {1e-5f, 1e-4f, 1e-3f, 0.01f, 1.0f / 30.0f, 0.1f, 1.0f})
        {
            Trial trial(ground, params, ball(32, 16, 0.3), {{{0, 0, 0}, 0.1f, true}});
            for (int i = 1; i <= 60; ++i)
                trial.step(pose({0.2 * std::sin(5.0 * i * seconds), 0, 0}, 0.5 * std::sin(3.0 * i * seconds)), seconds);
            judge(outcome, fmt::format("steps of {:.3g} s", seconds), trial);
        }
    }

    // Frames of the editor and of a command: fixed steps whatever the frame, and no more than asked for.
    Hairstyle style;
    style.params.interpolation_strands = 0;
    style.params.forces_repulsion = style.params.look_self_shadow = 0.0f;
    Simulation simulation(ground.device, style);
    const double frames[] = {0.0, -1.0, NAN, INFINITY, 1e-5, 1e-3, 0.1, 1.0};
    for (const double seconds : frames)
    {
        const long before = simulation.steps(), dropped = simulation.dropped();
        const int taken = simulation.advance(seconds, pose({0.05, 0, 0}), 4);
        const bool none = !(seconds >= 0.02) || !std::isfinite(seconds);
        expect(outcome, taken <= (none ? 1 : 4) && simulation.steps() - before == taken,
               fmt::format("a frame of {} s took {} steps", seconds, taken));
        expect(outcome, (simulation.dropped() > dropped) == (std::isfinite(seconds) && seconds > 0.09),
               fmt::format("a frame of {} s: steps dropped: {}", seconds, simulation.dropped() - dropped));
    }
    expect(outcome, measure_health(simulation.solver(), style.params, false).stretch_max <= 0.01,
           "stretched by long frames");
    return outcome;
}

// A strand held level falls with its head: no force is between them, so a solver that loses gravity in small steps
// leaves it behind.
Outcome free_fall(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        HairParams params = lone(kind);
        params.forces_drag = 0.0f;
        params.solver_bending = 0.0f;
        params.bending_droop = 1e4f;
        Trial trial(ground, params, row(1, 16, 0.3, {1, 0, 0}));
        const std::vector<glm::dvec3> start = trial.nodes();
        const double h = 1e-5, seconds = ground.quick ? 0.01 : 0.03;
        const int steps = int(std::lround(seconds / h));
        for (int i = 1; i <= steps; ++i)
            trial.step(pose({0.0, -0.5 * kGravity * (i * h) * (i * h), 0.0}), float(h));
        const double fallen = 0.5 * kGravity * seconds * seconds;
        double off = 0.0;
        const std::vector<glm::dvec3> now = trial.nodes();
        for (size_t i = 0; i < now.size(); ++i)
            off = std::max(off, glm::distance(now[i], start[i]));
        expect(outcome, off <= 0.01 * fallen,
               fmt::format("{}: {:.3g} % of the fall is missing", kSolvers[kind], 100.0 * off / fallen));
        outcome.note += fmt::format("{} {:.2g} % ", kSolvers[kind], 100.0 * off / fallen);
        judge(outcome, "free fall", trial);
    }
    return outcome;
}

// The same motion, undisturbed and with everything that an afternoon at the desk does to it.
Outcome pause_and_reload(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        Hairstyle style;
        style.params.solver_kind = kind;
        style.params.interpolation_strands = 64;
        style.params.grid_resolution = 16;
        style.params.strand_nodes = 16;
        Simulation calm(ground.device, style), busy(ground.device, style);
        for (Simulation* simulation : {&calm, &busy})
            simulation->play(find_motion("shake"));
        const double frame = 1.0 / 60.0;
        for (int f = 0; f < 60; ++f)
        {
            calm.advance(frame, calm.hand(), 4);
            if (f == 20)
                for (int i = 0; i < 5; ++i) // paused: time stands still, pictures go on
                {
                    busy.advance(0.0, busy.hand(), 4);
                    busy.solver().draw();
                }
            if (f == 30)
            {
                Hairstyle saved = busy.style();
                const std::filesystem::path file = ground.folder / fmt::format("reload-{}.toml", kSolvers[kind]);
                save_hairstyle(saved, file);
                busy.set_style(load_hairstyle(file), true);
            }
            busy.advance(frame, busy.hand(), 4);
        }
        const size_t values = size_t(calm.solver().groom().blocks) * LANES * size_t(style.params.strand_nodes) * 3;
        for (const char* name : {"position", "velocity"})
            expect(outcome,
                   read<float>(ground.device, calm.solver().buffers().at(name), values) ==
                       read<float>(ground.device, busy.solver().buffers().at(name), values),
                   fmt::format("{}: '{}' differs after a pause and a reload", kSolvers[kind], name));
        // Away from the window for a minute: whole steps are dropped, and told.
        busy.advance(60.0, busy.hand(), 4);
        expect(outcome, busy.dropped() == 3596, fmt::format("{} steps dropped of a lost minute", busy.dropped()));
        Watch watch;
        look(watch, busy.solver(), style.params, 0.0);
        judge(outcome, kind, "after a lost minute", watch.worst);
    }
    return outcome;
}

} // namespace coif::stress

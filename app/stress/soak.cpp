// Ten minutes of a hand that never rests.
#include "app/stress/cases.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <unistd.h>

namespace coif::stress
{

// Resident memory, bytes; 0 where the system does not tell.
static double resident()
{
    std::ifstream statm("/proc/self/statm");
    double total = 0.0, pages = 0.0;
    statm >> total >> pages;
    return statm ? pages * double(sysconf(_SC_PAGESIZE)) : 0.0;
}

// A new shake every two seconds, of its own size, axis and pace.
static Pose shaken(int seed, double t)
{
    const int turn = int(t / 2.0);
    const auto random = [&](int channel) { return double(random01(seed, turn, channel)); };
    const double pace = 2.0 * std::numbers::pi * (1.0 + std::floor(4.0 * random(0))) / 2.0; // whole swings
    const double swing = std::sin(pace * (t - 2.0 * turn));
    Pose p;
    for (int axis = 0; axis < 3; ++axis)
        p.origin[axis] = 0.12 * (2.0 * random(1 + axis) - 1.0) * swing;
    p.turn = glm::angleAxis(1.2 * (2.0 * random(4) - 1.0) * swing, glm::dvec3(0, 1, 0));
    if (random(5) < 0.5)
        p.wind = glm::dvec3(40.0 * (2.0 * random(6) - 1.0), 0.0, 40.0 * random(7)) *
                 (0.5 - 0.5 * std::cos(std::numbers::pi * t));
    return p;
}

Outcome soak(const Ground& ground)
{
    Outcome outcome;
    for (const int kind : {0, 1})
    {
        HairParams params = lone(kind);
        params.forces_repulsion = 1.0f;
        params.grid_resolution = 16;
        params.forces_drag = 1.0f;
        params.forces_turbulence = 1.0f;
        Trial trial(ground, params, ball(32, 16, 0.3), {{{0, 0, 0}, 0.1f, true}, {{0, -0.12f, 0.02f}, 0.06f, true}});
        const long steps = std::lround(60.0 * ground.soak);
        double warm = 0.0, energy[2] = {0.0, 0.0};
        float4 gusts = {};
        for (long i = 1; i <= steps; ++i)
        {
            trial.step(shaken(ground.seed, double(i) / 60.0));
            const float4 now = trial.solver.info().gust_origin;
            if (i == steps)
                expect(outcome, trial.solver.info().wind.w == 0.0f || !(now == gusts), "gusts stand still at the end");
            gusts = now;
            if (i == std::max(1L, steps / 5))
                warm = resident();
            if (i % 60 == 0)
            {
                double sum = 0.0;
                for (const float v : read<float>(ground.device, trial.solver.buffers().at("velocity"), 2 * 16 * 16 * 3))
                    sum += 0.5 * double(v) * double(v);
                double& most = energy[2 * i > steps];
                most = std::max(most, sum);
                if (i % 1800 == 0)
                    ground.say(fmt::format("{}, {} of {:.0f} s", kSolvers[kind], i / 60, ground.soak));
            }
        }
        const double grown = warm > 0.0 ? resident() / warm - 1.0 : 0.0;
        judge(outcome, fmt::format("{:.0f} s", ground.soak), trial);
        expect(outcome, grown < 0.01,
               fmt::format("{}: resident memory grew by {:.2f} %", kSolvers[kind], 100.0 * grown));
        expect(
            outcome, energy[1] <= 2.0 * energy[0] + 1e-6,
            fmt::format("{}: kinetic energy grew from {:.3g} to {:.3g} m^2/s^2", kSolvers[kind], energy[0], energy[1]));
        outcome.note += fmt::format("{}: memory {:+.2f} %, energy x{:.2f}  ", kSolvers[kind], 100.0 * grown,
                                    energy[1] / std::max(energy[0], 1e-12));
    }
    return outcome;
}

} // namespace coif::stress

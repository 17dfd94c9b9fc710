// Styles and motions that nobody would think of. What fails is kept as files that `coif report` plays again.
#include "app/stress/cases.h"
#include "app/stress/random_style.h"
#include "sim/error.h"

#include <chrono>
#include <cmath>

namespace coif::stress
{

namespace fs = std::filesystem;

static Figures play(const Ground& ground, const Hairstyle& style, const Motion& motion)
{
    Simulation simulation(ground.device, style);
    simulation.play(motion);
    Watch watch;
    look(watch, simulation.solver(), style.params, 0.0);
    const int steps = int(std::lround(style.params.solver_rate));
    for (int i = 0; i < steps; ++i)
    {
        simulation.step(simulation.hand());
        look(watch, simulation.solver(), style.params, simulation.step_seconds());
        if (i % 16 == 0)
            simulation.solver().take_times();
    }
    simulation.solver().draw();
    std::string which;
    if (!finite_everywhere(ground.device, simulation.solver(), true, which))
    {
        watch.worst.finite = false;
        watch.worst.fault += which;
    }
    return watch.worst;
}

Outcome random_styles(const Ground& ground)
{
    Outcome outcome;
    const fs::path folder = ground.folder / "random";
    fs::create_directories(folder);
    write_file(folder / "scalp.obj", small_scalp());
    std::string csv = "number,solver,rate,nodes,passed,stretch,penetration_mm,reach,finite,resets,seconds,fault\n";
    long failed = 0;
    const int begin = int(ground.from), end = int(ground.from + ground.styles);
    for (int number = begin; number < end; ++number)
    {
        if (number % 10 == 0)
            ground.say(fmt::format("style {} of {}, {} failed", number - begin, ground.styles, failed));
        Hairstyle style = random_style(ground.seed, number, "scalp.obj");
        style.file = folder / fmt::format("{}.toml", number); // where its scalp lies
        const Motion motion = random_motion(ground.seed, number);
        for (const int kind : {0, 1})
        {
            style.params.solver_kind = kind;
            Outcome one;
            const auto began = std::chrono::steady_clock::now();
            const Figures figures = play(ground, style, motion);
            // Rubber is bounded by MOST_RUBBER of kernels/simulate_pbd.cl.
            judge(one, kind, fmt::format("seed {} style {}", ground.seed, number), figures,
                  {.reach = style.params.solver_stretching < 1.0f ? 4.1 : 1.5});
            for (const std::string& trespass : find_trespasses(ground.device))
                one.faults.push_back(
                    fmt::format("seed {} style {}, {}: {}", ground.seed, number, kSolvers[kind], trespass));
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
            add(outcome.figures[kind], figures);
            csv += fmt::format("{},{},{:.6g},{},{},{:.6g},{:.6g},{:.6g},{},{},{},\"{}\"\n", number, kSolvers[kind],
                               style.params.solver_rate, style.params.strand_nodes, one.faults.empty(), figures.stretch,
                               1e3 * figures.penetration, figures.reach, figures.finite, figures.resets,
                               ground.untimed ? "" : fmt::format("{:.3f}", seconds.count()),
                               one.faults.empty() ? "" : one.faults.front());
            if (one.faults.empty())
                continue;
            ++failed;
            Hairstyle kept = style;
            const std::string name = fmt::format("{}-{}-{}", ground.seed, number, kSolvers[kind]);
            save_hairstyle(kept, folder / (name + ".toml"));
            write_file(folder / (name + "-motion.toml"), motion_text(motion));
            one.faults.front() +=
                "\n      again: " +
                (ground.keep
                     ? fmt::format("coif report {0}.toml --motion {0}-motion.toml --seconds 1 --fps {1:.9g}",
                                   (folder / name).string(), style.params.solver_rate)
                     : fmt::format("coif stress --only random --seed {} --from {} --cases 1", ground.seed, number));
            outcome.faults.insert(outcome.faults.end(), one.faults.begin(), one.faults.end());
        }
    }
    write_file(ground.folder / "random.csv", csv);
    outcome.note = fmt::format("{} of {} failed", failed, 2 * ground.styles);
    return outcome;
}

} // namespace coif::stress

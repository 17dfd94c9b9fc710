// Styles and motions that nobody would think of. What fails is kept as files that `coif report` plays again.
#include "app/batch/jobs.h"
#include "app/batch/run.h"
#include "app/csv.h"
#include "app/stress/cases.h"
#include "app/stress/random_style.h"
#include "sim/error.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

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

static const char* const kHead =
    "number,solver,rate,nodes,passed,stretch,penetration_mm,reach,finite,resets,seconds,fault\n";

// Plays one style by both solvers. Returns its rows; keeps what failed.
static std::string play_style(const Ground& ground, int number, Outcome& outcome, long& failed)
{
    const fs::path folder = ground.folder / "random";
    std::string csv;
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
            (ground.keep ? fmt::format("coif report {0}.toml --motion {0}-motion.toml --seconds 1 --fps {1:.9g}",
                                       (folder / name).string(), style.params.solver_rate)
                         : fmt::format("coif stress --only random --seed {} --from {} --cases 1", ground.seed, number));
        outcome.faults.insert(outcome.faults.end(), one.faults.begin(), one.faults.end());
    }
    return csv;
}

// The same by processes, as the tasks of `coif jobs stress`. A style that failed there is played here again, for all of
// its faults and for what is kept of it.
static std::string play_by_tasks(const Ground& ground, Outcome& outcome, long& failed)
{
    const int each = int(std::clamp(ground.styles / (4L * ground.jobs), 1L, 20L));
    JobsOptions wanted;
    wanted.from = ground.from;
    wanted.count = ground.styles;
    wanted.each = each;
    wanted.seed = ground.seed;
    wanted.untimed = ground.untimed;
    if (!ground.wish.empty())
        wanted.passed = {"--device", ground.wish};
    const std::vector<std::string> lines = stress_jobs(wanted);
    ground.say(fmt::format("{} styles in {} processes", ground.styles, ground.jobs));
    const RunHere done(lines, ground.jobs);
    std::vector<std::pair<std::string, std::string>> tables = {{"", kHead}};
    for (size_t i = 0; i < lines.size(); ++i)
    {
        std::string fault;
        const fs::path file = done.result(i, &fault);
        if (file.empty())
        {
            ++failed;
            outcome.faults.push_back(fmt::format("coif {}: {}", lines[i], fault));
            continue;
        }
        tables.emplace_back(lines[i], read_file(file));
        std::set<int> again;
        for (const std::vector<std::string>& row : csv_records(tables.back().second))
        {
            if (row[0] == "number")
                continue;
            if (row[4] != "true")
                again.insert(std::stoi(row[0]));
            Figures figures;
            figures.stretch = std::stod(row[5]);
            figures.penetration = 1e-3 * std::stod(row[6]);
            figures.reach = std::stod(row[7]);
            figures.finite = row[8] == "true";
            figures.resets = std::stol(row[9]);
            figures.looks = 1 + std::lround(std::stod(row[2])); // steps of a second
            add(outcome.figures[row[1] == kSolvers[1]], figures);
        }
        Outcome known;
        for (const int number : again)
            play_style(ground, number, known, failed);
        outcome.faults.insert(outcome.faults.end(), known.faults.begin(), known.faults.end());
    }
    return joined_csv(tables);
}

Outcome random_styles(const Ground& ground)
{
    Outcome outcome;
    const fs::path folder = ground.folder / "random";
    fs::create_directories(folder);
    write_file(folder / "scalp.obj", small_scalp());
    long failed = 0;
    std::string csv = kHead;
    if (ground.jobs > 1 && ground.styles > 1)
        csv = play_by_tasks(ground, outcome, failed);
    else
        for (long number = ground.from; number < ground.from + ground.styles; ++number)
        {
            if ((number - ground.from) % 10 == 0)
                ground.say(fmt::format("style {} of {}, {} failed", number - ground.from, ground.styles, failed));
            csv += play_style(ground, int(number), outcome, failed);
        }
    write_file(ground.folder / "random.csv", csv);
    outcome.note = fmt::format("{} of {} failed", failed, 2 * ground.styles);
    return outcome;
}

} // namespace coif::stress

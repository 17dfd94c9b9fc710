#include "app/stress/stress.h"

#include "app/csv.h"
#include "app/image.h"
#include "app/json.h"
#include "app/progress.h"
#include "app/stress/cases.h"
#include "sim/error.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace coif
{

namespace
{
struct Row
{
    const stress::Case* of;
    stress::Outcome outcome;
    double seconds;
};
} // namespace

static std::vector<const stress::Case*> wanted_cases(const std::vector<std::string>& only)
{
    std::vector<std::string> names;
    for (const stress::Case& c : stress::cases())
        names.emplace_back(c.name);
    std::vector<const stress::Case*> wanted;
    for (const size_t i : selected(only, names, "case"))
        wanted.push_back(&stress::cases()[i]);
    return wanted;
}

static std::string csv_of(const std::vector<Row>& rows, bool untimed)
{
    std::string csv = "case,solver,passed,finite,stretch_max,penetration_max_mm,resets,steps,seconds,faults,note\n";
    for (const Row& row : rows)
        for (const int kind : {0, 1})
        {
            const stress::Figures& f = row.outcome.figures[kind];
            // A case that plays no solver has a row all the same, or nobody would learn what it found.
            if (f.looks == 0 && (kind == 0 || row.outcome.figures[0].looks > 0))
                continue;
            const bool none = f.looks == 0;
            csv += fmt::format(
                "{},{},{},{},{:.6g},{:.6g},{},{},{},{},{}\n", row.of->name, none ? "" : stress::kSolvers[kind],
                row.outcome.faults.empty(), f.finite, f.stretch, 1e3 * f.penetration, f.resets, f.looks,
                untimed ? "" : fmt::format("{:.3f}", row.seconds),
                csv_quoted(fmt::format("{}", fmt::join(row.outcome.faults, "; "))), csv_quoted(row.outcome.note));
        }
    return csv;
}

static void write_tables(const std::filesystem::path& folder, const std::vector<Row>& rows, const std::string& device,
                         int seed, bool untimed)
{
    std::vector<std::string> objects;
    for (const Row& row : rows)
    {
        std::vector<std::string> solvers, faults;
        for (const int kind : {0, 1})
        {
            const stress::Figures& f = row.outcome.figures[kind];
            if (f.looks == 0)
                continue;
            solvers.push_back(fmt::format("\"{}\": {{\"finite\": {}, \"stretch_max\": {}, \"penetration_max_mm\": {}, "
                                          "\"resets\": {}, \"steps\": {}}}",
                                          stress::kSolvers[kind], f.finite, json_number(f.stretch),
                                          json_number(1e3 * f.penetration), f.resets, f.looks));
        }
        for (const std::string& fault : row.outcome.faults)
            faults.push_back(json_text(fault));
        objects.push_back(fmt::format("  {{\"case\": \"{}\", \"expected\": {}, \"passed\": {}, \"seconds\": {:.3f}, "
                                      "\"note\": {}, \"faults\": [{}]{}{}}}",
                                      row.of->name, json_text(row.of->expected), row.outcome.faults.empty(),
                                      row.seconds, json_text(row.outcome.note), fmt::join(faults, ", "),
                                      solvers.empty() ? "" : ", ", fmt::join(solvers, ", ")));
    }
    write_file(folder / "stress.csv", csv_of(rows, untimed));
    write_file(folder / "stress.json", fmt::format("{{\"device\": {}, \"seed\": {}, \"cases\": [\n{}\n]}}\n",
                                                   json_text(device), seed, fmt::join(objects, ",\n")));
}

static void print(const Row& row)
{
    const stress::Outcome& o = row.outcome;
    const auto figures = [&](int kind)
    {
        const stress::Figures& f = o.figures[kind];
        return f.looks == 0 ? std::string(17, ' ')
                            : fmt::format("{:>7.3f} {:>9.3f}", 100.0 * f.stretch, 1e3 * f.penetration);
    };
    fmt::print("{:<15} {:<6} {} {} {:>7.1f}  {}\n", row.of->name, o.faults.empty() ? "pass" : "FAIL", figures(0),
               figures(1), row.seconds, o.note.empty() ? row.of->expected : o.note);
    for (size_t i = 0; i < o.faults.size() && i < 12; ++i)
        fmt::print("    {}\n", o.faults[i]);
    if (o.faults.size() > 12)
        fmt::print("    and {} more\n", o.faults.size() - 12);
    std::fflush(stdout);
}

int run_stress(const Options& options, const StressOptions& wanted)
{
    const auto now = std::chrono::steady_clock::now;
    const auto since = [&](auto begin) { return std::chrono::duration<double>(now() - begin).count(); };
    const std::vector<const stress::Case*> all = wanted_cases(wanted.only);
    if (wanted.styles < -1 || wanted.styles > 1000000)
        throw fail("--cases {}: expected 0 to 1000000", wanted.styles);
    if (wanted.from < 0 || wanted.from > 1000000)
        throw fail("--from {}: expected 0 to 1000000", wanted.from);
    if (wanted.soak != -1.0 && !(wanted.soak > 0.0 && wanted.soak <= 86400.0))
        throw fail("--seconds {}: expected up to a day", wanted.soak);
    stress::Ground ground;
    ground.device = open_device(options);
    ground.device.guards = std::make_shared<Guards>();
    ground.device.built = std::make_shared<std::map<std::string, Kernel>>();
    namespace fs = std::filesystem;
    ground.folder = options.output.empty() ? "stress" : options.output;
    const bool rows_alone = ground.folder.extension() == ".csv" && !fs::is_directory(ground.folder);
    if (rows_alone)
    {
        check_folder(options.output);
        ground.folder = fs::temp_directory_path() / fmt::format("coif-stress-{}", getpid());
        ground.keep = false;
    }
    ground.from = wanted.from;
    ground.untimed = wanted.untimed;
    ground.jobs = wanted.jobs;
    ground.wish = options.device;
    ground.seed = wanted.seed;
    ground.quick = wanted.quick;
    ground.styles = wanted.styles >= 0 ? wanted.styles : wanted.quick ? 20 : 2000;
    ground.soak = wanted.soak > 0.0 ? wanted.soak : wanted.quick ? 10.0 : 600.0;
    make_folder(ground.folder);

    const Progress progress;
    fmt::print("{}, seed {}\n", ground.device.name, ground.seed);
    fmt::print("{:<15} {:<6} {:^17} {:^17} {:>7}\n", "", "", "direct: %, mm", "pbd: %, mm", "s");
    std::vector<Row> rows;
    const auto begin = now();
    for (const stress::Case* c : all)
    {
        ground.say = [&](const std::string& words)
        { progress.say(fmt::format("[{}/{}] {}: {}", rows.size() + 1, all.size(), c->name, words)); };
        ground.say("");
        const auto started = now();
        stress::Outcome outcome;
        try
        {
            outcome = c->run(ground);
        }
        catch (const Error& e) // a device or file that fails is this case's fault, not the end
        {
            outcome.faults.push_back(e.what());
        }
        for (const std::string& trespass : find_trespasses(ground.device))
            outcome.faults.push_back("outside of a buffer: " + trespass);
        progress.clear();
        rows.push_back({c, std::move(outcome), since(started)});
        print(rows.back());
    }
    if (rows_alone)
    {
        const bool styles = all.size() == 1 && all[0]->name == std::string("random");
        write_file(options.output, styles ? read_file(ground.folder / "random.csv") : csv_of(rows, wanted.untimed));
        std::error_code ignored;
        fs::remove_all(ground.folder, ignored);
        return 0;
    }
    write_tables(ground.folder, rows, ground.device.name, ground.seed, wanted.untimed);
    const auto failed = std::count_if(rows.begin(), rows.end(), [](const Row& r) { return !r.outcome.faults.empty(); });
    fmt::print("{} of {} cases passed in {:.0f} s; tables in {}\n", ptrdiff_t(rows.size()) - failed, rows.size(),
               since(begin), ground.folder.string());
    return failed ? 1 : 0;
}

} // namespace coif

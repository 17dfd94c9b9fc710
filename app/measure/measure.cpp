#include "app/measure/measure.h"

#include "app/batch/jobs.h"
#include "app/batch/run.h"
#include "app/csv.h"
#include "app/image.h"
#include "app/measure/plots.h"
#include "app/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace coif
{

namespace fs = std::filesystem;

static std::vector<Scene> wanted_scenes(const std::vector<std::string>& only)
{
    std::vector<std::string> ids;
    for (const Scene& scene : scenes())
        ids.emplace_back(scene.id);
    std::vector<Scene> wanted;
    for (const size_t i : selected(only, ids, "scene"))
        wanted.push_back(scenes()[i]);
    return wanted;
}

static void forget_prices(std::vector<Row>& rows)
{
    std::erase_if(rows, [](const Row& row) { return row.metric.starts_with("price"); });
    for (Row& row : rows)
        row.ms = row.ns_strand_frame = NAN;
}

// The scenes as the tasks of `coif jobs sweep`.
static std::vector<Row> measure_by_tasks(const Options& options, const MeasureOptions& wanted)
{
    JobsOptions jobs;
    jobs.only = wanted.only;
    if (wanted.quick)
        jobs.passed.push_back("--quick");
    if (!options.device.empty())
        jobs.passed.insert(jobs.passed.end(), {"--device", options.device});
    const std::vector<std::string> lines = sweep_jobs(jobs);
    const RunHere done(lines, wanted.jobs);
    std::vector<std::pair<std::string, std::string>> tables;
    for (size_t i = 0; i < lines.size(); ++i)
    {
        std::string fault;
        const fs::path file = done.result(i, &fault);
        if (file.empty())
            throw fail("coif {}: {}", lines[i], fault);
        tables.emplace_back(lines[i], read_file(file));
    }
    return rows_of(joined_csv(tables));
}

int measure(const Options& options, const MeasureOptions& wanted)
{
    const std::vector<Scene> all = wanted_scenes(wanted.only);
    if (wanted.jobs > 1 && !wanted.untimed)
        throw fail("-j {}: scenes that run at once disturb each other's prices; say --untimed, or -j 1", wanted.jobs);
    const fs::path folder = options.output.empty() ? "measure" : options.output;
    const bool rows_alone = folder.extension() == ".csv" && !fs::is_directory(folder);
    if (rows_alone)
        check_folder(folder);
    else
        make_folder(folder);
    const Device device = open_device(options);
    Measuring with{device, wanted.quick};
    if (!rows_alone)
        with.folder = folder;
    const Progress line;

    std::vector<Row> rows;
    const bool by_tasks = wanted.jobs > 1 && all.size() > 1;
    if (by_tasks)
    {
        line.say(fmt::format("{} scenes in {} processes", all.size(), wanted.jobs));
        rows = measure_by_tasks(options, wanted);
    }
    for (size_t i = 0; !by_tasks && i < all.size(); ++i)
    {
        with.progress = [&](const std::string& doing)
        { line.say(fmt::format("{} of {}: {}: {}", i + 1, all.size(), all[i].id, doing)); };
        with.progress(all[i].title);
        std::vector<Row> more = all[i].run(with);
        if (wanted.untimed)
            forget_prices(more);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    line.clear();

    fmt::print("{}", table_of(rows)); // first: it needs no room on a disk
    std::fflush(stdout);
    if (rows_alone)
    {
        write_file(folder, csv_of(rows));
        return 0;
    }
    write_file(folder / "measure.csv", csv_of(rows));
    write_file(folder / "measure.json", json_of(rows, device.name, wanted.quick));
    const std::string trouble = write_plots(folder, plots_of(rows));
    if (!trouble.empty())
        fmt::print(stderr, "coif: {}\n", trouble);
    const auto missed = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.passed(); });
    fmt::print(stderr, "wrote {}: {} rows, {} missed\n", folder.string(), rows.size(), missed);
    return missed ? 1 : 0;
}

} // namespace coif

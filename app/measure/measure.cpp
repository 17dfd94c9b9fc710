#include "app/measure/measure.h"

#include "app/measure/plots.h"
#include "sim/error.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <unistd.h>

namespace coif
{

namespace fs = std::filesystem;

static std::vector<Scene> wanted_scenes(const std::vector<std::string>& only)
{
    if (only.empty())
        return scenes();
    std::vector<Scene> wanted;
    std::vector<std::string> ids;
    for (const Scene& scene : scenes())
    {
        ids.push_back(scene.id);
        if (std::find(only.begin(), only.end(), scene.id) != only.end())
            wanted.push_back(scene);
    }
    for (const std::string& id : only)
        if (std::find(ids.begin(), ids.end(), id) == ids.end())
            throw fail("--only {}: there is no such scene; there are {}", id, fmt::join(ids, ", "));
    return wanted;
}

int measure(const Options& options, const MeasureOptions& wanted)
{
    const std::vector<Scene> all = wanted_scenes(wanted.only);
    const fs::path folder = options.output.empty() ? "measure" : options.output;
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw fail("{}: the folder cannot be made: {}", folder.string(), error.message());
    if (access(folder.c_str(), W_OK | X_OK) != 0) // before a quarter of an hour's work, not after
        throw fail("{}: the folder cannot be written into", folder.string());
    const Device device = open_device(options);
    Measuring with{device, wanted.quick};
    const bool terminal = isatty(STDERR_FILENO);
    const auto begin = std::chrono::steady_clock::now();

    std::vector<Row> rows;
    for (size_t i = 0; i < all.size(); ++i)
    {
        if (terminal)
            with.progress = [&](const std::string& doing)
            {
                const auto seconds =
                    std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - begin);
                fmt::print(stderr, "\r\033[K{} of {}: {}: {} ({} s)", i + 1, all.size(), all[i].id, doing,
                           seconds.count());
            };
        with.progress(all[i].title);
        const std::vector<Row> more = all[i].run(with);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    if (terminal)
        fmt::print(stderr, "\r\033[K");

    fmt::print("{}", table_of(rows)); // first: it needs no room on a disk
    std::fflush(stdout);
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

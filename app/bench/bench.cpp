#include "app/bench/bench.h"

#include "app/measure/plots.h"
#include "app/progress.h"
#include "sim/hairstyle.h"

#include <fmt/format.h>

#include <cstdio>

namespace coif
{

namespace fs = std::filesystem;

static const BenchScene kScenes[] = {
    {"head", "a whole head, all strands simulated", bench_whole_head},
    {"guides", "guides, and what is drawn of them", bench_guides},
    {"thesis", "against the thesis' own way", bench_thesis},
    {"picture", "drawing strands", bench_picture},
    {"look", "light in hair", bench_look},
    {"growth", "over strands and cores", bench_growth},
    {"start", "from nothing to a picture", bench_start},
};

// Time over the number of strands, and on how many cores.
static std::vector<Plot> bench_plots(const std::vector<BenchRow>& rows)
{
    std::string data, curves;
    std::vector<std::string> notes;
    for (const BenchRow& row : rows)
        if (row.scene == "growth" && row.what == "frame" &&
            std::find(notes.begin(), notes.end(), row.note) == notes.end())
            notes.push_back(row.note);
    if (notes.empty())
        return {};
    for (size_t i = 0; i < notes.size(); ++i)
    {
        data += fmt::format("$growth{} << END\n", i);
        for (const BenchRow& row : rows)
            if (row.scene == "growth" && row.what == "frame" && row.note == notes[i])
                data += fmt::format("{} {} {} {}\n", row.strands, row.ms, row.low, row.high);
        data += "END\n";
        curves += fmt::format("{}$growth{} using 1:2:3:4 with yerrorlines pointtype 7 linetype {} title '{}'",
                              i ? ", " : "plot ", i, i + 1, notes[i]);
    }
    const std::string body = "set logscale xy\nset xlabel 'strands, all simulated'\nset ylabel 'ms a frame'\n"
                             "set key left top\nset grid\nset xrange [200:140000]\n" +
                             curves +
                             ", 1000.0 / 60.0 with lines dashtype 2 linecolor 'gray' title '60 frames a second'\n";
    return {{"growth", 720, 480, data, body}};
}

int bench(const Options& options, const BenchOptions& wanted)
{
    std::vector<std::string> ids;
    for (const BenchScene& scene : kScenes)
        ids.emplace_back(scene.id);
    const std::vector<size_t> chosen = selected(wanted.only, ids, "scene");
    const fs::path folder = options.output.empty() ? "bench" : options.output;
    make_folder(folder);
    const Device device = open_device(options);
    const Progress line;
    line.say("the machine's limits");
    const Machine machine = measure_machine(device);
    Benching with{device, machine, wanted.quick, {}, folder};
    std::vector<BenchRow> rows;
    for (size_t i = 0; i < chosen.size(); ++i)
    {
        const BenchScene& scene = kScenes[chosen[i]];
        with.progress = [&](const std::string& doing)
        { line.say(fmt::format("{} of {}: {}: {}", i + 1, chosen.size(), scene.id, doing)); };
        with.progress(scene.title);
        for (BenchRow& row : scene.run(with))
        {
            row.scene = scene.id;
            rows.push_back(row);
        }
    }
    line.clear();
    fmt::print("{}", wanted.json  ? bench_json(rows, machine)
                     : wanted.csv ? bench_csv(rows, machine)
                                  : bench_table(rows, machine));
    std::fflush(stdout);
    write_file(folder / "bench.csv", bench_csv(rows, machine));
    write_file(folder / "bench.json", bench_json(rows, machine));
    const std::string trouble = write_plots(folder, bench_plots(rows));
    if (!trouble.empty())
        fmt::print(stderr, "coif: {}\n", trouble);
    const auto missed = std::count_if(rows.begin(), rows.end(), [](const BenchRow& r) { return !r.reached(); });
    fmt::print(stderr, "wrote {}: {} rows, {} short of what is wanted\n", folder.string(), rows.size(), missed);
    return 0;
}

} // namespace coif

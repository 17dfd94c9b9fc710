#include "app/batch/batch.h"

#include "sim/error.h"

#include <CLI/CLI.hpp>

#include <cstdio>

namespace coif
{

// Options that lines hand on, word for word.
static const struct Passed
{
    const char* name;
    const char* help;
} kPassed[] = {
    {"--set", "group.key=value, on top of the file; as often as wanted"},
    {"--variant", "The [variant.NAME] of the styles that is to be on"},
    {"--tolerance", "Error of the motion that is good enough, as 1%"},
    {"--motion", "Motion to play: a file, or one of coif's"},
    {"--time", "When to take it, s"},
    {"--camera", "front, left, right, back, top, or yaw,pitch[,distance] (deg, m)"},
    {"--samples", "Pictures averaged against jagged edges"},
    {"--seconds", "How long, s"},
    {"--fps", "Frames a second"},
    {"--frames", "FIRST:LAST of the motion, both too"},
    {"--device", "cpu, gpu, or a part of an OpenCL device's name; say it where machines differ"},
};

static void pass(CLI::App* kind, JobsOptions& wanted, std::initializer_list<const char*> names)
{
    for (const Passed& one : kPassed)
        for (const char* name : names)
            if (one.name == std::string(name))
                kind->add_option_function<std::vector<std::string>>(
                        name,
                        [&wanted, name](const std::vector<std::string>& values)
                        {
                            for (const std::string& value : values)
                                wanted.passed.insert(wanted.passed.end(), {name, value});
                        },
                        one.help)
                    ->allow_extra_args(false);
}

static void add_jobs(CLI::App* jobs, JobsOptions& wanted)
{
    const auto kind = [&](const char* name, const char* help) { return jobs->add_subcommand(name, help); };
    const auto with_styles = [&](CLI::App* command)
    { return command->add_option("STYLE", wanted.styles, "Hairstyle files, or names of presets"); };
    const auto with_size = [&](CLI::App* command)
    {
        command->add_option_function<std::string>(
            "--size",
            [&](const std::string& size) {
                wanted.passed.insert(wanted.passed.end(), {"--size", size});
            },
            "WIDTHxHEIGHT of each picture, pixels (360x360)");
    };
    CLI::App* sheet = kind("sheet", "A picture of each style; merge makes a sheet");
    with_styles(sheet)->required();
    sheet->add_option("--random", wanted.random, "Styles that chance makes of each, instead of itself")
        ->check(CLI::PositiveNumber);
    with_size(sheet);
    pass(sheet, wanted,
         {"--set", "--variant", "--tolerance", "--motion", "--time", "--camera", "--samples", "--device"});

    CLI::App* turntable = kind("turntable", "A picture of each view in a turn; merge makes a film or a sheet");
    with_styles(turntable)->required();
    turntable->add_option("--views", wanted.views, "Views in a turn")->capture_default_str();
    with_size(turntable);
    pass(turntable, wanted,
         {"--set", "--variant", "--tolerance", "--motion", "--time", "--camera", "--samples", "--device"});

    CLI::App* sweep = kind("sweep", "The scenes of coif measure, or styles at many settings; merge makes a table");
    with_styles(sweep);
    sweep->add_option("--vary", wanted.vary, "group.key=VALUE,VALUE,...: a report at each; several: all together")
        ->allow_extra_args(false);
    sweep->add_flag_function(
        "--quick", [&](int64_t) { wanted.passed.push_back("--quick"); }, "Scenes with fewer points");
    sweep->add_option("--only", wanted.only, "Scenes, separated by commas")->delimiter(',');
    pass(sweep, wanted, {"--motion", "--seconds", "--fps", "--device"});

    CLI::App* stress = kind("stress", "The cases of coif stress, or its random styles; merge makes a table");
    stress->add_flag_function(
        "--quick", [&](int64_t) { wanted.passed.push_back("--quick"); }, "Less of everything");
    stress->add_option("--only", wanted.only, "Cases, separated by commas")->delimiter(',');
    stress->add_option("--count", wanted.count, "Random styles and motions, instead of cases");
    stress->add_option("--each", wanted.each, "Random styles in a line")->capture_default_str();
    stress->add_option("--seed", wanted.seed, "Of what is random")->capture_default_str();
    pass(stress, wanted, {"--device"});

    CLI::App* cache = kind("cache", "A motion of each style for other programs; merge gathers them in a folder");
    with_styles(cache)->required();
    cache->add_option("--format", wanted.format, "Ending of the files, as coif export knows them")
        ->capture_default_str();
    pass(cache, wanted, {"--set", "--variant", "--tolerance", "--motion", "--frames", "--fps", "--device"});
    jobs->require_subcommand(1);
}

std::shared_ptr<Batch> add_batch(CLI::App& app)
{
    const auto batch = std::make_shared<Batch>();
    batch->jobs = app.add_subcommand("jobs", "Write a list of tasks for many machines, a coif command a line");
    add_jobs(batch->jobs, batch->wanted);

    batch->run = app.add_subcommand("run", "Do what is not done yet of a list of tasks");
    batch->run->add_option("LIST", batch->list, "List of tasks, as coif jobs writes it")->required();
    batch->run->add_option("--out", batch->running.folder, "Folder of the results")->required();
    batch->run->add_option("--shard", batch->shard, "I/N: only the tasks whose number is I modulo N")
        ->check(
            [](const std::string& text)
            {
                try
                {
                    parse_shard(text);
                    return std::string();
                }
                catch (const Error& e)
                {
                    return std::string(e.what());
                }
            });
    batch->run->add_option("-j,--jobs", batch->running.jobs, "Tasks at a time")
        ->capture_default_str()
        ->check(CLI::Range(1, 1024));
    batch->run->add_option("--tries", batch->running.tries, "Of a task that fails")
        ->capture_default_str()
        ->check(CLI::Range(1, 100));
    batch->run
        ->add_option("--threads", batch->running.threads,
                     "Processors for a task; unsaid: its share of Slurm's, or of those the process may use")
        ->check(CLI::Range(1, 1024));

    batch->merge = app.add_subcommand("merge", "Join the results of a list of tasks, in its order");
    batch->merge->add_option("LIST", batch->list, "List of tasks")->required();
    batch->merge->add_option("--out", batch->merging.folder, "Folder of the results")->required();
    batch->merge
        ->add_option("-o,--output", batch->merging.output,
                     ".png: a sheet; .mp4, .webm, .gif: a film; .csv, .json, .txt: all in one; NAME/: a folder")
        ->required();
    batch->merge->add_option("--columns", batch->merging.columns, "Pictures in a row of a sheet");
    batch->merge->add_option("--fps", batch->merging.fps, "Pictures a second of a film")
        ->capture_default_str()
        ->check(CLI::Range(1.0, 1000.0));
    return batch;
}

bool is_batch(const Batch& batch) { return batch.jobs->parsed() || batch.run->parsed() || batch.merge->parsed(); }

static int write_jobs(const Batch& batch)
{
    static const struct Made
    {
        const char* name;
        std::vector<std::string> (*lines)(const JobsOptions&);
        bool pictures;
    } kinds[] = {{"sheet", sheet_jobs, true},
                 {"turntable", turntable_jobs, true},
                 {"sweep", sweep_jobs, false},
                 {"stress", stress_jobs, false},
                 {"cache", cache_jobs, false}};
    for (const Made& kind : kinds)
        if (batch.jobs->got_subcommand(kind.name))
        {
            JobsOptions wanted = batch.wanted;
            if (kind.pictures && !std::ranges::count(wanted.passed, "--size"))
                wanted.passed.insert(wanted.passed.begin(), {"--size", "360x360"});
            for (const std::string& line : kind.lines(wanted))
                fmt::print("{}\n", line);
        }
    return 0;
}

int run_batch(const Batch& batch, const CheckLine& check)
{
    if (batch.jobs->parsed())
        return write_jobs(batch);
    try
    {
        const std::vector<Task> tasks = read_list(batch.list, check);
        if (batch.merge->parsed())
            return merge_tasks(tasks, batch.merging);
        RunOptions running = batch.running;
        running.shard = parse_shard(batch.shard);
        return run_tasks(tasks, running);
    }
    catch (const BadList& e)
    {
        fmt::print(stderr, "coif: {}\n", e.what());
        return 2;
    }
}

} // namespace coif

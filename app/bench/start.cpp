// How long it takes from nothing to a picture: the whole program, as it is called, with the kernels that it finds.
#include "app/bench/hair.h"
#include "app/shot.h"
#include "app/statistics.h"
#include "sim/error.h"
#include "sim/program_cache.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <chrono>

extern char** environ;

namespace coif
{

// ms from the start of such a process to its end.
static double ms_of(const std::vector<std::string>& words)
{
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const auto begin = std::chrono::steady_clock::now();
    pid_t process = 0;
    const int error = posix_spawn(&process, arguments[0], &quiet, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&quiet);
    int status = 0;
    if (error != 0 || waitpid(process, &status, 0) != process || status != 0)
        throw fail("bench: {} did not take its picture", words[0]);
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<BenchRow> bench_start(const Benching& with)
{
    Options options;
    options.style = "bob";
    options.device = with.device.name;
    options.output = with.folder / "start.png";
    ShotOptions shot;
    shot.samples = 1;
    with.progress("compiles and keeps what a picture takes"); // once on a machine
    {
        ProgramKeeper programs;
        take_shot(options, shot, 0.0);
        programs.finish();
    }
    const std::string self = std::filesystem::read_symlink("/proc/self/exe");
    const std::vector<std::string> words = {self, "shot",     "bob",          "--time", "0",           "--samples",
                                            "1",  "--device", options.device, "-o",     options.output};
    std::vector<double> ms;
    for (int i = 0; i < (with.quick ? 3 : 9); ++i)
    {
        with.progress("from nothing to a picture");
        ms.push_back(ms_of(words));
    }
    BenchRow row;
    row.what = "a shot of bob, 1280 x 720";
    row.note = "kernels cached";
    row.cores = with.machine.compute_units;
    row.ms = percentile(ms, 0.5);
    row.low = percentile(ms, 0.25);
    row.high = percentile(ms, 0.75);
    row.most_ms = 1000.0;
    return {row};
}

} // namespace coif

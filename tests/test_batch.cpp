// coif jobs, run and merge as scripts and farms call them: killed, run twice at once, fed with what is wrong. However
// it was come by, a merge has the bytes of a run from end to end, or is not there.
#include "app/batch/results.h"
#include "tests/commands.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <thread>

using namespace coif;
using namespace coif::test;

namespace
{
using namespace std::chrono_literals;

class Batches : public Commands
{
  protected:
    // Six tables of one strand, each of some bytes of its own.
    void write_lab(const std::string& name = "lab.txt")
    {
        std::string text = "# one strand\n";
        for (int i = 1; i <= 6; ++i)
            text += "lab --seconds 0.1 --nodes 6 --gamma " + std::to_string(i) + " -o g" + std::to_string(i) + ".csv\n";
        write(name, text);
    }
    // Tasks that need no device.
    void write_checks(int count = 6)
    {
        std::string text;
        for (int i = 1; i <= count; ++i)
            text += "check small.toml" + std::string(i % 3, ' ') + (i % 2 ? " small.toml" : "") + "\n";
        write("checks.txt", text);
    }
    std::vector<std::string> files(const std::string& in) const
    {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder / in))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    std::vector<std::string> results(const std::string& in, const std::string& ending = ".csv") const
    {
        std::vector<std::string> names;
        for (const std::string& name : files(in))
            if (name.ends_with(ending) && !name.ends_with(".log"))
                names.push_back(name);
        return names;
    }
    // Starts coif without waiting for it.
    pid_t start(const std::vector<std::string>& words) const
    {
        std::vector<char*> arguments;
        for (const std::string& word : words)
            arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        const std::string program = COIF_BUILD_FOLDER "/coif";
        const pid_t process = fork();
        if (process != 0)
            return process;
        const int nothing = open("/dev/null", O_RDWR);
        if (chdir(folder.c_str()) != 0 || dup2(nothing, 0) < 0 || dup2(nothing, 1) < 0 || dup2(nothing, 2) < 0)
            _exit(126);
        execv(program.c_str(), arguments.data());
        _exit(127);
    }
    static int end_of(pid_t process)
    {
        int status = 0;
        waitpid(process, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    template <typename Condition> static bool comes_true(Condition condition, std::chrono::seconds limit = 60s)
    {
        for (const auto end = std::chrono::steady_clock::now() + limit; std::chrono::steady_clock::now() < end;)
        {
            if (condition())
                return true;
            std::this_thread::sleep_for(20ms);
        }
        return false;
    }
    // A process that has this in its command line, its words parted by blanks; 0: there is none.
    static pid_t process_with(const std::string& words)
    {
        for (const auto& entry : fs::directory_iterator("/proc"))
        {
            std::ifstream in(entry.path() / "cmdline", std::ios::binary);
            std::string line{std::istreambuf_iterator<char>(in), {}};
            std::ranges::replace(line, '\0', ' ');
            if (line.find(words) != line.npos)
                return std::atoi(entry.path().filename().c_str());
        }
        return 0;
    }
    int shell(const std::string& command, const std::string& setting = {}) const
    {
        const std::string all = "cd '" + folder.string() + "' && env -u DISPLAY COIF='" COIF_BUILD_FOLDER "/coif' " +
                                setting + " " + command + " > out.txt 2> err.txt < /dev/null";
        const int status = std::system(all.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    static bool has(const std::string& program)
    {
        return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
    }
};
} // namespace

TEST_F(Batches, a_sheet_in_shards_has_the_bytes_of_the_sheet)
{
    write("red.toml", "[interpolation]\nstrands = 100\n[grid]\nresolution = 16\n[look]\nroot_color = \"#a01010\"\n");
    fs::create_directories(folder / "other");
    write("other/red.toml", "[interpolation]\nstrands = 100\n[grid]\nresolution = 16\n[strand]\nlength = 0.1\n");
    const std::string how = " small.toml red.toml other/red.toml --size 48x48 --samples 2 --time 0.1";
    const Result jobs = coif("jobs sheet" + how);
    ASSERT_EQ(jobs.status, 0) << jobs.err;
    EXPECT_EQ(jobs.out.substr(0, jobs.out.find('\n')),
              "shot small.toml --size 48x48 --time 0.1 --samples 2 -o small.png");
    write("jobs.txt", jobs.out);
    const Result run = coif("run jobs.txt --out whole -j 2");
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "3 of 3 tasks done, 0 kept, 0 failed\n");
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 3) << "a line a task:\n" << run.out;
    EXPECT_NE(run.out.find("2 done "), std::string::npos);
    for (const char* shard : {"2/3", "0/3", "1/3"})
        EXPECT_EQ(coif(std::string("run jobs.txt --out parts --shard ") + shard).status, 0) << shard;
    EXPECT_EQ(results("whole", ".png"), results("parts", ".png")) << "names tell keys and bytes";
    EXPECT_EQ(files("whole"), files("parts")) << "nothing but results and logs";
    ASSERT_EQ(coif("merge jobs.txt --out parts -o merged.png").status, 0);
    ASSERT_EQ(coif("sheet" + how + " -o sheet.png").status, 0);
    EXPECT_EQ(contents("merged.png"), contents("sheet.png"));
    write("bad.toml", "[strand]\nlength = \"long\"\n");
    const Result alone = coif("sheet bad.toml" + how + " -o a.png"),
                 many = coif("sheet bad.toml" + how + " -o b.png -j 3");
    EXPECT_EQ(alone.status, 1);
    EXPECT_EQ(many.status, 1);
    EXPECT_EQ(many.err.substr(0, many.err.find("wrote")), alone.err.substr(0, alone.err.find("wrote")));
    EXPECT_EQ(contents("b.png"), contents("a.png")) << "by processes too, what fails included";
    const Result again = coif("run jobs.txt --out whole");
    EXPECT_EQ(again.out, "1 kept\n2 kept\n3 kept\n");
    ASSERT_EQ(coif("merge jobs.txt --out whole -o pictures/").status, 1) << "red.png twice";
    EXPECT_EQ(coif("merge jobs.txt --out whole -o x.csv").status, 1);
    EXPECT_FALSE(fs::exists(folder / "x.csv"));
}

TEST_F(Batches, a_turntable_by_views_is_the_turntable)
{
    const std::string how = " small.toml --size 32x32 --samples 1 --time 0";
    write("jobs.txt", coif("jobs turntable --views 3" + how).out);
    ASSERT_EQ(coif("run jobs.txt --out views").status, 0);
    ASSERT_EQ(coif("merge jobs.txt --out views -o gathered/").status, 0);
    ASSERT_EQ(coif("shot --turntable 3" + how + " -o t.png").status, 0);
    for (const char* view : {"0000", "0001", "0002"})
        EXPECT_EQ(contents(std::string("gathered/small_") + view + ".png"),
                  contents(std::string("t_") + view + ".png"));
    EXPECT_NE(contents("t_0000.png"), contents("t_0001.png"));
    EXPECT_EQ(coif("shot --turntable 3 --view 3" + how + " -o x.png").status, 1);
    // A film takes the pictures in the list's order.
    fs::create_directories(folder / "bin");
    write("bin/ffmpeg", "#!/bin/sh\nfor last; do :; done\ncat > \"${last#file:}\"\n");
    fs::permissions(folder / "bin/ffmpeg", fs::perms::owner_all);
    ASSERT_EQ(
        coif("merge jobs.txt --out views -o film.mp4", "PATH='" + (folder / "bin").string() + "':\"$PATH\"").status, 0);
    std::string raw;
    for (const char* name : {"t_0000.png", "t_0001.png", "t_0002.png"})
    {
        const Image image = load_png(folder / name);
        raw.append(image.pixels.begin(), image.pixels.end());
    }
    EXPECT_EQ(contents("film.mp4"), raw);
}

TEST_F(Batches, a_run_that_is_killed_goes_on_to_the_same_bytes)
{
    write_lab();
    ASSERT_EQ(coif("run lab.txt --out serial").status, 0);
    ASSERT_EQ(coif("merge lab.txt --out serial -o serial.csv").status, 0);
    const std::string serial = contents("serial.csv");
    ASSERT_EQ(std::count(serial.begin(), serial.end(), '\n'), 1 + 6 * 7) << serial;

    const pid_t runner = start({"coif", "run", "lab.txt", "--out", "killed"});
    ASSERT_TRUE(comes_true([&] { return fs::exists(folder / "killed") && results("killed").size() >= 2; }));
    kill(runner, SIGKILL);
    EXPECT_EQ(end_of(runner), 128 + SIGKILL);
    EXPECT_TRUE(comes_true([&] { return process_with("-o killed/0000") == 0; }, 5s)) << "its tasks die with it";
    const size_t left = results("killed").size();
    ASSERT_LT(left, 6u) << "it was killed too late to tell anything";
    for (const std::string& name : results("killed"))
        EXPECT_TRUE(std::ranges::count(results("serial"), name)) << name << " is whole";
    const Result early = coif("merge lab.txt --out killed -o killed.csv");
    EXPECT_EQ(early.status, 1);
    EXPECT_NE(early.err.find("missing 6: lab --seconds 0.1 --nodes 6 --gamma 6 -o g6.csv\n"), std::string::npos)
        << early.err;
    EXPECT_FALSE(fs::exists(folder / "killed.csv"));

    const Result rest = coif("run lab.txt --out killed -j 2");
    EXPECT_EQ(rest.status, 0);
    EXPECT_EQ(rest.err, std::to_string(6 - left) + " of 6 tasks done, " + std::to_string(left) + " kept, 0 failed\n");
    ASSERT_EQ(coif("merge lab.txt --out killed -o killed.csv").status, 0);
    EXPECT_EQ(contents("killed.csv"), serial);
    EXPECT_EQ(results("killed"), results("serial"));
}

TEST_F(Batches, a_run_that_is_asked_to_stop_leaves_nothing_unfinished)
{
    write("slow.txt", "stress --only random --cases 1000000 -o a.csv\n");
    const pid_t runner = start({"coif", "run", "slow.txt", "--out", "slow"});
    ASSERT_TRUE(comes_true([&] { return fs::exists(folder / "slow") && !results("slow", ".tmp").empty(); }));
    std::this_thread::sleep_for(200ms);
    kill(runner, SIGTERM);
    EXPECT_EQ(end_of(runner), 128 + SIGTERM);
    EXPECT_TRUE(results("slow", ".tmp").empty());
    EXPECT_TRUE(results("slow").empty());
}

TEST_F(Batches, two_runs_on_one_folder_do_no_harm)
{
    write_lab();
    ASSERT_EQ(coif("run lab.txt --out one").status, 0);
    const pid_t a = start({"coif", "run", "lab.txt", "--out", "both"});
    const pid_t b = start({"coif", "run", "lab.txt", "--out", "both"});
    EXPECT_EQ(end_of(a), 0);
    EXPECT_EQ(end_of(b), 0);
    EXPECT_EQ(results("both"), results("one"));
    EXPECT_EQ(files("both"), files("one"));
}

TEST_F(Batches, a_result_that_somebody_edited_is_found_and_made_again)
{
    write_checks();
    ASSERT_EQ(coif("run checks.txt --out D").status, 0);
    ASSERT_EQ(coif("merge checks.txt --out D -o good.txt").status, 0);
    const std::string edited = "D/" + results("D", ".txt")[2], before = contents(edited);
    write(edited, before + " or so");
    const Result merge = coif("merge checks.txt --out D -o bad.txt");
    EXPECT_EQ(merge.status, 1);
    EXPECT_NE(merge.err.find("changed 3: " + edited), std::string::npos) << merge.err;
    EXPECT_FALSE(fs::exists(folder / "bad.txt"));
    const Result run = coif("run checks.txt --out D");
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("has been changed since it was made"), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("2 kept\n3 done "), std::string::npos) << run.out;
    ASSERT_EQ(coif("merge checks.txt --out D -o again.txt").status, 0);
    EXPECT_EQ(contents("again.txt"), contents("good.txt"));

    // Two results of one task, both as they were made: of machines that do not agree.
    const std::string name = results("D", ".txt")[0], stem = name.substr(0, 23);
    write("other.txt", "something else\n");
    fs::copy_file(folder / "other.txt", folder / "D" / (stem + "-" + digest_of_file(folder / "other.txt") + ".txt"));
    const Result twice = coif("merge checks.txt --out D -o twice.txt");
    EXPECT_EQ(twice.status, 1);
    EXPECT_NE(twice.err.find("ambiguous 1: "), std::string::npos) << twice.err;
    EXPECT_FALSE(fs::exists(folder / "twice.txt"));
}

TEST_F(Batches, what_is_edited_between_runs_is_done_anew)
{
    write_checks(3);
    ASSERT_EQ(coif("run checks.txt --out D").status, 0);
    const std::string list = contents("checks.txt");
    write("checks.txt", "# a word\n\n" + list);
    EXPECT_EQ(coif("run checks.txt --out D").out, "1 kept\n2 kept\n3 kept\n") << "comments are no change";
    const size_t second = list.find('\n') + 1;
    write("checks.txt", list.substr(0, second) + "check bob long\n" + list.substr(list.find('\n', second) + 1));
    EXPECT_EQ(coif("merge checks.txt --out D -o m.txt").status, 1);
    const Result line = coif("run checks.txt --out D");
    EXPECT_NE(line.out.find("1 kept\n2 done "), std::string::npos) << line.out;
    EXPECT_NE(line.out.find("3 kept\n"), std::string::npos) << line.out;
    ASSERT_EQ(coif("merge checks.txt --out D -o m.txt").status, 0);
    EXPECT_NE(contents("m.txt").find("bob: good\nlong: good\n"), std::string::npos) << contents("m.txt");
    write("small.toml", "[interpolation]\nstrands = 201\n");
    const Result missing = coif("merge checks.txt --out D -o m.txt");
    EXPECT_EQ(missing.status, 1) << "the old merge is of another style";
    EXPECT_NE(missing.err.find("2 of 3 tasks are missing"), std::string::npos) << missing.err;
    const Result style = coif("run checks.txt --out D");
    EXPECT_NE(style.out.find("2 kept\n3 done "), std::string::npos) << style.out;
}

TEST_F(Batches, a_task_that_fails_is_told_and_the_others_are_done)
{
    write("bad.toml", "[strand]\nlength = -1\n");
    write("jobs.txt", "check small.toml\ncheck bad.toml\ncheck small.toml\n");
    const Result run = coif("run jobs.txt --out D --tries 3");
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.out.find("2 failed: status 1"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find("3 done "), std::string::npos) << run.out;
    EXPECT_EQ(run.err, "2 of 3 tasks done, 0 kept, 1 failed\n");
    EXPECT_EQ(results("D", ".txt").size(), 2u);
    EXPECT_TRUE(results("D", ".tmp").empty());
    const Result merge = coif("merge jobs.txt --out D -o m.txt");
    EXPECT_EQ(merge.status, 1);
    EXPECT_NE(merge.err.find("missing 2: check bad.toml\n"), std::string::npos) << merge.err;

    // Errors of the program go to the log, once a try.
    write("fails.txt", "lab --gamma 5 --nodes 1\n");
    const Result told = coif("run fails.txt --out E --tries 3");
    EXPECT_EQ(told.status, 1);
    const std::string log = contents("E/" + files("E").at(0));
    size_t tries = 0;
    for (size_t at = 0; (at = log.find("coif: ", at)) != log.npos; ++at)
        ++tries;
    EXPECT_EQ(tries, 3u) << log;
    EXPECT_NE(told.out.find(log.substr(0, log.find('\n'))), std::string::npos)
        << "its last words are told: " << told.out;
}

TEST_F(Batches, a_list_with_a_bad_line_is_refused_before_any_work)
{
    write("jobs.txt", "check small.toml\nshot nobody -o a.png\nshot small.toml --zise 3 -o b.png\n"
                      "shot small.toml --set strand.length=-1 -o c.png\nshot small.toml -o ../../x.png\nrm -rf x\n"
                      "shot small.toml --size 3 -o a.png\n");
    for (const char* command :
         {"run jobs.txt --out D", "run jobs.txt --out D --shard 1/100", "merge jobs.txt --out D -o m.png"})
    {
        const Result refused = coif(command);
        EXPECT_EQ(refused.status, 2) << command;
        EXPECT_EQ(refused.out, "");
        for (const char* says :
             {"jobs.txt:2: 'nobody' is neither", "jobs.txt:3: ", "jobs.txt:4: --set strand.length=-1",
              "jobs.txt:5: -o ../../x.png", "jobs.txt:6: 'rm' makes no file", "jobs.txt:7: --size 3"})
            EXPECT_NE(refused.err.find(says), std::string::npos) << says << " in\n" << refused.err;
        EXPECT_EQ(refused.err.find("jobs.txt:1:"), std::string::npos);
        EXPECT_FALSE(fs::exists(folder / "D"));
    }
    EXPECT_EQ(coif("run nothing.txt --out D").status, 2);
    EXPECT_EQ(coif("run jobs.txt").status, 2);
    EXPECT_EQ(coif("run jobs.txt --out D --shard 3/3").status, 2);
    EXPECT_EQ(coif("run jobs.txt --out D -j 0").status, 2);
    EXPECT_EQ(coif("jobs").status, 2);
    EXPECT_EQ(coif("jobs sheet").status, 2);
    EXPECT_EQ(coif("jobs sheet nobody").status, 1);
    write("good.txt", "check small.toml\n");
    write("file", "");
    EXPECT_EQ(coif("run good.txt --out file").status, 1);
    EXPECT_EQ(coif("run good.txt --out /proc/here").status, 1);
    EXPECT_EQ(coif("merge good.txt --out nowhere -o m.txt").status, 1);
    ASSERT_EQ(coif("run good.txt --out D").status, 0);
    EXPECT_EQ(coif("merge good.txt --out D -o no/such/m.txt").status, 1);
    EXPECT_EQ(coif("merge good.txt --out D -o m.png").status, 1);
}

TEST_F(Batches, without_room_nothing_is_kept_by_halves)
{
    std::string long_line = "check";
    for (int i = 0; i < 40; ++i)
        long_line += " small.toml";
    write("jobs.txt", "check small.toml\n" + long_line + "\ncheck small.toml small.toml\n");
    // No file may grow beyond 512 bytes: to a program that is as a disk without room.
    EXPECT_EQ(shell("sh -c 'ulimit -f 1; exec \"$COIF\" run jobs.txt --out D'"), 1) << contents("err.txt");
    EXPECT_NE(contents("out.txt").find("2 failed: "), std::string::npos) << contents("out.txt");
    EXPECT_EQ(results("D", ".txt").size(), 2u);
    EXPECT_TRUE(results("D", ".tmp").empty());
    EXPECT_EQ(coif("run jobs.txt --out D").status, 0);
    EXPECT_EQ(shell("sh -c 'ulimit -f 1; exec \"$COIF\" merge jobs.txt --out D -o m.txt'") == 0, false);
    EXPECT_FALSE(fs::exists(folder / "m.txt"));
    ASSERT_EQ(coif("merge jobs.txt --out D -o m.txt").status, 0);
    EXPECT_EQ(contents("m.txt").size(), 43 * std::string("small.toml: good\n").size());
}

TEST_F(Batches, no_clock_is_asked_what_is_done)
{
    write_checks(3);
    ASSERT_EQ(coif("run checks.txt --out D").status, 0);
    const auto now = fs::file_time_type::clock::now();
    fs::last_write_time(folder / "small.toml", now + 10000h);
    const std::vector<std::string> all = files("D");
    for (size_t i = 0; i < all.size(); ++i)
        fs::last_write_time(folder / "D" / all[i], i % 2 ? now + 20000h : now - 200000h);
    EXPECT_EQ(coif("run checks.txt --out D").out, "1 kept\n2 kept\n3 kept\n");
    fs::create_directories(folder / "D/000001-0123456789abcdef.elsewhere.7.tmp");
    fs::last_write_time(folder / "D/000001-0123456789abcdef.elsewhere.7.tmp", now - 30h);
    const Result merge = coif("merge checks.txt --out D -o m.txt");
    EXPECT_EQ(merge.status, 0) << merge.err;
    EXPECT_NE(merge.err.find("removed what 1 killed tasks had left"), std::string::npos) << merge.err;
    EXPECT_EQ(files("D"), all);
}

TEST_F(Batches, measure_in_lines_is_measure)
{
    const Result jobs = coif("jobs sweep --quick --only A1,A2");
    write("jobs.txt", jobs.out);
    ASSERT_EQ(coif("run jobs.txt --out D -j 2").status, 0);
    ASSERT_EQ(coif("merge jobs.txt --out D -o merged.csv").status, 0);
    ASSERT_EQ(coif("measure --quick --only A1,A2 --untimed -o measured").status, 0);
    EXPECT_EQ(contents("merged.csv"), contents("measured/measure.csv"));
    const Result many = coif("measure --quick --only A1,A2 --untimed -o many -j 2");
    ASSERT_EQ(many.status, 0) << many.err;
    EXPECT_EQ(contents("many/measure.csv"), contents("measured/measure.csv"));
    EXPECT_EQ(contents("many/measure.json"), contents("measured/measure.json"));
    EXPECT_EQ(coif("measure --quick --only A1,A2 -o many -j 2").status, 1) << "prices want the machine alone";
    // With a row that misses its bound the merge has the status of the command, and is there.
    std::string table = contents("merged.csv");
    write("table.csv", table.substr(0, table.find('\n') + 1) + "A1,,x,direct,,,,1,L,,,,,,0.5,0.1,MISSED\n");
    const std::string name = results("D")[1];
    fs::remove(folder / "D" / name);
    fs::copy_file(folder / "table.csv",
                  folder / "D" / (name.substr(0, 23) + "-" + digest_of_file(folder / "table.csv") + ".csv"));
    const Result missed = coif("merge jobs.txt --out D -o missed.csv");
    EXPECT_EQ(missed.status, 1);
    EXPECT_NE(missed.err.find("1 rows missed"), std::string::npos) << missed.err;
    EXPECT_TRUE(fs::exists(folder / "missed.csv"));
}

TEST_F(Batches, stress_in_lines_is_stress)
{
    write("jobs.txt", coif("jobs stress --count 3 --each 2 --seed 37").out);
    ASSERT_EQ(coif("run jobs.txt --out D").status, 0);
    ASSERT_EQ(coif("merge jobs.txt --out D -o merged.csv").status, 0);
    ASSERT_EQ(coif("stress --only random --cases 3 --seed 37 --untimed -o strained").status, 0);
    EXPECT_EQ(contents("merged.csv"), contents("strained/random.csv"));
    ASSERT_EQ(coif("stress --only random --cases 3 --seed 37 --untimed -o tasks -j 2").status, 0);
    EXPECT_EQ(contents("tasks/random.csv"), contents("strained/random.csv"));
    EXPECT_EQ(contents("tasks/stress.csv"), contents("strained/stress.csv"));
    const std::string merged = contents("merged.csv");
    EXPECT_EQ(std::count(merged.begin(), merged.end(), '\n'), 1 + 2 * 3);
    write("cases.txt", coif("jobs stress --quick --only bad-input,teleport --seed 37").out);
    ASSERT_EQ(coif("run cases.txt --out C").status, 0);
    ASSERT_EQ(coif("merge cases.txt --out C -o cases.csv").status, 0);
    ASSERT_EQ(coif("stress --quick --only bad-input,teleport --seed 37 --untimed -o strained").status, 0);
    // In the order of the suite, whatever --only says first.
    EXPECT_EQ(contents("cases.csv"), contents("strained/stress.csv"));
}

TEST_F(Batches, a_sweep_of_a_style_is_one_table)
{
    const Result jobs = coif("jobs sweep small.toml --vary forces.drag=1,8 --seconds 0.2");
    write("jobs.txt", jobs.out);
    ASSERT_EQ(coif("run jobs.txt --out D").status, 0);
    ASSERT_EQ(coif("merge jobs.txt --out D -o sweep.csv").status, 0);
    const std::string table = contents("sweep.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3) << table;
    EXPECT_NE(table.find("\nsmall,forces.drag=1,still,0.2,"), std::string::npos) << table;
    EXPECT_NE(table.find("\nsmall,forces.drag=8,still,0.2,"), std::string::npos) << table;
}

TEST_F(Batches, gnu_parallel_does_the_same)
{
    if (!has("parallel"))
        GTEST_SKIP() << "GNU parallel is not installed: apt-get install parallel";
    write_lab();
    ASSERT_EQ(coif("run lab.txt --out serial").status, 0);
    ASSERT_EQ(coif("merge lab.txt --out serial -o serial.csv").status, 0);
    EXPECT_EQ(shell("'" COIF_SOURCE_FOLDER "/examples/batch/parallel.sh' lab.txt D 3 merged.csv --jobs 2"), 0)
        << contents("err.txt");
    EXPECT_EQ(contents("merged.csv"), contents("serial.csv"));
    EXPECT_EQ(results("D"), results("serial"));
    // A list is also what parallel reads by itself.
    write("lines.txt", "lab --seconds 0.1 --gamma 3 -o 'a b.csv'\n");
    EXPECT_EQ(shell("parallel -a lines.txt --jobs 2 '\"$COIF\" {=uq=}'"), 0) << contents("err.txt");
    EXPECT_TRUE(fs::exists(folder / "a b.csv"));
}

TEST_F(Batches, opencue_gets_a_command_a_line)
{
    write_checks();
    ASSERT_EQ(
        shell("'" COIF_SOURCE_FOLDER "/examples/batch/opencue.sh' checks.txt D 3 > commands.txt; cat commands.txt"), 0);
    const std::string commands = contents("out.txt");
    EXPECT_EQ(std::count(commands.begin(), commands.end(), '\n'), 3);
    write("commands.sh", commands);
    ASSERT_EQ(shell("sh commands.sh"), 0) << contents("err.txt");
    EXPECT_EQ(coif("merge checks.txt --out D -o m.txt").status, 0);
}

namespace
{
// A Slurm of its own, up as long as this lives.
struct Slurm
{
    fs::path folder;
    bool up = false;

    explicit Slurm(const fs::path& in) : folder(in / "slurm")
    {
        const int port = 20000 + int(getpid()) % 20000;
        up = std::system(("'" COIF_SOURCE_FOLDER "/tests/slurm/up.sh' '" + folder.string() + "' " +
                          std::to_string(port) + " < /dev/null")
                             .c_str()) == 0;
    }
    ~Slurm()
    {
        if (std::system(("'" COIF_SOURCE_FOLDER "/tests/slurm/down.sh' '" + folder.string() + "'").c_str()) != 0)
            ADD_FAILURE() << "Slurm does not end";
    }
};
} // namespace

TEST_F(Batches, slurm_with_a_killed_shard_does_the_same)
{
    for (const char* program : {"slurmctld", "slurmd", "sbatch", "munged"})
        if (!has(program))
            GTEST_SKIP() << program << " is not installed: apt-get install slurmctld slurmd slurm-client munge";
    if (getuid() != 0)
        GTEST_SKIP() << "Slurm's daemons want to be root";
    write_lab();
    ASSERT_EQ(coif("run lab.txt --out serial").status, 0);
    ASSERT_EQ(coif("merge lab.txt --out serial -o serial.csv").status, 0);

    const Slurm slurm(folder);
    ASSERT_TRUE(slurm.up);
    const std::string conf = "SLURM_CONF='" + (slurm.folder / "slurm.conf").string() + "'";
    const std::string send = "'" COIF_SOURCE_FOLDER "/examples/batch/slurm.sh' lab.txt D 2 merged.csv";
    const auto is_idle = [&] { return shell("squeue -h", conf) == 0 && contents("out.txt").empty(); };
    ASSERT_EQ(shell(send, conf), 0) << contents("err.txt");
    // Shard 1 has the tasks 1, 3 and 5.
    const auto done = [&](const char* task)
    {
        return fs::exists(folder / "D") &&
               std::ranges::any_of(results("D"), [&](const std::string& name) { return name.starts_with(task); });
    };
    ASSERT_TRUE(comes_true([&] { return done("000001"); })) << "the first task of shard 1";
    const pid_t shard = process_with("coif run lab.txt --out D --shard 1/2");
    ASSERT_GT(shard, 0);
    ASSERT_EQ(kill(shard, SIGKILL), 0);
    ASSERT_TRUE(comes_true(is_idle));
    EXPECT_FALSE(done("000005")) << "it was killed too late to tell anything";
    EXPECT_FALSE(fs::exists(folder / "merged.csv")) << "the merge waits for shards that end well";

    ASSERT_EQ(shell(send, conf), 0) << contents("err.txt");
    ASSERT_TRUE(comes_true(is_idle));
    const std::string said = contents("D/slurm-1.out");
    EXPECT_NE(said.find("1 kept\n"), std::string::npos) << said;
    EXPECT_NE(said.find("\n5 done "), std::string::npos) << said;
    EXPECT_EQ(contents("merged.csv"), contents("serial.csv")) << contents("D/slurm-merge.out");
    EXPECT_EQ(results("D"), results("serial"));
}

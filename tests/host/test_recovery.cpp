// Unsaved work outlives its editor, however that ends; and files that change on disk are seen.
#include "app/folders.h"
#include "app/recovery.h"
#include "app/watch.h"
#include "sim/source.h"
#include "tests/host/scratch.h"

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>

namespace coif
{
namespace
{
using namespace coif::test;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

template <typename Condition> bool within(std::chrono::milliseconds most, Condition&& condition)
{
    for (const auto end = Clock::now() + most; Clock::now() < end; std::this_thread::sleep_for(2ms))
        if (condition())
            return true;
    return condition();
}

Hairstyle style_of(const Scratch& scratch)
{
    const fs::path file = scratch.write("my.toml", "# mine\n[strand]\nlength = 0.2 # short\n");
    return load_hairstyle(file);
}

// What lies in the folder, by ending.
int files(const fs::path& folder, const char* ending)
{
    int count = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        count += entry.path().extension() == ending;
    return count;
}

TEST(Recovery, unsaved_work_is_kept_and_goes_when_it_is_saved)
{
    const Scratch scratch;
    const fs::path folder = scratch / "state";
    Hairstyle style = style_of(scratch);
    {
        Autosave autosave(folder, 5ms);
        style.params.strand_length = 0.3f;
        autosave.keep(style);
        EXPECT_TRUE(within(5s, [&] { return files(folder, ".toml") == 1; }));
        EXPECT_TRUE(find_recoveries(folder).empty()) << "its editor lives";
        autosave.clear();
        EXPECT_TRUE(within(5s, [&] { return files(folder, ".toml") == 0; }));
        autosave.keep(style);
        autosave.clear();
    }
    EXPECT_TRUE(fs::is_empty(folder)) << "nothing is left of an editor that was closed";
    EXPECT_EQ(bytes_of(style.file), "# mine\n[strand]\nlength = 0.2 # short\n") << "the file itself is not touched";
}

TEST(Recovery, what_an_editor_left_is_found_with_its_comments_and_can_be_thrown_away)
{
    const Scratch scratch;
    const fs::path folder = scratch / "state";
    Hairstyle style = style_of(scratch);
    style.params.strand_length = 0.3f;
    Autosave(folder, 1ms).keep(style); // ends without clear(): as by an exception
    const std::vector<Recovery> found = find_recoveries(folder);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].file, style.file);
    EXPECT_EQ(found[0].text, "# mine\n[strand]\nlength = 0.3 # short\n");
    EXPECT_EQ(recovered(found[0]).params.strand_length, 0.3f);
    EXPECT_FALSE(found[0].when.empty());
    discard(found[0]);
    EXPECT_TRUE(find_recoveries(folder).empty());
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(Recovery, what_lies_in_files_beside_a_style_is_kept_too)
{
    const Scratch scratch;
    const fs::path folder = scratch / "state";
    Hairstyle style = style_of(scratch);
    StrandShapes shapes{3, {}};
    for (int i = 0; i < 30; ++i)
        shapes.position.emplace_back(0.01f * float(i), 0.2f, -0.3f);
    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(shapes);
    style.host.maps.push_back({"strand.length", MAP_OFFSET, std::vector<float>(5000, 0.25f), "my.map"});
    style.host.regions.emplace_back().name = "painted";
    style.host.regions[0].weights.assign(5000, 0.5f);
    style.host.regions[0].file = "my.region";
    Autosave(folder, 1ms).keep(style);
    const std::vector<Recovery> found = find_recoveries(folder);
    ASSERT_EQ(found.size(), 1u);
    const Hairstyle again = recovered(found[0]);
    ASSERT_TRUE(again.host.groom_rest.shapes);
    EXPECT_EQ(*again.host.groom_rest.shapes, shapes);
    ASSERT_EQ(again.host.maps.size(), 1u);
    EXPECT_EQ(again.host.maps[0].values, style.host.maps[0].values);
    ASSERT_EQ(again.host.regions.size(), 1u);
    EXPECT_EQ(again.host.regions[0].weights, style.host.regions[0].weights);
    EXPECT_FALSE(fs::exists(scratch / "my.map") || fs::exists(scratch / "my.region"))
        << "nothing is written beside the style before it is saved";
}

TEST(Recovery, two_editors_of_one_file_keep_their_own_and_only_one_takes_over_a_third)
{
    const Scratch scratch;
    const fs::path folder = scratch / "state";
    Hairstyle style = style_of(scratch);
    style.params.strand_length = 0.3f;
    Autosave(folder, 1ms).keep(style);
    const Recovery left = find_recoveries(folder).at(0);
    {
        Autosave first(folder, 1ms), second(folder, 1ms);
        style.params.strand_length = 0.4f;
        first.keep(style);
        style.params.strand_length = 0.5f;
        second.keep(style);
        EXPECT_TRUE(within(5s, [&] { return files(folder, ".toml") == 3; }));
        EXPECT_EQ(find_recoveries(folder).size(), 1u);
        Autosave third(folder, 1ms), fourth(folder, 1ms);
        EXPECT_TRUE(third.take_over(left));
        EXPECT_FALSE(fourth.take_over(left));
        EXPECT_TRUE(find_recoveries(folder).empty()) << "it is the third's now";
    }
    EXPECT_EQ(find_recoveries(folder).size(), 3u);
}

TEST(Recovery, what_is_no_recovery_is_left_alone)
{
    const Scratch scratch;
    const fs::path folder = scratch / "state";
    scratch.write("state/1-0-0.toml", "rubbish");
    scratch.write("state/1-1-0.toml", "# coif: unsaved work on the hairstyle\n");
    scratch.write("state/1-2-0.toml",
                  "# coif: unsaved work on the hairstyle\n# /nowhere/x.toml\n[strand]\nlenght = 1\n");
    scratch.write("state/1-3-0.toml.1.new", "half");
    scratch.write("state/1-4.lock", "");
    fs::create_directories(folder / "folder.toml");
    const std::vector<Recovery> found = find_recoveries(folder);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NE(error_of([&] { recovered(found[0]); }).find("strand.lenght"), std::string::npos);
    EXPECT_EQ(files(folder, ".new") + files(folder, ".lock"), 0);
    EXPECT_EQ(files(folder, ".toml"), 4);
    EXPECT_TRUE(find_recoveries(scratch / "none").empty());
    EXPECT_TRUE(find_recoveries({}).empty());
}

TEST(Recovery, a_folder_that_cannot_be_written_is_told_and_tried_again)
{
    const Scratch scratch;
    scratch.write("state", "a file where the folder should be");
    Hairstyle style = style_of(scratch);
    Autosave autosave(scratch / "state" / "recovery", 5ms);
    autosave.keep(style);
    std::string trouble;
    EXPECT_TRUE(within(5s, [&] { return !(trouble = autosave.trouble()).empty(); }));
    EXPECT_NE(trouble.find("recovery"), std::string::npos) << trouble;
    fs::remove(scratch / "state");
    EXPECT_TRUE(within(5s, [&] { return files(scratch / "state" / "recovery", ".toml") == 1; })) << "now it can";
    autosave.clear();
}

// A disk with no room left, which writes fail on: the limit of a file's size does the same.
struct FullDisk
{
    rlimit before;
    void (*handler)(int) = std::signal(SIGXFSZ, SIG_IGN);
    FullDisk()
    {
        getrlimit(RLIMIT_FSIZE, &before);
        rlimit none = before;
        none.rlim_cur = 4;
        setrlimit(RLIMIT_FSIZE, &none);
    }
    ~FullDisk()
    {
        setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, handler);
    }
};

TEST(Recovery, on_a_full_disk_the_last_good_file_stays_and_it_is_told)
{
    const Scratch scratch;
    Hairstyle style = style_of(scratch);
    style.params.strand_length = 0.3f;
    const fs::path folder = scratch / "state";
    Autosave autosave(folder, 1ms);
    autosave.keep(style);
    EXPECT_TRUE(within(5s, [&] { return files(folder, ".toml") == 1; }));
    std::string trouble, refused;
    {
        const FullDisk full;
        refused = error_of([&] { save_hairstyle(style, style.file); });
        style.params.strand_length = 0.4f;
        autosave.keep(style);
        EXPECT_TRUE(within(5s, [&] { return !(trouble = autosave.trouble()).empty(); }));
    }
    EXPECT_NE(refused.find("my.toml: cannot be written"), std::string::npos) << refused;
    EXPECT_NE(trouble.find("cannot be written"), std::string::npos) << trouble;
    EXPECT_EQ(bytes_of(style.file), "# mine\n[strand]\nlength = 0.2 # short\n");
    EXPECT_EQ(files(scratch.folder(), ".new"), 0);
    autosave.clear();
}

// An editor's child: edits and keeps, now and then saves, and says how far it has come.
[[noreturn]] void edit_for_ever(Hairstyle style, const fs::path& folder, volatile int* edits)
{
    Autosave autosave(folder, 10ms);
    for (int n = 1;; ++n)
    {
        style.params.forces_drag = 1.0f + 0.001f * float(n % 10000);
        style.params.interpolation_seed = n;
        autosave.keep(style);
        *edits = n;
        if (n % 64 == 0)
            save_hairstyle(style, style.file); // goes on to be unsaved with the next edit
        std::this_thread::sleep_for(500us);
    }
}

TEST(Recovery, kill_minus_9_at_any_moment_loses_little_and_never_the_file)
{
    const Scratch scratch;
    const fs::path folder = scratch / "state";
    const Hairstyle style = style_of(scratch);
    auto* edits =
        static_cast<int*>(mmap(nullptr, 2 * sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    ASSERT_NE(edits, MAP_FAILED);
    std::mt19937 random(7);
    int found_some = 0;
    for (int round = 0; round < 20; ++round)
    {
        *edits = 0;
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0)
            edit_for_ever(load_hairstyle(style.file), folder, edits);
        ASSERT_TRUE(within(20s, [&] { return *edits > 0; }));
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 150000));
        // What it had done this long before the end must be there: the 10 ms between two keepings, and what a busy
        // machine takes to come round to its thread.
        const int before = *edits;
        std::this_thread::sleep_for(250ms);
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        const Hairstyle saved = load_hairstyle(style.file); // whole: it parses
        EXPECT_EQ(saved.text.rfind("# mine\n", 0), 0u);
        const std::vector<Recovery> found = find_recoveries(folder);
        ASSERT_EQ(found.size(), 1u) << "round " << round;
        const Hairstyle kept = recovered(found[0]);
        EXPECT_GE(std::max(kept.params.interpolation_seed, saved.params.interpolation_seed), before);
        EXPECT_EQ(kept.params.forces_drag, 1.0f + 0.001f * float(kept.params.interpolation_seed % 10000));
        found_some += kept.params.interpolation_seed > 0;
        discard(found[0]);
    }
    EXPECT_EQ(found_some, 20);
    EXPECT_TRUE(find_recoveries(folder).empty());
    munmap(edits, 2 * sizeof(int));
}

TEST(Recovery, folders_are_where_the_system_says)
{
    const auto value = [](const char* name) { return std::getenv(name) ? std::string(std::getenv(name)) : ""; };
    const std::string state = value("XDG_STATE_HOME"), home = value("HOME");
    setenv("XDG_STATE_HOME", "/here", 1);
    EXPECT_EQ(recovery_folder(), "/here/coif/recovery");
    setenv("XDG_STATE_HOME", "relative", 1);
    setenv("HOME", "/home/me", 1);
    EXPECT_EQ(state_folder(), "/home/me/.local/state/coif");
    setenv("HOME", "", 1);
    EXPECT_EQ(recovery_folder(), "");
    setenv("HOME", home.c_str(), 1);
    state.empty() ? unsetenv("XDG_STATE_HOME") : setenv("XDG_STATE_HOME", state.c_str(), 1);
}

TEST(Watch, sees_what_is_written_renamed_over_vanishes_and_comes_back)
{
    const Scratch scratch;
    const fs::path file = scratch.write("a.toml", "1"), other = scratch.write("b.toml", "1");
    Watch watch;
    watch.set({file, other, scratch / "none"});
    const auto settled = [&] // two looks: what has just changed waits for the second
    {
        const std::vector<fs::path> first = watch.changed();
        EXPECT_TRUE(first.empty());
        return watch.changed();
    };
    using Files = std::vector<fs::path>;
    EXPECT_EQ(settled(), Files());
    scratch.write("a.toml", "22");
    EXPECT_EQ(settled(), Files{file});
    EXPECT_EQ(settled(), Files()) << "once";
    scratch.write("c.toml", "33"); // the same size, and perhaps the same time
    fs::last_write_time(scratch / "c.toml", fs::last_write_time(file));
    fs::rename(scratch / "c.toml", file);
    EXPECT_EQ(settled(), Files{file});
    fs::remove(file);
    EXPECT_EQ(settled(), Files{file});
    scratch.write("a.toml", "22");
    scratch.write("none", "1");
    EXPECT_EQ(settled(), (Files{file, scratch / "none"}));
    scratch.write("a.toml", "by ourselves");
    watch.know(file);
    EXPECT_EQ(settled(), Files());
    scratch.write("b.toml", "2");
    watch.set({file}); // no longer of interest
    EXPECT_EQ(settled(), Files());
}

TEST(Watch, a_file_that_is_still_being_written_waits)
{
    const Scratch scratch;
    const fs::path file = scratch.write("a.toml", "1");
    Watch watch;
    watch.set({file});
    for (int i = 2; i < 6; ++i)
    {
        scratch.write("a.toml", std::string(size_t(i), '1'));
        EXPECT_TRUE(watch.changed().empty());
    }
    EXPECT_EQ(watch.changed().size(), 1u);
}

} // namespace
} // namespace coif

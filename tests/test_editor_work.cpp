// The editor in a real window, kept open all day: files that change under it, crashes, presets, chance, two styles.
#include "app/folders.h"
#include "sim/error.h"
#include "tests/editor_window.h"

#include <algorithm>
#include <csignal>
#include <memory>
#include <sys/wait.h>
#include <thread>

using namespace coif;
using namespace coif::test;

namespace
{
constexpr double kSecond = 3.0; // that a busy machine may make of one

// Another process, which does not outlive the test.
struct Child
{
    pid_t id = fork();
    ~Child() { end(); }
    void end()
    {
        if (id <= 0)
            return;
        kill(id, SIGKILL);
        waitpid(id, nullptr, 0);
        id = 0;
    }
};

void rewrite(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
} // namespace

TEST_F(EditorWindow, a_style_that_is_changed_on_disk_shows_and_a_broken_one_leaves_the_last_good)
{
    rewrite("style.toml", "# theirs\n[strand]\nlength = 0.3\n[interpolation]\nstrands = 300\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->simulation().solver().groom().longest == 0.3f; }));
    EXPECT_FALSE(editor->unsaved());
    rewrite("style.toml", "[strand]\nlenght = 0.1\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("style.toml:2:1: no") != std::string::npos; }))
        << editor->message();
    EXPECT_EQ(editor->style().params.strand_length, 0.3f);
    rewrite("style.toml", "[strand]\nlength = 0.1\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->style().params.strand_length == 0.1f; }));
    EXPECT_EQ(editor->message().find("no parameter"), std::string::npos) << "what is mended is no longer told";
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().params.strand_length == 0.3f; })) << "that is an edit too";
    EXPECT_TRUE(editor->unsaved());
}

TEST_F(EditorWindow, unsaved_changes_are_not_lost_to_a_file_that_is_changed_on_disk)
{
    slide("root.lift", 0.6, 0.2);
    const float mine = editor->style().params.root_lift;
    ASSERT_TRUE(editor->unsaved());
    rewrite("style.toml", "# theirs\n[strand]\nlength = 0.3\n[interpolation]\nstrands = 300\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->theirs() != nullptr; }));
    EXPECT_EQ(editor->style().params.root_lift, mine);
    frames(3);
    const float theirs = editor->theirs()->params.root_lift;
    click(editor->file_places().at("Take the file's"));
    EXPECT_TRUE(until([&] { return editor->style().params.strand_length == 0.3f; }));
    EXPECT_EQ(editor->style().params.root_lift, theirs);
    EXPECT_FALSE(editor->unsaved());
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().params.root_lift == mine; })) << "and it can be had again";
}

TEST_F(EditorWindow, a_style_that_vanishes_stays_on_screen_and_can_be_written_again)
{
    fs::remove("style.toml");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("is gone") != std::string::npos; }));
    EXPECT_TRUE(editor->unsaved()) << "closing would lose it";
    frames(5);
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+s");
    EXPECT_TRUE(until([&] { return !editor->unsaved(); }));
    EXPECT_EQ(contents("style.toml"), "# mine\n[strand]\nlength = 0.2 # short\n[interpolation]\nstrands = 300\n");
}

TEST_F(EditorWindow, meshes_that_are_changed_on_disk_are_read_again)
{
    const std::string whole = contents(data_folder() / "assets" / "scalp.obj");
    rewrite("mine.obj", whole);
    rewrite("style.toml", "[scalp]\nmesh = \"mine.obj\"\n[interpolation]\nstrands = 300\n");
    const int guides = editor->simulation().solver().groom().guides;
    EXPECT_TRUE(within(kSecond, [&] { return editor->style().host.scalp_mesh == "mine.obj"; }));
    // Every other way of being gone: broken, vanished, back with a triangle only.
    frames(20);
    rewrite("mine.obj", "v 0 0 0\nf 1 2 3\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("mine.obj") != std::string::npos; }));
    EXPECT_EQ(editor->simulation().solver().groom().guides, guides);
    fs::remove("mine.obj");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("mine.obj is gone") != std::string::npos; }))
        << editor->message();
    rewrite("mine.obj", "v 0.1 0.1 0\nv -0.1 0.1 0\nv 0 0.1 0.1\nvn 0 1 0\nf 1//1 3//1 2//1\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->simulation().solver().groom().guides == 3; }))
        << editor->message();
}

TEST_F(EditorWindow, a_motion_that_is_changed_on_disk_is_played_anew)
{
    const auto motion = [](const char* amplitude)
    {
        rewrite("mine.toml",
                std::string("seconds = 30.0\n[[oscillation]]\nchannel = \"x\"\nfrequency = 1.0\namplitude = ") +
                    amplitude + "\n");
    };
    motion("0.01");
    editor->play("mine.toml");
    frames(10);
    EXPECT_EQ(editor->simulation().motion_name(), "mine");
    const auto reach = [&] { return std::abs(editor->simulation().solver().head().origin.x); };
    EXPECT_FALSE(within(1.0, [&] { return reach() > 0.02; }));
    motion("0.1");
    EXPECT_TRUE(within(2.0 * kSecond, [&] { return reach() > 0.02; }));
    motion("wide");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("mine.toml:5") != std::string::npos; }))
        << editor->message();
    EXPECT_TRUE(editor->simulation().playing());
}

TEST_F(EditorWindow, after_kill_minus_9_the_work_of_more_than_five_seconds_ago_is_offered)
{
    const WidgetPlace place = editor->panel().places.at("strand.length");
    int left = 0, top = 0;
    SDL_GetWindowPosition(editor->window(), &left, &top);
    editor.reset();
    const std::string untouched = contents("style.toml");
    const auto find = []
    { return std::system("xdotool search --onlyvisible --name 'style - coif' > window.txt 2> /dev/null") == 0; };
    // An X server starts anew when its last client goes, and whoever comes just then finds none.
    bool shown = false;
    std::unique_ptr<Child> child;
    for (int attempt = 0; attempt < 4 && !shown; ++attempt)
    {
        child.reset();
        child = std::make_unique<Child>();
        ASSERT_GE(child->id, 0);
        if (child->id == 0)
        {
            execl(COIF_BUILD_FOLDER "/coif", "coif", "style.toml", nullptr);
            _exit(127);
        }
        for (int i = 0; i < 300 && !(shown = find()); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    ASSERT_TRUE(shown);
    std::this_thread::sleep_for(std::chrono::seconds(2));
    const std::string window = std::to_string(std::stol(contents("window.txt")));
    const auto on_screen = [&](double share)
    {
        return " --window " + window + " " + std::to_string(int(place.left + share * (place.right - place.left))) +
               " " + std::to_string(int(0.5 * (place.top + place.bottom)));
    };
    xdotool("mousemove" + on_screen(0.3));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    xdotool("mousedown 1");
    for (const double share : {0.4, 0.5, 0.6, 0.7})
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        xdotool("mousemove" + on_screen(share));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    xdotool("mouseup 1");
    std::this_thread::sleep_for(std::chrono::seconds(5));
    // Where the machine is so busy that the drag has not arrived by then, it is no work of five seconds ago either.
    const auto kept = [] { return fs::exists(recovery_folder()) && !fs::is_empty(recovery_folder()); };
    for (int i = 0; i < 600 && !kept(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::this_thread::sleep_for(std::chrono::seconds(2)); // the end of the drag, too
    child->end();
    EXPECT_EQ(contents("style.toml"), untouched) << "the file is as it was";

    start();
    ASSERT_EQ(editor->recoveries().size(), 1u);
    EXPECT_FLOAT_EQ(editor->style().params.strand_length, 0.2f);
    shoot("recovery");
    click(editor->file_places().at("Recover"));
    EXPECT_TRUE(until([&] { return editor->style().params.strand_length > 0.3f; }));
    EXPECT_TRUE(editor->unsaved());
    EXPECT_TRUE(editor->recoveries().empty());
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+s");
    EXPECT_TRUE(until([&] { return !editor->unsaved(); }));
    EXPECT_NE(contents("style.toml").find(" # short\n"), std::string::npos);
    start();
    EXPECT_TRUE(editor->recoveries().empty()) << "what was saved is not offered again";
}

TEST_F(EditorWindow, presets_are_browsed_by_their_pictures_copied_renamed_and_thrown_away)
{
    rewrite("broken.toml", "[strand]\nlenght = 1\n");
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key b");
    EXPECT_TRUE(until([&] { return editor->browser().places.contains("style.toml"); }));
    EXPECT_TRUE(within(300.0,
                       [&]
                       {
                           return editor->browser().pictures.contains(folder / "style.toml") &&
                                  editor->browser().pictures.at(folder / "style.toml").second != 0;
                       }));
    shoot("browser");
    const auto type = [&](const std::string& name)
    {
        ASSERT_TRUE(until([&] { return !editor->browser().asked.empty(); }));
        frames(5); // it takes the keyboard, and all of its name is chosen
        xdotool("type " + name);
        EXPECT_TRUE(until([&] { return editor->browser().name == name; })) << editor->browser().name;
        xdotool("keydown Return"); // ImGui sees a key that is down in a frame
        EXPECT_TRUE(until([&] { return editor->browser().asked.empty(); }));
        xdotool("keyup Return");
        frames(3);
    };
    click(editor->browser().places.at("style.toml"));
    EXPECT_EQ(editor->browser().selected, folder / "style.toml");
    click(editor->browser().places.at("Duplicate"));
    shoot("browser_name");
    type("copied");
    EXPECT_TRUE(until([&] { return fs::exists("copied.toml"); })) << editor->message();
    EXPECT_EQ(contents("copied.toml"), contents("style.toml"));
    EXPECT_TRUE(until([&] { return editor->browser().places.contains("copied.toml"); }));
    click(editor->browser().places.at("Rename"));
    type("renamed");
    EXPECT_TRUE(until([&] { return fs::exists("renamed.toml") && !fs::exists("copied.toml"); })) << editor->message();
    EXPECT_TRUE(until([&] { return editor->browser().places.contains("renamed.toml"); }));
    click(editor->browser().places.at("renamed.toml"));
    click(editor->browser().places.at("Delete"));
    EXPECT_TRUE(until([&] { return fs::exists(fs::path("trash") / "renamed.toml"); })) << editor->message();
    EXPECT_FALSE(fs::exists("renamed.toml"));
    // A style that is renamed while it is open goes on under its new name.
    click(editor->browser().places.at("style.toml"));
    click(editor->browser().places.at("Rename"));
    type("mine");
    EXPECT_TRUE(until([&] { return editor->style().name() == "mine"; }));
    EXPECT_FALSE(editor->unsaved());
    EXPECT_FALSE(within(1.0, [&] { return editor->unsaved(); })) << "and nothing is missed under the old one";
}

TEST_F(EditorWindow, chance_is_one_step_to_take_back_and_leaves_locks_alone)
{
    const Hairstyle first = editor->style();
    const WidgetPlace row = editor->panel().places.at("strand.length");
    point(row.left + 20.0, 0.5 * (row.top + row.bottom));
    ASSERT_TRUE(until([&] { return editor->panel().places.contains("strand.length lock"); }));
    click(editor->panel().places.at("strand.length lock"));
    EXPECT_TRUE(until([&] { return editor->panel().locked.contains("strand.length"); }));
    const size_t edits = editor->history().edits.size();
    const int seed = editor->panel().seed;
    click(editor->panel().places.at("randomise"));
    EXPECT_TRUE(until([&] { return editor->unsaved(); }));
    EXPECT_EQ(editor->history().edits.size(), edits + 1);
    EXPECT_EQ(editor->history().edits.back().what, "randomise, seed " + std::to_string(seed));
    EXPECT_EQ(editor->style().params.strand_length, first.params.strand_length);
    EXPECT_NE(editor->style().params.root_lift, first.params.root_lift);
    shoot("randomise");
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return difference(editor->style(), first).empty(); }));
}

TEST_F(EditorWindow, two_styles_move_side_by_side_and_one_becomes_the_other)
{
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key a");
    ASSERT_TRUE(until([&] { return editor->beside().places.contains("b"); }));
    editor->put_beside(data_folder() / "hairstyles" / "afro.toml");
    frames(3);
    ASSERT_TRUE(editor->beside().style);
    click(editor->beside().places.at("split"));
    ASSERT_TRUE(until([&] { return editor->beside().simulation != nullptr; })) << editor->message();
    editor->play("shake");
    frames(30);
    const Simulation& a = editor->simulation();
    const Simulation& b = *editor->beside().simulation;
    EXPECT_EQ(a.motion_name(), b.motion_name());
    EXPECT_NEAR(a.solver().head().origin.x, b.solver().head().origin.x, 1e-9) << "the same motion at the same time";
    EXPECT_NEAR(a.solver().head().turn.y, b.solver().head().turn.y, 1e-9);
    EXPECT_NEAR(a.time() - b.time(), editor->beside().began, 1e-6);
    shoot("beside");
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key p");
    ASSERT_TRUE(until([&] { return fs::exists("style-001.png"); })) << editor->message();
    const Image both = load_png("style-001.png");
    EXPECT_EQ(both.width, editor->view_width());
    // The same head twice, from the same side: what differs between the halves is the hair.
    const int half = both.width / 2;
    const auto red = [&](int x, int y) { return int(both.pixels[size_t(4) * size_t(y * both.width + x)]); };
    int heads[2] = {}, differ = 0; // pixels
    for (int y = both.height / 8; y < both.height; ++y)
        for (int x = 2; x < half; ++x)
        {
            heads[0] += std::abs(red(x, y) - red(2, y)) > 40;
            heads[1] += std::abs(red(half + x, y) - red(half + 2, y)) > 40;
            differ += std::abs(red(x, y) - red(half + x, y)) > 40;
        }
    EXPECT_GT(heads[0], both.height * half / 50);
    EXPECT_GT(heads[1], both.height * half / 50);
    EXPECT_GT(differ, both.height * half / 100) << "one of them has an afro";
    click(editor->beside().places.at("split"));
    EXPECT_TRUE(until([&] { return editor->beside().simulation == nullptr; }));

    const Hairstyle from = editor->style();
    const size_t edits = editor->history().edits.size();
    const WidgetPlace place = editor->beside().places.at("morph");
    const double y = 0.5 * (place.top + place.bottom), width = place.right - place.left;
    drag(place.left + 0.02 * width, y, place.left + 0.7 * width, y);
    release();
    EXPECT_TRUE(editor->unsaved());
    EXPECT_EQ(editor->history().edits.size(), edits + 1) << "one drag, one step";
    shoot("morph");
    drag(place.left + 0.7 * width, y, place.left - 30.0, y);
    release();
    EXPECT_EQ(difference(editor->style(), from), "") << "all the way back is where it began";
}

TEST_F(EditorWindow, the_strands_colours_tell_of_their_health)
{
    xdotool("mousemove " + at(100.0, 650.0));
    for (const int colors : {1, 2, 3, 4, 5, 0})
    {
        xdotool("key v");
        EXPECT_TRUE(until([&] { return editor->style().params.render_colors == colors; }));
        frames(4);
        EXPECT_EQ(editor->legend().readings.empty(), colors == 0);
        shoot("colors_" + std::to_string(colors));
    }
    xdotool("key F1");
    frames(4);
    shoot("help");
}

TEST_F(EditorWindow, the_window_is_arranged_as_it_was_left)
{
    click(editor->panel().places.at("group strand"));
    EXPECT_TRUE(until([&] { return editor->panel().folded.contains("strand"); }));
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key u");
    frames(5);
    SDL_SetWindowSize(editor->window(), 1100, 700);
    int width = 0, height = 0;
    EXPECT_TRUE(until(
        [&]
        {
            SDL_GetWindowSize(editor->window(), &width, &height);
            return width == 1100 && height == 700;
        }));
    start();
    EXPECT_TRUE(editor->panel().folded.contains("strand"));
    EXPECT_FALSE(editor->panel().places.contains("strand.length"));
    SDL_GetWindowSize(editor->window(), &width, &height);
    EXPECT_EQ(width, 1100);
    EXPECT_EQ(height, 700);
    shoot("arranged");
    // A spoilt file, and a folder that cannot be written: it opens as on the first day.
    editor.reset();
    fs::remove_all("config");
    rewrite("config", "no folder");
    start();
    EXPECT_TRUE(editor->panel().folded.empty());
    EXPECT_TRUE(within(kSecond + 3.0, [&] { return editor->message().find("cannot be kept") != std::string::npos; }));
}

TEST_F(EditorWindow, a_collider_that_is_added_or_dragged_and_a_value_taken_back_to_its_default_can_be_undone)
{
    const Hairstyle first = editor->style();
    const WidgetPlace place = editor->panel().places.at("strand.length");
    // The x behind a value that differs from the default.
    point(place.right + 10.0, 0.5 * (place.top + place.bottom));
    press();
    release();
    EXPECT_TRUE(until([&] { return editor->style().params.strand_length == Hairstyle().params.strand_length; }));
    xdotool("mousemove " + at(100.0, 650.0));
    frames(3);
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return difference(editor->style(), first).empty(); }));

    rewrite("style.toml", contents("style.toml") + "[[collider]]\ncenter = [0.25, 0.0, 0.1]\nradius = 0.05\n");
    ASSERT_TRUE(within(kSecond, [&] { return editor->style().host.colliders.size() == 1; }));
    const glm::vec3 placed = editor->style().host.colliders[0].center;
    double x = 0.0, y = 0.0; // where the camera sees it
    for (int step = 0; step < 4000 && x == 0.0; ++step)
    {
        const double at_x = 20.0 + (step % 80) * (editor->view_width() - 40.0) / 80.0, at_y = 150.0 + step / 80 * 10.0;
        if (grab(editor->simulation(), editor->camera(), at_x, at_y, editor->view_width(), 720, false).what ==
            Grab::COLLIDER)
        {
            x = at_x;
            y = at_y + 10.0; // not at its very rim
        }
    }
    ASSERT_GT(x, 0.0);
    drag(x, y, x + 60.0, y);
    release();
    EXPECT_NE(editor->style().host.colliders.at(0).center, placed);
    xdotool("mousemove " + at(100.0, 650.0));
    frames(3);
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().host.colliders.at(0).center == placed; }));
}

TEST_F(EditorWindow, a_ring_is_dragged_over_the_head_and_taken_back)
{
    rewrite("style.toml",
            contents(data_folder() / "hairstyles" / "pony_tail.toml") + "\n# fewer strands than that has\n");
    std::string text = contents("style.toml");
    text.replace(text.find("strands = 8000"), 14, "strands = 300");
    rewrite("style.toml", text);
    ASSERT_TRUE(within(2.0 * kSecond, [&] { return editor->style().host.ties.size() == 1; })) << editor->message();
    frames(5);
    const Tie placed = editor->style().host.ties[0];
    const size_t edits = editor->history().edits.size();
    const auto on_screen = [&](const Tie& tie)
    {
        const Pose& head = editor->simulation().solver().head();
        const glm::dvec3 in_world = head.origin + head.turn * glm::dvec3(tie.at);
        return *project(editor->camera(), in_world, editor->view_width(), 720);
    };
    const glm::dvec2 middle = on_screen(placed);
    double x = 0.0, y = 0.0; // on the ring itself, nearest to its middle
    for (int step = 0; step < 41 * 41; ++step)
    {
        const double at_x = middle.x - 40.0 + 2.0 * (step % 41), at_y = middle.y - 40.0 + 2.0 * (step / 41);
        if (grab(editor->simulation(), editor->camera(), at_x, at_y, editor->view_width(), 720, false).what ==
                Grab::TIE &&
            std::hypot(at_x - middle.x, at_y - middle.y) < std::hypot(x - middle.x, y - middle.y))
        {
            x = at_x;
            y = at_y;
        }
    }
    ASSERT_GT(x, 0.0);
    shoot("ring_before");
    drag(x, y, x + 20.0, y + 70.0);
    shoot("ring_held");
    release();
    const Tie moved = editor->style().host.ties.at(0);
    EXPECT_LT(moved.at.y, placed.at.y - 0.02f) << "down the back of the head";
    EXPECT_NE(moved.axis, placed.axis) << "and it leans as the head does there";
    const glm::dvec2 now = on_screen(moved);
    EXPECT_NEAR(now.x - middle.x, 20.0, 4.0) << "it is where the mouse has brought it";
    EXPECT_NEAR(now.y - middle.y, 70.0, 4.0);
    EXPECT_EQ(editor->simulation().style().host.ties.at(0), moved) << "and so is the hair";
    EXPECT_EQ(editor->history().edits.size(), edits + 1) << "one drag, one edit";
    EXPECT_EQ(editor->history().edits.back().what, "moved tie tail");
    EXPECT_TRUE(editor->unsaved());
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().host.ties.at(0) == placed; }));
    EXPECT_FALSE(editor->unsaved());
}

TEST_F(EditorWindow, a_file_that_changes_under_a_drag_ends_it)
{
    rewrite("style.toml", contents("style.toml") + "[[collider]]\ncenter = [0.25, 0.0, 0.1]\nradius = 0.05\n");
    ASSERT_TRUE(within(kSecond, [&] { return editor->style().host.colliders.size() == 1; }));
    const Pose& head = editor->simulation().solver().head();
    const glm::dvec2 middle =
        *project(editor->camera(), head.origin + glm::dvec3(0.25, 0.0, 0.1), editor->view_width(), 720);
    point(middle.x, middle.y);
    press();
    rewrite("style.toml", "[interpolation]\nstrands = 300\n"); // without what the hand holds
    ASSERT_TRUE(within(kSecond, [&] { return editor->style().host.colliders.empty(); }));
    point(middle.x + 20.0, middle.y);
    point(middle.x + 40.0, middle.y);
    release();
    EXPECT_TRUE(open);
    EXPECT_FALSE(editor->unsaved());
}

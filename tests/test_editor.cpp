// The editor in a real window.
#include "tests/editor_window.h"

#include <glm/geometric.hpp>
#include <imgui.h>

#include <set>

using namespace coif;
using namespace coif::test;

// Of a colour in sRGB (WCAG 2.1, relative luminance).
static double luminance(float r, float g, float b)
{
    return 0.2126 * double(linear_of_srgb(r)) + 0.7152 * double(linear_of_srgb(g)) + 0.0722 * double(linear_of_srgb(b));
}

TEST_F(EditorWindow, figures_can_be_read_over_hair_of_any_colour)
{
    xdotool("mousemove " + at(300.0, 650.0));
    xdotool("key t");
    std::set<ImU32> backings, letters;
    ASSERT_TRUE(until(
        [&]
        {
            const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
            const ImDrawData& all = *ImGui::GetDrawData();
            for (int i = 0; i < all.CmdListsCount; ++i)
                if (const ImDrawList& list = *all.CmdLists[i]; list._OwnerName == std::string("figures"))
                    for (const ImDrawVert& v : list.VtxBuffer)
                        (v.uv.x == white.x && v.uv.y == white.y ? backings : letters).insert(v.col);
            return letters.size() > 1; // figures, and times in grey
        }));
    ASSERT_EQ(backings.size(), 1u);
    const ImVec4 dark = ImGui::ColorConvertU32ToFloat4(*backings.begin());
    for (const float hair : {0.0f, 1.0f}) // black and white; what lies between is between
        for (const ImU32 color : letters)
        {
            const float through = (1.0f - dark.w) * hair;
            const ImVec4 ink = ImGui::ColorConvertU32ToFloat4(color);
            EXPECT_EQ(ink.w, 1.0f);
            const double text = luminance(ink.x, ink.y, ink.z);
            const double behind =
                luminance(dark.w * dark.x + through, dark.w * dark.y + through, dark.w * dark.z + through);
            // WCAG 2.1, success criterion 1.4.3: 4.5 to 1 for text of this size.
            EXPECT_GE((text + 0.05) / (behind + 0.05), 4.5) << std::hex << color << " over " << hair;
        }
}

TEST_F(EditorWindow, a_drag_on_the_head_moves_it_and_the_hair_follows)
{
    const double x = editor->view_width() / 2.0, y = 330.0;
    const Pose rest = editor->simulation().solver().head();
    drag(x, y, x + 120.0, y);
    EXPECT_TRUE(until([&] { return editor->simulation().solver().head().origin.x > rest.origin.x + 0.03; }));
    const glm::dvec3 moved = editor->simulation().solver().head().origin;
    EXPECT_NEAR(moved.y, rest.origin.y, 0.02);
    release();
    frames(10);
    EXPECT_NEAR(glm::distance(editor->simulation().solver().head().origin, moved), 0.0, 1e-6)
        << "it stays where it was let go";
    for (const int resets : editor->simulation().solver().resets())
        EXPECT_EQ(resets, 0);
}

TEST_F(EditorWindow, with_ctrl_the_head_turns_and_beside_it_the_camera_orbits)
{
    const double x = editor->view_width() / 2.0, y = 330.0;
    xdotool("keydown ctrl");
    frames(3);
    drag(x, y, x + 100.0, y);
    EXPECT_TRUE(until([&] { return std::abs(editor->simulation().solver().head().turn.y) > 0.1; }));
    release();
    xdotool("keyup ctrl");
    const double yaw = editor->camera().yaw;
    drag(12.0, 600.0, 112.0, 600.0);
    EXPECT_TRUE(until([&] { return std::abs(editor->camera().yaw - yaw) > 0.3; }));
    release();
}

TEST_F(EditorWindow, a_slider_moved_by_the_mouse_changes_the_hair_and_the_file_when_saved)
{
    const WidgetPlace place = editor->panel().places.at("strand.length");
    const double y = 0.5 * (place.top + place.bottom), width = place.right - place.left;
    drag(place.left + 0.3 * width, y, place.left + 0.7 * width, y);
    EXPECT_TRUE(until([&] { return editor->style().params.strand_length > 0.3f; }));
    release();
    EXPECT_TRUE(editor->unsaved());
    EXPECT_FLOAT_EQ(editor->simulation().solver().groom().longest, editor->style().params.strand_length);
    EXPECT_EQ(contents("style.toml"), "# mine\n[strand]\nlength = 0.2 # short\n[interpolation]\nstrands = 300\n")
        << "nothing is written before it is asked for";

    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+s");
    EXPECT_TRUE(until([&] { return !editor->unsaved(); }));
    const std::string saved = contents("style.toml");
    EXPECT_EQ(saved.rfind("# mine\n[strand]\nlength = ", 0), 0u) << saved;
    EXPECT_NE(saved.find(" # short\n"), saved.npos) << "the author's comments stay: " << saved;
    EXPECT_EQ(load_hairstyle("style.toml").params.strand_length, editor->style().params.strand_length);
}

// All of it arrives within one frame, as it does when one takes long.
TEST_F(EditorWindow, a_click_is_where_the_mouse_was_though_it_has_gone_on_since)
{
    const auto middle = [&](const char* path, double along)
    {
        const WidgetPlace place = editor->panel().places.at(path);
        return at(place.left + along * (place.right - place.left), 0.5 * (place.top + place.bottom));
    };
    const float lift = editor->style().params.root_lift;
    xdotool("mousemove " + middle("strand.length", 0.8) + " click 1 mousemove " + middle("root.lift", 0.1));
    EXPECT_TRUE(until([&] { return editor->style().params.strand_length > 0.5f; }));
    frames(8);
    EXPECT_EQ(editor->style().params.root_lift, lift);

    // On to the picture: the press was the slider's all the same.
    const Camera camera = editor->camera();
    xdotool("mousemove " + middle("strand.length", 0.1) + " mousedown 1 mousemove " + middle("strand.length", 0.2) +
            " mouseup 1 mousemove " + at(100.0, 650.0) + " click 4");
    EXPECT_TRUE(until([&] { return editor->camera().distance != camera.distance; })) << "the wheel was the picture's";
    EXPECT_NEAR(editor->style().params.strand_length, 0.3f, 0.15f);
    EXPECT_EQ(editor->camera().yaw, camera.yaw);
    EXPECT_EQ(editor->history().edits.size(), 3u);
}

TEST_F(EditorWindow, a_drag_on_a_slider_is_one_edit_that_can_be_taken_back_and_done_again)
{
    const HairParams first = editor->style().params;
    const auto same = [&](const HairParams& params)
    { return memcmp(&editor->style().params, &params, sizeof params) == 0; };
    for (const char* path : {"strand.length", "root.lift"})
    {
        const WidgetPlace place = editor->panel().places.at(path);
        const double y = 0.5 * (place.top + place.bottom), width = place.right - place.left;
        drag(place.left + 0.3 * width, y, place.left + 0.7 * width, y);
        release();
    }
    const HairParams last = editor->style().params;
    EXPECT_NE(last.root_lift, first.root_lift);
    EXPECT_EQ(editor->history().edits.size(), 3u);
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().params.root_lift == first.root_lift; }));
    EXPECT_EQ(editor->style().params.strand_length, last.strand_length);
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return same(first); }));
    EXPECT_FALSE(editor->unsaved());
    EXPECT_FLOAT_EQ(editor->simulation().solver().groom().longest, first.strand_length);
    xdotool("key ctrl+z"); // there is nothing before
    frames(3);
    EXPECT_TRUE(same(first));
    xdotool("key ctrl+shift+z");
    xdotool("key ctrl+y");
    EXPECT_TRUE(until([&] { return same(last); }));
    EXPECT_TRUE(editor->unsaved());

    // Opening another file is an edit too.
    xdotool("key ctrl+s");
    EXPECT_TRUE(until([&] { return !editor->unsaved(); }));
    const fs::path here = editor->style().file;
    editor->open(data_folder() / "hairstyles" / "brush.toml");
    frames(3);
    EXPECT_EQ(editor->style().name(), "brush");
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().file == here && same(last); }));
    EXPECT_FALSE(editor->unsaved());
}

TEST_F(EditorWindow, while_c_is_held_the_hair_is_as_it_was_saved)
{
    const float saved = editor->style().params.strand_length;
    const WidgetPlace place = editor->panel().places.at("strand.length");
    const double y = 0.5 * (place.top + place.bottom), width = place.right - place.left;
    drag(place.left + 0.3 * width, y, place.left + 0.7 * width, y);
    release();
    const float edited = editor->style().params.strand_length;
    ASSERT_NE(edited, saved);
    const auto shown = [&] { return editor->simulation().solver().groom().longest; };
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("keydown c");
    EXPECT_TRUE(until([&] { return shown() == saved; }));
    EXPECT_EQ(editor->style().params.strand_length, edited);
    xdotool("keyup c");
    EXPECT_TRUE(until([&] { return shown() == edited; }));
    EXPECT_TRUE(editor->unsaved());
}

TEST_F(EditorWindow, a_screenshot_key_writes_a_picture_of_the_view)
{
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key p");
    EXPECT_TRUE(until([&] { return fs::exists("style-001.png"); }));
    const Image image = load_png("style-001.png");
    EXPECT_EQ(image.width, editor->view_width());
    EXPECT_EQ(image.height, 720);
    int different = 0; // from the corner's backdrop
    for (size_t i = 0; i < image.pixels.size(); i += 4)
        different += std::abs(int(image.pixels[i]) - int(image.pixels[0])) > 40;
    EXPECT_GT(different, image.width * image.height / 50) << "there is a head in it";
}

TEST_F(EditorWindow, space_pauses_and_a_full_stop_takes_one_step)
{
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key space");
    ASSERT_TRUE(until([&] { return editor->paused(); }));
    const long steps = editor->simulation().steps();
    frames(5);
    EXPECT_EQ(editor->simulation().steps(), steps);
    xdotool("key period");
    EXPECT_TRUE(until([&] { return editor->simulation().steps() == steps + 1; }));
}

TEST_F(EditorWindow, what_stands_still_is_refined_and_then_left_alone)
{
    xdotool("mousemove " + at(100.0, 650.0));
    xdotool("key space");
    ASSERT_TRUE(until([&] { return editor->paused(); }));
    ASSERT_TRUE(until([&] { return editor->refined() == 16; }));
    frames(10);
    EXPECT_EQ(editor->refined(), 16);
    shoot("refined");
    slide("root.lift", 0.6, 0.3); // paused, hair is still shaped
    EXPECT_LT(editor->refined(), 16) << "what changes is drawn anew";
    EXPECT_TRUE(until([&] { return editor->refined() == 16; }));
}

TEST_F(EditorWindow, strands_left_out_while_dragging_come_back_when_the_hand_rests)
{
    drag(700.0, 40.0, 720.0, 60.0); // beside the head
    editor->leeway().level = 3;
    frames(2);
    shoot("leeway");
    editor->leeway().level = 3;
    release();
    EXPECT_TRUE(until([&] { return editor->leeway().level == 0; }));
}

TEST_F(EditorWindow, a_broken_file_leaves_the_last_good_style_with_its_message)
{
    std::ofstream("broken.toml") << "[strand]\nlenght = 0.2\n";
    editor->open("broken.toml");
    frames(2);
    EXPECT_EQ(editor->style().name(), "style");
    EXPECT_NE(editor->message().find("broken.toml:2:1: no parameter is called 'strand.lenght'"), std::string::npos)
        << editor->message();
}

TEST_F(EditorWindow, closing_with_unsaved_changes_asks_first)
{
    const WidgetPlace place = editor->panel().places.at("root.lift");
    const double y = 0.5 * (place.top + place.bottom), width = place.right - place.left;
    drag(place.left + 0.6 * width, y, place.left + 0.2 * width, y);
    ASSERT_TRUE(until([&] { return editor->unsaved(); }));
    release();
    SDL_Event quit = {};
    quit.type = SDL_QUIT;
    SDL_PushEvent(&quit);
    frames(4);
    EXPECT_TRUE(open) << "it stays open to ask";
}

TEST_F(EditorWindow, every_motion_plays_by_its_key)
{
    xdotool("mousemove " + at(100.0, 650.0));
    const std::vector<std::string> names = motion_names();
    for (size_t i = 0; i < names.size(); ++i)
    {
        xdotool("key " + std::to_string(i + 1));
        EXPECT_TRUE(until([&] { return editor->simulation().motion_name() == names[i]; })) << names[i];
    }
}

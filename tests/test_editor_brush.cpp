// Brushes, scissors, freeze, settle and variants in a real window, by mouse and keyboard.
#include "tests/editor_window.h"

#include <algorithm>

using namespace coif;
using namespace coif::test;

namespace
{
class EditorBrush : public EditorWindow
{
  protected:
    void SetUp() override
    {
        EditorWindow::SetUp();
        if (IsSkipped())
            return;
        xdotool("mousemove " + at(30.0, 600.0));
        xdotool("key s");
        ASSERT_TRUE(until([&] { return editor->brush_places().contains("comb"); }));
        frames(4);
    }
    void choose(const char* name)
    {
        click(editor->brush_places().at(name));
        frames(3);
    }
    // A stroke of the left button over the head, which the view shows in its middle.
    void stroke(double dx, double dy, const char* modifier = "")
    {
        const double x = 0.5 * editor->view_width(), y = 200.0;
        xdotool("mousemove " + at(x - 0.5 * dx, y - 0.5 * dy));
        frames(2);
        const std::string key = modifier;
        xdotool((key.empty() ? "" : "keydown " + key + " ") + std::string("mousedown 1"));
        for (int i = 1; i <= 10; ++i)
        {
            xdotool("mousemove " + at(x + dx * (0.1 * i - 0.5), y + dy * (0.1 * i - 0.5)));
            frames(1);
        }
        xdotool("mouseup 1" + (key.empty() ? "" : " keyup " + key));
        frames(4);
    }
    const std::vector<ScalpMap>& maps() const { return editor->style().host.maps; }
};
} // namespace

TEST_F(EditorBrush, each_brush_paints_in_one_stroke_and_one_undo_takes_it_back)
{
    const std::pair<const char*, const char*> painters[] = {{"length", "strand.length"},
                                                            {"lift", "root.lift"},
                                                            {"wave", "wave.normal_amplitude"},
                                                            {"density", "interpolation.density"},
                                                            {"color", "look.root_color"}};
    for (const auto& [name, path] : painters)
    {
        choose(name);
        editor->brush().strength = 0.8f;
        const size_t edits = editor->history().edits.size();
        const Hairstyle unpainted = editor->style();
        stroke(120.0, 0.0);
        shoot(std::string("brush_") + name);
        EXPECT_TRUE(std::ranges::any_of(maps(), [path = path](const ScalpMap& map) { return map.of == path; })) << name;
        EXPECT_EQ(editor->history().edits.size(), edits + 1) << name << ": one stroke, one edit";
        EXPECT_TRUE(editor->unsaved());
        xdotool("key ctrl+z");
        EXPECT_TRUE(until([&] { return same_style(editor->style(), unpainted); })) << name;
        xdotool("key ctrl+shift+z");
        EXPECT_TRUE(until([&] { return !same_style(editor->style(), unpainted); })) << name;
    }
    choose("smooth");
    const auto painted = maps();
    stroke(120.0, 0.0);
    EXPECT_NE(maps(), painted);
    choose("erase");
    editor->brush().strength = 1.0f;
    editor->brush().falloff = 0.0f;
    editor->brush().radius = 0.12f;
    for (int i = 0; i < 3 && !maps().empty(); ++i)
        stroke(120.0, 0.0);
    EXPECT_TRUE(maps().empty());
}

TEST_F(EditorBrush, the_comb_bends_the_rest_shape_while_the_hair_moves)
{
    editor->play("shake");
    choose("comb");
    editor->brush().strength = 1.0f;
    stroke(160.0, 0.0);
    shoot("brush_comb");
    ASSERT_TRUE(editor->style().host.groom_rest.shapes);
    EXPECT_EQ(editor->style().host.groom_rest.shapes->strands(),
              int(editor->simulation().assets().scalp.positions.size()));
    EXPECT_TRUE(editor->simulation().playing()) << "and nothing stopped";
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return !editor->style().host.groom_rest.shapes; }));
}

TEST_F(EditorBrush, alt_picks_the_value_under_the_brush)
{
    choose("length");
    editor->brush().length = 0.05f;
    editor->brush().strength = 1.0f;
    editor->brush().falloff = 0.0f;
    stroke(100.0, 0.0);
    editor->brush().length = 0.5f;
    stroke(2.0, 0.0, "alt");
    EXPECT_NEAR(editor->brush().length, 0.05f, 0.01f);
}

TEST_F(EditorBrush, scissors_cut_below_a_line)
{
    choose("cut");
    const double y = 420.0;
    xdotool("mousemove " + at(330.0, y)); // beside the tools
    frames(2);
    xdotool("mousedown 1");
    for (int i = 1; i <= 10; ++i)
    {
        xdotool("mousemove " + at(330.0 + 50.0 * i, y));
        frames(1);
    }
    shoot("scissors");
    xdotool("mouseup 1");
    frames(4);
    ASSERT_TRUE(std::ranges::any_of(maps(), [](const ScalpMap& map) { return map.of == "strand.length"; }))
        << editor->message();
    shoot("scissors_after");
}

TEST_F(EditorBrush, frozen_hair_is_saved_beside_the_style_and_settles_again)
{
    choose("freeze");
    ASSERT_TRUE(editor->style().host.groom_rest.shapes) << editor->message();
    EXPECT_EQ(editor->history().edits.back().what, "froze the hair as it is");
    shoot("freeze");
    xdotool("mousemove " + at(30.0, 600.0));
    xdotool("key ctrl+s");
    EXPECT_TRUE(until([&] { return !editor->unsaved(); })) << editor->message();
    EXPECT_TRUE(fs::exists("style.rest"));
    const std::string text = contents("style.toml");
    EXPECT_NE(text.find("length = 0.2 # short"), std::string::npos) << "the author's own lines stay";
    EXPECT_NE(text.find("rest = \"style.rest\""), std::string::npos);
    choose("settle");
    EXPECT_FALSE(editor->style().host.groom_rest.shapes);
    xdotool("mousemove " + at(30.0, 600.0));
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().host.groom_rest.shapes != nullptr; }));
}

TEST_F(EditorBrush, a_save_of_ones_own_is_not_read_again_whatever_lies_beside)
{
    // Files that a style names are watched too: these are ours.
    choose("freeze");
    for (int i = 0; i < 2; ++i)
    {
        choose("comb");
        stroke(120.0, 0.0);
        xdotool("mousemove " + at(30.0, 600.0));
        xdotool("key ctrl+s");
        ASSERT_TRUE(until([&] { return !editor->unsaved(); })) << editor->message();
        EXPECT_FALSE(within(1.5, [&] { return editor->message().find("saved ") != 0; })) << editor->message();
    }
    // Another's is seen.
    std::ofstream("style.toml", std::ios::app) << "# theirs\n";
    EXPECT_TRUE(within(3.0, [&] { return editor->message().find("was written by another") != std::string::npos; }));
    EXPECT_FALSE(editor->unsaved());
}

TEST_F(EditorBrush, a_region_is_painted_and_erased_and_seen)
{
    choose("region");
    frames(3);
    click(editor->brush_places().at("show regions"));
    EXPECT_TRUE(until([&] { return !editor->legend().readings.empty(); }));
    const Hairstyle unpainted = editor->style();
    const size_t edits = editor->history().edits.size();
    editor->brush().strength = 1.0f;
    stroke(120.0, 0.0);
    frames(3);
    shoot("brush_region");
    const auto& regions = editor->style().host.regions;
    ASSERT_EQ(regions.size(), 1u) << editor->message();
    EXPECT_EQ(regions[0].name, "region 1");
    EXPECT_EQ(editor->history().edits.size(), edits + 1) << "one stroke, one edit";
    EXPECT_EQ(editor->history().edits.back().what, "painted region 1");
    EXPECT_EQ(editor->legend().title, "regions");
    EXPECT_EQ(editor->legend().readings.back(), "region 1");
    const auto sum = [&]
    {
        double all = 0.0;
        for (const float w : regions.at(0).weights)
            all += double(w);
        return all;
    };
    const double painted = sum();
    EXPECT_GT(painted, 3.0);
    stroke(0.0, 100.0);
    EXPECT_EQ(regions.size(), 1u) << "the next goes on with it";
    EXPECT_GT(sum(), painted);
    const double more = sum();
    editor->brush().weight = 0.0f;
    stroke(0.0, 100.0);
    EXPECT_LT(sum(), more);
    // All of it cannot go: a region of nothing is none.
    editor->brush().radius = 0.15f;
    editor->brush().falloff = 0.0f;
    for (int i = 0; i < 3; ++i)
        stroke(100.0, 0.0);
    EXPECT_GT(sum(), 0.0);
    EXPECT_NE(editor->message().find("selects none"), std::string::npos) << editor->message();
    xdotool("mousemove " + at(30.0, 600.0));
    for (int i = 0; i < 8 && !regions.empty(); ++i)
    {
        xdotool("key ctrl+z");
        frames(6);
    }
    EXPECT_TRUE(same_style(editor->style(), unpainted));
    xdotool("key ctrl+shift+z");
    EXPECT_TRUE(until([&] { return editor->style().host.regions.size() == 1; }));
    xdotool("key ctrl+s");
    EXPECT_TRUE(until([&] { return !editor->unsaved(); })) << editor->message();
    EXPECT_EQ(load_hairstyle("style.toml").host.regions, regions);
}

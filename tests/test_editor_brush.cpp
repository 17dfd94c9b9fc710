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
    xdotool("mousemove " + at(100.0, y));
    frames(2);
    xdotool("mousedown 1");
    for (int i = 1; i <= 10; ++i)
    {
        xdotool("mousemove " + at(100.0 + 60.0 * i, y));
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

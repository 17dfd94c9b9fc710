// The editor's window that writes hair for other tools.
#include "tests/editor_window.h"
#include "tests/host/ogawa_walk.h"

using namespace coif;
using namespace coif::test;

TEST_F(EditorWindow, hair_is_exported_as_it_is_now_while_the_window_goes_on)
{
    xdotool("key e");
    ASSERT_TRUE(until([&] { return editor->exporting().shown; }));
    ASSERT_TRUE(within(20.0, [&] { return !editor->exporting().words.empty(); })) << editor->exporting().trouble;
    EXPECT_EQ(editor->exporting().file, (folder / "style.usda").string());
    EXPECT_NE(editor->exporting().words[0].find("300 strands of 15 points"), std::string::npos)
        << editor->exporting().words[0];
    const WidgetPlace tool = editor->exporting().places.at("for");
    click(tool);
    const double item = 0.85 * (tool.bottom - tool.top); // its list opens below, the first of it no tool
    const float left = tool.left + 40.0f, top = tool.bottom + 8.0f + float(item);
    click({left, top, left, top + float(item)});
    ASSERT_TRUE(until([&] { return editor->exporting().wanted.target == "unreal"; }))
        << editor->exporting().wanted.target;
    ASSERT_TRUE(within(20.0, [&] { return editor->exporting().words.size() > 2; })) << "what Unreal is to be told";
    shoot("export");
    click(editor->exporting().places.at("Export"));
    ASSERT_TRUE(within(20.0, [&] { return fs::exists("style.usda") && !editor->exporting().writing.valid(); }));
    EXPECT_NE(editor->message().find("wrote "), std::string::npos) << editor->message();
    EXPECT_EQ(contents("style.usda").substr(0, 9), "#usda 1.0");
    xdotool("key e");
    EXPECT_TRUE(until([&] { return !editor->exporting().shown; }));
}

TEST_F(EditorWindow, a_motion_is_exported_with_progress_and_can_be_stopped)
{
    xdotool("key ctrl+e");
    ASSERT_TRUE(within(20.0, [&] { return !editor->exporting().words.empty(); })) << "the window stands";
    frames(3);
    const auto type = [&](const char* field, const std::string& text, const std::string& value)
    {
        click(editor->exporting().places.at(field));
        xdotool("key ctrl+a");
        frames(2);
        xdotool("type --delay 5 " + text);
        xdotool("key Return");
        ASSERT_TRUE(within(20.0, [&] { return value == text; })) << value;
        frames(3);
    };
    const auto type_file = [&](const std::string& name) { type("file", name, editor->exporting().file); };
    type_file("m.obj");
    click(editor->exporting().places.at("the motion"));
    ASSERT_TRUE(within(20.0, [&] { return !editor->exporting().trouble.empty(); })) << "it holds one pose";
    type_file("m.abc");
    type("frames", "0:5999", editor->exporting().frames.frames); // long enough to be stopped on any machine
    ASSERT_TRUE(within(20.0, [&] { return !editor->exporting().words.empty(); })) << editor->exporting().trouble;
    click(editor->exporting().places.at("Export"));
    ASSERT_TRUE(within(60.0, [&] { return editor->exporting().share > 0.001f; }));
    shoot("export_motion");
    click(editor->exporting().places.at("Stop"));
    ASSERT_TRUE(within(60.0, [&] { return !editor->exporting().writing.valid(); }));
    EXPECT_NE(editor->message().find("stopped"), std::string::npos) << editor->message();
    EXPECT_FALSE(fs::exists("m.abc"));
    type("frames", "0:59", editor->exporting().frames.frames);
    click(editor->exporting().places.at("Export"));
    ASSERT_TRUE(within(120.0, [&] { return fs::exists("m.abc") && !editor->exporting().writing.valid(); }))
        << editor->message();
    const OgawaWalk walk(contents("m.abc"));
    EXPECT_EQ(walk.properties.at("/hair/strands:.geom/P").declared, 60u);
}

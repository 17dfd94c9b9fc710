#include "app/panel.h"

#include <gtest/gtest.h>
#include <imgui.h>

using namespace coif;

namespace
{
// ImGui lays out and clips without a window or a GPU.
class Panel : public testing::Test
{
  protected:
    void SetUp() override
    {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {500.0f, 5000.0f}; // tall enough for every parameter
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
    void TearDown() override { ImGui::DestroyContext(); }

    // Presses and lets go four fifths along a widget.
    bool click(const std::string& path)
    {
        if (!state.places.contains(path))
        {
            frame();
            frame();
        }
        const WidgetPlace place = state.places.at(path);
        ImGuiIO& io = ImGui::GetIO();
        io.MousePos = {place.left + 0.8f * (place.right - place.left), 0.5f * (place.top + place.bottom)};
        frame();
        io.MouseDown[0] = true;
        bool changed = frame();
        changed |= frame();
        io.MouseDown[0] = false;
        frame();
        return changed;
    }

    bool frame()
    {
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({0.0f, 0.0f});
        ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
        ImGui::Begin("panel");
        const bool changed = draw_params_panel(style, state);
        ImGui::End();
        ImGui::Render();
        return changed;
    }

    Hairstyle style;
    PanelState state;
};
} // namespace

TEST_F(Panel, shows_a_widget_for_every_parameter_and_changes_none_by_itself)
{
    const Hairstyle before;
    for (int i = 0; i < 3; ++i)
        EXPECT_FALSE(frame());
    for (const ParamInfo& info : param_table())
    {
        EXPECT_TRUE(same_value(style, before, info)) << info.path();
        EXPECT_EQ(state.places.contains(info.path()), info.kind != Kind::LIST) << info.path();
    }
}

TEST_F(Panel, a_drag_on_a_slider_changes_that_parameter_only)
{
    EXPECT_TRUE(click("strand.length"));
    EXPECT_GT(style.params.strand_length, 0.3f);
    Hairstyle expected;
    expected.params.strand_length = style.params.strand_length;
    for (const ParamInfo& info : param_table())
        EXPECT_TRUE(same_value(style, expected, info)) << info.path();
}

TEST_F(Panel, a_point_of_a_profile_goes_where_the_mouse_drags_it)
{
    frame();
    frame();
    const WidgetPlace place = state.places.at("look.opacity_along");
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {place.left + 0.64f * (place.right - place.left), place.top + 5.0f}; // nearest to the third
    frame();
    io.MouseDown[0] = true;
    frame();
    const float height = 3.0f * ImGui::GetFrameHeight();
    io.MousePos = {place.left, place.top + 0.5f * height}; // stays with the third, wherever the mouse goes
    EXPECT_TRUE(frame());
    io.MouseDown[0] = false;
    frame();
    const float4 is = style.params.look_opacity_along;
    EXPECT_NEAR(is.z, 0.5f, 0.01f);
    EXPECT_EQ(is, F4(1.0f, 1.0f, is.z, 1.0f));
    Hairstyle expected;
    expected.params.look_opacity_along = is;
    for (const ParamInfo& info : param_table())
        EXPECT_TRUE(same_value(style, expected, info)) << info.path();
}

TEST_F(Panel, what_the_chosen_solver_does_not_read_cannot_be_moved)
{
    for (const char* solver : {"direct", "pbd"})
    {
        style = {};
        assign(style, std::string("solver.kind=") + solver);
        for (const char* path :
             {"solver.iterations", "solver.substeps", "bending.droop", "bending.along", "forces.drag"})
            EXPECT_EQ(click(path), is_read(*find_param(path), style.params)) << path << " under " << solver;
    }
}

TEST_F(Panel, what_the_chosen_level_does_not_read_cannot_be_moved)
{
    for (const char* level : {"kajiya_kay", "auto", "dual_scattering"})
    {
        style = {};
        assign(style, std::string("look.level=") + level);
        for (const char* path : {"look.diffuse", "look.roughness", "look.ior", "look.tolerance", "look.self_shadow"})
            EXPECT_EQ(click(path), is_read(*find_param(path), style.params)) << path << " at " << level;
    }
}

TEST_F(Panel, what_differs_from_the_default_has_a_button_that_takes_it_back)
{
    assign(style, "root.lift=12");
    frame();
    frame();
    const WidgetPlace place = state.places.at("root.lift");
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {place.right + ImGui::GetStyle().ItemInnerSpacing.x + 5.0f, 0.5f * (place.top + place.bottom)};
    frame();
    io.MouseDown[0] = true;
    frame();
    io.MouseDown[0] = false;
    EXPECT_TRUE(frame());
    EXPECT_EQ(style.params.root_lift, Hairstyle().params.root_lift);
    EXPECT_FALSE(style.places.contains("root.lift"));
}

TEST_F(Panel, groups_fold_and_what_is_looked_for_is_shown_all_the_same)
{
    frame();
    click("group strand");
    frame();
    EXPECT_EQ(state.folded, std::set<std::string>{"strand"});
    EXPECT_FALSE(state.places.contains("strand.length"));
    EXPECT_TRUE(state.places.contains("root.lift"));
    snprintf(state.filter, sizeof state.filter, "LENGTH OF A STRAND"); // what its help says
    frame();
    EXPECT_TRUE(state.places.contains("strand.length"));
    EXPECT_FALSE(state.places.contains("root.lift"));
    state.filter[0] = 0;
    frame();
    EXPECT_FALSE(state.places.contains("strand.length")) << "it is folded still";
    click("group strand");
    frame();
    EXPECT_TRUE(state.folded.empty());
}

TEST_F(Panel, a_row_under_the_mouse_shows_its_lock)
{
    frame();
    frame();
    const WidgetPlace place = state.places.at("strand.length");
    EXPECT_FALSE(state.places.contains("strand.length lock"));
    ImGui::GetIO().MousePos = {place.left + 20.0f, 0.5f * (place.top + place.bottom)};
    frame();
    ASSERT_TRUE(state.places.contains("strand.length lock"));
    click("strand.length lock");
    EXPECT_EQ(state.locked, std::set<std::string>{"strand.length"});
}

TEST_F(Panel, dice_are_thrown_within_the_locks)
{
    const Hairstyle first = style;
    state.locked = {"strand.length"};
    click("randomise"); // a button acts when it is let go
    EXPECT_EQ(state.done, "randomise, seed 1");
    EXPECT_EQ(state.seed, 2);
    EXPECT_EQ(style.params.strand_length, first.params.strand_length);
    EXPECT_NE(style.params.root_lift, first.params.root_lift);
}

TEST_F(Panel, the_filter_leaves_what_contains_it)
{
    snprintf(state.filter, sizeof state.filter, "wave.");
    frame();
    frame();
    EXPECT_TRUE(state.places.contains("wave.normal_amplitude"));
    EXPECT_FALSE(state.places.contains("strand.length"));
}

TEST_F(Panel, the_mark_at_a_light_chooses_it_and_a_direction_never_becomes_none)
{
    style.host.lights = {Light{"key", {0.0f, 1.0f, 0.0f}}, Light{"rim", {0.0f, 0.5f, -1.0f}}};
    snprintf(state.filter, sizeof state.filter, "light");
    frame();
    frame();
    const auto mark = [&]
    {
        const WidgetPlace place = state.places.at("light[1]");
        state.places["mark"] = {place.left, place.top, place.left + 10.0f, place.bottom}; // left of its name
        return click("mark");
    };
    EXPECT_FALSE(mark()) << "it changes no light";
    EXPECT_EQ(state.light, 1u);
    style.host.look_lights = "soft.toml";
    state.light = 0;
    mark();
    EXPECT_EQ(state.light, 0u) << "grey, since a file's lights shine in their place";
    style.host.look_lights.clear();

    // The direction of the first is dragged down to 0, and stays what it was.
    frame();
    frame();
    const WidgetPlace first = state.places.at("light[0]");
    const float row = ImGui::GetFrameHeightWithSpacing(), width = ImGui::GetIO().DisplaySize.x * 0.5f;
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {first.left + 0.5f * width, first.top + 2.5f * row}; // its y
    frame();
    io.MouseDown[0] = true;
    frame();
    for (int i = 0; i < 40; ++i)
    {
        io.MousePos.x -= 50.0f; // 0.05 a frame, 1 to -1
        frame();
        EXPECT_TRUE(points_somewhere(style.host.lights[0].direction));
    }
    io.MouseDown[0] = false;
    frame();
    EXPECT_LT(style.host.lights[0].direction.y, 1.0f) << "it was dragged";
    EXPECT_EQ(style.host.lights[1], (Light{"rim", {0.0f, 0.5f, -1.0f}}));
}

// Lights in the editor's window: turned and brightened by the mouse, chosen, taken and saved in the panel.
#include "app/image.h"
#include "tests/editor_window.h"

#include <glm/geometric.hpp>

using namespace coif;
using namespace coif::test;

namespace
{
constexpr double kSecond = 3.0; // that a busy machine may make of one

const char kTwo[] = "# mine\n[interpolation]\nstrands = 300\n"
                    "[[light]] # the window\nname = \"key\"\ndirection = [0.5, 0.5, 0.7]\n"
                    "[[light]]\nname = \"rim\"\ndirection = [-0.6, 0.5, 0.1]\nirradiance = 1.0\n";

class EditorLights : public EditorWindow
{
  protected:
    void SetUp() override
    {
        EditorWindow::SetUp();
        if (editor && !IsSkipped())
            away();
    }
    // The mouse out of every window's way.
    void away()
    {
        xdotool("mousemove " + at(30.0, 650.0));
        frames(3);
    }
    // The style as another program writes it.
    void take(const std::string& text)
    {
        std::ofstream("style.toml") << text;
        ASSERT_TRUE(within(kSecond, [&] { return editor->style().text == text; })) << editor->message();
        frames(3);
    }
    void hold(bool on)
    {
        xdotool(std::string(on ? "keydown" : "keyup") + " l");
        frames(4);
    }
    double depth_of(size_t light) // towards the camera
    {
        const Camera& camera = editor->camera();
        return glm::dot(glm::normalize(glm::dvec3(editor->lights().at(light).direction)),
                        glm::normalize(camera.position() - camera.target));
    }
    void find_in_panel(const std::string& words)
    {
        click(editor->panel().places.at("filter"));
        xdotool("key ctrl+a");
        xdotool("type '" + words + "'");
        EXPECT_TRUE(until([&] { return words == editor->panel().filter; })) << editor->panel().filter;
        frames(3);
    }
};
} // namespace

TEST_F(EditorLights, a_light_of_the_list_goes_where_the_mouse_takes_it_as_one_edit)
{
    take(kTwo);
    const Hairstyle old = editor->style();
    const size_t edits = editor->history().edits.size();
    const glm::dvec2 rim = editor->light_place(1);
    hold(true);
    shoot("lights");
    drag(rim.x, rim.y, rim.x + 90.0, rim.y + 60.0);
    hold(false); // the mouse keeps it
    point(rim.x + 120.0, rim.y + 80.0);
    release();
    const std::vector<Light>& lights = editor->style().host.lights;
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_EQ(lights[0], old.host.lights[0]);
    EXPECT_GT(glm::distance(lights[1].direction, glm::normalize(old.host.lights[1].direction)), 0.3f);
    EXPECT_NEAR(glm::length(lights[1].direction), 1.0f, 2e-3f);
    EXPECT_NEAR(glm::distance(editor->light_place(1), rim + glm::dvec2(120.0, 80.0)), 0.0, 3.0) << "under the mouse";
    EXPECT_EQ(lights[1].irradiance, 1.0f);
    EXPECT_EQ(editor->panel().light, 1u) << "it is the chosen one now";
    EXPECT_EQ(editor->history().edits.size(), edits + 1);
    EXPECT_EQ(editor->history().edits.back().what, "turned a light");
    EXPECT_EQ(difference(editor->style(), old), "light") << "and nothing else";
    xdotool("key ctrl+s");
    EXPECT_TRUE(until([&] { return !editor->unsaved(); }));
    EXPECT_EQ(load_hairstyle("style.toml").host.lights, lights);
    EXPECT_NE(contents("style.toml").find("[[light]] # the window"), std::string::npos);
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return editor->style().host.lights == old.host.lights; }));
}

TEST_F(EditorLights, beyond_the_circle_is_behind_the_head)
{
    take(kTwo);
    ASSERT_GT(depth_of(0), 0.0);
    hold(true);
    const glm::dvec2 key = editor->light_place(0);
    drag(key.x, key.y, editor->view_width() - 40.0, key.y);
    shoot("behind");
    EXPECT_LT(depth_of(0), -0.3);
    point(key.x, key.y);
    EXPECT_TRUE(until([&] { return depth_of(0) > 0.0; })) << "and back";
    release();
    // Beside any light the chosen one goes the way that the mouse goes.
    const glm::vec3 rim = editor->style().host.lights.at(1).direction;
    drag(100.0, 600.0, 140.0, 600.0);
    release();
    EXPECT_NEAR(glm::distance(editor->light_place(0), key + glm::dvec2(40.0, 0.0)), 0.0, 4.0);
    EXPECT_EQ(editor->style().host.lights.at(1).direction, rim);
    hold(false);
    const double yaw = editor->camera().yaw;
    drag(100.0, 600.0, 180.0, 600.0);
    EXPECT_TRUE(until([&] { return std::abs(editor->camera().yaw - yaw) > 0.2; })) << "without the key the view turns";
    release();
}

TEST_F(EditorLights, without_a_list_the_one_light_is_turned_and_the_picture_shows_it)
{
    xdotool("key space");
    ASSERT_TRUE(until([&] { return editor->paused(); }));
    const Image first = load_png(editor->screenshot());
    const Hairstyle style = editor->style();
    hold(true);
    const glm::dvec2 from = editor->light_place(0);
    drag(from.x, from.y, from.x - 200.0, from.y + 60.0);
    release();
    hold(false);
    EXPECT_NE(editor->style().params.look_light_direction, style.params.look_light_direction);
    Hairstyle expected = style;
    expected.params.look_light_direction = editor->style().params.look_light_direction;
    EXPECT_TRUE(same_style(editor->style(), expected)) << difference(editor->style(), expected);
    EXPECT_EQ(editor->simulation().params().look_light_direction, expected.params.look_light_direction);
    const Image after = load_png(editor->screenshot());
    ASSERT_EQ(first.pixels.size(), after.pixels.size());
    double apart = 0.0;
    for (size_t i = 0; i < first.pixels.size(); ++i)
        apart += std::abs(int(first.pixels[i]) - int(after.pixels[i]));
    EXPECT_GT(apart / double(first.pixels.size()), 1.0);
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return same_style(editor->style(), style); })) << "one step";
}

TEST_F(EditorLights, the_panel_measures_the_shown_level_on_demand_and_says_when_that_is_of_another_look)
{
    take("[look]\nlevel = \"dual_scattering\"\n[interpolation]\nstrands = 300\n[forces]\nrepulsion = 0.0\n");
    find_in_panel("look.level");
    EXPECT_TRUE(editor->panel().look_cost.starts_with("dual_scattering: ")) << editor->panel().look_cost;
    EXPECT_EQ(editor->panel().look_error, "");
    click(editor->panel().places.at("measure look"));
    const auto& panel = editor->panel();
    ASSERT_TRUE(within(30.0, [&] { return !panel.look_error.empty(); })) << editor->message();
    EXPECT_TRUE(panel.look_error.starts_with("dual_scattering has ")) << panel.look_error;
    EXPECT_TRUE(panel.look_error.ends_with(" % off")) << panel.look_error;
    shoot("look measured");
    take("[look]\nlevel = \"dual_scattering\"\nroot_color = \"#ffffff\"\n[interpolation]\nstrands = 300\n");
    EXPECT_TRUE(panel.look_error.ends_with(" % off, before the last change")) << panel.look_error;
}

TEST_F(EditorLights, of_a_file_become_the_style_s_own_when_they_are_turned)
{
    take("[look]\nlights = \"studio.toml\"\n[interpolation]\nstrands = 300\n");
    ASSERT_EQ(editor->lights().size(), 3u);
    const std::vector<Light> file = editor->lights();
    const Sky sky = editor->simulation().assets().lights->sky;
    const Hairstyle old = editor->style();
    hold(true);
    const glm::dvec2 fill = editor->light_place(1);
    point(fill.x, fill.y);
    press();
    release();
    EXPECT_TRUE(same_style(editor->style(), old)) << "a click changes nothing";
    drag(fill.x, fill.y, fill.x - 30.0, fill.y - 60.0);
    release();
    hold(false);
    const Hairstyle& after = editor->style();
    EXPECT_EQ(after.host.look_lights, "");
    ASSERT_EQ(after.host.lights.size(), 3u);
    EXPECT_EQ(after.host.lights[0], file[0]);
    EXPECT_EQ(after.host.lights[2], file[2]);
    EXPECT_NE(after.host.lights[1].direction, file[1].direction);
    EXPECT_EQ(after.params.look_sky_radiance, sky.radiance);
    EXPECT_FALSE(editor->simulation().assets().lights);
    xdotool("key ctrl+z");
    EXPECT_TRUE(until([&] { return same_style(editor->style(), old); })) << "one step brings the file back";
    EXPECT_TRUE(editor->simulation().assets().lights);
}

TEST_F(EditorLights, the_wheel_over_a_light_makes_it_brighter_and_elsewhere_zooms)
{
    take(kTwo);
    const double distance = editor->camera().distance;
    const size_t edits = editor->history().edits.size();
    hold(true);
    const glm::dvec2 rim = editor->light_place(1);
    point(rim.x, rim.y);
    xdotool("click 4");
    EXPECT_TRUE(until([&] { return std::abs(editor->style().host.lights.at(1).irradiance - 1.1f) < 1e-6f; }));
    xdotool("click 4");
    EXPECT_TRUE(until([&] { return std::abs(editor->style().host.lights.at(1).irradiance - 1.21f) < 1e-6f; }));
    for (int i = 0; i < 50; ++i)
        xdotool("click 5");
    EXPECT_TRUE(until([&] { return editor->style().host.lights.at(1).irradiance == 0.0f; })) << "dark at last";
    xdotool("click 4");
    EXPECT_TRUE(until([&] { return editor->style().host.lights.at(1).irradiance > 0.0f; })) << "and lit again";
    EXPECT_EQ(editor->camera().distance, distance);
    EXPECT_EQ(editor->style().host.lights.at(0).irradiance, Light{}.irradiance);
    hold(false);
    EXPECT_EQ(editor->history().edits.size(), edits + 1) << "all of it is one edit";
    hold(true);
    point(40.0, 640.0);
    xdotool("click 4");
    EXPECT_TRUE(until([&] { return editor->camera().distance < distance; }));
    hold(false);
    EXPECT_EQ(editor->history().edits.size(), edits + 1);
}

TEST_F(EditorLights, a_file_of_lights_that_is_changed_on_disk_shows_and_a_broken_one_leaves_the_last_good)
{
    const auto rewrite = [](const std::string& text) { std::ofstream("mine.toml") << text; };
    rewrite("[[light]]\ndirection = [1, 0, 0]\n");
    take("[look]\nlights = \"mine.toml\"\n[interpolation]\nstrands = 300\n");
    const auto direction = [&] { return editor->simulation().params().look_light_direction; };
    ASSERT_EQ(direction(), F4(1, 0, 0, 0));
    const int grown = int(editor->simulation().solver().groom().drawn.size());
    frames(20);
    rewrite("[[light]]\ndirection = [0, 0.5, 1]\n");
    EXPECT_TRUE(within(kSecond, [&] { return direction() == F4(0, 0.5f, 1, 0); })) << editor->message();
    EXPECT_EQ(editor->message(), "read the lights again");
    frames(20);
    rewrite("[[light]]\ndirection = [0, 0, 0]\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("mine.toml:2:13") != std::string::npos; }))
        << editor->message();
    EXPECT_EQ(direction(), F4(0, 0.5f, 1, 0));
    fs::remove("mine.toml");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("mine.toml is gone") != std::string::npos; }))
        << editor->message();
    rewrite("[sky]\nradiance = 1\n");
    EXPECT_TRUE(within(kSecond, [&] { return editor->simulation().lighting().suns.empty(); })) << editor->message();
    EXPECT_EQ(editor->simulation().lighting().sky, glm::vec3(1.0f));
    EXPECT_FALSE(editor->unsaved());
    EXPECT_EQ(int(editor->simulation().solver().groom().drawn.size()), grown);
}

TEST_F(EditorLights, are_chosen_taken_and_saved_in_the_panel)
{
    const Hairstyle plain = editor->style();
    find_in_panel("styles share");
    const auto choose = [&](const std::string& name)
    {
        click(editor->panel().places.at("look.lights"));
        ASSERT_TRUE(until([&] { return editor->panel().places.contains("lights " + name); })) << name;
        frames(3);
        shoot("chooser");
        click(editor->panel().places.at("lights " + name));
    };
    choose("outdoors.toml");
    EXPECT_TRUE(until([&] { return editor->style().host.look_lights == "outdoors.toml"; }));
    EXPECT_EQ(editor->lights().size(), 1u);
    EXPECT_EQ(editor->lights().at(0).name, "sun");
    shoot("outdoors");
    click(editor->panel().places.at("edit lights"));
    EXPECT_TRUE(until([&] { return editor->style().host.lights.size() == 1; }));
    EXPECT_EQ(editor->style().host.look_lights, "");
    EXPECT_EQ(editor->history().edits.back().what, "lights edited here");

    click(editor->panel().places.at("save lights"));
    frames(5);
    xdotool("type evening");
    frames(5);
    shoot("save");
    xdotool("keydown Return"); // long enough for a slow frame
    frames(3);
    xdotool("keyup Return");
    EXPECT_TRUE(until([&] { return fs::exists("lights/evening.toml"); })) << editor->message();
    frames(5);
    EXPECT_EQ(editor->style().host.look_lights, "lights/evening.toml");
    EXPECT_TRUE(editor->style().host.lights.empty());
    EXPECT_EQ(load_lights("lights/evening.toml"), load_lights(data_folder() / "hairstyles/lights/outdoors.toml"));
    choose("lights/evening.toml"); // it is on offer, and chosen already
    choose("own");
    EXPECT_TRUE(until([&] { return same_style(editor->style(), plain); })) << difference(editor->style(), plain);
    away();
    for (const char* back : {"lights/evening.toml", "", "outdoors.toml", ""})
    {
        xdotool("key ctrl+z");
        EXPECT_TRUE(until([&] { return editor->style().host.look_lights == back; }))
            << back << " " << editor->style().host.look_lights;
    }
    EXPECT_TRUE(same_style(editor->style(), plain));
}

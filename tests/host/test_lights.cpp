// Lights: files of them, what a style makes of them, and where the view shows them.
#include "app/light_globe.h"
#include "app/randomise.h"
#include "sim/lights.h"
#include "tests/host/entries.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>

namespace coif
{
namespace
{

using test::between;
using test::bytes_of;
using test::error_of;
using test::Scratch;

const fs::path kShipped = fs::path(COIF_SOURCE_FOLDER) / "hairstyles" / "lights";

bool same_light(const Lighting& a, const Lighting& b)
{
    bool same = a.sky == b.sky && a.suns.size() == b.suns.size();
    for (size_t i = 0; same && i < a.suns.size(); ++i)
        same = a.suns[i].direction == b.suns[i].direction && a.suns[i].irradiance == b.suns[i].irradiance &&
               a.suns[i].radius == b.suns[i].radius;
    return same;
}

LightRig random_rig(std::mt19937& random)
{
    LightRig rig;
    for (unsigned long i = random() % 4; i > 0; --i)
        test::add_entry(rig.lights, random);
    rig.sky.color = {float(random() % 256) / 255.0f, 1.0f, 0.3f};
    rig.sky.radiance = 0.01f * float(random() % 100);
    return rig;
}

TEST(Lights, a_file_holds_suns_and_a_sky)
{
    const Scratch scratch;
    const LightRig rig = load_lights(scratch.write("a.toml", "[[light]]\n"
                                                             "direction = [0, 1, 0]\n"
                                                             "[sky]\n"
                                                             "radiance = 0.5\n"
                                                             "color = '#8090ff'\n"
                                                             "[[light]]\n"
                                                             "name = 'rim'\n"
                                                             "direction = [0, 0.5, -1]\n"
                                                             "color = [1, 0.5, 0.25]\n"
                                                             "irradiance = 4\n"
                                                             "angle = 3\n"));
    ASSERT_EQ(rig.lights.size(), 2u);
    EXPECT_EQ(rig.lights[0].direction, glm::vec3(0, 1, 0));
    EXPECT_EQ(rig.lights[0].irradiance, Light{}.irradiance);
    EXPECT_EQ(rig.lights[1], (Light{"rim", {0, 0.5f, -1}, {1, 0.5f, 0.25f}, 4, 3}));
    EXPECT_EQ(rig.sky, (Sky{{float(128 / 255.0), float(144 / 255.0), 1}, 0.5f}));
    EXPECT_EQ(load_lights(scratch.write("b.toml", "[sky]\nradiance = 1\n")), (LightRig{{}, {{1, 1, 1}, 1}}));
    EXPECT_EQ(load_lights(scratch.write("c.toml", "[[light]]\ndirection = [1, 0, 0]\n")).sky.radiance, 0.0f)
        << "what is not said is not there";
    EXPECT_EQ(load_lights(scratch.write("d.toml", "[sky]\nradiance = 0\n")), LightRig{}) << "darkness, if it is said";
}

TEST(Lights, what_is_wrong_is_told_with_its_place_in_files_and_in_styles)
{
    const std::string one = "[[light]]\ndirection = [0, 1, 0]\n";
    std::string many;
    for (size_t i = 0; i < kMostLights; ++i)
        many += one;
    const std::pair<std::string, std::string> of_both[] = {
        {"[[light]]\nirradiance = 1\n", ":1:1: a light needs direction"},
        {"[[light]]\ndirection = [0, 0, 0]\n",
         ":2:13: light.direction is no direction: one of its numbers must not be 0"},
        {"[[light]]\ndirection = [0, 1e-30, 0]\n",
         ":2:13: light.direction is no direction: one of its numbers must not be 0"},
        {"[[light]]\ndirection = [0, 2, 0]\n", ":2:13: light.direction is 2, but must lie in [-1, 1]"},
        {"[[light]]\ndirection = [0, nan, 0]\n", ":2:13: light.direction is nan, but must lie in [-1, 1]"},
        {"[[light]]\ndirection = [0, 1]\n", ":2:13: light.direction must be three numbers"},
        {one + "irradiance = -1\n", ":3:14: light.irradiance is -1, but must lie in [0, 100]"},
        {one + "irradiance = inf\n", ":3:14: light.irradiance is inf, but must lie in [0, 100]"},
        {one + "irradiance = nan\n", ":3:14: light.irradiance is nan, but must lie in [0, 100]"},
        {one + "irradiance = 'much'\n", ":3:14: light.irradiance must be a number, not text"},
        {one + "color = 'white'\n", ":3:9: light.color must be a colour like \"#8a5a3c\" or three numbers from 0 to 1"},
        {one + "color = [2, 0, 0]\n",
         ":3:9: light.color must be a colour like \"#8a5a3c\" or three numbers from 0 to 1"},
        {one + "angle = 90\n", ":3:9: light.angle is 90, but must lie in [0, 60] deg"},
        {one + "power = 9\n", ":3:9: a light has no 'power'; it has name, direction, color, irradiance, angle"},
        {"[light]\ndirection = [0, 1, 0]\n", ":1:1: light must be written as [[light]] tables"},
        {many + one, ":33:1: 17 lights are more than the 16 that coif takes"},
        {"[[light]\n", ":1:9: not valid TOML"},
    };
    const Scratch scratch;
    const auto told = [&](const std::string& text) {
        return error_of([&] { load_lights(scratch.write("l.toml", text)); })
            .substr((scratch / "l.toml").string().size());
    };
    for (const auto& [text, message] : of_both)
    {
        const std::string of_file = told(text), of_style = error_of([&, t = text] { parse_hairstyle(t, "bob.toml"); });
        EXPECT_EQ(of_file.substr(0, message.size()), message) << text;
        EXPECT_EQ(of_style.substr(0, 8 + message.size()), "bob.toml" + message) << text;
    }
    const std::pair<std::string, std::string> of_files[] = {
        {"", ": holds neither a [[light]] nor a [sky]; for darkness say radiance = 0 of a [sky]"},
        {"# nothing\n", ": holds neither a [[light]] nor a [sky]; for darkness say radiance = 0 of a [sky]"},
        {"[strand]\nlength = 1\n", ":1:2: expected [[light]] tables and a [sky] only, found 'strand'"},
        {"[sky]\ncolor = '#ffffff'\n", ":1:1: a sky needs radiance"},
        {"[sky]\nradiance = -0.1\n", ":2:12: sky.radiance is -0.1, but must lie in [0, 100]"},
        {"[sky]\nradiance = inf\n", ":2:12: sky.radiance is inf, but must lie in [0, 100]"},
        {"[sky]\nradiance = 1\nhdri = 'a.hdr'\n", ":3:8: a sky has no 'hdri'; it has color, radiance"},
        {"[[sky]]\nradiance = 1\n", ":1:1: sky must be written as a [sky] table"},
        {"sky = 1\n", ":1:7: sky must be written as a [sky] table"},
    };
    for (const auto& [text, message] : of_files)
        EXPECT_EQ(told(text), message) << text;
    EXPECT_EQ(load_lights(scratch.write("l.toml", many)).lights.size(), kMostLights);
    EXPECT_EQ(parse_hairstyle(many, "bob.toml").host.lights.size(), kMostLights);
    EXPECT_EQ(error_of([&] { load_lights(scratch.folder()); }),
              scratch.folder().string() + ": is a folder, not a regular file; name a file in it");
    EXPECT_NE(error_of([&] { load_lights(scratch.write("l.toml", "#" + std::string(5 << 20, 'x'))); })
                  .find("is larger than the 4194304 bytes"),
              std::string::npos);
}

TEST(Lights, a_style_names_them_beside_itself_or_among_those_that_are_shipped)
{
    const Scratch scratch;
    const fs::path bob = scratch.write("bob.toml", "\n[look]\nlights = 'studio.toml'\n");
    EXPECT_EQ(named_lights(load_hairstyle(bob)), load_lights(kShipped / "studio.toml"));
    EXPECT_EQ(named_lights(parse_hairstyle("", bob)), std::nullopt);
    scratch.write("studio.toml", "[sky]\nradiance = 3\n");
    EXPECT_EQ(named_lights(load_hairstyle(bob))->sky.radiance, 3.0f) << "what lies beside it comes first";
    scratch.write("studio.toml", "[sky]\nradiance = -3\n");
    EXPECT_EQ(error_of([&] { named_lights(load_hairstyle(bob)); }),
              bob.string() + ":3:10: " + (scratch / "studio.toml").string() +
                  ":2:12: sky.radiance is -3, but must lie in [0, 100]");
    scratch.write("bob.toml", "[look]\nlights = 'none.toml'\n");
    EXPECT_EQ(error_of([&] { named_lights(load_hairstyle(bob)); }),
              bob.string() + ":2:10: look.lights: no file 'none.toml', neither as " + (scratch / "none.toml").string() +
                  " nor as " + (kShipped / "none.toml").string());
    Hairstyle set = load_hairstyle(bob);
    assign(set, "look.lights=rim.toml");
    EXPECT_EQ(named_lights(set), load_lights(kShipped / "rim.toml"));
    assign(set, "look.lights=");
    EXPECT_EQ(named_lights(set), std::nullopt);
}

TEST(Lights, a_style_saved_elsewhere_still_shares_them)
{
    const Scratch scratch;
    scratch.write("lights/mine.toml", "[sky]\nradiance = 3\n");
    Hairstyle style = load_hairstyle(scratch.write("bob.toml", "[look]\nlights = 'lights/mine.toml' # ours\n"));
    fs::create_directories(scratch / "deep/er");
    save_hairstyle(style, scratch / "deep/er/bob.toml");
    EXPECT_EQ(bytes_of(scratch / "deep/er/bob.toml"), "[look]\nlights = \"../../lights/mine.toml\" # ours\n");
    EXPECT_EQ(named_lights(style)->sky.radiance, 3.0f);
    assign(style, "look.lights=soft.toml");
    save_hairstyle(style, scratch / "bob.toml");
    EXPECT_EQ(style.host.look_lights, "soft.toml") << "what coif ships stays";
}

TEST(Lights, those_that_are_shipped_are_what_they_are_called)
{
    const LightRig soft = load_lights(kShipped / "soft.toml"), studio = load_lights(kShipped / "studio.toml"),
                   rim = load_lights(kShipped / "rim.toml"), outdoors = load_lights(kShipped / "outdoors.toml");
    for (const Light& light : soft.lights)
        EXPECT_GE(light.angle, 20.0f) << light.name;
    ASSERT_EQ(studio.lights.size(), 3u);
    EXPECT_GT(studio.lights[0].direction.z, 0.0f) << "the face looks to +z";
    EXPECT_GT(studio.lights[1].direction.z, 0.0f);
    EXPECT_LT(studio.lights[0].direction.x * studio.lights[1].direction.x, 0.0f) << "key and fill, from both sides";
    EXPECT_GT(studio.lights[0].irradiance, 2.0f * studio.lights[1].irradiance);
    EXPECT_LT(studio.lights[2].direction.z, 0.0f);
    Hairstyle by_studio;
    by_studio = lit(by_studio, studio);
    EXPECT_GT(by_studio.params.look_light_direction.z, 0.0f) << "the key is the strongest";
    ASSERT_EQ(rim.lights.size(), 2u);
    for (const Light& light : rim.lights)
        EXPECT_LT(light.direction.z, 0.0f) << light.name;
    for (const LightRig* other : {&soft, &studio, &outdoors})
        EXPECT_LT(2.0f * rim.sky.radiance, other->sky.radiance);
    ASSERT_EQ(outdoors.lights.size(), 1u);
    EXPECT_GT(outdoors.lights[0].color.r, outdoors.lights[0].color.b);
    EXPECT_LT(outdoors.sky.color.r, outdoors.sky.color.b);
    for (const auto& entry : fs::directory_iterator(kShipped))
        EXPECT_EQ(error_of([&] { load_lights(entry.path()); }), "no error");
}

TEST(Lights, a_style_without_any_is_lit_as_ever)
{
    Hairstyle style = parse_hairstyle("[look]\nlight_direction = [0.2, 0.4, -0.4]\nlight_color = '#8040ff'\n"
                                      "light_irradiance = 3\nsky_radiance = 0.5\nsky_color = [0.5, 1, 0]\n",
                                      "bob.toml");
    const Hairstyle same = lit(style, std::nullopt);
    EXPECT_EQ(memcmp(&same.params, &style.params, sizeof style.params), 0);
    const Lighting lighting = lighting_of(style.params, style.host);
    ASSERT_EQ(lighting.suns.size(), 1u);
    EXPECT_NEAR(glm::distance(lighting.suns[0].direction, glm::vec3(1, 2, -2) / 3.0f), 0.0f, 1e-6f);
    const auto linear = [](double c) { return std::pow((c + 0.055) / 1.055, 2.4); };
    EXPECT_NEAR(lighting.suns[0].irradiance.x, 3.0 * linear(128 / 255.0), 1e-5);
    EXPECT_NEAR(lighting.suns[0].irradiance.y, 3.0 * linear(64 / 255.0), 1e-5);
    EXPECT_NEAR(lighting.suns[0].irradiance.z, 3.0, 1e-5);
    EXPECT_NEAR(lighting.sky.x, 0.5 * linear(0.5), 1e-5);
    EXPECT_NEAR(lighting.sky.y, 0.5, 1e-5);
    EXPECT_EQ(lighting.sky.z, 0.0f);
}

TEST(Lights, what_knows_one_light_has_the_strongest_as_the_eye_counts)
{
    Hairstyle style =
        parse_hairstyle("[[light]]\ndirection = [1, 0, 0]\ncolor = '#0000ff'\nirradiance = 9\n"
                        "[[light]]\ndirection = [0, 0.5, -0.5]\ncolor = [0.5, 0.25, 0.0]\nirradiance = 8\n"
                        "angle = 9\n",
                        "bob.toml");
    const Hairstyle one = lit(style, std::nullopt);
    EXPECT_EQ(one.params.look_light_direction, F4(0.0f, 0.5f, -0.5f, 0.0f)) << "blue is dark";
    const float4 color = device_params(one.params).look_light_color;
    const double half = std::pow((0.5 + 0.055) / 1.055, 2.4), quarter = std::pow((0.25 + 0.055) / 1.055, 2.4);
    EXPECT_NEAR(color.x, 1.0, 1e-6) << "its brightest channel is as bright as it goes";
    EXPECT_NEAR(color.y, quarter / half, 1e-5);
    EXPECT_EQ(color.z, 0.0f);
    EXPECT_NEAR(one.params.look_light_irradiance, 8.0 * half, 1e-5);
    EXPECT_EQ(one.host.lights, style.host.lights);
    const Lighting lighting = lighting_of(one.params, one.host);
    ASSERT_EQ(lighting.suns.size(), 2u);
    EXPECT_NEAR(lighting.suns[1].irradiance.x, 8.0 * half, 1e-5);
    EXPECT_NEAR(lighting.suns[1].radius, 9.0 * M_PI / 180.0, 1e-6);
    EXPECT_NEAR(glm::length(lighting.suns[1].direction), 1.0f, 1e-6f);
    // A file's stand in the place of all that the style says.
    const LightRig shared{{Light{"sun", {0, 1, 0}, {1, 0.5f, 0.5f}, 2, 1}}, {{1, 1, 1}, 0.25f}};
    const Hairstyle by_file = lit(style, shared);
    EXPECT_EQ(by_file.params.look_light_direction, F4(0.0f, 1.0f, 0.0f, 0.0f));
    EXPECT_EQ(by_file.params.look_light_color, F4(1.0f, 0.5f, 0.5f, 1.0f)) << "as bright already: to the bit";
    const Lighting of_file = lighting_of(by_file.params, by_file.host);
    EXPECT_EQ(of_file.suns.size(), 1u);
    EXPECT_EQ(of_file.sky, glm::vec3(0.25f));
}

TEST(Lights, black_ones_and_none_are_darkness_and_no_fault)
{
    for (const char* text :
         {"[[light]]\ndirection = [0, 1, 0]\nirradiance = 0\n", "[[light]]\ndirection = [0, 1, 0]\ncolor = '#000000'\n",
          "[[light]]\ndirection = [0, 1, 0]\ncolor = '#000000'\nirradiance = 0\n"
          "[[light]]\ndirection = [1, 0, 0]\ncolor = '#000000'\n",
          "[look]\nlight_irradiance = 0\n", "[look]\nlight_color = '#000000'\n"})
    {
        const Hairstyle style = parse_hairstyle(text, "bob.toml"), one = lit(style, std::nullopt);
        const Lighting lighting = lighting_of(one.params, one.host);
        EXPECT_TRUE(lighting.suns.empty()) << text;
        EXPECT_GT(lighting.sky.x, 0.0f) << text;
        for (const ParamInfo& info : param_table())
            if (!info.on_host())
            {
                float v[kMostNumbers] = {};
                get_numbers(device_params(one.params), info, v);
                for (const float number : v)
                    EXPECT_TRUE(std::isfinite(number)) << info.path();
            }
        if (!style.host.lights.empty())
        {
            EXPECT_EQ(one.params.look_light_color, F4(0.0f, 0.0f, 0.0f, 1.0f)) << text;
        }
    }
    // A file that has but a sky: the style's own lights do not shine through it.
    const Hairstyle style = parse_hairstyle("[[light]]\ndirection = [0, 1, 0]\n", "bob.toml");
    for (const Hairstyle& any : {Hairstyle{}, style})
    {
        const Hairstyle one = lit(any, LightRig{{}, {{1, 1, 1}, 2}});
        EXPECT_TRUE(lighting_of(one.params, one.host).suns.empty());
        EXPECT_EQ(lighting_of(one.params, one.host).sky, glm::vec3(2.0f));
        EXPECT_EQ(one.params.look_light_color, F4(0.0f, 0.0f, 0.0f, 1.0f));
    }
    const Hairstyle dark = lit(Hairstyle{}, LightRig{});
    EXPECT_TRUE(lighting_of(dark.params, dark.host).suns.empty());
    EXPECT_EQ(lighting_of(dark.params, dark.host).sky, glm::vec3(0.0f));
}

TEST(Lights, a_file_s_made_the_style_s_own_shine_the_same_and_so_do_those_saved_as_a_file)
{
    const Scratch scratch;
    std::mt19937 random(9);
    int dark = 0;
    for (int trial = 0; trial < 60; ++trial)
    {
        const LightRig rig = random_rig(random);
        Hairstyle named = parse_hairstyle("[look]\nlights = 'x.toml'\n", scratch / "bob.toml"), own = named;
        const Hairstyle by_file = lit(named, rig);
        set_own_lights(own, rig);
        EXPECT_EQ(own.host.look_lights, "");
        save_hairstyle(own, scratch / "bob.toml");
        const Hairstyle by_itself = lit(load_hairstyle(scratch / "bob.toml"), std::nullopt);
        const Lighting shines = lighting_of(by_file.params, by_file.host);
        EXPECT_TRUE(same_light(shines, lighting_of(by_itself.params, by_itself.host)));
        EXPECT_EQ(by_file.params.look_light_color, by_itself.params.look_light_color);
        dark += rig.lights.empty();

        save_lights(own_lights(own), scratch / fmt::format("{}.toml", trial % 4)); // three of four over another
        const LightRig again = load_lights(scratch / fmt::format("{}.toml", trial % 4));
        EXPECT_EQ(again, rig) << bytes_of(scratch / fmt::format("{}.toml", trial % 4));
    }
    EXPECT_GT(dark, 5);
    // The one of look.light_direction becomes a [[light]].
    const Hairstyle plain = parse_hairstyle("[look]\nlight_irradiance = 2\n", scratch / "bob.toml");
    Hairstyle listed = plain;
    set_own_lights(listed, own_lights(plain));
    ASSERT_EQ(listed.host.lights.size(), 1u);
    const Lighting a = lighting_of(plain.params, plain.host), b = lighting_of(listed.params, listed.host);
    EXPECT_EQ(a.sky, b.sky);
    EXPECT_NEAR(glm::distance(a.suns[0].irradiance, b.suns[0].irradiance), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(a.suns[0].direction, b.suns[0].direction), 0.0f, 1e-6f);
}

TEST(Lights, saved_over_a_file_they_keep_its_comments_and_never_a_hairstyle_s_place)
{
    const Scratch scratch;
    const fs::path file = scratch.write("lights/mine.toml", "# ours\n[sky] # grey\nradiance = 0.20 # dim\n\n"
                                                            "[[light]] # the window\ndirection = [0, 1, 1]\n");
    LightRig rig = load_lights(file);
    save_lights(rig, file);
    EXPECT_EQ(bytes_of(file), "# ours\n[sky] # grey\nradiance = 0.20 # dim\n\n"
                              "[[light]] # the window\ndirection = [0, 1, 1]\n");
    rig.lights[0].irradiance = 1.5f;
    rig.lights.push_back({"lamp", {-1, 0, 0}, {1, 1, 1}, 2.6f, 0});
    save_lights(rig, file);
    EXPECT_EQ(bytes_of(file), "# ours\n[sky] # grey\nradiance = 0.20 # dim\n\n"
                              "[[light]] # the window\ndirection = [0, 1, 1]\nirradiance = 1.5\n\n"
                              "[[light]]\nname = \"lamp\"\ndirection = [-1.0, 0.0, 0.0]\n");
    EXPECT_EQ(load_lights(file), rig);
    save_lights({}, scratch / "new/folder/dark.toml");
    EXPECT_EQ(load_lights(scratch / "new/folder/dark.toml"), LightRig{});
    const fs::path bob = scratch.write("bob.toml", "[strand]\nlength = 1\n");
    EXPECT_EQ(error_of([&] { save_lights(rig, bob); }).rfind(bob.string() + ": is there and holds something else", 0),
              0u);
    EXPECT_EQ(bytes_of(bob), "[strand]\nlength = 1\n");
}

TEST(Lights, names_to_choose_from_are_those_beside_the_style_and_those_that_are_shipped)
{
    const Scratch scratch;
    const std::vector<std::string> shipped = {"outdoors.toml", "rim.toml", "soft.toml", "studio.toml"};
    EXPECT_EQ(light_names(scratch.folder()), shipped);
    EXPECT_EQ(light_names(kShipped.parent_path()), shipped) << "once, though they lie beside it";
    EXPECT_EQ(light_names(scratch / "none"), shipped);
    scratch.write("mine.toml", "[sky]\nradiance = 1\n");
    scratch.write("bob.toml", "[strand]\nlength = 0.1\n");
    scratch.write("empty.toml", "");
    scratch.write("lights/b.toml", "[sky]\nradiance = 1\n");
    scratch.write("lights/a.toml", "broken, so that choosing it tells");
    scratch.write("lights/a.txt", "");
    EXPECT_EQ(light_names(scratch.folder()),
              (std::vector<std::string>{"mine.toml", "lights/a.toml", "lights/b.toml", "outdoors.toml", "rim.toml",
                                        "soft.toml", "studio.toml"}));
}

TEST(Lights, chance_and_variants_leave_them_alone)
{
    const Hairstyle style =
        parse_hairstyle("[look]\nlights = 'soft.toml'\n[[light]]\ndirection = [0, 1, 0]\n", "a.toml");
    const Hairstyle thrown = randomised(style, 3, 1.0, {});
    EXPECT_EQ(thrown.host, style.host);
    EXPECT_NE(thrown.params.strand_length, style.params.strand_length);
    Hairstyle variant = style;
    take_variant(variant, "wild");
    variant.host.lights[0].irradiance = 9.0f;
    switch_variant(variant, "");
    EXPECT_EQ(variant.host.lights[0].irradiance, 9.0f) << "lists are the same in all variants";
    Hairstyle reset = style;
    const ParamInfo& list = *find_param("light");
    copy_value({}, reset, list);
    EXPECT_TRUE(reset.host.lights.empty());
    EXPECT_FALSE(same_style(reset, style));
    EXPECT_EQ(hairstyle_text(reset, "a.toml"), "[look]\nlights = 'soft.toml'\n");
}

Camera camera_at(double yaw, double pitch)
{
    Camera camera;
    camera.yaw = yaw;
    camera.pitch = pitch;
    return camera;
}

TEST(LightGlobe, every_direction_has_its_pixel)
{
    std::mt19937 random(4);
    for (int trial = 0; trial < 400; ++trial)
    {
        const LightGlobe globe =
            light_globe(camera_at(between(random, -4, 4), between(random, -1.5, 1.5)), glm::dvec3(0.0), 900, 700);
        const auto unit = [&] { return between(random, -1.0, 1.0); };
        const glm::dvec3 direction = glm::normalize(glm::dvec3(unit(), unit(), unit()));
        const glm::dvec2 pixel = place_of(globe, 0.3 * direction);
        EXPECT_NEAR(glm::distance(direction_at(globe, pixel), direction), 0.0, 1e-6);
        EXPECT_TRUE(pixel.x > 0 && pixel.x < 900 && pixel.y > 0 && pixel.y < 700);
        const bool behind = glm::dot(direction, globe.axes[2]) < 0.0;
        EXPECT_EQ(glm::distance(pixel, globe.center) > globe.radius, behind);
    }
}

TEST(LightGlobe, lights_are_where_they_stand_as_the_camera_sees_it)
{
    const LightGlobe front = light_globe(camera_at(0.0, 0.0), glm::dvec3(0.0), 800, 600);
    EXPECT_NEAR(glm::distance(front.center, glm::dvec2(400, 300)), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(place_of(front, {0, 0, 1}), front.center), 0.0, 1e-9) << "from the camera";
    EXPECT_NEAR(place_of(front, {1, 0, 0}).x, 400 + front.radius, 1e-9) << "+x is to the right of who sees the face";
    EXPECT_NEAR(place_of(front, {0, 1, 0}).y, 300 - front.radius, 1e-9) << "up";
    EXPECT_GT(place_of(front, {1, 0, -0.2}).x, 400 + front.radius);
    EXPECT_NEAR(glm::distance(place_of(front, {0, 0, -1}), front.center), 2.0 * front.radius, 1e-9);
    EXPECT_NEAR(glm::distance(direction_at(front, {-9999, 300}), glm::dvec3(0, 0, -1)), 0.0, 1e-9)
        << "beyond all that there is: straight behind";
    EXPECT_NEAR(glm::distance(direction_at(front, front.center), glm::dvec3(0, 0, 1)), 0.0, 1e-9);
    const LightGlobe side = light_globe(camera_at(M_PI / 2, 0.0), glm::dvec3(0.0), 800, 600);
    EXPECT_NEAR(glm::distance(place_of(side, {1, 0, 0}), side.center), 0.0, 1e-6) << "at the head's left side";
    // A head beside the view, behind it or nowhere: the circle is still seen.
    for (const glm::dvec3 head : {glm::dvec3(9, 0, 0), glm::dvec3(0, -9, 0), glm::dvec3(0, 0, 9)})
        for (const int wide : {1, 60, 4000})
        {
            const LightGlobe globe = light_globe(camera_at(0.0, 0.0), head, wide, 50);
            EXPECT_TRUE(std::isfinite(globe.center.x) && std::isfinite(globe.center.y));
            EXPECT_GE(globe.center.x, 0.0);
            EXPECT_LE(globe.center.x, wide + 1.0);
        }
}

} // namespace
} // namespace coif

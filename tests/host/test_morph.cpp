// Between two hairstyles, and hairstyles drawn by chance: pure functions of what they are given.
#include "app/morph.h"
#include "app/randomise.h"
#include "sim/source.h"
#include "tests/host/scratch.h"

#include <cctype>
#include <cmath>

namespace coif
{
namespace
{
using namespace coif::test;

Hairstyle preset(const char* name)
{
    return load_hairstyle(data_folder() / "hairstyles" / (std::string(name) + ".toml"));
}

std::vector<float> numbers(const Hairstyle& style, const ParamInfo& info)
{
    float v[kMostNumbers] = {};
    get_numbers(style.params, info, v);
    return {v, v + info.components()};
}

TEST(Morph, its_ends_are_the_two_styles)
{
    const Hairstyle a = preset("bob"), b = preset("afro");
    const Hairstyle first = morphed(a, b, 0.0), last = morphed(a, b, 1.0);
    EXPECT_EQ(hairstyle_text(first, a.file), a.text);
    for (const ParamInfo& info : param_table())
        EXPECT_TRUE(same_value(last, b, info)) << info.path();
    EXPECT_EQ(last.file, a.file) << "nothing is saved over the second by mistake";
}

TEST(Morph, writes_no_more_digits_than_one_would)
{
    const Hairstyle a = preset("bob"), b = preset("curly");
    const std::string text = hairstyle_text(morphed(a, b, 0.3), a.file);
    size_t numbers = 0, digits = 0;
    for (const char c : text + ' ')
    {
        digits = std::isdigit(static_cast<unsigned char>(c)) ? digits + 1 : c == '.' ? digits : 0;
        numbers += digits == 1;
        EXPECT_LE(digits, 8u) << text; // "0.0" and six
    }
    EXPECT_GT(numbers, 50u);
}

TEST(Morph, numbers_and_colours_lie_between_and_the_rest_switches_in_the_middle)
{
    const Hairstyle a = preset("bob"), b = preset("curly");
    for (const double at : {0.1, 0.4, 0.6, 0.9})
    {
        const Hairstyle style = morphed(a, b, at);
        for (const ParamInfo& info : param_table())
            if (info.on_host() || info.kind == Kind::CHOICE)
            {
                EXPECT_TRUE(same_value(style, at < 0.5 ? a : b, info)) << info.path();
            }
            else
                for (size_t i = 0; i < numbers(a, info).size(); ++i)
                {
                    const double from = double(numbers(a, info)[i]), to = double(numbers(b, info)[i]);
                    const double step = info.kind == Kind::INT ? 0.5 : 1e-5 * std::abs(to - from) + 1e-6;
                    EXPECT_NEAR(double(numbers(style, info)[i]), from + at * (to - from), step) << info.path();
                }
        // What was made can be saved and read, comments and all.
        const Scratch scratch;
        Hairstyle saved = style;
        save_hairstyle(saved, scratch / "c.toml");
        const Hairstyle read = load_hairstyle(scratch / "c.toml");
        for (const ParamInfo& info : param_table())
            EXPECT_TRUE(info.kind == Kind::TEXT || same_value(read, style, info)) << info.path();
        EXPECT_EQ(read.text.substr(0, 10), a.text.substr(0, 10));
    }
}

TEST(Morph, maps_and_rest_shapes_go_over_evenly)
{
    Hairstyle a, b;
    a.host.maps = {{"strand.length", MAP_OFFSET, {0.1f, 0.2f}, "a.map"}, {"root.lift", MAP_FACTOR, {2.0f, 3.0f}, {}}};
    b.host.maps = {{"strand.length", MAP_OFFSET, {0.3f, 0.0f}, {}}, {"look.width", MAP_FACTOR, {0.5f, 1.0f}, {}}};
    const auto shape = [](float x) {
        return std::make_shared<const StrandShapes>(StrandShapes{3, {{x, 0, 0}, {x, 1, 0}, {x, 2, x}}});
    };
    a.host.groom_rest = {"a.rest", shape(0.0f)};
    b.host.groom_rest = {"b.rest", shape(1.0f)};
    const HostParams half = morphed(a, b, 0.5).host;
    ASSERT_EQ(half.maps.size(), 3u);
    EXPECT_FLOAT_EQ(half.maps[0].values.at(0), 0.2f);
    EXPECT_FLOAT_EQ(half.maps[0].values.at(1), 0.1f);
    EXPECT_EQ(half.maps[0].file, "") << "another's file is not written over";
    EXPECT_EQ(half.maps[1].values, (std::vector<float>{1.5f, 2.0f})) << "towards no change";
    EXPECT_EQ(half.maps[2].values, (std::vector<float>{0.75f, 1.0f}));
    EXPECT_EQ(half.groom_rest.shapes->position[2], glm::vec3(0.5f, 2.0f, 0.5f));
    EXPECT_EQ(morphed(a, b, 0.0).host, a.host);
    EXPECT_EQ(morphed(a, b, 1.0).host.groom_rest, b.host.groom_rest);
}

TEST(Morph, angles_go_the_shorter_way_and_paths_stay_those_of_their_files)
{
    const Scratch scratch;
    scratch.write("b/my.obj", "v 0 0 0\n");
    const Hairstyle a = load_hairstyle(scratch.write("a/a.toml", "[root]\nsweep = 170.0\n"));
    const Hairstyle b =
        load_hairstyle(scratch.write("b/b.toml", "[root]\nsweep = -170.0\n[head]\nmesh = \"my.obj\"\n"));
    EXPECT_NEAR(std::abs(double(morphed(a, b, 0.5).params.root_sweep)), 180.0, 1e-4);
    EXPECT_NEAR(double(morphed(a, b, 0.25).params.root_sweep), 175.0, 1e-4);
    EXPECT_NEAR(double(morphed(a, b, 0.75).params.root_sweep), -175.0, 1e-4);
    EXPECT_EQ(morphed(a, b, 0.75).host.head_mesh, "../b/my.obj");
    EXPECT_EQ(morphed(a, b, 0.75).host.scalp_mesh, b.host.scalp_mesh) << "coif's own is found from anywhere";
}

TEST(Randomise, the_seed_and_the_style_say_it_all)
{
    const Hairstyle bob = preset("bob");
    const Hairstyle one = randomised(bob, 7, 0.3, {}), again = randomised(bob, 7, 0.3, {});
    const Hairstyle other = randomised(bob, 8, 0.3, {});
    int changed = 0, differ = 0;
    for (const ParamInfo& info : param_table())
    {
        EXPECT_TRUE(same_value(one, again, info)) << info.path();
        changed += !same_value(one, bob, info);
        differ += !same_value(one, other, info);
        EXPECT_TRUE(is_left_to_chance(info, bob.params) || same_value(one, bob, info)) << info.path();
    }
    EXPECT_GT(changed, 10);
    EXPECT_GT(differ, 10);
}

TEST(Randomise, a_lock_keeps_its_value_and_changes_no_other)
{
    const Hairstyle bob = preset("bob");
    const Hairstyle free = randomised(bob, 3, 0.5, {}),
                    locked = randomised(bob, 3, 0.5, {"strand.length", "look.root_color"});
    for (const ParamInfo& info : param_table())
        EXPECT_TRUE(
            same_value(locked, info.path() == "strand.length" || info.path() == "look.root_color" ? bob : free, info))
            << info.path();
    EXPECT_FALSE(same_value(free, bob, *find_param("strand.length")));
}

TEST(Randomise, stays_within_the_ranges_and_near_where_it_was)
{
    Hairstyle style = preset("curly");
    for (int seed = 0; seed < 50; ++seed)
        for (const double amount : {0.01, 0.3, 1.0})
        {
            const Hairstyle drawn = randomised(style, seed, amount, {});
            for (const ParamInfo& info : param_table())
            {
                if (!is_left_to_chance(info, style.params) || info.kind == Kind::CHOICE)
                    continue;
                for (size_t i = 0; i < numbers(drawn, info).size(); ++i)
                {
                    const double now = double(numbers(drawn, info)[i]), before = double(numbers(style, info)[i]);
                    EXPECT_GE(float(now), info.min);
                    EXPECT_LE(float(now), info.max);
                    EXPECT_NEAR(slider_place(info, now), slider_place(info, before), 0.5 * amount + 0.01)
                        << info.path();
                    EXPECT_NEAR(slider_value(info, slider_place(info, before)), before,
                                1e-4 * (1.0 + std::abs(before)));
                }
            }
        }
}

} // namespace
} // namespace coif

// What varies over the scalp: regions, partings and maps, from the file to every strand.
#include "sim/clumps.h"
#include "sim/groom.h"
#include "sim/hairstyle.h"
#include "sim/scatter.h"
#include "sim/shaping.h"
#include "sim/simulation.h"
#include "sim/source.h"
#include "tests/host/scratch.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;

Scalp whole_scalp() { return load_scalp(data_folder() / "assets" / "scalp.obj"); }

Hairstyle parsed(const std::string& text) { return parse_hairstyle(text, "bob.toml"); }

Groom grown(const Hairstyle& style, const Scalp& scalp) { return grow(style.params, scalp, style.host); }

glm::vec3 root_of(const DrawnStrand& strand) { return {strand.root.x, strand.root.y, strand.root.z}; }

// A map of one value for every vertex.
std::string map_of(const std::string& of, const std::string& how, const Scalp& scalp, const std::string& value)
{
    std::string values;
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        values += (v ? ", " : "") + value;
    return "[[map]]\nof = \"" + of + "\"\nhow = \"" + how + "\"\nvalues = [" + values + "]\n";
}

const char kThree[] = R"(
[strand]
length = 0.2
[[region]]
name = "sides"
where = ["sides", "nape"]
edge = 0.0
strand.length = 0.01
root.lift = 30
[[region]]
name = "fringe"
where = "front"
edge = 0.03
strand.length = 0.06
look.tip_color = "#ffffff"
[[region]]
name = "half"
planes = [[1, 0, 0, 0.02]]
edge = 0.0
bending.droop = 3
[[parting]]
points = [[0.03, 0.07, 0.09], [0.035, 0.11, 0.0], [0.03, 0.09, -0.05]]
reach = 0.07
)";

TEST(Shaping, what_is_wrong_in_a_list_is_told_with_its_place)
{
    const std::pair<const char*, const char*> broken[] = {
        {"[[region]]\nname = \"a\"\nwhere = \"ear\"\n",
         "bob.toml:3:9: region.where is 'ear', but must be of top, front, back, left, right, sides, nape, crown"},
        {"[[region]]\nwhere = \"top\"\n", "bob.toml:1:1: a region needs name"},
        {"[[region]]\nname = \"a\"\n\n[[region]]\nname = \"a\"\n", "bob.toml:4:1: two regions are called 'a'"},
        {"[[region]]\nname = \"a\"\nlook.ambient = 1\n",
         "bob.toml:3:16: look.ambient is the same for the whole head and cannot be set in a region"},
        {"[[region]]\nname = \"a\"\nstrand.lenth = 1\n",
         "bob.toml:3:8: no parameter is called 'strand.lenth'; the nearest is strand.length"},
        {"[[region]]\nname = \"a\"\nstrand.length = 9\n",
         "bob.toml:3:17: strand.length is 9, but must lie in [0.002, 1.5] m"},
        {"[[region]]\nname = \"a\"\nplanes = [[0, 0, 0, 1]]\n", "bob.toml:3:11: region.planes holds a plane without a"},
        {"[[region]]\nname = \"a\"\nplanes = [[0, 1, 0]]\n", "bob.toml:3:11: region.planes must hold planes of four"},
        {"[[region]]\nname = \"a\"\nedge = -1\n", "bob.toml:3:8: region.edge is -1, but must lie in [0, 1] m"},
        {"[[region]]\nname = \"a\"\nsize = 1\n", "bob.toml:3:8: a region has no 'size'; it has name, where"},
        {"[[region]]\nname = \"a\"\nweights = [0.5, 2]\n", "bob.toml:3:17: region.weights is 2, but must lie in"},
        {"[[parting]]\npoints = [[0, 0, 0]]\n", "bob.toml:2:10: parting.points must be 2 to 256 points, not 1"},
        {"[[parting]]\npoints = [[0, 0, 0], [0, 0, 0]]\n", "bob.toml:2:10: parting.points says the point 1 twice"},
        {"[[parting]]\nreach = 0.1\n", "bob.toml:1:1: a parting needs points"},
        {"[[map]]\nof = \"look.ambient\"\nvalues = [1]\n",
         "bob.toml:2:6: map.of is look.ambient, which is the same for the whole head"},
        {"[[map]]\nof = \"strand.lenth\"\nvalues = [1]\n",
         "bob.toml:2:6: map.of is 'strand.lenth', but no parameter is called that; the nearest is strand.length"},
        {"[[map]]\nof = \"strand.length\"\n", "bob.toml:1:1: a map needs either values or a file of them"},
        {"[[map]]\nof = \"strand.length\"\nhow = \"over\"\nvalues = [1]\n",
         "bob.toml:3:7: map.how must be \"factor\" or \"offset\" for a number"},
        {"[[map]]\nof = \"look.tip_color\"\nhow = \"factor\"\nvalues = [1]\n",
         "bob.toml:3:7: map.how must be \"over\" for a colour"},
        {"[[map]]\nof = \"strand.length\"\nvalues = [1, \"x\"]\n",
         "bob.toml:3:14: map.values must hold numbers only, not text"},
    };
    for (const auto& [text, message] : broken)
        EXPECT_EQ(error_of([&, text = text] { parsed(text); }).rfind(message, 0), 0u)
            << text << error_of([&, text = text] { parsed(text); });
}

TEST(Shaping, what_does_not_fit_the_scalp_is_told_when_it_is_loaded)
{
    Scratch scratch;
    const std::pair<const char*, const char*> broken[] = {
        {"[[region]]\nname = \"a\"\nplanes = [[0, 1, 0, 5]]\n", ":1:1: the region 'a' selects none of the scalp's"},
        {"[[region]]\nname = \"a\"\nweights = [1]\n", ":1:1: the region 'a' has 1 weights, but the scalp 252 vertices"},
        {"[[region]]\nname = \"a\"\ngroup = \"x\"\n",
         ":1:1: the region 'a' names the group 'x', but the scalp's are: "},
        {"[[map]]\nof = \"strand.length\"\nvalues = [1, 2, 3]\n",
         ":1:1: the map of strand.length has 3 values, but the scalp's 252 vertices need 252"},
    };
    for (const auto& [text, message] : broken)
    {
        const fs::path file = scratch.write("style.toml", text);
        EXPECT_EQ(error_of([&] { load_assets(load_hairstyle(file)); }).rfind(file.string() + message, 0), 0u)
            << error_of([&] { load_assets(load_hairstyle(file)); });
    }
}

TEST(Shaping, a_region_everywhere_is_as_if_the_style_said_so)
{
    const Scalp scalp = whole_scalp();
    const Hairstyle said = parsed("[strand]\nlength = 0.12\n[root]\nlift = 20\nsweep = 30\n");
    const Hairstyle all = parsed("[[region]]\nname = \"all\"\nplanes = [[0, 1, 0, -5]]\nedge = 0.0\n"
                                 "strand.length = 0.12\nroot.lift = 20\nroot.sweep = 30\n");
    const Groom a = grown(said, scalp), b = grown(all, scalp);
    EXPECT_EQ(a.segment_length, b.segment_length);
    EXPECT_EQ(a.root_direction, b.root_direction);
    ASSERT_EQ(a.drawn.size(), b.drawn.size());
    for (size_t i = 0; i < a.drawn.size(); ++i)
    {
        EXPECT_EQ(root_of(a.drawn[i]), root_of(b.drawn[i]));
        EXPECT_NEAR(a.drawn[i].root.w, b.drawn[i].root.w, 1e-6f);
        EXPECT_EQ(a.drawn[i].guide0, b.drawn[i].guide0);
    }
    EXPECT_TRUE(a.looks.empty());
    EXPECT_EQ(b.looks.size(), b.drawn.size());
}

TEST(Shaping, each_guide_and_each_drawn_root_takes_what_its_regions_say)
{
    const Scalp scalp = whole_scalp();
    const Hairstyle style = parsed(kThree);
    const Groom groom = grown(style, scalp);
    int shaved = 0, between = 0, stiff = 0;
    for (int g = 0; g < groom.guides; ++g)
    {
        // Twin of the rules: the fringe over the sides over the style.
        const glm::dvec3 p(scalp.positions[size_t(g)]), d = (p - glm::dvec3(scalp.center)) / double(scalp.radius);
        const bool side = std::abs(d.x) >= 0.5 || (-0.8 * d.y - 0.6 * d.z) >= 0.5;
        const double t = std::clamp(((d.z - 0.5) * double(scalp.radius) + 0.015) / 0.03, 0.0, 1.0),
                     w = t * t * (3.0 - 2.0 * t);
        const double length = (side ? 0.01 : 0.2) * (1.0 - w) + 0.06 * w;
        EXPECT_NEAR(groom.segment_length[size_t(g)] * 14.0, length, 1e-5) << g;
        shaved += side && w == 0.0;
        between += w > 0.0 && w < 1.0;
        // Ten times as stiff for its own length and weight.
        const bool half = p.x >= 0.02;
        EXPECT_NEAR(groom.bend_factor[size_t(g)], half ? 10.0 : 1.0, 1e-4) << g;
        stiff += half;
    }
    EXPECT_GT(shaved, 20);
    EXPECT_GT(between, 5);
    EXPECT_GT(stiff, 20);
    for (size_t i = 0; i < groom.drawn.size(); ++i)
    {
        const DrawnStrand& strand = groom.drawn[i];
        const bool copy = int(i) >= groom.drawn_multi;
        const auto of = [&](int g) { return double(groom.segment_length[size_t(g)]) * 14.0; };
        const double full = copy ? of(strand.guide0)
                                 : double(strand.weights.x) * of(strand.guide0) +
                                       double(strand.weights.y) * of(strand.guide1) +
                                       double(strand.weights.z) * of(strand.guide2);
        const glm::vec3 d = (root_of(strand) - scalp.center) / scalp.radius;
        const bool side = std::abs(d.x) > 0.52f || (-0.8f * d.y - 0.6f * d.z) > 0.52f;
        if (side && d.z < 0.3f)
        {
            EXPECT_LE(full * double(strand.root.w), 0.0101) << "no long strand grows where it is shaved: " << i;
        }
    }
}

TEST(Shaping, no_drawn_strand_mixes_across_a_parting_or_a_hard_edge_nor_joins_a_clump_there)
{
    const Scalp scalp = whole_scalp();
    Hairstyle style = parsed(kThree);
    style.params.clump_strength = 0.8f;
    for (const int refine : {0, 1})
    {
        style.params.interpolation_refine = refine;
        const Scalp fine = refined(scalp, refine);
        const Shaping shaping = shape_over(style.params, style.host, scalp, fine);
        const Groom groom = grown(style, scalp);
        int across = 0, near = 0;
        for (int i = 0; i < int(groom.drawn.size()); ++i)
        {
            const DrawnStrand& strand = groom.drawn[size_t(i)];
            const Sides own = sides_at(shaping, {root_of(strand), {}, {}});
            near += (own.left | own.right) != 0;
            const bool copy = i >= groom.drawn_multi;
            const std::pair<int, float> guides[] = {{strand.guide0, 1.0f},
                                                    {strand.guide1, copy ? 0.0f : strand.weights.y},
                                                    {strand.guide2, copy ? 0.0f : strand.weights.z}};
            for (const auto& [guide, weight] : guides)
                across += weight > 0.0f && !may_mix(own, sides_at(shaping, at_vertex(fine, size_t(guide))));
            const Sides led = sides_at(shaping, {root_of(groom.drawn[size_t(strand.leader)]), {}, {}});
            across += !may_mix(own, led);
        }
        EXPECT_EQ(across, 0) << refine;
        EXPECT_GT(near, 500);
    }
}

TEST(Shaping, hair_leaves_a_parting_to_both_sides)
{
    const Scalp scalp = whole_scalp();
    Hairstyle style = parsed(kThree);
    style.host.regions.clear();
    style.params.root_sweep_variation = 0.0f;
    const Groom groom = grown(style, scalp);
    const Shaping shaping = shape_over(style.params, style.host, scalp, scalp);
    int left = 0, right = 0;
    for (int g = 0; g < groom.guides; ++g)
    {
        const glm::vec3 p = scalp.positions[size_t(g)];
        const Sides sides = sides_at(shaping, at_vertex(scalp, size_t(g)));
        if (std::abs(p.x - 0.032f) > 0.02f || p.y < 0.08f || !(sides.left | sides.right))
            continue;
        const float x = groom.root_direction[size_t(strand_value(g, 0, 0, 1))];
        EXPECT_GT((p.x - 0.032f) * x, 0.0f) << g << ": away from the line";
        (p.x > 0.032f ? left : right) += 1;
    }
    EXPECT_GT(left, 2);
    EXPECT_GT(right, 2);
}

TEST(Shaping, maps_multiply_move_and_cover)
{
    const Scalp scalp = whole_scalp();
    const Groom plain = grown(parsed("[strand]\nlength = 0.2\n"), scalp);
    const Groom none = grown(parsed("[strand]\nlength = 0.2\n" + map_of("strand.length", "factor", scalp, "1")), scalp);
    EXPECT_EQ(plain.segment_length, none.segment_length) << "a map of ones changes nothing";
    const Groom half =
        grown(parsed("[strand]\nlength = 0.2\n" + map_of("strand.length", "factor", scalp, "0.5")), scalp);
    const Groom moved =
        grown(parsed("[strand]\nlength = 0.2\n" + map_of("strand.length", "offset", scalp, "-0.1")), scalp);
    const Groom least =
        grown(parsed("[strand]\nlength = 0.2\n" + map_of("strand.length", "offset", scalp, "-9")), scalp);
    for (size_t g = 0; g < size_t(plain.guides); ++g)
    {
        EXPECT_FLOAT_EQ(half.segment_length[g] * 14.0f, 0.1f);
        EXPECT_NEAR(moved.segment_length[g] * 14.0f, 0.1f, 1e-6f);
        EXPECT_FLOAT_EQ(least.segment_length[g] * 14.0f, 0.002f) << "never beyond a parameter's range";
    }
    std::string colors = "[[map]]\nof = \"look.root_color\"\nvalues = [";
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        colors += "1, 0, 0, 0.5, ";
    const Groom dyed = grown(parsed("[look]\nroot_color = [0.0, 1.0, 0.0]\n" + colors + "]\n"), scalp);
    for (const StrandLook& look : dyed.looks)
    {
        EXPECT_NEAR(look.root_color.x, 0.2140411f, 1e-5f) << "half red in sRGB, and then linear";
        EXPECT_NEAR(look.root_color.y, 0.2140411f, 1e-5f);
    }
}

TEST(Shaping, maps_are_smooth_between_vertices_and_over_refined_scalps)
{
    const Scalp scalp = whole_scalp();
    Hairstyle style;
    style.host.maps.push_back({"strand.length", MAP_OFFSET, {}, {}});
    for (const glm::vec3& p : scalp.positions)
        style.host.maps[0].values.push_back(p.x); // linear over space
    for (const int refine : {0, 2, -1})
    {
        // -1: with vertices strewn over it.
        const Scalp fine = refine < 0 ? strewn(scalp, spread_places(scalp, 2000, 1)) : refined(scalp, refine);
        ASSERT_GT(fine.positions.size(), refine ? 2000u : 100u);
        const Shaping shaping = shape_over(style.params, style.host, scalp, fine);
        ASSERT_EQ(shaping.map_values[0].size(), fine.positions.size());
        for (const glm::uvec3& t : fine.triangles)
        {
            const glm::vec3 shares(0.2f, 0.3f, 0.5f);
            float x = 0.0f;
            for (int k = 0; k < 3; ++k)
                x += shares[k] * shaping.map_values[0][t[k]];
            EXPECT_NEAR(params_at(shaping, {{}, t, shares}).strand_length, style.params.strand_length + x, 1e-6f);
        }
        for (size_t v = 0; v < fine.positions.size(); ++v)
            EXPECT_NEAR(shaping.map_values[0][v], fine.positions[v].x, refine ? 0.004f : 0.0f);
    }
}

TEST(Shaping, density_thins_hair_out_strand_by_strand)
{
    const Scalp scalp = whole_scalp();
    const auto roots = [&](const char* density)
    {
        std::set<std::tuple<float, float, float>> at;
        for (const DrawnStrand& strand :
             grown(parsed(std::string("[interpolation]\nstrands = 3000\ndensity = ") + density), scalp).drawn)
            at.insert({strand.root.x, strand.root.y, strand.root.z});
        return at;
    };
    const auto all = roots("1.0"), some = roots("0.6"), few = roots("0.2"), none = roots("0.0");
    EXPECT_EQ(all.size(), 3000u);
    EXPECT_NEAR(double(some.size()), 1800.0, 120.0);
    EXPECT_NEAR(double(few.size()), 600.0, 90.0);
    EXPECT_TRUE(none.empty());
    EXPECT_TRUE(std::includes(all.begin(), all.end(), some.begin(), some.end())) << "none moves as others go";
    EXPECT_TRUE(std::includes(some.begin(), some.end(), few.begin(), few.end()));
}

TEST(Shaping, a_group_of_the_scalps_file_is_a_region)
{
    Scratch scratch;
    const fs::path file = scratch.write("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng fringe\nf 1 2 3\n"
                                                 "g rest\nf 1 3 4\nf 1 4 2\n");
    const Scalp scalp = load_scalp(file);
    ASSERT_EQ(scalp.groups.size(), 2u);
    const Hairstyle style = parsed("[[region]]\nname = \"a\"\ngroup = \"fringe\"\nstrand.length = 0.1\n");
    const Shaping shaping = shape_over(style.params, style.host, scalp, scalp);
    EXPECT_EQ(region_weight(shaping, 0, at_vertex(scalp, 1)), 1.0f);
    EXPECT_EQ(region_weight(shaping, 0, at_vertex(scalp, 3)), 0.0f);
    EXPECT_FLOAT_EQ(region_weight(shaping, 0, {{}, {1, 3, 3}, {0.25f, 0.5f, 0.25f}}), 0.25f);
}

TEST(Shaping, as_many_values_as_are_kept_in_the_file_can_be_read_again)
{
    Hairstyle style;
    for (const char* of : {"strand.length", "root.lift", "look.width"})
        style.host.maps.push_back({of, MAP_OFFSET, std::vector<float>(4096, 0.125f), {}});
    EXPECT_EQ(parse_hairstyle(hairstyle_text(style, "a.toml"), "a.toml").host.maps, style.host.maps);
}

TEST(Shaping, lists_are_written_as_they_were_read)
{
    const Hairstyle style = parsed(kThree);
    Hairstyle fresh;
    fresh.host = style.host;
    const std::string text = hairstyle_text(fresh, "new.toml");
    const Hairstyle again = parse_hairstyle(text, "new.toml");
    EXPECT_EQ(again.host, style.host) << text;
    // And over the author's own lines nothing changes at all.
    EXPECT_EQ(hairstyle_text(style, "bob.toml"), kThree);
}

} // namespace
} // namespace coif

// What a style keeps besides its own numbers: named variants, and shapes and maps in files beside it.
#include "sim/groom.h"
#include "sim/hairstyle.h"
#include "sim/shaping.h"
#include "sim/source.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace coif
{
namespace
{

using test::bytes_of;
using test::error_of;
using test::Scratch;

const char kTwo[] = "# mine\n[strand]\nlength = 0.16 # short\n\n[variant.long]\nstrand.length = 0.4 # really long\n"
                    "look.root_color = \"#000000\"\n\n[variant.wild]\nforces.gravity = 0.5\n";

TEST(Variant, switching_lays_its_values_on_and_takes_them_off_again)
{
    Hairstyle style = parse_hairstyle(kTwo, "bob.toml");
    const Hairstyle own = style;
    switch_variant(style, "long");
    EXPECT_EQ(style.params.strand_length, 0.4f);
    EXPECT_EQ(style.params.look_root_color.x, 0.0f);
    EXPECT_EQ(style.params.forces_gravity, 1.0f);
    switch_variant(style, "wild");
    EXPECT_EQ(style.params.strand_length, 0.16f);
    EXPECT_EQ(style.params.forces_gravity, 0.5f);
    switch_variant(style, "");
    EXPECT_TRUE(same_style(style, own));
    EXPECT_EQ(hairstyle_text(style, "bob.toml"), kTwo) << "and nothing is to be written";
    EXPECT_EQ(error_of([&] { switch_variant(style, "lon"); }), "bob has no variant 'lon'; it has long, wild");
    EXPECT_EQ(style.variant, "");
}

TEST(Variant, what_is_changed_while_one_is_on_is_its_own)
{
    Hairstyle style = parse_hairstyle(kTwo, "bob.toml");
    switch_variant(style, "long");
    assign(style, "strand.length=0.5");
    const std::string text = hairstyle_text(style, "bob.toml");
    std::string wanted = kTwo;
    wanted.replace(wanted.find("0.4 #"), 3, "0.5");
    EXPECT_EQ(text, wanted) << "one value in one line";
    switch_variant(style, "");
    EXPECT_EQ(style.params.strand_length, 0.16f);
    switch_variant(style, "long");
    EXPECT_EQ(style.params.strand_length, 0.5f);
}

TEST(Variant, a_snapshot_keeps_the_sliders_and_leaves_the_style_as_it_was_written)
{
    Hairstyle style = parse_hairstyle(kTwo, "bob.toml");
    assign(style, "strand.length=0.3");
    assign(style, "root.lift=20");
    take_variant(style, "tall");
    EXPECT_EQ(style.params.strand_length, 0.3f);
    const Hairstyle again = parse_hairstyle(hairstyle_text(style, "bob.toml"), "bob.toml");
    EXPECT_EQ(again.params.strand_length, 0.16f);
    EXPECT_EQ(again.variants.size(), 3u);
    Hairstyle tall = again;
    switch_variant(tall, "tall");
    for (const ParamInfo& info : param_table())
        EXPECT_TRUE(same_value(tall, style, info)) << info.path();
    EXPECT_NE(error_of([&] { take_variant(style, "two words"); }).find("cannot be a variant's name"),
              std::string::npos);
    EXPECT_NE(error_of([&] { take_variant(style, ""); }).find("cannot be a variant's name"), std::string::npos);
}

TEST(Variant, a_snapshot_of_nothing_new_is_kept_too_and_can_be_saved_while_it_is_on)
{
    Scratch scratch;
    Hairstyle style = load_hairstyle(scratch.write("a.toml", kTwo));
    take_variant(style, "same");
    save_hairstyle(style, scratch / "a.toml");
    EXPECT_EQ(style.variant, "same");
    assign(style, "strand.length=0.5");
    save_hairstyle(style, scratch / "a.toml");
    Hairstyle again = load_hairstyle(scratch / "a.toml");
    EXPECT_EQ(again.params.strand_length, 0.16f);
    switch_variant(again, "same");
    EXPECT_EQ(again.params.strand_length, 0.5f);
}

TEST(Variant, what_is_wrong_in_one_is_told_with_its_place)
{
    const std::pair<const char*, const char*> broken[] = {
        {"variant = 3\n", "bob.toml:1:11: variants must be written as [variant.NAME] tables"},
        {"[variant]\na = 1\n", "bob.toml:2:5: variants must be written as [variant.NAME] tables"},
        {"[variant.a]\nstrand = 1\n", "bob.toml:2:10: a variant holds parameters as strand.length, not 'strand'"},
        {"[variant.a]\nstrand.lenth = 1\n", "bob.toml:2:8: no parameter is called 'strand.lenth'; the nearest is"},
        {"[variant.a]\nstrand.length = 9\n", "bob.toml:2:17: strand.length is 9, but must lie in"},
        {"[variant.a]\nhead.mesh = \"x.obj\"\n", "bob.toml:2:13: head.mesh cannot be set here"},
    };
    for (const auto& [text, message] : broken)
    {
        const std::string told = error_of([text = text] { parse_hairstyle(text, "bob.toml"); });
        EXPECT_EQ(told.rfind(message, 0), 0u) << text << told;
    }
}

StrandShapes some_shapes(size_t strands, int nodes)
{
    StrandShapes shapes;
    shapes.nodes = nodes;
    for (size_t s = 0; s < strands; ++s)
        for (int k = 0; k < nodes; ++k)
            shapes.position.emplace_back(0.001f * float(s), 0.01f * float(k - 1), 0.0003f * float(k * k));
    return shapes;
}

TEST(StrandShapes, a_file_gives_back_what_was_written)
{
    Scratch scratch;
    const StrandShapes shapes = some_shapes(7, 5);
    EXPECT_EQ(read_shapes(scratch.write("a.rest", shapes_text(shapes))), shapes);
}

TEST(StrandShapes, a_broken_file_is_told_with_its_line)
{
    Scratch scratch;
    const std::pair<std::string, const char*> broken[] = {
        {"", ":1: is no file of strand shapes"},
        {"coif rest 2\n", ":1: is no file of strand shapes"},
        {"coif rest 1\nstrands 0 nodes 3\n", ":2: must say 'strands N nodes M'"},
        {"coif rest 1\nstrands 9999999999 nodes 3\n", ":2: must say 'strands N nodes M'"},
        {"coif rest 1\nstrands 2 nodes 3\n0 0 0\n", ": ends before its 2 strands of 3 nodes"},
        {"coif rest 1\nstrands 65536 nodes 64\n0 0 0\n", ": ends before its 65536 strands of 64 nodes"},
        {"coif rest 1\nstrands 1 nodes 3\n0 0 0\n0 0 nan\n0 0 0\n", ":4: must be three numbers within 100 m"},
        {"coif rest 1\nstrands 1 nodes 3\n0 0 0\n0 0\n0 0 0\n", ":4: must be three numbers within 100 m"},
        {"coif rest 1\nstrands 1 nodes 3\n0 0 0 0\n0 0 0\n0 0 0\n", ":3: must be three numbers within 100 m"},
        {"coif rest 1\nstrands 1 nodes 3\n0 0 1e9\n0 0 0\n0 0 0\n", ":3: must be three numbers within 100 m"},
    };
    for (const auto& [text, message] : broken)
    {
        const fs::path file = scratch.write("a.rest", text);
        const std::string told = error_of([&] { read_shapes(file); });
        EXPECT_EQ(told.rfind(file.string() + message, 0), 0u) << text << told;
    }
    scratch.write("style.toml", "[groom]\nrest = \"none.rest\"\n");
    EXPECT_NE(error_of([&] { load_hairstyle(scratch / "style.toml"); }).find("style.toml:2:8: "), std::string::npos);
}

TEST(StrandShapes, strands_follow_their_curves_as_far_as_they_are_long)
{
    const Scalp scalp = load_scalp(data_folder() / "assets" / "scalp.obj");
    Hairstyle style;
    // A quarter of a circle of 0.1 m radius, fine enough to be told from its chords by less than the bound below.
    StrandShapes arcs;
    arcs.nodes = 64;
    const float full = 0.1f * 1.5707963f;
    for (const glm::vec3& root : scalp.positions)
        for (int k = 0; k < 64; ++k)
        {
            const float angle = 1.5707963f * float(k - 1) / 62.0f;
            arcs.position.push_back(root + 0.1f * glm::vec3(std::sin(angle), 0.0f, 1.0f - std::cos(angle)));
        }
    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(arcs);
    for (const float length : {0.5f * full, full, 2.0f * full})
    {
        style.params.strand_length = length;
        const Groom groom = grow(style.params, scalp, style.host);
        for (const int g : {0, 100, 247})
        {
            const glm::dvec3 root = vector_at(groom.rest_position.data(), g, 1, groom.nodes);
            const double angle = double(std::min(length, full)) / 0.1, beyond = double(std::max(0.0f, length - full));
            const glm::dvec3 tip = root + glm::dvec3(0.1 * std::sin(angle) + beyond * std::cos(angle), 0.0,
                                                     0.1 * (1.0 - std::cos(angle)) + beyond * std::sin(angle));
            EXPECT_LT(glm::distance(vector_at(groom.rest_position.data(), g, groom.nodes - 1, groom.nodes), tip), 2e-3)
                << length;
        }
    }
    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(some_shapes(3, 4));
    EXPECT_EQ(error_of([&] { grow(style.params, scalp, style.host); }),
              "groom.rest holds 3 strands, but the scalp has 252 vertices: freeze the hair on this scalp again");
}

TEST(StrandShapes, a_save_keeps_them_beside_the_style_and_never_writes_over_anothers)
{
    Scratch scratch;
    const std::string theirs = shapes_text(some_shapes(252, 4));
    scratch.write("shared.rest", theirs);
    const std::string text = "# mine\n[groom]\nrest = \"shared.rest\" # from a friend\n";
    Hairstyle style = load_hairstyle(scratch.write("a.toml", text));
    save_hairstyle(style, scratch / "a.toml");
    EXPECT_EQ(bytes_of(scratch / "a.toml"), text) << "what is as it was is not touched";
    EXPECT_FALSE(fs::exists(scratch / "a.rest"));
    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(some_shapes(252, 5));
    save_hairstyle(style, scratch / "a.toml");
    EXPECT_EQ(bytes_of(scratch / "shared.rest"), theirs);
    EXPECT_EQ(bytes_of(scratch / "a.toml"), "# mine\n[groom]\nrest = \"a.rest\" # from a friend\n");
    EXPECT_EQ(*load_hairstyle(scratch / "a.toml").host.groom_rest.shapes, some_shapes(252, 5));
    // Elsewhere it comes along, and a file that has vanished is written again.
    fs::create_directory(scratch / "other");
    fs::remove(scratch / "a.rest");
    save_hairstyle(style, scratch / "other" / "b.toml");
    EXPECT_EQ(*load_hairstyle(scratch / "other" / "b.toml").host.groom_rest.shapes, some_shapes(252, 5));
}

TEST(StrandShapes, copies_and_namesakes_have_files_of_their_own)
{
    Scratch scratch;
    Hairstyle style;
    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(some_shapes(252, 4));
    // Two maps of one parameter, too.
    style.host.maps = {{"root.lift", MAP_FACTOR, std::vector<float>(5000, 2.0f), {}},
                       {"root.lift", MAP_OFFSET, std::vector<float>(5000, 3.0f), {}}};
    save_hairstyle(style, scratch / "a.toml");
    Hairstyle copy = style;
    save_hairstyle(copy, scratch / "b.toml");
    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(some_shapes(252, 6));
    save_hairstyle(style, scratch / "a.toml");
    EXPECT_EQ(style.host.groom_rest.file, "a.rest") << "its own is written over";
    const HostParams other = load_hairstyle(scratch / "b.toml").host;
    EXPECT_EQ(*other.groom_rest.shapes, some_shapes(252, 4)) << "and not the copy's";
    EXPECT_EQ(other.maps.at(0).values, std::vector<float>(5000, 2.0f));
    EXPECT_EQ(other.maps.at(1).values, std::vector<float>(5000, 3.0f));
    // Renamed, it goes on with its file; a new one of the old name takes another.
    fs::rename(scratch / "a.toml", scratch / "c.toml");
    Hairstyle fresh;
    fresh.host.groom_rest.shapes = std::make_shared<const StrandShapes>(some_shapes(252, 5));
    save_hairstyle(fresh, scratch / "a.toml");
    EXPECT_EQ(fresh.host.groom_rest.file, "a.2.rest");
    EXPECT_EQ(*load_hairstyle(scratch / "c.toml").host.groom_rest.shapes, some_shapes(252, 6));
}

TEST(StrandShapes, large_maps_lie_in_files_of_their_own)
{
    Scratch scratch;
    Hairstyle style;
    style.host.maps.push_back({"strand.length", MAP_OFFSET, std::vector<float>(5000, 0.125f), {}});
    save_hairstyle(style, scratch / "a.toml");
    EXPECT_LT(bytes_of(scratch / "a.toml").size(), 300u);
    const Hairstyle again = load_hairstyle(scratch / "a.toml");
    EXPECT_EQ(again.host.maps.at(0).values, std::vector<float>(5000, 0.125f));
    scratch.write("a.strand.length.map", "0.5\nhello\n");
    EXPECT_NE(error_of([&] { load_hairstyle(scratch / "a.toml"); }).find("a.strand.length.map:2: must hold numbers"),
              std::string::npos);
}

} // namespace
} // namespace coif

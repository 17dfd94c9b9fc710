// Hair on its way to other tools: the writers against samples that another program wrote, what files hold by readers
// that know nothing of the writers, and what is refused.
#include "app/options.h"
#include "sim/exchange/targets.h"
#include "tests/host/nine_strands.h"
#include "tests/host/ogawa_walk.h"
#include "tests/host/scratch.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <limits>
#include <sys/resource.h>

namespace coif
{
namespace
{

using test::bytes_of;
using test::error_of;
using test::nine_strands;
using test::OgawaWalk;
using test::Scratch;
using test::WalkedProperty;

std::string sample(const char* name) { return bytes_of(fs::path(COIF_SOURCE_FOLDER) / "tests" / "exchange" / name); }

// What the format's writer makes of hair, out of a file.
std::string written(const char* name, Curves curves, const char* target = "", Through through = Through::LINES,
                    const Cache* cache = nullptr)
{
    const Scratch scratch;
    const FormatInfo& format = format_of(name);
    const Placement placement = placement_of(format, find_target(target));
    place(curves, placement);
    NewFile file(scratch / name);
    write_curves(file, format, curves, words_of(placement, through), cache);
    const uint64_t size = file.size();
    file.finish();
    const std::string bytes = bytes_of(scratch / name);
    EXPECT_EQ(bytes.size(), size);
    return bytes;
}

Curves without_guides(double sway = 0.0)
{
    Curves curves = nine_strands(sway);
    curves.guide.clear(); // the Alembic samples keep none apart
    return curves;
}

Cache swaying(double per_metre = 1.0)
{
    Cache cache;
    cache.count = 5;
    cache.positions = [per_metre](int frame, std::vector<glm::vec3>& position)
    {
        position = nine_strands(0.01 * frame).position;
        place(position, {Axes::Y_UP, float(per_metre)});
    };
    return cache;
}

// Words and numbers of a text, apart.
std::vector<std::string> tokens(const std::string& text)
{
    std::vector<std::string> all;
    bool more = false;
    for (const char c : text)
    {
        const bool part = std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' || c == '_';
        if (part && more)
            all.back() += c;
        else if (!std::isspace(static_cast<unsigned char>(c)))
            all.emplace_back(1, c);
        more = part;
    }
    return all;
}

bool is_number(const std::string& token, double& value)
{
    char* end = nullptr;
    value = std::strtod(token.c_str(), &end);
    return end != token.c_str() && !*end;
}

// The same words in the same order, and numbers to a millionth (floats that were rounded twice differ by less).
void expect_same_text(const std::string& ours, const std::string& theirs)
{
    const std::vector<std::string> a = tokens(ours), b = tokens(theirs);
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
    {
        double x = 0.0, y = 0.0;
        if (is_number(a[i], x) && is_number(b[i], y))
            ASSERT_NEAR(x, y, 1e-6 * std::max(1e-3, std::abs(y))) << "token " << i;
        else
            ASSERT_EQ(a[i], b[i]) << "token " << i;
    }
}

TEST(Export, texts_are_those_of_the_samples)
{
    const Cache cache = swaying();
    expect_same_text(written("a.usda", nine_strands(), "", Through::CATMULL_ROM), sample("groom.usda"));
    expect_same_text(written("a.usda", nine_strands()), sample("groom_linear.usda"));
    expect_same_text(written("a.usda", nine_strands(), "", Through::CATMULL_ROM, &cache), sample("groom_cache.usda"));
    expect_same_text(written("a.obj", nine_strands()), sample("groom.obj"));
    expect_same_text(written("a.pbrt", nine_strands(), "", Through::CATMULL_ROM), sample("groom.pbrt"));
    expect_same_text(written("a.mitsuba.txt", nine_strands()), sample("groom_mitsuba.txt"));
}

TEST(Export, plain_binaries_are_the_samples_byte_by_byte)
{
    EXPECT_EQ(written("a.hair", nine_strands()), sample("groom.hair"));
    EXPECT_EQ(written("a.data", nine_strands()), sample("groom.data"));
    EXPECT_EQ(written("a.ply", nine_strands()), sample("groom.ply"));
}

TEST(Export, a_resampled_tfx_is_the_sample_but_for_the_last_bit_of_its_floats)
{
    const std::string ours = written("a.tfx", nine_strands()), theirs = sample("groom.tfx");
    ASSERT_EQ(ours.size(), theirs.size());
    EXPECT_EQ(ours.substr(0, 160), theirs.substr(0, 160)) << "the header";
    for (size_t at = 160; at < ours.size(); at += 4)
    {
        float a = 0.0f, b = 0.0f;
        std::memcpy(&a, &ours[at], 4);
        std::memcpy(&b, &theirs[at], 4);
        // The sample was reckoned in doubles throughout; ours were floats before they were mixed, and before 1 - v.
        // What that costs is a last bit: of 0.12 m, the farthest coordinate, and of 1.
        ASSERT_NEAR(a, b, at < 160 + 9 * 16 * 16 ? 7.5e-9 : 6e-8) << "byte " << at;
    }
}

TEST(Export, a_tfx_keeps_the_points_of_strands_that_have_as_many_as_it_takes)
{
    Curves curves = nine_strands();
    for (size_t s = 0; s < 9; ++s) // eight points each, not at equal lengths
    {
        curves.count[s] = 8;
    }
    curves.position.resize(72);
    for (size_t i = 0; i < 72; ++i)
        curves.position[i] = {float(i % 8 * (i % 8)), float(i / 8), 0.25f};
    curves.width.assign(72, 1e-4f);
    curves.color.assign(72, glm::vec3(0.5f));
    const std::string bytes = written("a.tfx", curves);
    ASSERT_EQ(bytes.size(), 160u + 72u * 16u + 72u);
    for (size_t i = 0; i < 72; ++i)
    {
        float at[4];
        std::memcpy(at, &bytes[160 + 16 * i], 16);
        EXPECT_EQ(glm::vec3(at[0], at[1], at[2]), curves.position[i]);
        EXPECT_EQ(at[3], i % 8 < 2 ? 0.0f : 1.0f);
    }
}

void expect_same_archive(const OgawaWalk& ours, const OgawaWalk& theirs)
{
    EXPECT_EQ(ours.objects, theirs.objects);
    EXPECT_EQ(ours.times, theirs.times);
    EXPECT_EQ(ours.archive, theirs.archive);
    ASSERT_EQ(ours.properties.size(), theirs.properties.size());
    for (const auto& [name, b] : theirs.properties)
    {
        ASSERT_TRUE(ours.properties.contains(name)) << name;
        const WalkedProperty& a = ours.properties.at(name);
        EXPECT_EQ(a.meta, b.meta) << name;
        EXPECT_EQ(a.kind, b.kind) << name;
        EXPECT_EQ(a.times, b.times) << name;
        EXPECT_EQ(a.declared, b.declared) << name;
        EXPECT_EQ(a.constant, b.constant) << name;
        if (b.kind)
        {
            EXPECT_EQ(a.pod, b.pod) << name;
            EXPECT_EQ(a.extent, b.extent) << name;
        }
        ASSERT_EQ(a.samples.size(), b.samples.size()) << name;
        for (size_t s = 0; s < b.samples.size(); ++s)
        {
            ASSERT_EQ(a.samples[s].size(), b.samples[s].size()) << name;
            if (b.pod == 10)
                for (size_t i = 0; i < b.values<float>(s).size(); ++i)
                    ASSERT_NEAR(a.values<float>(s)[i], b.values<float>(s)[i],
                                1e-6 * std::max(1e-3f, std::abs(b.values<float>(s)[i])))
                        << name << " " << i;
            else if (b.pod == 11)
                for (size_t i = 0; i < b.values<double>(s).size(); ++i)
                    ASSERT_NEAR(a.values<double>(s)[i], b.values<double>(s)[i], 2e-6) << name;
            else
                EXPECT_EQ(a.samples[s], b.samples[s]) << name;
        }
    }
}

TEST(Export, archives_hold_what_the_samples_hold)
{
    const Cache cache = swaying(100.0);
    expect_same_archive(OgawaWalk(written("a.abc", without_guides(), "unity")), OgawaWalk(sample("groom_unity.abc")));
    expect_same_archive(OgawaWalk(written("a.abc", without_guides(), "unreal")), OgawaWalk(sample("groom_unreal.abc")));
    expect_same_archive(OgawaWalk(written("a.abc", without_guides(), "maya", Through::LINES, &cache)),
                        OgawaWalk(sample("groom_cache.abc")));
}

TEST(Export, an_archive_keeps_guides_and_groups_apart_and_what_stands_still_once)
{
    Curves curves = nine_strands();
    curves.group = {0, 0, 0, 1, 1, 1, 1, 1, 1};
    curves.group_name = {"crown", "fringe"};
    Cache cache;
    cache.count = 300; // needs two bytes a number
    cache.positions = [&](int, std::vector<glm::vec3>& position) { position = curves.position; };
    const OgawaWalk walk(written("a.abc", curves, "", Through::CATMULL_ROM, &cache));
    std::vector<std::string> names;
    for (const auto& [name, meta] : walk.objects)
        names.push_back(name);
    EXPECT_EQ(names, (std::vector<std::string>{"/hair", "/hair/crown", "/hair/crown_guides", "/hair/fringe",
                                               "/hair/fringe_guides"}));
    const auto of = [&](const char* object, const char* property) -> const WalkedProperty&
    { return walk.properties.at(std::string("/hair/") + object + ":.geom/" + property); };
    EXPECT_EQ(of("crown_guides", "nVertices").values<int>(), std::vector<int>{5});
    EXPECT_EQ(of("crown_guides", ".arbGeomParams/groom_guide").values<int>(), std::vector<int>{1});
    EXPECT_EQ(of("fringe", ".arbGeomParams/groom_guide").values<int>(), std::vector<int>{0});
    EXPECT_EQ(of("fringe", ".arbGeomParams/groom_id").values<int>(), (std::vector<int>{4, 5, 7, 8}));
    EXPECT_EQ(of("fringe", ".arbGeomParams/groom_group_id").values<int>(), std::vector<int>{1});
    EXPECT_EQ(of("fringe", ".arbGeomParams/groom_group_name").samples[0], std::string("fringe\0", 7));
    EXPECT_EQ(of("fringe", "curveBasisAndType").samples[0], std::string("\0\0\3\3", 4));
    EXPECT_TRUE(of("fringe", "P").constant);
    EXPECT_EQ(of("fringe", "P").samples.size(), 1u);
    EXPECT_EQ(of("fringe", "P").declared, 300u);
}

TEST(Export, samples_that_differ_have_different_digests)
{
    const Cache cache = swaying();
    const OgawaWalk walk(written("a.abc", nine_strands(), "", Through::LINES, &cache));
    std::map<std::string, std::string> by_key;
    size_t samples = 0;
    for (const auto& [name, property] : walk.properties)
        for (size_t s = 0; s < property.samples.size(); ++s, ++samples)
        {
            const auto [place, is_new] = by_key.try_emplace(property.keys[s], property.samples[s]);
            EXPECT_EQ(place->second, property.samples[s]) << name;
        }
    EXPECT_GT(samples, 30u);
}

TEST(Export, a_scene_of_groups_has_a_prim_for_each_that_moves_on_its_own)
{
    Curves curves = nine_strands();
    curves.group = {0, 0, 0, 0, 0, 2, 2, 2, 2};
    curves.group_name = {"crown", "nobody", "fringe"};
    const Cache cache = swaying();
    const std::string text = written("a.usda", curves, "", Through::LINES, &cache);
    const size_t crown = text.find("def BasisCurves \"crown\""), fringe = text.find("def BasisCurves \"fringe\"");
    ASSERT_NE(crown, text.npos);
    ASSERT_NE(fringe, text.npos);
    EXPECT_EQ(text.find("nobody"), text.npos) << "there are no prims without strands";
    EXPECT_EQ(text.find("GroomAPI"), text.rfind("GroomAPI")) << "once, or importers make a groom of each prim";
    // Numbers of all frames of a prim's points, against the strands of its group.
    for (const auto& [begin, first, last] : {std::tuple{crown, 0, 5}, std::tuple{fringe, 5, 9}})
    {
        const size_t at = text.find("points.timeSamples", begin), end = text.find('}', at);
        std::vector<double> numbers;
        for (const std::string& token : tokens(text.substr(at, end - at)))
            if (double value = 0.0; is_number(token, value))
                numbers.push_back(value);
        size_t i = 0;
        for (int frame = 0; frame < 5; ++frame)
        {
            ASSERT_LT(i, numbers.size());
            EXPECT_EQ(numbers[i++], frame);
            const Curves now = nine_strands(0.01 * frame);
            const std::vector<size_t> points = first_points(now);
            for (size_t p = points[size_t(first)]; p < (last == 9 ? now.points() : points[size_t(last)]); ++p)
                for (int axis = 0; axis < 3; ++axis)
                    ASSERT_EQ(float(numbers.at(i++)), now.position[p][axis]);
        }
        EXPECT_EQ(i, numbers.size());
    }
    size_t open = 0, closed = 0;
    for (const char c : text)
    {
        open += c == '{' || c == '(' || c == '[';
        closed += c == '}' || c == ')' || c == ']';
    }
    EXPECT_EQ(open, closed);
}

TEST(Export, glb_is_the_sample_in_its_bytes_and_whole_in_its_json)
{
    const std::string ours = written("a.glb", nine_strands()), theirs = sample("groom.glb");
    const auto number = [](const std::string& bytes, size_t at)
    {
        uint32_t value = 0;
        std::memcpy(&value, &bytes.at(at), 4);
        return value;
    };
    const auto binary = [&](const std::string& bytes) { return bytes.substr(20 + number(bytes, 12) + 8); };
    EXPECT_EQ(ours.substr(0, 8), theirs.substr(0, 8));
    EXPECT_EQ(number(ours, 8), ours.size());
    EXPECT_EQ(number(ours, 12) % 4, 0u);
    const std::string a = binary(ours), b = binary(theirs);
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); i += 4)
    {
        float x = 0.0f, y = 0.0f;
        std::memcpy(&x, &a[i], 4);
        std::memcpy(&y, &b[i], 4);
        ASSERT_NEAR(x, y, 6e-8) << i; // 1 - v, of a float and of a double
    }
    const std::string json = ours.substr(20, number(ours, 12));
    EXPECT_NE(json.find(fmt::format("\"byteLength\":{}", a.size())), json.npos);
    EXPECT_NE(json.find("\"mode\":1"), json.npos);
}

TEST(Export, assimp_reads_the_lines_of_obj_and_glb)
{
    const Scratch scratch;
    for (const char* name : {"a.obj", "a.glb"})
    {
        const fs::path file = scratch.write(name, written(name, nine_strands()));
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFile(file, 0);
        ASSERT_NE(scene, nullptr) << importer.GetErrorString();
        size_t lines = 0, points = 0;
        for (unsigned m = 0; m < scene->mNumMeshes; ++m)
        {
            points += scene->mMeshes[m]->mNumVertices;
            for (unsigned f = 0; f < scene->mMeshes[m]->mNumFaces; ++f)
                lines += scene->mMeshes[m]->mFaces[f].mNumIndices == 2;
        }
        const Curves curves = nine_strands();
        EXPECT_EQ(lines, curves.points() - 9) << name;
        EXPECT_GE(points, curves.points()) << name;
        // Its first line joins the first strand's first two points.
        const aiMesh& mesh = *scene->mMeshes[0];
        for (unsigned k = 0; k < 2; ++k)
        {
            const aiVector3D at = mesh.mVertices[mesh.mFaces[0].mIndices[k]];
            EXPECT_NEAR(glm::distance(glm::vec3(at.x, at.y, at.z), curves.position[k]), 0.0, 1e-7) << name;
        }
    }
}

TEST(Export, mitsubas_pieces_pass_the_points_and_stay_on_the_curve)
{
    std::istringstream in(written("a.mitsuba.txt", nine_strands(), "", Through::CATMULL_ROM));
    const Curves curves = nine_strands();
    size_t at = 0, lines = 0;
    std::string line;
    for (size_t s = 0; s < 9; ++s)
        for (size_t k = 0; std::getline(in, line) && !line.empty(); ++k, ++lines)
            if (k % 4 == 0)
            {
                glm::vec3 p;
                float radius = 0.0f;
                std::istringstream(line) >> p.x >> p.y >> p.z >> radius;
                EXPECT_NEAR(glm::distance(p, curves.position[at]), 0.0, 1e-8);
                EXPECT_FLOAT_EQ(radius, curves.width[at] / 2.0f);
                ++at;
            }
    EXPECT_EQ(at, curves.points());
    EXPECT_EQ(lines, 4 * (curves.points() - 9) + 9);
}

TEST(Export, a_straight_strand_is_straight_in_pbrt)
{
    Curves one;
    one.count = {3};
    one.position = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}};
    one.width = {1, 1, 1};
    one.color.assign(3, glm::vec3(0.5f));
    one.root_uv = {{0.5f, 0.5f}};
    const std::string text = written("a.pbrt", one);
    EXPECT_NE(text.find("[0 0 0  1 0 0  2 0 0  3 0 0  3 1 0  3 2 0  3 3 0]"), text.npos) << text;
}

// ---- what a file will be

TEST(Export, sizes_are_told_before_they_are_written)
{
    const Curves curves = nine_strands();
    for (const FormatInfo& format : formats())
    {
        const FileSize size = size_of(format, curves, {});
        EXPECT_TRUE(size.exact);
        EXPECT_EQ(size.bytes, written((std::string("a") + format.suffix).c_str(), curves).size()) << format.suffix;
    }
    const Cache cache = swaying();
    for (const char* name : {"a.usda", "a.abc"})
    {
        const FileSize size = size_of(format_of(name), curves, {}, &cache);
        EXPECT_FALSE(size.exact);
        const double truth = double(written(name, curves, "", Through::LINES, &cache).size());
        EXPECT_NEAR(double(size.bytes), truth, 0.05 * truth) << name;
    }
    EXPECT_EQ(size_text({12'345'678, true}), "12.3 MB");
    EXPECT_EQ(size_text({3'300'000'000, false}), "about 3.3 GB");
}

TEST(Export, tools_get_their_axes_and_units)
{
    Curves curves;
    curves.position = {{1, 2, 3}};
    curves.width = {0.5f};
    const auto placed = [&](const char* name, const char* target)
    {
        Curves own = curves;
        place(own, placement_of(format_of(name), find_target(target)));
        return std::pair(own.position[0], own.width[0]);
    };
    EXPECT_EQ(placed("a.abc", "unreal"), std::pair(glm::vec3(100, 300, 200), 50.0f));
    EXPECT_EQ(placed("a.abc", "unity"), std::pair(glm::vec3(100, 200, 300), 50.0f));
    EXPECT_EQ(placed("a.abc", "maya"), std::pair(glm::vec3(100, 200, 300), 50.0f));
    EXPECT_EQ(placed("a.abc", "houdini"), std::pair(glm::vec3(1, 2, 3), 0.5f));
    EXPECT_EQ(placed("a.abc", ""), std::pair(glm::vec3(1, 2, 3), 0.5f));
    EXPECT_EQ(placed("a.ply", "blender"), std::pair(glm::vec3(1, -3, 2), 0.5f));
    EXPECT_EQ(placed("a.obj", "blender"), std::pair(glm::vec3(1, 2, 3), 0.5f));
    for (const char* says_itself : {"a.usda", "a.glb", "a.pbrt", "a.mitsuba.txt"})
        EXPECT_EQ(placed(says_itself, "unreal"), std::pair(glm::vec3(1, 2, 3), 0.5f)) << says_itself;
    EXPECT_NE(written("a.hair", nine_strands(), "unreal").find("coif; centimetres; z up, left handed; thickness is"),
              std::string::npos);
}

TEST(Export, points_are_spread_at_equal_lengths)
{
    const std::vector<glm::vec3> bent = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 3, 0}}; // two points in one place
    const std::vector<glm::vec3> five = resampled(bent, 5);
    const std::vector<glm::vec3> wanted = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {1, 3, 0}};
    ASSERT_EQ(five.size(), 5u);
    for (size_t i = 0; i < 5; ++i)
        EXPECT_NEAR(glm::distance(five[i], wanted[i]), 0.0, 1e-6) << i;
    for (const glm::vec3& p : resampled({{2, 2, 2}, {2, 2, 2}}, 4)) // of no length
        EXPECT_EQ(p, glm::vec3(2));
    EXPECT_EQ(tfx_points(3), 4);
    EXPECT_EQ(tfx_points(16), 16);
    EXPECT_EQ(tfx_points(17), 32);
    EXPECT_EQ(tfx_points(500), 64);
}

// ---- what is refused

std::string refusal(const Curves& curves, const char* name)
{
    return error_of([&] { check_curves(curves, format_of(name)); });
}

TEST(Export, what_no_reader_could_take_is_refused)
{
    EXPECT_EQ(refusal(nine_strands(), "a.usda"), "no error");
    Curves bad = nine_strands();
    bad.position[11].y = std::numeric_limits<float>::quiet_NaN(); // the strands have 5, 6, 7 ... points
    for (const FormatInfo& format : formats())
        EXPECT_EQ(error_of([&] { check_curves(bad, format); }),
                  "strand 2, point 0 is not a finite number, which no tool can read; `coif report` says what went "
                  "wrong with the strand");
    EXPECT_EQ(error_of([&] { check_positions(nine_strands(), bad.position, 7); }).substr(0, 26),
              "frame 7: strand 2, point 0");
    bad = nine_strands();
    bad.position.pop_back();
    EXPECT_NE(error_of([&] { check_positions(nine_strands(), bad.position, 7); }).find("keeps their number"),
              std::string::npos);
    bad = nine_strands();
    bad.width[0] = 0.0f;
    EXPECT_NE(refusal(bad, "a.abc").find("strand 0 is not wider than 0 at its root"), std::string::npos);
    bad.width[0] = 1e-4f;
    bad.width[4] = 0.0f; // a tip may come to a point
    EXPECT_EQ(refusal(bad, "a.abc"), "no error");
    bad.width[3] = -1e-5f;
    EXPECT_NE(refusal(bad, "a.abc").find("strand 0, point 3 has a width"), std::string::npos);
    bad = nine_strands();
    bad.count[8] = 1;
    EXPECT_EQ(refusal(bad, "a.obj"), "strand 8 has 1 point; a curve takes two or more");
    EXPECT_EQ(refusal({}, "a.obj"), "there is no hair to write; raise interpolation.strands");
}

TEST(Export, more_points_than_a_format_can_hold_are_refused)
{
    Curves one;
    one.count = {65537};
    one.position.assign(65537, glm::vec3(0.0f));
    one.width.assign(65537, 1e-4f);
    one.color.assign(65537, glm::vec3(0.5f));
    one.root_uv = {{0.5f, 0.5f}};
    EXPECT_NE(refusal(one, "a.hair").find("strand 0 has 65536 segments, and a .hair holds 65,535"), std::string::npos);
    EXPECT_EQ(refusal(one, "a.usda"), "no error");
    for (std::vector<glm::vec3>* array : {&one.position, &one.color})
        array->pop_back();
    one.width.pop_back();
    one.count = {65536};
    EXPECT_EQ(refusal(one, "a.hair"), "no error");
    const std::string bytes = written("a.hair", one);
    uint32_t segments = 0;
    std::memcpy(&segments, &bytes[16], 4);
    EXPECT_EQ(segments, 65535u);
}

TEST(Export, names_that_the_format_does_not_allow_are_refused)
{
    Curves curves = nine_strands();
    curves.group.assign(9, 0);
    for (const char* name : {"left side", "2nd", "", "Stirn\xc3\xa4", "a-b", "a/b", "a\"b", "a\nb"})
    {
        curves.group_name = {name};
        EXPECT_NE(refusal(curves, "a.usda").find("another name"), std::string::npos) << name;
    }
    for (const char* name : {"a/b", "a\nb", ""})
    {
        curves.group_name = {name};
        EXPECT_NE(refusal(curves, "a.abc").find("another name"), std::string::npos) << name;
    }
    curves.group_name = {"left side"};
    EXPECT_EQ(refusal(curves, "a.abc"), "no error");
    curves.group_name = {"_left_2"};
    EXPECT_EQ(refusal(curves, "a.usda"), "no error");
}

TEST(Export, the_regions_of_all_presets_may_be_groups_in_every_format)
{
    size_t named = 0;
    for (const fs::path& preset : preset_files())
    {
        Curves curves = nine_strands();
        curves.group.assign(9, 0);
        curves.group_name = {"hair"};
        for (const Region& region : load_hairstyle(preset).host.regions)
            curves.group_name.push_back(region.name);
        named += curves.group_name.size() - 1;
        for (const FormatInfo& format : formats())
            EXPECT_EQ(refusal(curves, (std::string("a") + format.suffix).c_str()), "no error") << preset;
    }
    EXPECT_GT(named, 5u);
}

TEST(Export, suffixes_and_tools_that_are_not_known_are_named)
{
    EXPECT_NE(error_of([] { format_of("bob.fbx"); }).find("-o bob.fbx: the end of the name says what is written"),
              std::string::npos);
    EXPECT_NE(error_of([] { format_of(".abc"); }).find("the end of the name"), std::string::npos);
    EXPECT_EQ(format_of("BOB.ABC").format, Format::ABC);
    EXPECT_EQ(error_of([] { find_target("cinema"); }),
              "--for cinema: expected one of unreal, unity, blender, maya, houdini");
}

TEST(Export, a_full_disk_leaves_the_old_file_and_nothing_else)
{
    const Scratch scratch;
    const fs::path file = scratch.write("a.abc", "old");
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit old;
    getrlimit(RLIMIT_FSIZE, &old);
    rlimit small = old;
    small.rlim_cur = 3000;
    for (const FormatInfo& format : formats())
    {
        const fs::path target = scratch / (std::string("a") + format.suffix);
        setrlimit(RLIMIT_FSIZE, &small);
        const std::string said = error_of(
            [&]
            {
                NewFile out(target);
                for (int i = 0; i < 10; ++i) // a few kilobytes each
                    write_curves(out, format, nine_strands(), {});
                out.finish();
            });
        setrlimit(RLIMIT_FSIZE, &old);
        EXPECT_EQ(said, target.string() + ": cannot be written: File too large; make room, or save elsewhere");
    }
    std::signal(SIGXFSZ, SIG_DFL);
    EXPECT_EQ(bytes_of(file), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
    EXPECT_NE(error_of([&] { check_room(file, {uint64_t(1) << 62, true}); }).find("make room"), std::string::npos);
    EXPECT_EQ(error_of([&] { check_room(file, {1, true}); }), "no error");
}

TEST(Export, a_file_is_there_only_when_it_is_whole)
{
    const Scratch scratch;
    const fs::path file = scratch.write("a.usda", "old");
    Cache cache = swaying();
    const auto good = cache.positions;
    cache.positions = [&](int frame, std::vector<glm::vec3>& position)
    {
        EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
        if (frame == 3)
            throw Error("enough");
        good(frame, position);
    };
    for (const char* name : {"a.usda", "a.abc"})
        EXPECT_EQ(error_of(
                      [&]
                      {
                          NewFile out(scratch / name);
                          write_curves(out, format_of(name), nine_strands(), {}, &cache);
                          out.finish();
                      }),
                  "enough");
    EXPECT_EQ(bytes_of(file), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 1);
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_write);
    fs::create_symlink("a.usda", scratch / "link.usda");
    NewFile out(scratch / "link.usda");
    out.add("new");
    out.finish();
    EXPECT_EQ(bytes_of(file), "new") << "through a link the file that it names is replaced";
    EXPECT_TRUE(fs::is_symlink(scratch / "link.usda"));
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_write);
}

TEST(Export, places_that_take_no_file_are_told)
{
    const Scratch scratch;
    EXPECT_NE(error_of([&] { NewFile(scratch / "none" / "a.abc"); }).find("is its folder there"), std::string::npos);
    EXPECT_NE(error_of([&] { NewFile{scratch.folder()}; }).find("is a folder"), std::string::npos);
    EXPECT_NE(error_of([&] { NewFile("/dev/full"); }).find("is no plain file"), std::string::npos);
}

} // namespace
} // namespace coif

// Hair from a running style into files: the curves against what the passes drew and the oracle's waves, the command as
// a script calls it, and the editor's window.
#include "sim/drawn_curve.h"
#include "sim/exchange/targets.h"
#include "tests/commands.h"
#include "tests/host/ogawa_walk.h"
#include "tests/on_device.h"
#include "tests/oracle.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>

using namespace coif;
using namespace coif::test;

namespace
{

Hairstyle small_style()
{
    Hairstyle style;
    style.params.interpolation_strands = 200;
    style.params.grid_resolution = 16;
    return style;
}

std::unique_ptr<Simulation> running(const Hairstyle& style, double seconds)
{
    auto simulation = std::make_unique<Simulation>(test_device(), style);
    simulation->play(find_motion("drag"));
    while (simulation->time() < seconds)
        simulation->step(simulation->hand());
    simulation->solver().draw();
    return simulation;
}

glm::dvec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

} // namespace

TEST(ExportedHair, strands_without_waves_are_the_drawn_nodes_from_the_root_on_in_the_world)
{
    Hairstyle style = small_style();
    style.params.look_variation = 0.5f;
    style.params.look_taper = 0.5f;
    const auto simulation = running(style, 0.4);
    const Solver& solver = simulation->solver();
    const Groom& groom = solver.groom();
    const Curves curves = curves_of(*simulation, taken(*simulation, false, 0));
    ASSERT_GT(glm::length(solver.head().origin), 0.01) << "or the test would not see whose frame it is";
    ASSERT_EQ(curves.strands(), groom.drawn.size());
    const Mapped drawn = solver.drawn_positions();
    const HairParams& p = style.params;
    for (size_t s = 0; s < groom.drawn.size(); ++s)
    {
        ASSERT_EQ(int(curves.count[s]), groom.nodes - 1);
        const double bright =
            std::exp(0.5 * 2.0 * (oracle::strand_random(int(s) + 7919 * p.interpolation_seed, 1) - 0.5));
        for (int k = 1; k < groom.nodes; ++k)
        {
            const size_t i = s * size_t(groom.nodes - 1) + size_t(k - 1);
            const glm::dvec3 there =
                vec(drawn.as<float4>()[s * size_t(groom.nodes) + size_t(k)]) + glm::dvec3(solver.head().origin);
            ASSERT_NEAR(glm::distance(glm::dvec3(curves.position[i]), there), 0.0, 1e-6) << s << " " << k;
            const double along = double(k - 1) / (groom.nodes - 2);
            ASSERT_NEAR(curves.width[i],
                        double(p.look_width) * (1.0 - 0.5 * along * along) *
                            oracle::profile_at(p.look_width_along, along),
                        1e-9);
            const double red = linear_of_srgb(p.look_root_color.x), tip = linear_of_srgb(p.look_tip_color.x);
            ASSERT_NEAR(curves.color[i].x, bright * (red + (tip - red) * oracle::profile_at(p.look_color_along, along)),
                        1e-5);
        }
    }
    std::vector<glm::vec3> again;
    positions_of(*simulation, taken(*simulation, false, 0), again);
    EXPECT_EQ(again, curves.position);
}

TEST(ExportedHair, curls_and_frizz_are_in_it_as_the_oracle_lays_them_on)
{
    Hairstyle style = small_style();
    style.params.curl_radius = 0.006f;
    style.params.curl_pitch = 0.012f; // too fine for the nodes: laid on
    style.params.curl_variation = 0.4f;
    style.params.curl_hand = 2;
    style.params.frizz_amount = 0.002f;
    const auto simulation = running(style, 0.2);
    ASSERT_FALSE(curls_are_shape(simulation->params()));
    const Solver& solver = simulation->solver();
    const Groom& groom = solver.groom();
    const Taken wanted = taken(*simulation, false, 0);
    ASSERT_GT(wanted.pieces, 2) << "or the curls would be lost";
    const Curves curves = curves_of(*simulation, wanted);
    const Mapped positions = solver.drawn_positions(), frames = solver.drawn_frames();
    const HairParams& p = simulation->params();
    double farthest = 0.0;
    for (size_t s = 0; s < groom.drawn.size(); ++s)
        for (int k = 1; k < groom.nodes - 1; ++k)
        {
            const float4 *at = positions.as<float4>() + s * size_t(groom.nodes) + size_t(k),
                         *frame = frames.as<float4>() + s * size_t(groom.nodes) + size_t(k);
            const glm::dvec3 tangent = glm::normalize(vec(at[1]) - vec(at[-1]));
            glm::dvec3 normal = vec(frame[0]);
            normal = glm::normalize(normal - tangent * glm::dot(tangent, normal));
            const int seed = int(s) + 7919 * p.interpolation_seed;
            const double along = double(k - 1) / (groom.nodes - 2), distance = frame[0].w;
            const oracle::Across curl = oracle::curl_at(seed, double(p.curl_phase) * oracle::strand_random(seed, 5),
                                                        distance, p.curl_pitch, p.curl_variation, p.curl_hand);
            const oracle::Across frizz = oracle::frizz_at(seed, distance, p.frizz_frequency);
            const double turned = double(p.curl_radius) * oracle::wave_onset(along, p.curl_begin);
            const double strayed = double(p.frizz_amount) * along * (2.0 - along);
            const double share = oracle::profile_at(p.wave_along, along);
            const glm::dvec3 offset =
                share * (normal * (turned * curl.normal + strayed * frizz.normal) +
                         glm::cross(tangent, normal) * (turned * curl.binormal + strayed * frizz.binormal));
            const size_t i = s * curves.count[s] + size_t(wanted.pieces) * size_t(k - 1);
            const glm::dvec3 there = vec(at[0]) + offset + glm::dvec3(solver.head().origin);
            // A float's turns at 0.3 m are 25, to 2e-6 of one: 0.1 um.
            ASSERT_NEAR(glm::distance(glm::dvec3(curves.position[i]), there), 0.0, 2e-6) << s << " " << k;
            farthest = std::max(farthest, glm::length(offset));
        }
    EXPECT_GT(farthest, 0.005);
}

TEST(ExportedHair, braids_are_plaited_as_the_oracle_plaits_them)
{
    Hairstyle style = load_hairstyle(fs::path(COIF_SOURCE_FOLDER) / "hairstyles" / "braid.toml");
    style.params.interpolation_strands = 400;
    const auto simulation = running(style, 0.1);
    const Solver& solver = simulation->solver();
    const Groom& groom = solver.groom();
    const Taken wanted = taken(*simulation, false, 0);
    const Curves curves = curves_of(*simulation, wanted);
    const Mapped positions = solver.drawn_positions(), frames = solver.drawn_frames();
    size_t plaited = 0;
    for (size_t s = 0; s < groom.tied.size(); ++s)
    {
        const TiedStrand& tied = groom.tied[s];
        const Tail& tail = groom.tails[size_t(tied.tail)];
        if (tied.ring == 0.0f || tail.axis.w == 0.0f)
            continue;
        for (int k = 2; k < groom.nodes - 1; ++k)
        {
            const float4 *at = positions.as<float4>() + s * size_t(groom.nodes) + size_t(k),
                         *frame = frames.as<float4>() + s * size_t(groom.nodes) + size_t(k);
            // The strand is cut at a share of the whole: where its node is on that, from the root.
            const double node = 1.0 + double(groom.drawn[s].root.w) * (k - 1);
            const double behind =
                (node - double(tied.ring)) * double(tail.length) / (groom.nodes - 1 - double(tied.ring));
            if (behind < 0.002)
                continue;
            const glm::dvec3 tangent = glm::normalize(vec(at[1]) - vec(at[-1]));
            glm::dvec3 normal = vec(frame[0]);
            normal = glm::normalize(normal - tangent * glm::dot(tangent, normal));
            const glm::dvec3 by = oracle::braid_share(behind, tail.axis.w) *
                                  oracle::braid_offset(behind, vec(tied.place), tail.axis.w, tail.side.w, tail.depth,
                                                       tail.plait, tail.bound);
            const glm::dvec3 there = vec(at[0]) + by.x * normal + by.y * glm::cross(tangent, normal) + by.z * tangent +
                                     glm::dvec3(solver.head().origin);
            const size_t i = s * curves.count[s] + size_t(wanted.pieces) * size_t(k - 1);
            ASSERT_NEAR(glm::distance(glm::dvec3(curves.position[i]), there), 0.0, 5e-6) << s << " " << k;
            ++plaited;
        }
    }
    EXPECT_GT(plaited, 1000u);
}

TEST(ExportedHair, points_of_equal_lengths_lie_on_the_curve_from_root_to_tip)
{
    const auto simulation = running(small_style(), 0.3);
    const Curves nodes = curves_of(*simulation, taken(*simulation, false, 0));
    const Curves five = curves_of(*simulation, taken(*simulation, false, 5));
    for (size_t s = 0; s < five.strands(); ++s)
    {
        ASSERT_EQ(five.count[s], 5u);
        EXPECT_EQ(five.position[5 * s], nodes.position[s * nodes.count[s]]);
        EXPECT_EQ(five.position[5 * s + 4], nodes.position[(s + 1) * nodes.count[s] - 1]);
        double nearest = 1.0; // of the nodes to the middle point, which is between two of them
        for (size_t k = 0; k < nodes.count[s]; ++k)
            nearest = std::min(nearest,
                               double(glm::distance(five.position[5 * s + 2], nodes.position[s * nodes.count[s] + k])));
        EXPECT_LT(nearest, 0.012) << s; // segments are 18 mm at most
    }
}

TEST(ExportedHair, guides_have_their_roots_and_root_uvs_are_a_map_of_the_head_from_above)
{
    const auto simulation = running(small_style(), 0.0);
    const Groom& groom = simulation->solver().groom();
    const Curves guides = curves_of(*simulation, taken(*simulation, true, 0));
    ASSERT_EQ(int(guides.strands()), groom.guides);
    for (size_t g = 0; g < guides.strands(); ++g)
    {
        EXPECT_TRUE(guides.guide[g]);
        const glm::dvec3 root = vector_at(groom.root_position.data(), int(g), 0, 1);
        EXPECT_NEAR(glm::distance(glm::dvec3(guides.position[g * guides.count[g]]), root), 0.0, 2e-5) << g;
        // Back from the map to the way out of the head.
        const glm::dvec2 from = glm::dvec2(guides.root_uv[g]) - 0.5;
        const double angle = 2.0 * M_PI * glm::length(from);
        const glm::dvec2 flat = glm::length(from) > 1e-9 ? glm::normalize(from) : glm::dvec2(0.0);
        const glm::dvec3 out(std::sin(angle) * flat.x, std::cos(angle), -std::sin(angle) * flat.y);
        EXPECT_NEAR(glm::distance(out, glm::normalize(root - glm::dvec3(groom.center))), 0.0, 1e-5) << g;
    }
}

TEST(ExportedHair, groups_are_the_regions_of_the_style)
{
    Hairstyle style = load_hairstyle(fs::path(COIF_SOURCE_FOLDER) / "hairstyles" / "undercut.toml");
    style.params.interpolation_strands = 400;
    const auto simulation = running(style, 0.0);
    const Curves curves = curves_of(*simulation, taken(*simulation, false, 0));
    ASSERT_EQ(curves.group.size(), curves.strands());
    ASSERT_GT(curves.group_name.size(), 2u);
    std::vector<size_t> members(curves.group_name.size());
    for (const int32_t group : curves.group)
        ++members.at(size_t(group));
    for (size_t g = 0; g < members.size(); ++g)
        EXPECT_GT(members[g], 0u) << curves.group_name[g];
    EXPECT_NE(std::ranges::find(curves.group_name, "quiff"), curves.group_name.end());
}

// ---- the command

TEST_F(Commands, hair_is_exported_to_every_format_and_says_what_the_target_gets)
{
    for (const FormatInfo& format : formats())
    {
        const std::string file = std::string("x") + format.suffix;
        const Result result = coif("export small.toml --time 0.1 -o " + file);
        ASSERT_EQ(result.status, 0) << file << ": " << result.err;
        EXPECT_EQ(result.out, "") << "words go to standard error";
        EXPECT_GT(contents(file).size(), 10000u) << file;
        EXPECT_NE(result.err.find("wrote " + file), std::string::npos) << result.err;
        EXPECT_EQ(result.err.find("does not carry") != std::string::npos, *format.leaves_out != 0) << result.err;
    }
    const std::string first = contents("x.abc");
    ASSERT_EQ(coif("export small.toml --time 0.1 -o x.abc").status, 0);
    EXPECT_EQ(contents("x.abc"), first) << "the same input gives the same bytes";
    const OgawaWalk plain(first);
    const std::vector<float> ours = plain.properties.at("/hair/strands:.geom/P").values<float>();
    const struct
    {
        const char *target, *says;
        float x, y, z; // of the first point, of ours
    } wanted[] = {{"unreal", "centimetres, z up, left handed", 100 * ours[0], 100 * ours[2], 100 * ours[1]},
                  {"unity", "centimetres, y up", 100 * ours[0], 100 * ours[1], 100 * ours[2]},
                  {"blender", "metres, y up", ours[0], ours[1], ours[2]},
                  {"maya", "centimetres, y up", 100 * ours[0], 100 * ours[1], 100 * ours[2]},
                  {"houdini", "metres, y up", ours[0], ours[1], ours[2]}};
    for (const auto& target : wanted)
    {
        const Result result = coif(std::string("export small.toml --time 0.1 -o y.abc --for ") + target.target);
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_NE(result.err.find(target.says), std::string::npos) << result.err;
        const OgawaWalk walk(contents("y.abc"));
        const std::vector<float> theirs = walk.properties.at("/hair/strands:.geom/P").values<float>();
        EXPECT_FLOAT_EQ(theirs[0], target.x) << target.target;
        EXPECT_FLOAT_EQ(theirs[1], target.y) << target.target;
        EXPECT_FLOAT_EQ(theirs[2], target.z) << target.target;
    }
    const Result odd = coif("export small.toml --time 0 -o y.ply --for unity --strands guides --points 8");
    ASSERT_EQ(odd.status, 0) << odd.err;
    EXPECT_NE(odd.err.find("unity is not known to read hair from .ply"), std::string::npos) << odd.err;
    EXPECT_NE(odd.err.find("guides of 8 points"), std::string::npos) << odd.err;
}

TEST_F(Commands, a_cache_holds_the_poses_of_its_frames)
{
    ASSERT_EQ(coif("export small.toml --motion drag --frames 3:7 --fps 24 -o c.abc").status, 0);
    ASSERT_EQ(coif("export small.toml --motion drag --frames 3:7 --fps 24 -o c.usda").status, 0);
    ASSERT_EQ(coif("export small.toml --motion drag --time 0.291666667 -o one.abc").status, 0); // 7 / 24 s
    const OgawaWalk cache(contents("c.abc")), one(contents("one.abc"));
    const WalkedProperty& moving = cache.properties.at("/hair/strands:.geom/P");
    ASSERT_EQ(moving.samples.size(), 5u);
    EXPECT_EQ(moving.samples[4], one.properties.at("/hair/strands:.geom/P").samples[0]);
    EXPECT_NE(moving.samples[0], moving.samples[4]);
    double start = 0.0, cycle = 0.0;
    std::memcpy(&cycle, &cache.times.at(24 + 4), 8);
    std::memcpy(&start, &cache.times.at(24 + 16), 8);
    EXPECT_DOUBLE_EQ(cycle, 1.0 / 24.0);
    EXPECT_DOUBLE_EQ(start, 3.0 / 24.0);
    const std::string text = contents("c.usda");
    for (const char* line : {"startTimeCode = 3\n", "endTimeCode = 7\n", "timeCodesPerSecond = 24\n"})
        EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST_F(Commands, blender_takes_the_edges_of_obj_and_ply_whole_and_upright)
{
    if (std::system("command -v blender > /dev/null") != 0)
        GTEST_SKIP() << "Blender is not installed: apt-get install blender";
    for (const char* suffix : {".obj", ".ply"})
        ASSERT_EQ(
            coif(std::string("export small.toml --time 0 --strands guides --points 8 --for blender -o b") + suffix)
                .status,
            0);
    write("count.py", R"(import bpy
for read in (lambda: bpy.ops.wm.obj_import(filepath="b.obj"),
             lambda: (bpy.ops.wm.ply_import if hasattr(bpy.types, "WM_OT_ply_import") else bpy.ops.import_mesh.ply)(filepath="b.ply")):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    read()
    meshes = [o for o in bpy.data.objects if o.type == "MESH"]
    points = [o.matrix_world @ v.co for o in meshes for v in o.data.vertices]
    print("seen", len(points), sum(len(o.data.edges) for o in meshes),
          *["%.5f %.5f" % (min(p[i] for p in points), max(p[i] for p in points)) for i in range(3)])
)");
    ASSERT_EQ(std::system(("cd '" + folder.string() +
                           "' && blender --background --factory-startup --python count.py > seen.txt 2> seen.err")
                              .c_str()),
              0);
    // The guides as the .obj has them: y up.
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    int points = 0;
    std::istringstream lines(contents("b.obj"));
    for (std::string line; std::getline(lines, line);)
    {
        double p[3];
        if (std::sscanf(line.c_str(), "v %lf %lf %lf", &p[0], &p[1], &p[2]) != 3)
            continue;
        ++points;
        for (int i = 0; i < 3; ++i)
        {
            low[i] = std::min(low[i], p[i]);
            high[i] = std::max(high[i], p[i]);
        }
    }
    ASSERT_GT(points, 1000);
    std::istringstream words(contents("seen.txt"));
    int files = 0;
    for (std::string line; std::getline(words, line);)
    {
        int vertices = 0, edges = 0;
        double x[2], y[2], z[2];
        if (std::sscanf(line.c_str(), "seen %d %d %lf %lf %lf %lf %lf %lf", &vertices, &edges, &x[0], &x[1], &y[0],
                        &y[1], &z[0], &z[1]) != 8)
            continue;
        ++files;
        EXPECT_EQ(vertices, points);
        EXPECT_EQ(edges, points / 8 * 7);
        EXPECT_NEAR(x[0], low[0], 2e-5);
        EXPECT_NEAR(z[0], low[1], 2e-5) << "height";
        EXPECT_NEAR(z[1], high[1], 2e-5) << "height";
        EXPECT_NEAR(y[1], -low[2], 2e-5) << "the back of the head";
    }
    EXPECT_EQ(files, 2) << contents("seen.txt") << contents("seen.err");
}

TEST_F(Commands, exports_that_cannot_be_say_why_and_leave_no_file)
{
    write("named.toml", "[interpolation]\nstrands = 200\n[grid]\nresolution = 16\n[[region]]\nname = \"left side\"\n"
                        "where = \"front\"\nstrand.length = 0.1\n");
    const struct
    {
        const char *arguments, *says;
    } refused[] = {{"small.toml -o x.fbx", "the end of the name says what is written"},
                   {"small.toml -o x.abc --for cinema", "--for cinema: expected one of unreal"},
                   {"small.toml -o x.obj --curve catmull_rom", "holds straight pieces only"},
                   {"small.toml -o x.abc --curve round", "--curve round: expected linear or catmull_rom"},
                   {"small.toml -o x.tfx --points 20", "4, 8, 16, 32 or 64"},
                   {"small.toml -o x.abc --points 1", "--points 1: expected 2"},
                   {"small.toml -o x.obj --frames 0:3", "holds one pose"},
                   {"small.toml -o x.abc --frames 3:0", "--frames 3:0"},
                   {"small.toml -o x.abc --strands all", "--strands all: expected drawn or guides"},
                   {"small.toml -o none/x.abc", "none/x.abc"},
                   {"small.toml -o x.abc --points 65536 --set interpolation.strands=20000", "ask for fewer --points"},
                   {"named.toml -o x.usda", "group 'left side': USD allows only the letters"}};
    for (const auto& [arguments, says] : refused)
    {
        const Result result = coif(std::string("export ") + arguments);
        EXPECT_EQ(result.status, 1) << arguments;
        EXPECT_NE(result.err.find(says), std::string::npos) << arguments << ": " << result.err;
    }
    for (const auto& entry : fs::directory_iterator(folder))
        EXPECT_NE(entry.path().stem(), "x") << entry.path();
    EXPECT_EQ(coif("export small.toml -o x.abc --frames 0:2 --time 1").status, 2) << "one or the other";
    // No room: the program's files may have 1 MB, which the device's own kernels keep within.
    const std::string limited = "sh -c 'ulimit -f 2000; trap \"\" XFSZ; exec \"$0\" \"$@\"'";
    const Result full = coif("export small.toml -o x.usda --time 0 --set interpolation.strands=3000", limited);
    EXPECT_EQ(full.status, 1);
    EXPECT_NE(full.err.find("x.usda: cannot be written: File too large; make room"), std::string::npos) << full.err;
    EXPECT_FALSE(fs::exists(folder / "x.usda"));
}

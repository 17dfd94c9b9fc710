// `coif advise` without a device: which features a style has and lacks, how guides are compared, and the file that
// --apply writes.
#include "app/advise/differences.h"
#include "app/advise/features.h"
#include "app/advise/lean.h"
#include "app/table.h"
#include "tests/host/scratch.h"

#include <algorithm>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;

Hairstyle styled(const std::vector<std::string>& sets)
{
    Hairstyle style;
    for (const std::string& set : sets)
        assign(style, set);
    return style;
}

const Feature* find(const std::vector<Feature>& features, const std::string& name)
{
    const auto found = std::ranges::find(features, name, &Feature::name);
    return found == features.end() ? nullptr : &*found;
}

std::string change(const Hairstyle& style, const std::vector<Feature>& features, const std::string& name)
{
    const Feature* feature = find(features, name);
    return feature ? changes_text(style, feature->style) : "none";
}

TEST(AdviseFeatures, what_is_used_is_switched_off_or_stepped_down)
{
    Hairstyle style = styled({"forces.wind=[3,0,0]", "wave.normal_amplitude=0.01", "solver.rate=120",
                              "solver.substeps=4", "look.width=0.001"});
    style.host.colliders.push_back({});
    const std::vector<Feature> used = used_features(style, false);
    const auto said = [&](const char* name) { return change(style, used, name); };
    EXPECT_EQ(said("repulsion"), "forces.repulsion = 0.0");
    EXPECT_EQ(said("self-shadow"), "look.self_shadow = 0.0");
    EXPECT_EQ(said("friction"), "forces.friction = 0.0");
    EXPECT_EQ(said("bending"), "bending.droop = 10000.0");
    EXPECT_EQ(said("wind"), "forces.wind = [0.0, 0.0, 0.0]");
    EXPECT_EQ(said("gusts"), "forces.turbulence = 0.0");
    EXPECT_EQ(said("waves"), "wave.normal_amplitude = 0.0");
    EXPECT_EQ(said("colliders"), "collider = 0 of them");
    EXPECT_EQ(said("shape of the head"), "head.contact = \"spheres\"");
    EXPECT_EQ(said("nodes"), "strand.nodes = 11");
    EXPECT_EQ(said("grid"), "grid.resolution = 32");
    EXPECT_EQ(said("time steps"), "solver.rate = 60.0");
    EXPECT_EQ(said("substeps at least"), "solver.substeps = 2");
    EXPECT_EQ(said("substeps"), "solver.courant = 1.8");
    EXPECT_EQ(said("drawn strands"), "interpolation.strands = 2048, look.width = 0.002");
    EXPECT_EQ(said("sweeps"), "none") << "pbd's";
    for (const Feature& feature : used)
    {
        EXPECT_FALSE(feature.lacked);
        EXPECT_NE(changes_text(style, feature.style), "") << feature.name;
    }
}

TEST(AdviseFeatures, what_does_nothing_is_not_used)
{
    const Hairstyle calm = styled({"forces.repulsion=0", "look.self_shadow=0"});
    EXPECT_EQ(find(used_features(calm, false), "grid"), nullptr) << "nothing reads it";
    EXPECT_EQ(find(used_features(calm, false), "blur of the grid"), nullptr);
    EXPECT_EQ(find(used_features(calm, false), "gusts"), nullptr) << "there is no wind";
    EXPECT_NE(find(used_features(calm, true), "gusts"), nullptr) << "the motion brings some";
    EXPECT_EQ(find(used_features(calm, false), "waves"), nullptr);
    EXPECT_EQ(find(used_features(calm, false), "colliders"), nullptr);
    const Hairstyle pbd = styled({"solver.kind=pbd"});
    EXPECT_EQ(find(used_features(pbd, false), "friction"), nullptr);
    EXPECT_EQ(change(pbd, used_features(pbd, false), "bending"), "solver.bending = 0.0");
    EXPECT_EQ(change(pbd, used_features(pbd, false), "sweeps"), "solver.iterations = 5");
}

TEST(AdviseFeatures, what_defaults_have_and_the_style_has_not_is_lacked)
{
    const Hairstyle style = styled({"forces.repulsion=0", "forces.friction=0", "grid.resolution=16"});
    const std::vector<Feature> lacked = lacked_features(style, false);
    EXPECT_EQ(change(style, lacked, "repulsion"), "forces.repulsion = 0.4");
    EXPECT_EQ(change(style, lacked, "friction"), "forces.friction = 0.3");
    EXPECT_EQ(change(style, lacked, "nodes"), "strand.nodes = 24");
    EXPECT_EQ(change(style, lacked, "substeps"), "solver.courant = 0.5");
    EXPECT_EQ(change(style, lacked, "grid"), "grid.resolution = 32");
    EXPECT_EQ(find(lacked, "self-shadow"), nullptr) << "it has that";
    EXPECT_EQ(find(lacked, "waves"), nullptr) << "nobody expects those";
    EXPECT_TRUE(std::ranges::all_of(lacked, &Feature::lacked));
}

TEST(AdviseFeatures, a_head_goes_from_its_shape_to_spheres_to_a_ball)
{
    const char* name = "shape of the head";
    const Hairstyle style, spheres = styled({"head.contact=spheres"});
    const Feature first = *find(used_features(style, false), name);
    EXPECT_EQ(changes_text(style, first.style), "head.contact = \"spheres\"");
    const std::string ball = "head.spheres = \"\"";
    EXPECT_EQ(changes_text(first.style, further(first).style), ball);
    EXPECT_EQ(changes_text(further(first).style, further(further(first)).style), "");
    EXPECT_EQ(change(spheres, used_features(spheres, false), name), ball);
    EXPECT_EQ(change(spheres, lacked_features(spheres, false), name), "head.contact = \"grid\"");
    EXPECT_EQ(find(lacked_features(style, false), name), nullptr);
}

TEST(AdviseFeatures, counts_step_down_to_an_end)
{
    const Hairstyle style;
    Feature nodes = *find(used_features(style, false), "nodes");
    std::vector<int> steps;
    for (int i = 0; i < 9; ++i, nodes = further(nodes))
        steps.push_back(nodes.style.params.strand_nodes);
    EXPECT_EQ(std::vector<int>(steps.begin(), steps.begin() + 4), (std::vector<int>{11, 7, 6, 6}));
    const Feature shadow = *find(used_features(style, false), "self-shadow");
    EXPECT_EQ(changes_text(shadow.style, further(shadow).style), "") << "off is off";
}

TEST(AdviseFeatures, changes_add_up)
{
    const Hairstyle style, fewer = styled({"strand.nodes=8"}), still = styled({"forces.repulsion=0"});
    const Hairstyle both = with_changes(with_changes(style, style, fewer), style, still);
    EXPECT_EQ(changes_text(style, both), "strand.nodes = 8, forces.repulsion = 0.0");
}

// A strand a guide, straight down or bent by a right angle in the middle; shifted along x.
std::vector<float> guides(int count, int nodes, bool bent, float aside)
{
    std::vector<float> values(size_t((count + LANES - 1) / LANES * LANES) * size_t(nodes) * 3);
    for (int s = 0; s < count; ++s)
        for (int k = 0; k < nodes; ++k)
        {
            const float along = float(k - 1) / float(nodes - 2), over = bent ? std::max(0.0f, along - 0.5f) : 0.0f;
            values[size_t(strand_value(s, k, 0, nodes))] = aside + over;
            values[size_t(strand_value(s, k, 1, nodes))] = over - along;
        }
    return values;
}

TEST(AdviseDifferences, guides_are_compared_at_equal_lengths)
{
    const auto of = [](const std::vector<float>& a, int nodes_a, const std::vector<float>& b, int nodes_b)
    { return apart(a.data(), nodes_a, b.data(), nodes_b, 20); };
    const std::vector<float> eight = guides(20, 8, false, 0.0f), sixteen = guides(20, 16, false, 0.0f);
    EXPECT_EQ(of(eight, 8, eight, 8), 0.0);
    EXPECT_NEAR(of(eight, 8, sixteen, 16), 0.0, 1e-7);
    EXPECT_NEAR(of(eight, 8, guides(20, 16, false, 0.25f), 16), 0.25, 1e-6);
    EXPECT_NEAR(of(guides(20, 10, true, 0.0f), 10, guides(20, 18, true, 0.0f), 18), 0.0, 1e-6) << "a node at the bend";
    EXPECT_EQ(of(sixteen, 16, guides(20, 8, true, 0.0f), 8), of(guides(20, 8, true, 0.0f), 8, sixteen, 16));
    EXPECT_GT(of(sixteen, 16, guides(20, 8, true, 0.0f), 8), 0.1);
}

TEST(AdviseLean, goes_beside_the_file_or_for_a_preset_into_the_current_folder)
{
    const Scratch scratch;
    const fs::path file = scratch.write("mine.toml", "");
    EXPECT_EQ(lean_path(file.string(), file), scratch / "mine.lean.toml");
    EXPECT_EQ(lean_path("bob", "/somewhere/hairstyles/bob.toml"), "bob.lean.toml");
}

TEST(AdviseLean, keeps_comments_and_is_written_again_only_while_it_is_its_own)
{
    const Scratch scratch;
    const std::string text = "# mine\n[forces]\nrepulsion = 1.0 # fluffy\n";
    Hairstyle style = parse_hairstyle(text, scratch / "mine.toml");
    const fs::path target = scratch / "mine.lean.toml";
    assign(style, "forces.repulsion=0");
    write_lean(style, target);
    const std::string written = test::bytes_of(target);
    EXPECT_EQ(written.rfind("# mine\n[forces]\nrepulsion = 0.0 # fluffy\n", 0), 0u) << written;
    EXPECT_EQ(load_hairstyle(target).params.forces_repulsion, 0.0f);

    assign(style, "forces.repulsion=0.5");
    write_lean(style, target); // its own
    EXPECT_EQ(load_hairstyle(target).params.forces_repulsion, 0.5f);

    scratch.write("mine.lean.toml", test::bytes_of(target) + "[grid]\nblur = 2\n");
    EXPECT_NE(error_of([&] { write_lean(style, target); }).find("is there already"), std::string::npos);
    scratch.write("mine.lean.toml", "# by hand\n" + written);
    EXPECT_NE(error_of([&] { check_lean(target); }).find("name another file with -o"), std::string::npos);
    EXPECT_NE(error_of([&] { check_lean(scratch / "none" / "a.toml"); }).find("is its folder there, and writable?"),
              std::string::npos);
    EXPECT_NE(error_of([&] { check_lean(scratch.folder()); }).find("is there already"), std::string::npos);
}

TEST(Table, columns_are_as_wide_as_they_need)
{
    EXPECT_EQ(aligned({{"a", "1"}, {}, {"word", "20", "more"}}, {0, 2}), "a      1\n\nword  20  more\n");
}

} // namespace
} // namespace coif

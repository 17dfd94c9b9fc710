// How hair falls to rest before it is first seen: all the way, and no longer than it gets calmer.
#include "app/options.h"
#include "sim/simulation.h"
#include "tests/editor_window.h"
#include "tests/on_device.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace coif
{
namespace
{

Hairstyle few_drawn(Hairstyle style)
{
    style.params.interpolation_strands = 200;
    return style;
}

// What is told while the style falls.
std::vector<double> shares(const Hairstyle& style)
{
    std::vector<double> told;
    const Simulation simulation(test_device(), style, [&](double share) { told.push_back(share); });
    return told;
}

TEST(Draping, its_progress_rises_from_nothing_to_all)
{
    for (const char* hold : {"0", "1"})
    {
        Hairstyle style = few_drawn({});
        assign(style, std::string("bending.hold=") + hold);
        const std::vector<double> told = shares(style);
        ASSERT_GE(told.size(), 3u);
        EXPECT_EQ(told.front(), 0.0);
        EXPECT_EQ(told.back(), 1.0);
        EXPECT_TRUE(std::ranges::is_sorted(told));
        EXPECT_LT(told[told.size() - 2], 1.0);
    }
    Hairstyle swept = few_drawn({});
    assign(swept, "solver.kind=pbd");
    EXPECT_TRUE(shares(swept).empty()) << "it does not fall before it is seen";
}

// All the steps there can be are two times twenty looks, and two words about the ends.
TEST(Draping, ends_where_hair_gets_no_calmer)
{
    Hairstyle style = few_drawn(load_hairstyle(find_style("windswept")));
    EXPECT_LT(shares(style).size(), 24u) << "gusts will move it anyhow";
    assign(style, "forces.turbulence=0");
    EXPECT_LT(shares(style).size(), 40u) << "it flutters, if little";
}

// The undercut's scalp has roots in the hollow behind the ears, which the head's grid fills: a millimetre deep.
TEST(Draping, hair_whose_roots_lie_inside_the_head_comes_to_rest)
{
    Simulation simulation(test_device(), few_drawn(load_hairstyle(find_style("undercut"))));
    for (int i = 0; i < 240 && !simulation.solver().asleep(); ++i)
        simulation.step(simulation.hand());
    EXPECT_TRUE(simulation.solver().asleep());
}

// Clumped curls push each other: one gives way slowly at first.
TEST(Draping, hair_that_gives_way_late_has_done_so_before_it_is_seen)
{
    Simulation simulation(test_device(), few_drawn(load_hairstyle(find_style("curly"))));
    double fastest = 0.0;
    for (int i = 0; i < 60; ++i)
    {
        simulation.step(simulation.hand());
        fastest = std::max(fastest, simulation.solver().fastest());
    }
    EXPECT_LT(fastest, 0.01) << "m/s";
}

TEST(Draping, long_hair_falls_all_the_way)
{
    Hairstyle style = few_drawn({});
    for (const char* set : {"strand.length=1.5", "root.lift=10", "bending.droop=1000", "forces.drag=15",
                            "forces.repulsion=0", "forces.friction=0"})
        assign(style, set);
    Simulation simulation(test_device(), style);
    const StrandShapes before = simulation.shapes();
    simulation.settle(3.0);
    const StrandShapes after = simulation.shapes();
    double sum = 0.0;
    for (int s = 0; s < after.strands(); ++s)
    {
        const size_t tip = size_t((s + 1) * after.nodes - 1);
        sum += double(glm::distance(after.position[tip], before.position[tip]));
    }
    EXPECT_LT(sum / after.strands(), 0.02 * 1.5);
}

using DrapingInTheEditor = test::EditorWindow;

TEST_F(DrapingInTheEditor, many_guides_are_told_as_they_fall)
{
    const int earlier = editor->waiting().shown();
    std::ofstream("many.toml") << "[interpolation]\nstrands = 300\nrefine = 2\n[bending]\nhold = 0.5\n";
    editor->open("many.toml");
    frames(2);
    EXPECT_GT(editor->simulation().solver().groom().guides, 2000);
    EXPECT_GT(editor->waiting().shown(), earlier);
    shoot("many guides");
}

} // namespace
} // namespace coif

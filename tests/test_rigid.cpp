// Hair too stiff to bend is not solved for: when that is so, and that it goes where it would have gone.
#include "sim/health.h"
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>

namespace coif
{
namespace
{

Hairstyle stiff_style(std::initializer_list<const char*> sets)
{
    Hairstyle style;
    for (const char* set :
         {"bending.droop=0.05", "strand.length=0.06", "root.lift=15", "interpolation.strands=60", "grid.resolution=16"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

bool is_rigid(Simulation& simulation)
{
    simulation.solver().take_times();
    simulation.solver().keep_awake();
    simulation.step(simulation.hand());
    const PassTimes times = simulation.solver().take_times();
    return std::any_of(times.begin(), times.end(), [](const auto& t) { return t.first == "simulate_rigid"; });
}

TEST(Rigid, IsWhatStandsClearOfTheHeadAndHardlyBends)
{
    struct
    {
        std::initializer_list<const char*> sets;
        bool rigid;
        const char* why;
    } const cases[] = {
        {{}, true, "stiff, on the head's grid"},
        {{"head.contact=spheres", "root.lift=0"}, true, "stiff, on the head's spheres"},
        {{"bending.droop=0.2"}, false, "it bends"},
        {{"bending.modulus=100"}, false, "a material says how much"},
        {{"forces.wind=[50, 0, 0]"}, false, "wind bends it"},
        {{"forces.gravity=8"}, false, "its weight bends it"},
        {{"root.lift=95", "strand.length=0.2", "root.lift_variation=0"},
         true,
         "what would go through the head was draped over it"},
    };
    for (const auto& c : cases)
    {
        Simulation simulation(test_device(), stiff_style(c.sets));
        EXPECT_EQ(is_rigid(simulation), c.rigid) << c.why;
        EXPECT_LT(measure_health(simulation.solver(), simulation.params(), false).penetration_max, 1e-3) << c.why;
    }
}

TEST(Rigid, IsNoLongerSoOnceSomethingElseMayBeMet)
{
    Simulation simulation(test_device(), stiff_style({}));
    EXPECT_TRUE(is_rigid(simulation));
    Hairstyle style = stiff_style({});
    style.host.colliders = {{{0.0f, 0.3f, 0.0f}, 0.1f, false}};
    simulation.set_style(style);
    EXPECT_FALSE(is_rigid(simulation));
    style.host.colliders[0].on_head = true;
    simulation.set_style(style);
    EXPECT_TRUE(is_rigid(simulation));
    style.host.colliders[0].center = {0.0f, 0.18f, 0.0f}; // where strands stand
    simulation.set_style(style);
    EXPECT_FALSE(is_rigid(simulation));
}

TEST(Rigid, GoesWhereTheSolverWouldHaveTakenIt)
{
    Simulation rigid(test_device(), stiff_style({})), solved(test_device(), stiff_style({"bending.droop=0.1"}));
    ASSERT_TRUE(is_rigid(rigid));
    ASSERT_FALSE(is_rigid(solved));
    for (Simulation* simulation : {&rigid, &solved})
    {
        simulation->play(find_motion("turn"));
        for (int i = 0; i < 60; ++i)
            simulation->step(simulation->hand());
    }
    const Groom& groom = rigid.solver().groom();
    const Mapped a = rigid.solver().guide_positions(), b = solved.solver().guide_positions();
    double most = 0.0, moved = 0.0;
    for (int s = 0; s < groom.guides; ++s)
    {
        const glm::dvec3 tip = vector_at(a.as<float>(), s, groom.nodes - 1, groom.nodes);
        most = std::max(most, glm::distance(tip, vector_at(b.as<float>(), s, groom.nodes - 1, groom.nodes)));
        moved = std::max(moved, glm::length(tip));
    }
    // Held level, a tip droops by Gamma / 8 of its length; a turn of the head takes a few times its weight.
    EXPECT_LT(most, 4.0 * 0.1 / 8.0 * double(groom.longest));
    EXPECT_GT(moved, 0.1);
}

} // namespace
} // namespace coif

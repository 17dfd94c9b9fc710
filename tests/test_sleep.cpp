// Hair at rest costs next to nothing: blocks of strands sleep, and wake for whatever would move them.
#include "kernels/sleep.h"
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace coif
{
namespace
{

Hairstyle style_of(std::initializer_list<const char*> sets)
{
    Hairstyle style;
    for (const char* set : {"head.mesh=", "interpolation.strands=60", "grid.resolution=20", "look.self_shadow=0"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

void step(Simulation& simulation, int steps)
{
    for (int i = 0; i < steps; ++i)
        simulation.step(simulation.hand());
}

std::vector<glm::dvec3> nodes_of(const Simulation& simulation)
{
    return nodes_in(test_device(), simulation.solver().buffers().at("position"), simulation.solver().groom());
}

// Until blocks sleep; the whole of the hair would a little later (Solver::asleep()). Before that it is kept awake for
// some seconds, in which the last strand comes to rest.
void let_sleep(Simulation& simulation)
{
    for (int i = 0; i < 180; ++i)
    {
        simulation.solver().keep_awake();
        step(simulation, 1);
    }
    EXPECT_EQ(simulation.solver().blocks_awake(), simulation.solver().groom().blocks);
    step(simulation, 40);
    EXPECT_FALSE(simulation.solver().asleep());
    EXPECT_LE(simulation.solver().blocks_awake(), simulation.solver().groom().blocks / 8);
}

// Strands of blocks that sleep.
std::vector<int> sleepers(const Simulation& simulation)
{
    const Solver& solver = simulation.solver();
    const std::vector<float> still =
        read<float>(test_device(), solver.buffers().at("still"), size_t(solver.groom().blocks) * LANES);
    std::vector<int> found;
    for (int s = 0; s < solver.groom().guides; ++s)
    {
        const auto block = still.begin() + s / LANES * LANES;
        if (*std::min_element(block, block + LANES) >= SLEEP_AFTER)
            found.push_back(s);
    }
    return found;
}

// Of these strands, how far a node is from where it is in the other.
double farthest(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b, const std::vector<int>& strands,
                int nodes)
{
    double most = 0.0;
    for (const int s : strands)
        for (int i = s * nodes; i < (s + 1) * nodes; ++i)
            most = std::max(most, glm::distance(a[size_t(i)], b[size_t(i)]));
    return most;
}

TEST(Sleep, HairAtRestCostsNextToNothing)
{
    Simulation simulation(test_device(), style_of({}));
    ASSERT_GT(simulation.solver().groom().blocks, 4);
    let_sleep(simulation);
    const std::vector<glm::dvec3> before = nodes_of(simulation);
    const std::vector<int> asleep = sleepers(simulation);
    step(simulation, 1);
    EXPECT_EQ(farthest(nodes_of(simulation), before, asleep, simulation.solver().groom().nodes), 0.0);
}

// Each of them acts in the very next step, and moves nothing by more than it would have.
TEST(Sleep, WhateverMovesHairWakesAllOfIt)
{
    struct Cause
    {
        const char* name;
        void (*happen)(Simulation&);
    };
    const auto set = [](Simulation& simulation, const char* what)
    {
        Hairstyle style = simulation.style();
        assign(style, what);
        simulation.set_style(style);
    };
    static const auto change = set;
    for (const Cause& cause : {Cause{"the head moves",
                                     [](Simulation& s)
                                     {
                                         Pose hand = s.hand();
                                         hand.origin.x += 1e-4;
                                         s.step(hand);
                                     }},
                               Cause{"the head turns",
                                     [](Simulation& s)
                                     {
                                         Pose hand = s.hand();
                                         hand.turn = glm::angleAxis(1e-3, glm::dvec3(0.0, 1.0, 0.0));
                                         s.step(hand);
                                     }},
                               Cause{"wind blows",
                                     [](Simulation& s)
                                     {
                                         change(s, "forces.wind=[1, 0, 0]");
                                         step(s, 1);
                                     }},
                               Cause{"a parameter changes",
                                     [](Simulation& s)
                                     {
                                         change(s, "forces.drag=2.5");
                                         step(s, 1);
                                     }},
                               Cause{"an obstacle moves",
                                     [](Simulation& s)
                                     {
                                         s.solver().set_colliders({{glm::vec3(0.3f, 0.0f, 0.0f), 0.01f, false, {}}});
                                         step(s, 1);
                                     }},
                               Cause{"it is reset", [](Simulation& s)
                                     {
                                         s.reset();
                                         step(s, 1);
                                     }}})
    {
        Simulation simulation(test_device(), style_of({}));
        const int blocks = simulation.solver().groom().blocks;
        let_sleep(simulation);
        cause.happen(simulation);
        EXPECT_EQ(simulation.solver().blocks_awake(), blocks) << cause.name;
    }
}

TEST(Sleep, NothingJumpsWhereItWakes)
{
    Simulation simulation(test_device(), style_of({}));
    let_sleep(simulation);
    const std::vector<glm::dvec3> before = nodes_of(simulation);
    const std::vector<int> slept = sleepers(simulation);
    simulation.solver().keep_awake();
    step(simulation, 1);
    EXPECT_EQ(simulation.solver().blocks_awake(), simulation.solver().groom().blocks);
    // As fast as it was when it fell asleep: a two-hundredth of the longest strand a second.
    const double moved = farthest(nodes_of(simulation), before, slept, simulation.solver().groom().nodes);
    EXPECT_LE(moved, double(SLEEP_SPEED) / 60.0 * double(simulation.solver().groom().longest));
    EXPECT_GT(moved, 0.0);
}

TEST(Sleep, OtherHairWakesABlockThatItComesToPush)
{
    Simulation simulation(test_device(), style_of({"forces.repulsion=1"}));
    Solver& solver = simulation.solver();
    const Groom& groom = solver.groom();
    let_sleep(simulation);
    // All strands of the first block come to lie about one of the last.
    std::vector<float> position = read<float>(test_device(), solver.buffers().at("position"),
                                              size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3);
    const int last = groom.guides - 1;
    for (int s = 0; s < LANES; ++s)
        for (int k = 2; k < groom.nodes; ++k)
            for (int axis = 0; axis < 3; ++axis)
                position[size_t(strand_value(s, k, axis, groom.nodes))] =
                    position[size_t(strand_value(last, k, axis, groom.nodes))] + 0.001f * float(s);
    write(test_device(), solver.buffers().at("position"), position);
    const auto sleeps = [&] { return std::ranges::count(sleepers(simulation), last) == 1; };
    ASSERT_TRUE(sleeps());
    step(simulation, 1); // where they lie now is known after it
    EXPECT_TRUE(sleeps());
    step(simulation, 1);
    EXPECT_FALSE(sleeps());
}

// What is stirred comes to rest where it would have, had none of it slept: to a hundredth of its length.
TEST(Sleep, HairThatSleptLiesWhereItWouldHave)
{
    for (const char* repulsion : {"forces.repulsion=0", "forces.repulsion=1"})
    {
        const auto lies = [&](bool may_sleep, int& awake)
        {
            Simulation simulation(test_device(), style_of({repulsion}));
            simulation.solver().let_blocks_sleep(may_sleep);
            Pose hand = simulation.hand();
            for (int i = 0; i < 30; ++i)
            {
                hand.origin.x = 0.05 * std::sin(0.4 * i);
                simulation.step(hand);
            }
            for (int i = 0; i < 600; ++i)
            {
                if (!may_sleep)
                    simulation.solver().keep_awake();
                simulation.step(hand);
            }
            awake = simulation.solver().blocks_awake();
            return nodes_of(simulation);
        };
        int awake = 0, all = 0;
        const std::vector<glm::dvec3> slept = lies(true, awake), moved = lies(false, all);
        const double longest = double(Simulation(test_device(), style_of({repulsion})).solver().groom().longest);
        double most = 0.0;
        for (size_t i = 0; i < slept.size(); ++i)
            most = std::max(most, glm::distance(slept[i], moved[i]));
        EXPECT_LE(most, 0.01 * longest) << repulsion;
        EXPECT_LE(awake, all / 8) << repulsion;
    }
}

TEST(Sleep, AllWidthsSleep)
{
    for (const int width : {16, 8, 1})
    {
        const Device device = with_width(width);
        Simulation simulation(device, style_of({}));
        let_sleep(simulation);
    }
}

TEST(Sleep, IsTheSameEachTime)
{
    const auto lies = []
    {
        Simulation simulation(test_device(), style_of({"forces.repulsion=1"}));
        step(simulation, 60);
        return std::pair(bytes_of(test_device(), simulation.solver().buffers().at("position")),
                         bytes_of(test_device(), simulation.solver().buffers().at("still")));
    };
    EXPECT_EQ(lies(), lies());
}

} // namespace
} // namespace coif

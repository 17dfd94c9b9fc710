// How a whole style lives in time: bytes that hang on nothing but the input, frames that cut time in any way, steps
// that are none.
#include "sim/error.h"
#include "sim/health.h"
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdlib>

namespace coif
{
namespace
{

// Coif's own scalp and the spheres of its head, with everything switched on and a small grid.
Hairstyle small_style(const std::string& sets = {})
{
    Hairstyle style;
    for (const char* set : {"head.mesh=", "interpolation.strands=60", "grid.resolution=20", "forces.wind=[3, 0, 1]",
                            "forces.repulsion=1", "wave.normal_amplitude=0.004"})
        assign(style, set);
    for (size_t begin = 0; begin < sets.size();)
    {
        const size_t end = std::min(sets.find(';', begin), sets.size());
        assign(style, sets.substr(begin, end - begin));
        begin = end + 1;
    }
    return style;
}

using Bytes = std::map<std::string, std::vector<uint8_t>>;

// What a step and a draw leave behind.
Bytes results(const Simulation& simulation)
{
    Bytes bytes;
    for (const char* name :
         {"position", "velocity", "resets", "density", "gradient", "drawn_position", "drawn_frame", "depth"})
        bytes[name] = bytes_of(test_device(), simulation.solver().buffers().at(name));
    return bytes;
}

// Names of the buffers that differ.
std::string differing(const Bytes& a, const Bytes& b)
{
    std::string names;
    for (const auto& [name, bytes] : a)
        if (bytes != b.at(name))
            names += name + " ";
    return names;
}

// What light needs besides, where the look has a volume of its own, would be swept for nobody.
TEST(Time, OnlyTheThesisLightAsksForTheGridOfShadows)
{
    for (const char* repulsion : {"forces.repulsion=0", "forces.repulsion=1"})
    {
        SCOPED_TRACE(repulsion);
        const std::string sets = std::string("look.level=auto;") + repulsion;
        Simulation other(test_device(), small_style(sets));
        Simulation thesis(test_device(), small_style(sets + ";look.level=kajiya_kay"));
        for (Simulation* simulation : {&other, &thesis})
        {
            simulation->solver().take_times();
            simulation->step(simulation->hand());
            simulation->solver().draw();
        }
        const auto ran = [](Simulation& simulation)
        {
            std::set<std::string> passes;
            for (const auto& [pass, ms] : simulation.solver().take_times())
                passes.insert(pass);
            return passes;
        };
        const std::set<std::string> by_other = ran(other), by_thesis = ran(thesis);
        EXPECT_TRUE(by_thesis.contains("transmittance"));
        EXPECT_FALSE(by_other.contains("transmittance"));
        EXPECT_EQ(by_other.contains("clear_density"), std::string(repulsion) == "forces.repulsion=1");
        EXPECT_EQ(other.solver().optical_depth().bytes(), 0u);

        // Asked for between two steps it is as if it had always been.
        Hairstyle style = other.style();
        assign(style, "look.level=kajiya_kay");
        other.set_style(style);
        other.solver().draw();
        EXPECT_EQ(differing(results(other), results(thesis)), "");
        // Colours that tell something else are lit as the thesis does it, whatever the level.
        for (const char* set : {"look.level=auto", "render.colors=stretch"})
            assign(style, set);
        other.set_style(style);
        EXPECT_GT(other.solver().optical_depth().bytes(), 0u);
    }
}

// A light that is dragged about it is followed by what shades it, and wakes it only for the thesis' own shadows.
TEST(Time, HairThatSleepsIsNotWokenByALightThatItsStepsDoNotRead)
{
    for (const char* level : {"auto", "kajiya_kay"})
    {
        Simulation simulation(test_device(),
                              small_style(std::string("forces.wind=[0, 0, 0];forces.repulsion=0;look.level=") + level));
        for (int i = 0; i < 600 && (i < 2 || !simulation.solver().asleep()); ++i)
            simulation.step(simulation.hand());
        ASSERT_TRUE(simulation.solver().asleep());
        simulation.solver().draw();
        simulation.solver().draw();
        const long drawings = simulation.solver().drawings();
        Hairstyle style = simulation.style();
        assign(style, "look.light_direction=[-1, 0.2, 0.3]");
        simulation.set_style(style);
        simulation.step(simulation.hand());
        simulation.solver().draw();
        const bool woken = std::string(level) == "kajiya_kay";
        EXPECT_EQ(simulation.solver().asleep(), !woken) << level;
        EXPECT_EQ(simulation.solver().drawings() > drawings, woken) << level;
        assign(style, "bending.droop=3");
        simulation.set_style(style);
        simulation.step(simulation.hand());
        EXPECT_FALSE(simulation.solver().asleep()) << level;
    }
}

TEST(Time, EqualInputGivesEqualBytes)
{
    for (const char* kind : {"solver.kind=direct", "solver.kind=pbd"})
    {
        Bytes bytes[2];
        for (Bytes& b : bytes)
        {
            Simulation simulation(test_device(), small_style(kind));
            simulation.play(find_motion("shake"));
            for (int i = 0; i < 60; ++i)
                simulation.step(simulation.hand());
            simulation.solver().draw();
            b = results(simulation);
        }
        EXPECT_EQ(differing(bytes[0], bytes[1]), "") << kind;
    }
}

TEST(Time, AScriptGivesEqualBytesAtAnyFrameRate)
{
    const std::string pbd = "solver.kind=pbd;solver.iterations=4";
    for (const auto& [motion, sets] : {std::pair("shake", pbd), std::pair("shake", std::string()),
                                       std::pair("gust", std::string()), std::pair("teleport", std::string())})
    {
        Bytes reference;
        for (const int fps : {60, 10, 30, 144})
        {
            Simulation simulation(test_device(), small_style(sets));
            simulation.play(find_motion(motion));
            int taken = 0;
            for (int frame = 0; frame < 2 * fps; ++frame)
                taken += simulation.advance(1.0 / fps, simulation.hand(), 1000);
            EXPECT_EQ(taken, 120) << motion << " at " << fps;
            EXPECT_EQ(simulation.dropped(), 0);
            simulation.solver().draw();
            if (reference.empty())
                reference = results(simulation);
            EXPECT_EQ(differing(reference, results(simulation)), "") << motion << " at " << fps << " " << sets;
        }
    }
}

TEST(Time, AStepLongerThanASixtiethIsCut)
{
    // Repulsion sees the density of the last whole step, so it is left out of the comparison.
    Simulation fast(test_device(), small_style("forces.repulsion=0"));
    Simulation slow(test_device(), small_style("forces.repulsion=0;solver.rate=30"));
    for (Simulation* simulation : {&fast, &slow})
        simulation->play(find_motion("shake"));
    EXPECT_DOUBLE_EQ(slow.step_seconds(), 1.0 / 30.0);
    for (int i = 0; i < 30; ++i)
    {
        slow.step(slow.hand());
        fast.step(fast.hand());
        fast.step(fast.hand());
        EXPECT_FLOAT_EQ(slow.solver().info().substep, 1.0f / 60.0f);
    }
    EXPECT_NEAR(slow.time(), fast.time(), 1e-12);
    const std::vector<float> a =
        read<float>(test_device(), fast.solver().buffers().at("position"), fast.solver().guide_positions().bytes() / 4);
    const std::vector<float> b = read<float>(test_device(), slow.solver().buffers().at("position"), a.size());
    for (size_t i = 0; i < a.size(); ++i)
        ASSERT_NEAR(a[i], b[i], 1e-5); // times of substeps are sums, rounded apart by 1e-16 s

    Simulation quick(test_device(), small_style("solver.rate=240"));
    quick.step(quick.hand());
    EXPECT_FLOAT_EQ(quick.solver().info().substep, 1.0f / 240.0f);
}

TEST(Time, AStepOfNoTimeIsNoStep)
{
    Simulation simulation(test_device(), small_style());
    simulation.play(find_motion("shake"));
    for (int i = 0; i < 20; ++i)
        simulation.step(simulation.hand());
    const Bytes before = results(simulation);
    for (const float seconds : {0.0f, -0.0f, -1.0f, NAN, -INFINITY})
    {
        simulation.solver().step({{simulation.solver().head(), simulation.time(), seconds}});
        EXPECT_EQ(differing(before, results(simulation)), "") << seconds << " s";
    }
    const long steps = simulation.steps();
    for (const double seconds : {0.0, -1.0, double(NAN), double(-INFINITY), double(INFINITY)})
        EXPECT_EQ(simulation.advance(seconds, simulation.hand(), 100), 0) << seconds << " s";
    EXPECT_EQ(simulation.steps(), steps);
    EXPECT_EQ(simulation.dropped(), 0);
    EXPECT_EQ(differing(before, results(simulation)), "");
    simulation.solver().step({});
    EXPECT_EQ(differing(before, results(simulation)), "") << "no substeps";
}

TEST(Time, StepsThatCannotBeTakenAreDroppedAndCounted)
{
    Simulation simulation(test_device(), small_style());
    Pose hand;
    hand.origin = {0.01, 0.0, 0.0};
    EXPECT_EQ(simulation.advance(0.5, hand, 4), 4);
    EXPECT_EQ(simulation.dropped(), 26);
    EXPECT_EQ(simulation.steps(), 4);
    EXPECT_EQ(simulation.solver().head().origin, hand.origin) << "the hand arrives with the last step";
    EXPECT_EQ(simulation.advance(0.4 / 60.0, hand, 4), 0);
    EXPECT_EQ(simulation.advance(0.7 / 60.0, hand, 4), 1) << "what is over waits";
    EXPECT_EQ(simulation.dropped(), 26);
}

TEST(Time, TheHandsWayIsSharedOutOverTheSteps)
{
    Simulation simulation(test_device(), small_style());
    Pose hand;
    hand.origin = {0.06, 0.0, 0.0};
    hand.turn = glm::angleAxis(0.5, glm::dvec3(0, 1, 0));
    EXPECT_EQ(simulation.advance(3.0 / 60.0, hand, 100), 3);
    // A third of the way in the last step.
    EXPECT_NEAR(simulation.solver().info().origin_move.x, 0.02, 1e-8);
    EXPECT_EQ(simulation.solver().head().origin, hand.origin);
    EXPECT_NEAR(std::abs(glm::dot(simulation.solver().head().turn, hand.turn)), 1.0, 1e-12);
}

TEST(Time, AScriptThatEndsLeavesTheHeadWhereItIs)
{
    Simulation simulation(test_device(), small_style());
    Motion motion;
    motion.seconds = 0.2;
    motion.ramps.push_back({Motion::X, 0.1, 0.0, 0.2});
    simulation.play(motion);
    for (int i = 0; i < 20; ++i)
        simulation.step(simulation.hand());
    EXPECT_FALSE(simulation.playing());
    EXPECT_NEAR(simulation.solver().head().origin.x, 0.1, 1e-9);
    EXPECT_EQ(simulation.solver().info().teleport, 0);
}

TEST(Time, ASimulationMayGoWhileItsStepsAreStillQueued)
{
    // As when the editor opens another style. What the queue has yet to read must outlive it. In a process of its own,
    // for where it does not the program crashes.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto drop = []
    {
        for (int i = 0; i < 10; ++i)
        {
            Simulation simulation(test_device(), small_style());
            for (int k = 0; k < 30; ++k)
                simulation.step(simulation.hand());
        }
        test_device().queue.finish();
        std::exit(0);
    };
    EXPECT_EXIT(drop(), testing::ExitedWithCode(0), "");
}

TEST(Time, GuidesOfAWholeHeadStayOutOfItInEveryMotion)
{
    // The head's spheres overlap, and guides leave them one after the other, in four rounds: where strands are dragged
    // over a crease between two, a push still undoes a little of another.
    for (const std::string& name : motion_names())
    {
        Simulation simulation(test_device(), small_style());
        simulation.settle(0.5);
        simulation.play(find_motion(name));
        double deepest = 0.0, drawn = 0.0;
        for (int i = 0; i < 90; ++i)
        {
            simulation.step(simulation.hand());
            if (i % 6)
                continue;
            simulation.solver().draw();
            const Health health = measure_health(simulation.solver(), simulation.style().params, true);
            EXPECT_TRUE(health.finite);
            deepest = std::max(deepest, health.penetration_max);
            drawn = std::max(drawn, health.drawn_penetration_max);
        }
        EXPECT_LE(deepest, 2e-4) << name;
        EXPECT_LE(drawn, 1e-4) << name;
        EXPECT_EQ(simulation.solver().resets(), std::vector<int>(size_t(simulation.solver().groom().guides), 0));
    }
}

} // namespace
} // namespace coif

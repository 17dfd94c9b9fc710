// What quality.tolerance makes of a style, and whether what it predicts is what is measured.
#include "app/options.h"
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <cmath>

namespace coif
{
namespace
{

Hairstyle preset(const char* name, const char* tolerance)
{
    Hairstyle style = load_hairstyle(find_style(name));
    assign(style, std::string("quality.tolerance=") + tolerance);
    return style;
}

TEST(Quality, ErrorsArePredictedWithinAFactorOfTwo)
{
    for (const char* name : {"bob", "curly", "brush", "pony_tail"})
        for (const char* tolerance : {"3", "0.5"})
        {
            const Simulation simulation(test_device(), preset(name, tolerance));
            const Quality& quality = simulation.quality();
            ASSERT_FALSE(quality.rungs.empty()) << name;
            // Another motion than the one that was tried, harder and softer ones.
            for (const char* motion : {"shake", "nod"})
            {
                const double measured = measure_time_error(test_device(), simulation.params(),
                                                           simulation.solver().groom(), find_motion(motion), 1.5);
                if (std::string(motion) == "shake")
                {
                    EXPECT_LT(measured, 2.0 * quality.time_error) << name << " at " << tolerance;
                    EXPECT_GT(measured, 0.5 * quality.time_error) << name << " at " << tolerance;
                }
                else
                    EXPECT_LT(measured, 2.0 * quality.time_error) << name << " at " << tolerance;
            }
            // Or it says that it cannot, as where a style pins its nodes; bob pins none.
            const bool met = quality.said.find("no less can be had") == std::string::npos;
            EXPECT_EQ(met, quality.predicted() <= 0.01 * std::atof(tolerance)) << name;
            EXPECT_TRUE(met || std::string(name) != "bob");
        }
}

TEST(Quality, ASmallerToleranceTakesMoreOfEverything)
{
    const Simulation coarse(test_device(), preset("bob", "5")), fine(test_device(), preset("bob", "0.1"));
    EXPECT_LT(coarse.params().strand_nodes, fine.params().strand_nodes);
    EXPECT_GT(coarse.params().solver_courant, fine.params().solver_courant);
    EXPECT_LT(coarse.params().grid_resolution, fine.params().grid_resolution);
    EXPECT_LT(coarse.params().smoothing_subdivisions, fine.params().smoothing_subdivisions);
    EXPECT_EQ(coarse.params().interpolation_refine, 0);
    EXPECT_EQ(fine.params().interpolation_refine, 1);
    const int few = coarse.solver().groom().guides, many = fine.solver().groom().guides;
    EXPECT_GT(many, 3 * few);
    EXPECT_NEAR(coarse.quality().guide_error * few, fine.quality().guide_error * many, 1e-9 * many);
}

TEST(Quality, WhatTheStyleSaysItselfIsPinnedEvenAtItsDefault)
{
    Hairstyle style = preset("bob", "5");
    for (const char* set : {"strand.nodes=16", "solver.courant=1", "interpolation.refine=0", "grid.resolution=64",
                            "smoothing.subdivisions=5", "solver.rate=60"})
        assign(style, set);
    const Simulation simulation(test_device(), style);
    Hairstyle live = style;
    live.params = simulation.params();
    for (const char* path : kTolerant)
        EXPECT_TRUE(same_value(live, style, *find_param(path))) << path;
    EXPECT_NE(simulation.quality().said.find("nothing to choose"), std::string::npos) << simulation.quality().said;
}

TEST(Quality, WhatCannotBeHadIsSaid)
{
    Simulation simulation(test_device(), preset("bob", "0.05"));
    EXPECT_GT(simulation.quality().predicted(), 5e-4);
    EXPECT_NE(simulation.quality().said.find("no less can be had"), std::string::npos);
    EXPECT_LT(simulation.solver().groom().guides, 1200) << "63 links move no better, and more would take minutes";

    Hairstyle swept = preset("bob", "1");
    assign(swept, "solver.kind=pbd");
    simulation.set_style(swept);
    EXPECT_TRUE(simulation.quality().rungs.empty());
    EXPECT_NE(simulation.quality().said.find("pbd"), std::string::npos);
    EXPECT_EQ(simulation.params().strand_nodes, 16);

    assign(swept, "quality.tolerance=0");
    simulation.set_style(swept);
    EXPECT_EQ(simulation.quality().said, "");
}

} // namespace
} // namespace coif

// The push of crowded hair on nodes that stay where they are: it is the hair's, not the grid's.
#include "app/measure/voxels.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace coif
{
namespace
{

class Repulsion : public testing::Test
{
  protected:
    Forces forces(int resolution)
    {
        Hair asked = hair;
        asked.params.grid_resolution = resolution;
        return probe_repulsion(test_device(), asked, glm::vec3(0.0f)).forces;
    }
    // As hard on the whole: the factor of `reference` that comes nearest.
    static double strength(const Forces& forces, const Forces& reference)
    {
        double both = 0.0, own = 0.0;
        for (size_t i = 0; i < forces.size(); ++i)
        {
            both += glm::dot(forces[i], reference[i]);
            own += glm::dot(reference[i], reference[i]);
        }
        return both / own;
    }
    // A bob on a ball: its bounds say nothing of whichever head and presets coif ships.
    static Hairstyle on_ball()
    {
        Hairstyle style;
        for (const char* set : {"strand.length=0.185", "strand.length_variation=0.1", "root.lift=87",
                                "root.crown=[0.25, 0.65, 0.7]", "root.part=0", "bending.attenuation=1"})
            assign(style, set);
        style.host.scalp_mesh = COIF_SOURCE_FOLDER "/tests/reference/ball_scalp.obj";
        style.host.head_mesh = style.host.head_spheres = "";
        return style;
    }
    Hair hair = hair_of(test_device(), on_ball());
};

// Where the coarsest grid has voxels of 18 mm, which no more than hold the width.
TEST_F(Repulsion, IsAsStrongInCoarseGridsAsInFineOnes)
{
    hair.params.grid_blur = 0.03f;
    const Forces finest = forces(128), middle = forces(64), coarse = forces(32);
    EXPECT_NEAR(strength(middle, finest), 1.0, 0.01);
    EXPECT_NEAR(strength(coarse, finest), 1.0, 0.08); // 0.070 on this ball
    EXPECT_LE(difference(middle, finest), 0.06);
    EXPECT_LE(difference(coarse, finest), 0.16);
}

// With voxels of 9 mm it is as wide as asked; with those of 18 mm as narrow as they can be, which is nearly that.
TEST_F(Repulsion, IsAsStrongAtItsUsualWidth)
{
    const Forces finest = forces(128), middle = forces(64), coarse = forces(32);
    EXPECT_NEAR(strength(middle, finest), 1.0, 0.05);
    EXPECT_NEAR(strength(coarse, finest), 1.0, 0.05);
    EXPECT_LE(difference(middle, finest), 0.13);
}

// Nowhere on the way does a voxel more make a leap, though the boxes grow from three voxels to five.
TEST_F(Repulsion, ChangesLittleFromOneResolutionToTheNext)
{
    hair.params.grid_blur = 0.02f;
    Forces before = forces(60);
    for (int resolution = 61; resolution <= 68; ++resolution)
    {
        const Forces now = forces(resolution);
        EXPECT_NEAR(strength(now, before), 1.0, 0.01) << resolution;
        EXPECT_LE(difference(now, before), 0.05) << resolution; // two grids lie differently, by 3 % each
        before = now;
    }
}

} // namespace
} // namespace coif

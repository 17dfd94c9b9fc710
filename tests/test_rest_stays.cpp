// Hair that was combed or frozen begins where it was left and stays there.
#include "app/brush.h"
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace coif;

namespace
{
// How far the farthest tip of the guides has gone from `from`, as a share of the length.
double tips_moved(const Simulation& simulation, const StrandShapes& from)
{
    const StrandShapes now = simulation.shapes();
    double most = 0.0;
    for (int s = 0; s < now.strands(); ++s)
    {
        const size_t tip = size_t((s + 1) * now.nodes - 1);
        most = std::max(most, double(glm::distance(now.position[tip], from.position[tip])));
    }
    return most / double(simulation.params().strand_length);
}

double mean_tip_moved(const Simulation& simulation, const StrandShapes& from)
{
    const StrandShapes now = simulation.shapes();
    double sum = 0.0;
    for (int s = 0; s < now.strands(); ++s)
    {
        const size_t tip = size_t((s + 1) * now.nodes - 1);
        sum += double(glm::distance(now.position[tip], from.position[tip]));
    }
    return sum / now.strands() / double(simulation.params().strand_length);
}
} // namespace

TEST(RestStays, hair_frozen_in_a_wind_begins_there_and_stays_in_still_air)
{
    Hairstyle style;
    style.params.interpolation_strands = 200;
    style.params.bending_droop = 4.0f;
    style.params.forces_repulsion = 0.0f;
    style.params.root_lift = 40.0f;
    style.params.forces_wind = F4(0.0f, 4.0f, -8.0f, 0.0f);
    style.params.forces_turbulence = 0.0f;
    Simulation blown(test_device(), style);
    blown.settle(4.0);
    const StrandShapes frozen = blown.shapes();
    style.params.forces_wind = {};
    const Simulation calm(test_device(), style);
    EXPECT_GT(mean_tip_moved(calm, frozen), 0.1) << "else there was nothing to freeze";

    style.host.groom_rest.shapes = std::make_shared<const StrandShapes>(frozen);
    Simulation kept(test_device(), style);
    EXPECT_LT(tips_moved(kept, frozen), 0.002) << "it begins where it was frozen";
    kept.settle(10.0);
    EXPECT_LT(mean_tip_moved(kept, frozen), 0.01) << "and does not sag";

    // Settled, it falls to where it would be without.
    style.host.groom_rest = {};
    kept.set_style(style);
    EXPECT_LT(tips_moved(kept, frozen), 0.05) << "not at once";
    kept.settle(6.0);
    EXPECT_LT(mean_tip_moved(kept, calm.shapes()), 0.02);
}

TEST(RestStays, combed_hair_goes_over_to_its_new_shape)
{
    Hairstyle style;
    style.params.interpolation_strands = 200;
    style.params.bending_droop = 3.0f;
    style.params.root_lift = 20.0f;
    Simulation simulation(test_device(), style);
    Brush brush;
    brush.strength = 1.0f;
    brush.radius = 0.05f;
    const Scalp& scalp = simulation.assets().scalp;
    const StrandShapes rest = simulation.rest_shapes(), before = simulation.shapes();
    const glm::vec3 top(0.0f, 0.1f, 0.0f);
    for (int i = 0; i < 6; ++i)
        apply_brush(style, scalp, rest, brush, {top, {0.01f, 0.0f, 0.0f}});
    simulation.set_style(style);
    EXPECT_LT(tips_moved(simulation, before), 0.02) << "nothing jumps";
    simulation.settle(3.0);
    const StrandShapes after = simulation.shapes();
    int combed = 0;
    for (int s = 0; s < after.strands(); ++s)
        if (brush_weight(brush, top, scalp.positions[size_t(s)]) > 0.9f)
        {
            const size_t tip = size_t((s + 1) * after.nodes - 1);
            EXPECT_GT(after.position[tip].x, before.position[tip].x + 0.01f) << s;
            ++combed;
        }
    EXPECT_GT(combed, 2);
}

// simulate_pbd against its double-precision twin, one substep at a time.
#include "sim/error.h"
#include "sim/median.h"
#include "tests/guide_pass.h"
#include "tests/oracle.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace coif
{
namespace
{

struct Case
{
    const char* name;
    int width, nodes, resolution, strands;
    bool wind, repulsion, density, teleport;
    void (*change)(HairParams&);
    bool body = false;
    bool held = false; // some strands are held by more nodes than the root's two, as ties do
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class SimulatePass : public testing::TestWithParam<Case>
{
  protected:
    void SetUp() override
    {
        const Case& c = GetParam();
        params = pass_params(c.nodes, c.resolution, c.wind, c.repulsion, c.change);
        groom = random_groom(random, c.strands, c.nodes, 10);
        for (int s = 0; s < groom.blocks * LANES && c.held; ++s)
            groom.held.push_back(s % 3 || s >= c.strands ? 2 : 2 + s / 3 % (c.nodes - 4));
        if (c.held)
            state.held.assign(groom.held.begin(), groom.held.begin() + c.strands);

        if (c.body)
        {
            placed = lumpy_head();
            body = oracle::body_of(*placed.grid);
        }
        move_head(random, c.teleport, 0.02, 0.05, before, now);
        info = make_step_info(params, groom, before, {0.4, -0.2, 0.7}, now, 9, true, placed);
        ASSERT_EQ(bool(info.teleport), c.teleport);

        // Strands that hang together, but bent, stretched by up to a third and on the move.
        state.nodes = c.nodes;
        state.root_position = from_blocks(groom.root_position, c.strands, 1);
        state.root_direction = from_blocks(groom.root_direction, c.strands, 1);
        for (int s = 0; s < c.strands; ++s)
        {
            const double rest = groom.segment_length[size_t(s)];
            state.segment_length.push_back(rest);
            const glm::dvec3 direction = state.root_direction[size_t(s)];
            glm::dvec3 at = before.turn * (state.root_position[size_t(s)] - rest * direction);
            glm::dvec3 at_rest = state.root_position[size_t(s)] - rest * direction;
            for (int k = 0; k < c.nodes; ++k)
            {
                const bool held = k > 1 && k < held_nodes(groom, s);
                if (held)
                    at = before.turn * at_rest;
                state.position.push_back(rounded(at));
                state.velocity.push_back(rounded(random.vector(1.0)));
                at += rest * (before.turn * direction + 0.35 * random.vector(1.0));
                state.rest_position.push_back(rounded(at_rest));
                if (c.held)
                    at_rest += rest * (k > 0 ? glm::normalize(direction + 0.5 * random.vector(1.0)) : direction);
            }
        }
        state.resets.assign(size_t(c.strands), 0);

        for (int i = 0; i < 7; ++i) // one large in the middle, others among the strands
        {
            const glm::dvec3 at = i == 0 ? glm::dvec3(0.0) : 0.15 * random.direction();
            colliders.push_back(capsule(at, i == 0 ? 0.1 : 0.03));
        }
        for (int i = 0; i < 2; ++i)
            colliders.push_back(capsule(0.15 * random.direction(), 0.02, 0.1 * random.direction()));
        const size_t voxels = size_t(c.resolution) * size_t(c.resolution) * size_t(c.resolution);
        for (size_t i = 0; i < voxels; ++i)
            gradient.push_back(rounded(random.vector(3.0 * 4096.0)));
    }

    Buffers buffers(const Device& device) const
    {
        const Case& c = GetParam();
        return {{"position", filled(device, to_blocks(state.position, c.strands, c.nodes))},
                {"velocity", filled(device, to_blocks(state.velocity, c.strands, c.nodes))},
                {"root_position", filled(device, groom.root_position)},
                {"root_direction", filled(device, groom.root_direction)},
                {"segment_length", filled(device, groom.segment_length)},
                {"rest_position", filled(device, to_blocks(state.rest_position, c.strands, c.nodes))},
                {"held_nodes", filled(device, c.held ? groom.held : std::vector<int>(1))},
                {"gradient", filled(device, axis_by_axis(gradient))},
                {"density", filled(device, std::vector<int>(gradient.size(), 0))},
                {"touched", filled(device, std::vector<int>(6, c.resolution))},
                {"resets", filled(device, std::vector<int>(size_t(groom.blocks) * 16, 0))},
                {"faults", filled(device, std::vector<int>(size_t(groom.blocks) * 16, 0))},
                {"colliders", filled(device, colliders)},
                {"body_distance", filled(device, c.body ? body.distance : std::vector<float>(1))},
                {"params", filled(device, params)},
                {"info", filled(device, info)}};
    }

    void simulate(const Device& device, const Buffers& buffers) const
    {
        const Case& c = GetParam();
        const std::string features =
            fmt::format("{}{}{}{}{}", c.wind ? "-D WIND " : "", c.repulsion ? "-D REPULSION " : "",
                        c.density ? "-D DENSITY " : "", c.body ? "-D BODY_GRID " : "", c.held ? "-D HELD " : "");
        Kernel kernel = load_kernel(device, "simulate_pbd", pass_options(device, c.nodes, c.resolution, features));
        run(device, kernel, buffers, cl::NDRange(size_t(groom.blocks) * 16 / size_t(device.width)));
    }

    Random random{unsigned(7 * GetParam().nodes + 1000 * GetParam().strands + GetParam().resolution)};
    HairParams params;
    Groom groom;
    Pose before;
    Substep now;
    StepInfo info = {};
    oracle::Strands state;
    std::vector<Capsule> colliders;
    PlacedGrid placed;
    oracle::Body body;
    std::vector<oracle::Vec> gradient;
};

TEST_P(SimulatePass, MovesTheGuidesAsTheTwinDoes)
{
    const Case& c = GetParam();
    const Device device = with_width(c.width);
    const Buffers on_device = buffers(device);
    simulate(device, on_device);
    const auto position = nodes_in(device, on_device.at("position"), groom);
    const auto velocity = nodes_in(device, on_device.at("velocity"), groom);

    const auto twin = [&](const std::function<oracle::Vec()>& rounding)
    {
        oracle::Strands strands = state;
        oracle::simulate_pbd(strands, {c.wind, c.repulsion}, gradient, c.resolution, colliders, params, info, rounding,
                             body);
        return strands;
    };
    const oracle::Strands expected = twin({});
    // A coordinate of a quarter of a metre rounds by up to 1.5e-8 m in every operation. What that may come to differs
    // from strand to strand: over-relaxed sweeps of a chain that spheres squeeze throw nodes past each other, and the
    // direction between two that nearly meet hangs on their last bits. So the twin is asked, with roundings at random.
    std::vector<double> allowed(size_t(c.strands), 1e-7);
    for (int trial = 0; trial < 8; ++trial)
    {
        const oracle::Strands rounded_off = twin([&] { return random.vector(1.5e-8); });
        const std::vector<double> carried = apart(rounded_off.position, expected.position, c.strands);
        for (size_t s = 0; s < carried.size(); ++s)
            allowed[s] = std::max(allowed[s], 1e-7 + 4.0 * carried[s]);
    }
    const std::vector<double> error = apart(position, expected.position, c.strands);
    const std::vector<double> speed_error = apart(velocity, expected.velocity, c.strands);
    for (int s = 0; s < c.strands; ++s)
    {
        EXPECT_LE(error[size_t(s)], allowed[size_t(s)]) << "strand " << s;
        // A difference of positions over the substep, and the rounding of a speed of up to 10 m/s.
        EXPECT_LE(speed_error[size_t(s)], allowed[size_t(s)] / info.substep + 5e-6) << "strand " << s;
    }
    // Most strands are not like that.
    EXPECT_LE(median(error), 2e-6);
    double moved = 0.0;
    for (const double d : apart(position, state.position, c.strands))
        moved = std::max(moved, d);
    EXPECT_GT(moved, 1e-3);
    EXPECT_EQ(read<int>(device, on_device.at("resets"), size_t(c.strands)), expected.resets);
}

TEST_P(SimulatePass, AddsItsNodesToTheDensityInFixedPoint)
{
    const Case& c = GetParam();
    const Device device = with_width(c.width);
    for (const int stride : {1, 3}) // all nodes, and a part of them that weighs as much
    {
        info.density_stride = stride;
        info.density_unit = stride * DENSITY_ONE;
        const Buffers on_device = buffers(device);
        simulate(device, on_device);
        const std::vector<int> density = read<int>(device, on_device.at("density"), gradient.size());
        if (!c.density)
        {
            EXPECT_EQ(density, std::vector<int>(gradient.size(), 0));
            continue;
        }
        // From where the kernel has put the nodes, so that only this sum is compared. The lanes that fill the last
        // block must not count.
        oracle::Strands after = state;
        after.position = nodes_in(device, on_device.at("position"), groom);
        const oracle::Density expected = oracle::add_density(after, c.resolution, info);
        int wrong = 0, shares = 0;
        for (size_t i = 0; i < density.size(); ++i)
        {
            // Each share is rounded to a whole unit; before that, a coordinate of up to 64 voxels carries 8e-6 of
            // rounding, which 4096 units make 0.03.
            wrong += std::abs(density[i] - expected.sum[i]) > (0.5 + 0.1 * stride) * expected.shares[i];
            shares += expected.shares[i];
        }
        EXPECT_EQ(wrong, 0) << "stride " << stride;
        EXPECT_GT(shares, 0);
        // The box about all that has got some; shares that round to nothing may widen it.
        const std::vector<int> touched = read<int>(device, on_device.at("touched"), 6);
        const auto [low, high] = oracle::box_of(density, c.resolution);
        for (int axis = 0; axis < 3; ++axis)
        {
            EXPECT_NEAR(touched[size_t(axis)], low[axis] - 0.5, 0.5);
            EXPECT_NEAR(-touched[size_t(3 + axis)], high[axis] + 0.5, 0.5);
        }
    }
}

TEST_P(SimulatePass, StartsABadStrandAnewAndLeavesItsNeighboursTheirBits)
{
    const Case& c = GetParam();
    const Device device = with_width(c.width);
    const Buffers sound = buffers(device);
    simulate(device, sound);

    const int bad = c.strands / 2;
    state.position[size_t(bad * c.nodes + 2)].y = NAN;
    const Buffers ill = buffers(device);
    simulate(device, ill);

    for (const char* name : {"position", "velocity"})
    {
        const auto a = nodes_in(device, sound.at(name), groom);
        const auto b = nodes_in(device, ill.at(name), groom);
        for (int s = 0; s < c.strands; ++s)
            for (int k = 0; k < c.nodes; ++k)
            {
                const size_t i = size_t(s * c.nodes + k);
                ASSERT_TRUE(std::isfinite(b[i].x + b[i].y + b[i].z)) << name << " of strand " << s << ", node " << k;
                if (s != bad)
                {
                    ASSERT_EQ(a[i], b[i]) << name << " of strand " << s << ", node " << k;
                }
            }
    }
    std::vector<int> resets(size_t(c.strands), 0);
    resets[size_t(bad)] = 1;
    EXPECT_EQ(read<int>(device, ill.at("resets"), size_t(c.strands)), resets);
    EXPECT_EQ(read<int>(device, sound.at("resets"), size_t(c.strands)), std::vector<int>(size_t(c.strands), 0));

    // The twin resets to the same shape.
    oracle::simulate_pbd(state, {c.wind, c.repulsion}, gradient, c.resolution, colliders, params, info, {}, body);
    const auto position = nodes_in(device, ill.at("position"), groom);
    for (int k = 0; k < c.nodes; ++k)
        EXPECT_LE(glm::distance(position[size_t(bad * c.nodes + k)], state.position[size_t(bad * c.nodes + k)]), 1e-6);
}

void limp(HairParams& p) { p.solver_bending = 0.0f; }
void rubber(HairParams& p)
{
    p.solver_stretching = 0.4f;
    p.solver_sweeps = 1;
    p.strand_spacing = 1.3f;
    p.solver_iterations = 4;
}
void brush(HairParams& p)
{
    p.solver_bending = 0.8f;
    p.solver_bending_scale = 1.5f;
    p.solver_bending_attenuation = 0.5f;
    p.forces_drag = 40.0f;
    p.forces_gravity = -1.0f;
}
void calm_gusts(HairParams& p) { p.forces_turbulence = 0.0f; }
void one_sweep(HairParams& p) { p.solver_iterations = 1; }

INSTANTIATE_TEST_SUITE_P(
    All, SimulatePass,
    testing::Values(Case{"everything", 16, 16, 64, 248, true, true, true, false, nullptr},
                    Case{"everything_8_wide", 8, 16, 64, 17, true, true, true, false, brush},
                    Case{"everything_1_wide", 1, 16, 64, 17, true, true, true, false, nullptr},
                    Case{"nothing_but_gravity", 16, 16, 64, 248, false, false, false, false, limp},
                    Case{"one_strand_of_3", 16, 3, 8, 1, true, false, true, false, nullptr},
                    Case{"strands_of_5", 16, 5, 20, 17, false, true, false, false, rubber},
                    Case{"strands_of_5_in_light", 1, 5, 20, 33, false, false, true, true, one_sweep},
                    Case{"strands_of_33", 16, 33, 20, 17, true, false, false, false, calm_gusts},
                    Case{"strands_of_33_8_wide", 8, 33, 8, 50, false, true, true, true, nullptr},
                    Case{"a_leap", 16, 16, 64, 40, true, true, true, true, brush},
                    Case{"on_a_grid", 16, 16, 64, 100, true, true, true, false, nullptr, true},
                    Case{"on_a_grid_8_wide", 8, 16, 20, 33, false, false, true, false, brush, true},
                    Case{"on_a_grid_1_wide", 1, 9, 20, 17, true, false, false, true, limp, true},
                    Case{"held", 16, 16, 20, 235, true, true, true, false, brush, true, true},
                    Case{"held_8_wide", 8, 12, 20, 101, false, false, true, false, nullptr, false, true},
                    Case{"held_1_wide", 1, 9, 20, 50, true, false, false, true, nullptr, true, true}),
    [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace coif

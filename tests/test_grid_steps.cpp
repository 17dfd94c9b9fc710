// What the passes over the grid leave behind, step after step: they see to the part of it that hair is or was in only.
#include "tests/on_device.h"
#include "tests/oracle.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace coif
{
namespace
{

constexpr int kSide = 32;

class GridSteps : public testing::TestWithParam<int>
{
  protected:
    const Device device = with_width(GetParam());
    Random random{unsigned(GetParam())};

    std::vector<int> grid_of(const Solver& solver, const char* name) const
    {
        return read<int>(device, solver.buffers().at(name), kSide * kSide * kSide);
    }

    // What the step leaves for light, and for repulsion, against all of the grid done anew from where the nodes are.
    void expect_as_from_scratch(const Solver& solver, bool repels, const char* when) const
    {
        const StepInfo& info = solver.info();
        oracle::Strands strands;
        strands.nodes = solver.groom().nodes;
        strands.segment_length.resize(size_t(solver.groom().guides)); // counts them
        strands.position = nodes_in(device, solver.buffers().at("position"), solver.groom());
        const oracle::Density raw = oracle::add_density(strands, kSide, info);
        std::vector<int> units;
        std::vector<int> within; // thousandths of a unit, that rounding may have moved it by
        for (size_t i = 0; i < raw.sum.size(); ++i)
        {
            units.push_back(int(std::lround(raw.sum[i])));
            within.push_back(700 * raw.shares[i]); // each is rounded, after a place that carries a little itself
        }
        const auto blur = [&](const float4& box)
        {
            for (int axis = 0; axis < 3 && box.w > 0.0f; ++axis)
            {
                const std::vector<double> sums = oracle::blur_density(units, axis, kSide, box);
                const std::vector<double> roundings = oracle::blur_density(within, axis, kSide, box);
                for (size_t i = 0; i < units.size(); ++i)
                {
                    units[i] = int(std::lround(sums[i]));
                    within[i] = sums[i] > 0.0 ? int(roundings[i]) + 1010 : 0;
                }
            }
        };
        const auto expect = [&](const char* name)
        {
            const std::vector<int> found = grid_of(solver, name);
            int wrong = 0, some = 0;
            for (size_t i = 0; i < found.size(); ++i)
            {
                wrong += 1000 * std::abs(found[i] - units[i]) > within[i];
                some += found[i] != 0;
            }
            EXPECT_EQ(wrong, 0) << name << ", " << when;
            EXPECT_GT(some, 100) << name << ", " << when;
        };
        blur(info.light_box);
        expect("density");
        if (!repels)
            return;
        blur(info.push_box);
        expect("lit");
        const std::vector<oracle::Vec> expected = oracle::density_gradient(grid_of(solver, "lit"), kSide);
        const std::vector<float> gradient = read<float>(device, solver.buffers().at("gradient"), expected.size() * 3);
        int wrong = 0;
        for (size_t i = 0; i < expected.size(); ++i)
            for (int axis = 0; axis < 3; ++axis)
                wrong += double(gradient[i + size_t(axis) * expected.size()]) != expected[i][axis];
        EXPECT_EQ(wrong, 0) << when;
    }
};

TEST_P(GridSteps, LeaveWhatAllOfTheGridDoneAnewWouldHold)
{
    HairParams params;
    params.grid_resolution = kSide;
    params.forces_repulsion = 1.0f;
    params.look_self_shadow = 1.0f;
    params.grid_blur = 0.04f;
    const Groom groom = random_groom(random, 37, 8, 40);
    Solver solver(device, params, groom, Pose{});
    double time = 0.0;
    Pose head;
    const auto step = [&]
    {
        time += 1.0 / 60.0;
        solver.step({{head, time, 1.0f / 60.0f}});
    };
    for (int i = 0; i < 6; ++i) // hair falls, and the head goes on its way
    {
        head.origin += random.vector(0.03);
        head.turn = glm::angleAxis(0.2, random.direction()) * head.turn;
        step();
        expect_as_from_scratch(solver, true, "falling");
    }
    head.origin += glm::dvec3(2.0, 0.0, 0.0); // a teleport that turns it over: hair is elsewhere in the grid
    head.turn = glm::angleAxis(3.0, glm::dvec3(0.0, 0.0, 1.0)) * head.turn;
    step();
    expect_as_from_scratch(solver, true, "jumped");

    params.grid_blur = 0.02f;
    solver.set_params(params);
    step();
    expect_as_from_scratch(solver, true, "blurred less");

    params.forces_repulsion = 0.0f;
    solver.set_params(params);
    for (int i = 0; i < 3; ++i)
        step();
    expect_as_from_scratch(solver, false, "without repulsion");

    params.forces_repulsion = 1.0f;
    solver.set_params(params);
    step();
    expect_as_from_scratch(solver, true, "with repulsion again");

    params.grid_blur = 0.0f; // the density as it is
    solver.set_params(params);
    step();
    expect_as_from_scratch(solver, false, "not blurred");

    solver.reset(head);
    step();
    expect_as_from_scratch(solver, false, "reset");
}

TEST_P(GridSteps, BeforeTheFirstStepThereIsNoHairInTheLight)
{
    HairParams params;
    params.grid_resolution = kSide;
    params.look_self_shadow = 1.0f;
    Solver solver(device, params, random_groom(random, 20, 8, 40), Pose{});
    solver.draw();
    for (const char* name : {"density", "occupied", "depth"})
        EXPECT_EQ(grid_of(solver, name), std::vector<int>(kSide * kSide * kSide, 0)) << name;
}

// Kept as long as neither it nor the grid turns; light, that is how much of it stops light, changes it too.
TEST_P(GridSteps, TheHeadIsStoodInTheGridOnlyWhereItChanges)
{
    HairParams params;
    params.grid_resolution = kSide;
    params.look_self_shadow = 1.0f;
    const Groom groom = random_groom(random, 20, 8, 40);
    Solver solver(device, params, groom, Pose{});
    solver.set_body({lumpy_body(), 1.0f, {0.0f, 0.0f, 0.0f}});
    Pose head;
    double time = 0.0;
    const auto stood = [&]
    {
        time += 1.0 / 60.0;
        solver.step({{head, time, 1.0f / 60.0f}});
        solver.draw();
        int passes = 0;
        for (const auto& [pass, ms] : solver.take_times())
            passes += pass == "stand_head";
        // Nothing of it is of another pose: as a solver that has never seen another.
        Solver fresh(device, params, groom, head);
        fresh.set_body(solver.body());
        fresh.step({{head, time, 1.0f / 60.0f}});
        fresh.draw();
        EXPECT_EQ(grid_of(solver, "in_head"), grid_of(fresh, "in_head"));
        // And what light meets is all of that, and of the hair, and nothing else.
        const std::vector<int> density = grid_of(solver, "density"), in_head = grid_of(solver, "in_head");
        std::vector<int> both;
        for (size_t i = 0; i < density.size(); ++i)
            both.push_back(std::max(density[i], in_head[i]));
        EXPECT_EQ(grid_of(solver, "occupied"), both);
        return passes;
    };
    EXPECT_EQ(stood(), 1);
    EXPECT_EQ(stood(), 0);
    head.origin += glm::dvec3(0.01, 0.0, 0.0); // the grid goes with it
    EXPECT_EQ(stood(), 0);
    head.turn = glm::angleAxis(0.01, glm::dvec3(0.0, 1.0, 0.0));
    EXPECT_EQ(stood(), 1);
    params.look_self_shadow = 0.5f;
    solver.set_params(params);
    EXPECT_EQ(stood(), 1);
    for (const float side : {0.2f, -0.2f, 0.2f}) // it stands out of the hair to one side, and then no more
    {
        solver.set_body({lumpy_body(), 1.1f, {side, 0.5f * side, side}});
        EXPECT_EQ(stood(), 1);
        EXPECT_EQ(stood(), 0);
    }
}

INSTANTIATE_TEST_SUITE_P(All, GridSteps, testing::Values(1, 8, 16));

} // namespace
} // namespace coif

// What the kernels are told of one substep, against the formulas in double.
#include "sim/simulation.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <numbers>

namespace coif
{
namespace
{

using test::between;
using test::Scratch;

Groom small_groom()
{
    Groom groom;
    groom.nodes = 16;
    groom.guides = 248;
    groom.blocks = 16;
    groom.longest = 0.25f;
    groom.extent = 0.2f;
    groom.drawn.resize(4096);
    groom.drawn_multi = 3072;
    return groom;
}

StepInfo info_of(const HairParams& authored, const Pose& before = {}, const Substep& now = {},
                 const Groom& groom = small_groom())
{
    return make_step_info(device_params(authored), groom, before, {1, 2, 3}, now, 5, true);
}

Substep moved_to(glm::dvec3 origin, double yaw)
{
    Substep now;
    now.head.origin = origin;
    now.head.turn = glm::angleAxis(yaw, glm::dvec3(0, 1, 0));
    return now;
}

const double kDegree = std::numbers::pi / 180.0;

TEST(StepInfo, drag_keeps_and_gains_what_its_integral_says_down_to_none)
{
    for (const double seconds : {1.0 / 60.0, 1.0 / 240.0, 1e-5})
        for (const double drag :
             {0.0, 1e-9, 1e-6, 0.99e-6 / seconds, 1e-6 / seconds, 1.01e-6 / seconds, 0.5, 3.0, 100.0, 1e6 * seconds})
        {
            HairParams params;
            params.forces_drag = float(drag);
            Substep now;
            now.seconds = float(seconds);
            const StepInfo info = info_of(params, {}, now);
            const double b = params.forces_drag, h = now.seconds;
            EXPECT_EQ(info.substep, now.seconds);
            EXPECT_NEAR(info.drag_keep, std::exp(-b * h), 1e-7) << b << " " << h;
            const double gain = b > 0.0 ? -std::expm1(-b * h) / b : h;
            EXPECT_NEAR(info.drag_gain / gain, 1.0, 1e-6) << b << " " << h;
        }
}

TEST(StepInfo, strengths_of_a_sweep_make_up_the_strength_of_the_whole)
{
    for (const int sweeps : {1, 2, 10, 1000})
        for (const float strength : {0.0f, 0.15f, 0.5f, 0.99f, 1.0f})
        {
            HairParams params;
            params.solver_iterations = sweeps;
            params.solver_stretching = strength;
            params.solver_bending = strength;
            const StepInfo info = info_of(params);
            // Eq. 5.5: after all sweeps, (1 - k')^n of the error is left, which is 1 - k.
            EXPECT_NEAR(std::pow(1.0 - double(info.stretch), sweeps), 1.0 - double(strength), 2e-4) << sweeps;
            EXPECT_NEAR(info.bend, 1.0 - std::pow(1.0 - double(strength), 1.0 / sweeps), 1e-7) << sweeps;
            EXPECT_EQ(info.stretch, info.bend);
        }
}

TEST(StepInfo, over_relaxation_is_youngs_for_a_strand_of_that_many_links)
{
    for (const int nodes : {3, 16, 64})
    {
        Groom groom = small_groom();
        groom.nodes = nodes;
        HairParams params;
        const double links = nodes - 2;
        EXPECT_NEAR(info_of(params, {}, {}, groom).relax,
                    2.0 / (1.0 + std::sin(std::numbers::pi / (2.0 * links + 1.0))), 1e-6);
        params.solver_sweeps = 1;
        EXPECT_EQ(info_of(params, {}, {}, groom).relax, 1.0f);
    }
}

TEST(StepInfo, only_a_jump_beyond_a_quarter_metre_or_a_right_angle_is_a_teleport)
{
    const Pose before{{100, 0, 0}, glm::angleAxis(0.3, glm::dvec3(0, 1, 0)), {}};
    const auto jumps = [&](double metres, double degrees) {
        return info_of({}, before, moved_to({100, metres, 0}, 0.3 + degrees * kDegree)).teleport;
    };
    EXPECT_FALSE(jumps(0.0, 0.0));
    EXPECT_FALSE(jumps(0.2499, 0.0));
    EXPECT_TRUE(jumps(0.2501, 0.0));
    EXPECT_TRUE(jumps(-0.2501, 0.0));
    EXPECT_FALSE(jumps(0.0, 89.0));
    EXPECT_TRUE(jumps(0.0, 91.0));
    EXPECT_TRUE(jumps(0.0, -91.0));
    EXPECT_FALSE(jumps(0.0, 271.0)); // is a turn by -89
    EXPECT_FALSE(jumps(0.2499, 89.0));
}

TEST(StepInfo, the_same_turn_written_with_the_other_sign_is_no_teleport)
{
    const Pose before{{}, glm::angleAxis(0.3, glm::dvec3(0, 1, 0)), {}};
    Substep now;
    now.head.turn = -before.turn;
    EXPECT_FALSE(info_of({}, before, now).teleport);
}

glm::dmat3 rows(float4 a, float4 b, float4 c)
{
    return glm::transpose(glm::dmat3(glm::dvec3(a.x, a.y, a.z), glm::dvec3(b.x, b.y, b.z), glm::dvec3(c.x, c.y, c.z)));
}

TEST(StepInfo, a_teleport_turns_the_old_pose_into_the_new_and_moves_nothing_besides)
{
    const Pose before{{1, 2, 3}, glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, -1))), {}};
    Substep now = moved_to({6, 2, 3}, -1.1);
    StepInfo info = info_of({}, before, now);
    ASSERT_TRUE(info.teleport);
    const glm::dmat3 carried = rows(info.turn_row0, info.turn_row1, info.turn_row2);
    const glm::dmat3 head = rows(info.head_row0, info.head_row1, info.head_row2);
    for (const glm::dvec3 v : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0.2, -0.4, 0.9)})
    {
        EXPECT_LT(glm::length(head * v - now.head.turn * v), 1e-6);
        EXPECT_LT(glm::length(carried * (before.turn * v) - now.head.turn * v), 1e-6);
    }
    EXPECT_EQ(info.origin_move, F4(0, 0, 0, 0));

    now.head.origin = {1.125, 2, 2.875};
    now.head.turn = before.turn;
    info = info_of({}, before, now);
    ASSERT_FALSE(info.teleport);
    EXPECT_EQ(info.turn_row0, F4(1, 0, 0, 0));
    EXPECT_EQ(info.turn_row1, F4(0, 1, 0, 0));
    EXPECT_EQ(info.turn_row2, F4(0, 0, 1, 0));
    EXPECT_EQ(info.origin_move, F4(0.125f, 0, -0.125f, 0));
}

TEST(StepInfo, a_kilometre_away_the_heads_move_keeps_its_precision)
{
    const Pose before{{1000, -5000, 1e6}, {1, 0, 0, 0}, {}};
    Substep now;
    now.head.origin = before.origin + glm::dvec3(0.01, 0.001, -0.02);
    const StepInfo info = info_of({}, before, now);
    EXPECT_NEAR(info.origin_move.x, 0.01, 1e-9);
    EXPECT_NEAR(info.origin_move.y, 0.001, 1e-9);
    EXPECT_NEAR(info.origin_move.z, -0.02, 1e-9);
}

TEST(StepInfo, counts_velocity_wind_and_gravity_are_passed_on)
{
    HairParams params;
    params.forces_gravity = -2.0f;
    params.forces_wind = F4(1, 0, 2, 0);
    params.forces_turbulence = 0.75f;
    Substep now;
    now.head.wind = {2, 4, 2};
    const StepInfo info = info_of(params, {}, now);
    EXPECT_EQ(info.head_velocity, F4(1, 2, 3, 0));
    EXPECT_EQ(info.wind.x, 3.0f);
    EXPECT_EQ(info.wind.y, 4.0f);
    EXPECT_EQ(info.wind.z, 4.0f);
    EXPECT_NEAR(info.wind.w, std::sqrt(41.0), 1e-6);
    EXPECT_NEAR(info.gravity, 19.62, 1e-5);
    EXPECT_EQ(info.gust_origin.w, 0.75f);
    EXPECT_EQ(info.guides, 248);
    EXPECT_EQ(info.drawn_multi, 3072);
    EXPECT_EQ(info.drawn, 4096);
    EXPECT_EQ(info.colliders, 5);
    EXPECT_EQ(info.last_substep, 1);
    EXPECT_GT(info.clearance, 0.0f);
}

TEST(StepInfo, gusts_drift_with_the_wind_and_never_lose_precision_to_time)
{
    HairParams params;
    params.forces_wind = F4(10, 0, 0, 0);
    for (const double time : {0.0, 1.0, 1e4, 1e7})
    {
        Substep now;
        now.time = time;
        now.head.origin = {0, 1.5, 0};
        const StepInfo info = info_of(params, now.head, now);
        for (const float cell : {info.gust_origin.x, info.gust_origin.y, info.gust_origin.z})
        {
            EXPECT_GE(cell, 0.0f);
            EXPECT_LE(cell, 256.0f);
        }
        const double cells = -10.0 * 0.3 * time / 0.15, wrapped = cells - 256.0 * std::floor(cells / 256.0);
        EXPECT_NEAR(std::remainder(info.gust_origin.x - wrapped, 256.0), 0.0, 1e-4) << time;
        EXPECT_NEAR(info.gust_origin.y, 10.0, 1e-5);
    }
}

// The light's sweep: kernels/light_grid.h.
TEST(StepInfo, the_sweep_follows_the_light_along_its_main_axis)
{
    std::mt19937 random(11);
    for (int trial = 0; trial < 200; ++trial)
    {
        HairParams params;
        glm::dvec3 light;
        for (int axis = 0; axis < 3; ++axis)
            light[axis] = trial < 6 ? (axis == trial % 3 ? (trial < 3 ? 1.0 : -1.0) : 0.0) : between(random, -1, 1);
        params.look_light_direction = F4(float(light.x), float(light.y), float(light.z), 0.0f);
        const StepInfo info = info_of(params);
        light = glm::normalize(light);
        int axis = 0;
        for (int i = 1; i < 3; ++i)
            axis = std::abs(light[i]) > std::abs(light[axis]) ? i : axis;
        ASSERT_EQ(info.sweep_axis, axis);
        EXPECT_EQ(info.sweep_sign, light[axis] > 0.0 ? -1 : 1); // away from the light
        EXPECT_EQ(info.sweep_from, light[axis] > 0.0 ? params.grid_resolution - 1 : 0);
        // One slice on: (sign, u, v) in cells leads straight away from the light, and is as long as a ray.
        glm::dvec3 step(0.0);
        step[axis] = info.sweep_sign;
        step[axis == 0 ? 1 : 0] = info.sweep.x;
        step[axis == 2 ? 1 : 2] = info.sweep.y;
        EXPECT_LT(glm::length(glm::cross(step, light)), 1e-6);
        EXPECT_LT(glm::dot(step, light), 0.0);
        EXPECT_NEAR(info.sweep.z, glm::length(step) * info.grid_corner.w, 1e-7);
        EXPECT_LE(std::abs(info.sweep.x), 1.0f);
        EXPECT_LE(std::abs(info.sweep.y), 1.0f);
    }
}

TEST(StepInfo, shadow_that_is_off_stops_no_light_and_a_body_stops_nearly_all)
{
    HairParams params;
    params.look_self_shadow = 0.0f;
    EXPECT_EQ(info_of(params).sweep.w, 0.0f);
    EXPECT_EQ(info_of(params).body_density, 0);
    params.look_self_shadow = 1.0f;
    const StepInfo one = info_of(params);
    EXPECT_NEAR(one.body_density * double(one.sweep.w) * one.grid_corner.w, 3.0, 0.01);
    params.look_self_shadow = 2.0f;
    EXPECT_NEAR(info_of(params).sweep.w / one.sweep.w, 2.0, 1e-5);
    Groom bald = small_groom();
    bald.drawn.clear();
    bald.drawn_multi = 0;
    const StepInfo head_alone = info_of(params, {}, {}, bald);
    EXPECT_NEAR(head_alone.body_density * double(head_alone.sweep.w) * head_alone.grid_corner.w, 3.0, 0.01)
        << "a head without hair still shades itself";
}

TEST(StepInfo, repulsion_does_not_hang_on_the_grid)
{
    // For a field that is smooth on both grids, the gradient in units of density a voxel goes as voxel^3 (amount of
    // density in a voxel) times voxel (from one to the next).
    HairParams coarse, fine;
    coarse.grid_resolution = 32;
    fine.grid_resolution = 64;
    const StepInfo a = info_of(coarse), b = info_of(fine);
    EXPECT_NEAR(a.repulsion * std::pow(double(a.grid_corner.w), 4), b.repulsion * std::pow(double(b.grid_corner.w), 4),
                1e-5 * a.repulsion * std::pow(double(a.grid_corner.w), 4));
    EXPECT_GT(a.repulsion, 0.0f);
}

// Is a point, relative to the head's origin, where grid_point() of kernels/grid.h finds a voxel?
bool in_grid(const StepInfo& info, int resolution, glm::dvec3 p)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const double corner = axis == 0 ? info.grid_corner.x : axis == 1 ? info.grid_corner.y : info.grid_corner.z;
        const double cell = (p[axis] - corner) / info.grid_corner.w - 0.5;
        if (!(cell >= 0.0 && cell < resolution - 1))
            return false;
    }
    return true;
}

void expect_all_hair_in_grid(const Scalp& scalp, const char* name)
{
    std::mt19937 random(5);
    for (const auto& [resolution, spacing, scale] : {std::tuple{8, 1.0f, 1.0f}, std::tuple{64, 1.0f, 1.0f},
                                                     std::tuple{64, 3.0f, 0.5f}, std::tuple{128, 0.5f, 3.0f}})
    {
        HairParams params;
        params.grid_resolution = resolution;
        params.strand_spacing = spacing;
        params.head_scale = scale;
        params.interpolation_strands = 10;
        const Groom groom = grow(params, scalp);
        int outside = 0;
        for (int trial = 0; trial < 40; ++trial)
        {
            Substep now;
            const glm::dvec3 axis(between(random, -1, 1), between(random, -1, 1), between(random, 0.1, 1));
            now.head.turn = glm::angleAxis(between(random, -3, 3), glm::normalize(axis));
            now.head.origin = {1000.0, 7.0, 0.0};
            const StepInfo info = info_of(params, now.head, now, groom);
            const double reach = params.strand_length * spacing;
            for (const glm::vec3& root : scalp.positions)
                for (int side = 0; side < 6; ++side)
                {
                    glm::dvec3 along(0.0);
                    along[side % 3] = side < 3 ? reach : -reach;
                    outside += !in_grid(info, resolution, now.head.turn * (glm::dvec3(root) * double(scale)) + along);
                }
        }
        EXPECT_EQ(outside, 0) << name << ", resolution " << resolution << ", spacing " << spacing;
    }
}

// What a box's weights add up to, and their variance.
std::pair<double, double> moments(const float4& box)
{
    double all = 0.0, squares = 0.0;
    const int end = int(box.x) + 1;
    for (int k = -end; k <= end; ++k)
    {
        const double weight = std::abs(k) == end ? double(box.z) : double(box.y);
        all += weight;
        squares += weight * k * k;
    }
    return {all, squares};
}

TEST(StepInfo, boxes_and_grid_together_spread_a_node_as_wide_as_asked_in_any_grid)
{
    HairParams params;
    for (const float width : {0.0f, 0.004f, 0.015f, 0.05f})
        for (int resolution = 8; resolution <= 128; ++resolution)
        {
            params.grid_blur = width;
            params.grid_resolution = resolution;
            const StepInfo info = info_of(params);
            double variance = 2.0 / 3.0;
            for (const float4& box : {info.light_box, info.push_box})
            {
                const auto [all, own] = moments(box);
                EXPECT_NEAR(all, 1.0, 1e-6);
                EXPECT_NEAR(own, box.w, 1e-5 * own);
                EXPECT_GE(box.z, 0.0f);
                EXPECT_LE(box.z, box.y);
                variance += own;
            }
            const double wanted = std::pow(width / info.grid_corner.w, 2);
            EXPECT_NEAR(variance, std::max(wanted, 2.0 / 3.0), 1e-5 * variance) << width << " m in " << resolution;
        }
}

TEST(StepInfo, the_grid_holds_every_point_that_hair_can_reach_wherever_the_head_turns)
{
    for (const char* name : {"scalp.obj", "scalp_top.obj", "scalp_strip.obj"})
        expect_all_hair_in_grid(load_scalp(test::shipped(name)), name);
}

TEST(StepInfo, the_grid_holds_the_hair_of_a_nearly_flat_patch_far_from_its_spheres_centre)
{
    std::string obj;
    for (int z = 0; z < 5; ++z)
        for (int x = 0; x < 5; ++x)
            obj +=
                fmt::format("v {} {} {}\n", 0.02 * x, 1.5 - 0.0005 * ((x - 2) * (x - 2) + (z - 2) * (z - 2)), 0.02 * z);
    for (int z = 0; z < 4; ++z)
        for (int x = 0; x < 4; ++x)
            obj += fmt::format("f {0} {1} {2}\nf {2} {1} {3}\n", 5 * z + x + 1, 5 * z + x + 6, 5 * z + x + 2,
                               5 * z + x + 7);
    const Scratch scratch;
    expect_all_hair_in_grid(load_scalp(scratch.write("patch.obj", obj)), "patch");
}

TEST(StepInfo, the_grid_is_as_large_for_every_pose)
{
    const StepInfo a = info_of({}), b = info_of({}, {}, moved_to({0.1, 0, 0}, 1.0));
    EXPECT_EQ(a.grid_corner.w, b.grid_corner.w);
}

// The direct solver's table of drag: mean velocities of one substep and the next.
TEST(StepPath, drag_is_what_integrating_it_gives_at_every_pace)
{
    for (const double drag : {0.0, 1e-6, 0.5, 3.0, 100.0})
        for (const double seconds_before : {1.0 / 60.0, 1.0 / 240.0})
        {
            HairParams params;
            params.forces_drag = float(drag);
            const Substep now;
            const StepPath path = make_step_path(params, {}, now, false, seconds_before);
            for (int from = 0; from <= DRAG_WITHIN; ++from)
                for (int to = 0; to < PACES; ++to)
                {
                    const int counts[PACES] = {1, 2, 3, 4, 6, 8, 12, 16};
                    const double h = double(now.seconds) / counts[to];
                    const double before = from == 0 ? 0.0 : from == DRAG_WITHIN ? h : seconds_before / counts[from - 1];
                    const float4 got = path.drag[PACES * from + to];
                    for (const auto& [start, force] : {std::pair(1.0, 0.0), std::pair(0.0, 9.81), std::pair(-2.0, 5.0)})
                    {
                        // Velocity by the midpoint rule, from the begin of the substep before.
                        constexpr int kParts = 2000;
                        double v = start, mean[2] = {start, 0.0};
                        for (const bool second : {false, true})
                        {
                            const double dt = (second ? h : before) / kParts;
                            double sum = 0.0;
                            for (int i = 0; i < kParts && dt > 0.0; ++i)
                            {
                                const double middle = v + 0.5 * dt * (force - drag * v);
                                sum += middle;
                                v += dt * (force - drag * middle);
                            }
                            if (dt > 0.0)
                                mean[second] = sum / kParts;
                        }
                        EXPECT_NEAR(double(got.x) * mean[0] + double(got.y) * force, mean[1], 1e-6)
                            << drag << ", from " << from << " to " << to;
                    }
                }
        }
}

TEST(StepPath, the_head_goes_its_way_in_twelfths_and_sixteenths_and_nowhere_in_a_leap)
{
    const Pose before{{100, 2, 3}, glm::angleAxis(0.4, glm::dvec3(0, 1, 0)), {}};
    Substep now = moved_to({100.1, 2, 3.05}, 0.6);
    const auto origin = [](const StepPath& path, int i)
    { return glm::dvec3(path.row[3 * i].w, path.row[3 * i + 1].w, path.row[3 * i + 2].w); };
    const StepPath straight = make_step_path({}, before, now, false, 1.0 / 60.0);
    now.way = [&](double share) { return Pose{{100.0 + 0.1 * share * share, 2, 3.05}, before.turn, {}}; };
    const StepPath bent = make_step_path({}, before, now, false, 1.0 / 60.0);
    const StepPath leap = make_step_path({}, before, now, true, 1.0 / 60.0);
    for (const int i : {0, 3, 4, 6, 8, 9, 12, 15, 16, 18, 20, 21, 24, 27, 28, 30, 32, 33, 36, 39, 40, 42, 44, 45, 48})
    {
        const double share = i / 48.0;
        EXPECT_LT(glm::distance(origin(straight, i), share * glm::dvec3(0.1, 0, 0.05)), 1e-8) << i;
        const glm::dmat3 turn = rows(straight.row[3 * i], straight.row[3 * i + 1], straight.row[3 * i + 2]);
        const glm::dquat expected = glm::angleAxis(0.4 + 0.2 * share, glm::dvec3(0, 1, 0));
        EXPECT_LT(glm::length(turn * glm::dvec3(1, 2, 3) - expected * glm::dvec3(1, 2, 3)), 1e-6) << i;
        EXPECT_NEAR(origin(bent, i).x, 0.1 * share * share, 1e-8) << i;
        EXPECT_EQ(origin(leap, i), glm::dvec3(0.0)) << i;
        EXPECT_EQ(leap.row[3 * i].x, leap.row[0].x) << i;
    }
}

TEST(StepInfo, many_nodes_feed_the_density_by_an_even_part_that_weighs_as_much)
{
    EXPECT_EQ(info_of(HairParams()).density_stride, 1);
    EXPECT_EQ(info_of(HairParams()).density_unit, DENSITY_ONE);
    for (const int guides : {4369, 4370, 20000, 200000})
    {
        Groom groom = small_groom();
        groom.guides = guides;
        const StepInfo info = info_of(HairParams(), {}, {}, groom);
        const double all = double(guides) * (groom.nodes - 1);
        EXPECT_EQ(info.density_stride == 1, all <= DENSITY_NODES);
        double sum = 0.0;
        std::vector<int> at_node(size_t(groom.nodes));
        for (int s = 0; s < guides; ++s)
            for (int k = density_first(s, info.density_stride); k < groom.nodes; k += info.density_stride)
            {
                sum += info.density_unit;
                ++at_node[size_t(k)];
            }
        EXPECT_NEAR(sum / (all * DENSITY_ONE), 1.0, 1e-4) << guides;
        EXPECT_EQ(at_node[0], 0) << "the segment under the scalp is no hair";
        const double mean = sum / info.density_unit / (groom.nodes - 1);
        EXPECT_LE(mean * (groom.nodes - 1), 1.01 * DENSITY_NODES);
        // Each node along the strand gets its share, and so does each stretch of neighbouring strands.
        for (int k = 1; k < groom.nodes; ++k)
            EXPECT_NEAR(at_node[size_t(k)], mean, 0.01 * mean) << guides << " guides, node " << k;
    }
}

} // namespace
} // namespace coif

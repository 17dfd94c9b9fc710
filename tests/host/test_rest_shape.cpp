// The rest shape of the direct solver: that gravity, tension and bending are in balance where a strand begins.
#include "sim/rest_shape.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{
namespace
{

using Vec = glm::dvec3;

// Sixteen strands of the same shape, turned apart about the vertical. `points`: one segment apart, the root first.
Groom shaped(const std::vector<Vec>& points)
{
    Groom groom;
    groom.nodes = int(points.size()) + 1;
    groom.guides = LANES;
    groom.blocks = 1;
    const double rest = glm::distance(points[0], points[1]);
    groom.longest = float(rest * (groom.nodes - 2));
    groom.segment_length.assign(LANES, float(rest));
    groom.root_position.resize(LANES * 3);
    groom.root_direction.resize(LANES * 3);
    groom.rest_position.resize(LANES * 3 * points.size() + LANES * 3);
    for (int s = 0; s < LANES; ++s)
    {
        const double angle = 2.0 * std::numbers::pi * s / LANES;
        const auto turned = [&](Vec v) {
            return Vec(std::cos(angle) * v.x + std::sin(angle) * v.z, v.y,
                       std::cos(angle) * v.z - std::sin(angle) * v.x);
        };
        const auto put = [&](std::vector<float>& to, int node, int nodes, Vec v)
        {
            for (int axis = 0; axis < 3; ++axis)
                to[size_t(strand_value(s, node, axis, nodes))] = float(v[axis]);
        };
        const Vec direction = glm::normalize(points[1] - points[0]);
        put(groom.root_position, 0, 1, turned(points[0]));
        put(groom.root_direction, 0, 1, turned(direction));
        put(groom.rest_position, 0, groom.nodes, turned(points[0] - rest * direction));
        for (int k = 1; k < groom.nodes; ++k)
            put(groom.rest_position, k, groom.nodes, turned(points[size_t(k - 1)]));
    }
    return groom;
}

std::vector<Vec> ringlet(int nodes, int per_turn, double radius, double pitch)
{
    std::vector<Vec> points;
    for (int k = 0; k + 1 < nodes; ++k)
    {
        const double angle = 2.0 * std::numbers::pi * k / per_turn;
        points.push_back({0.1 + radius * std::cos(angle), -pitch * k / per_turn, radius * std::sin(angle)});
    }
    return points;
}

// A half circle to the side and back in.
std::vector<Vec> combed(int nodes, double length)
{
    std::vector<Vec> points = {Vec(0.05, 0.1, 0.0)};
    for (int k = 0; k + 2 < nodes; ++k)
    {
        const double angle = std::numbers::pi * (k + 0.5) / (nodes - 2);
        points.push_back(points.back() + length / (nodes - 2) * Vec(std::cos(angle), -std::sin(angle), 0.0));
    }
    return points;
}

Vec value(const std::vector<float>& from, int strand, int node, int nodes)
{
    return {from[size_t(strand_value(strand, node, 0, nodes))], from[size_t(strand_value(strand, node, 1, nodes))],
            from[size_t(strand_value(strand, node, 2, nodes))]};
}

// Bending energy over the stiffness: half the weighted squares of second differences off their targets, which lie in a
// frame carried along the strand by the smallest rotations (Rodrigues).
double energy(const std::vector<Vec>& x, Vec direction, Vec normal, const std::vector<Vec>& bend,
              const HairParams& params)
{
    double sum = 0.0;
    Vec t = direction;
    const size_t links = x.size() - 2;
    for (size_t e = 1; e + 1 < x.size(); ++e)
    {
        const Vec target = bend[e].x * t + bend[e].y * normal + bend[e].z * glm::cross(t, normal);
        const Vec off = x[e - 1] - 2.0 * x[e] + x[e + 1] - target;
        const double along = double(e - 1) / double(links);
        const double weight = (e == 1 ? 2.0 : 1.0) * std::exp(-params.bending_attenuation * along) *
                              profile_at(params.bending_along, along);
        sum += 0.5 * weight * glm::dot(off, off);
        const Vec next = glm::normalize(x[e + 1] - x[e]), axis = glm::cross(t, next);
        const double sine = glm::length(axis), cosine = glm::dot(t, next);
        if (sine > 1e-14)
        {
            const Vec k = axis / sine;
            normal = normal * cosine + glm::cross(k, normal) * sine + k * glm::dot(k, normal) * (1.0 - cosine);
        }
        t = next;
    }
    return sum;
}

// The largest force on a node that is left over, in its weight.
double unbalanced(const HairParams& params, const Groom& groom)
{
    const RestShape shape = make_rest_shape(params, groom);
    const int n = groom.nodes;
    double worst = 0.0;
    for (int s = 0; s < LANES; ++s)
    {
        std::vector<Vec> x, bend;
        std::vector<double> pull;
        for (int k = 0; k < n; ++k)
        {
            x.push_back(value(shape.position, s, k, n));
            bend.push_back(value(shape.bend, s, k, n));
            pull.push_back(shape.multiplier[size_t(k * LANES + s)]);
        }
        const Vec direction = value(groom.root_direction, s, 0, 1), normal = value(shape.normal, s, 0, 1);
        EXPECT_NEAR(glm::length(normal), 1.0, 1e-6);
        EXPECT_NEAR(glm::dot(normal, direction), 0.0, 1e-6);
        const double rest = groom.segment_length[size_t(s)];
        const double stiffness =
            std::min(9.81 * std::pow(n - 2, 3) / (double(params.bending_droop) * rest), shape.bend_most);
        const double step = 1e-5 * rest;
        for (size_t i = 2; i < size_t(n); ++i)
        {
            Vec force(0.0, -9.81 * params.forces_gravity * (i + 1 == size_t(n) ? groom.tip_mass : 1.0f), 0.0);
            force -= pull[i] * (x[i] - x[i - 1]);
            if (i + 1 < size_t(n))
                force += pull[i + 1] * (x[i + 1] - x[i]);
            for (int axis = 0; axis < 3; ++axis)
            {
                std::vector<Vec> at = x;
                at[i][axis] += step;
                const double above = energy(at, direction, normal, bend, params);
                at[i][axis] -= 2.0 * step;
                const double below = energy(at, direction, normal, bend, params);
                force[axis] -= stiffness * (above - below) / (2.0 * step);
            }
            // Positions and bends are floats: so much of a tenth of a metre, and of a segment, times what multiplies
            // it.
            const double rounding = 16.0 * 6e-8 * 0.2 * (stiffness + std::abs(pull[i]));
            worst = std::max(worst, (glm::length(force) - rounding) / 9.81);
        }
    }
    return worst;
}

TEST(RestShape, bending_and_tension_hold_up_what_gravity_pulls_down)
{
    for (const Groom& groom :
         {shaped(combed(16, 0.2)), shaped(ringlet(33, 8, 0.006, 0.03)), shaped(ringlet(16, 12, 0.02, 0.06))})
        for (const float droop : {5.0f, 20.0f, 40.0f})
            for (const float gravity : {1.0f, 0.0f, -1.0f})
                for (const float attenuation : {0.0f, 1.0f})
                {
                    HairParams params;
                    params.bending_droop = droop;
                    params.bending_attenuation = attenuation;
                    if (attenuation > 0.0f)
                        params.bending_along = F4(2.0f, 0.8f, 1.0f, 0.5f);
                    params.forces_gravity = gravity;
                    EXPECT_LE(unbalanced(params, groom), 0.02)
                        << groom.nodes << " nodes, droop " << droop << ", gravity " << gravity << ", " << attenuation;
                }
}

TEST(RestShape, straight_hair_has_no_bend_and_stiffness_as_it_is)
{
    Groom groom = shaped(combed(16, 0.2));
    groom.rest_position.clear();
    const RestShape shape = make_rest_shape(HairParams(), groom);
    EXPECT_FALSE(shape.curled);
    EXPECT_EQ(shape.turning_rate, 0.0);
    EXPECT_GE(shape.bend_most, 1e30);
    for (const float part : shape.bend)
        EXPECT_LE(std::abs(part), 1e-6f * groom.segment_length[0]);
    for (int k = 1; k < 16; ++k) // straight on from the root
        EXPECT_LT(glm::distance(value(shape.position, 3, k, 16),
                                value(groom.root_position, 3, 0, 1) +
                                    value(groom.root_direction, 3, 0, 1) * double(groom.segment_length[3]) * (k - 1.0)),
                  1e-6);
}

TEST(RestShape, tighter_and_stiffer_curls_ask_for_shorter_substeps_and_no_shorter_than_there_are)
{
    HairParams params;
    const auto rate = [&](const std::vector<Vec>& points, float droop)
    {
        params.bending_droop = droop;
        return make_rest_shape(params, shaped(points)).turning_rate;
    };
    EXPECT_LT(rate(ringlet(33, 16, 0.006, 0.06), 20.0f), rate(ringlet(33, 8, 0.006, 0.03), 20.0f));
    EXPECT_LT(rate(ringlet(33, 8, 0.006, 0.03), 40.0f), rate(ringlet(33, 8, 0.006, 0.03), 20.0f));
    EXPECT_LE(rate(ringlet(33, 8, 0.006, 0.03), 0.01f), 60.0 * 16.0 * 1.0001);
}

TEST(RestShape, spacing_scales_the_shape_and_keeps_it)
{
    const Groom groom = shaped(ringlet(33, 8, 0.006, 0.03));
    HairParams params;
    const RestShape one = make_rest_shape(params, groom);
    params.strand_spacing = 2.0f;
    const RestShape two = make_rest_shape(params, groom);
    for (int k = 2; k < 33; ++k)
        EXPECT_LT(glm::distance(value(two.position, 5, k, 33) - value(two.position, 5, 1, 33),
                                2.0 * (value(one.position, 5, k, 33) - value(one.position, 5, 1, 33))),
                  1e-6)
            << k;
}

} // namespace
} // namespace coif

// Hair as it grows: roots, and the mixing of drawn strands.
#include "sim/groom.h"
#include "sim/scatter.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace coif
{
namespace
{

using test::Scratch;
using test::shipped;

const Scalp& whole_scalp()
{
    static const Scalp scalp = load_scalp(shipped("scalp.obj"));
    return scalp;
}

// Four triangles side by side, of 1, 3, 6 and 20 parts of the area.
Scalp uneven_scalp()
{
    std::string text = "v 0 0 0\nv 0 0 0.1\n";
    float x = 0.0f;
    for (const float parts : {1.0f, 3.0f, 6.0f, 20.0f})
        text += fmt::format("v {0} 0 0\nv {0} 0 0.1\n", x += 0.01f * parts);
    text += "f 1 2 3\nf 3 4 5\nf 5 6 7\nf 7 8 9\n";
    const Scratch scratch;
    return load_scalp(scratch.write("uneven.obj", text));
}

bool same(const Groom& a, const Groom& b)
{
    return a.root_position == b.root_position && a.root_direction == b.root_direction &&
           a.segment_length == b.segment_length && a.drawn_multi == b.drawn_multi && a.drawn.size() == b.drawn.size() &&
           memcmp(a.drawn.data(), b.drawn.data(), a.drawn.size() * sizeof(DrawnStrand)) == 0;
}

glm::vec3 of_lane(const std::vector<float>& values, int strand)
{
    glm::vec3 v;
    for (int axis = 0; axis < 3; ++axis)
        v[axis] = values.at(size_t(strand_value(strand, 0, axis, 1)));
    return v;
}

glm::vec3 vec(float4 v) { return {v.x, v.y, v.z}; }

TEST(Groom, is_the_same_for_the_same_seed_and_another_for_another)
{
    HairParams params;
    const Groom first = grow(params, whole_scalp());
    EXPECT_TRUE(same(first, grow(params, whole_scalp())));
    params.interpolation_seed = 2;
    const Groom other = grow(params, whole_scalp());
    EXPECT_NE(first.root_direction, other.root_direction);
    EXPECT_EQ(first.root_position, other.root_position);
    EXPECT_NE(memcmp(first.drawn.data(), other.drawn.data(), sizeof(DrawnStrand) * first.drawn.size()), 0);
}

TEST(Groom, the_ratio_says_how_many_strands_are_copies)
{
    HairParams params;
    for (const auto& [strands, ratio, copies] : {std::tuple{4096, 0.0f, 0},
                                                 {4096, 0.25f, 1024},
                                                 {4096, 1.0f, 4096},
                                                 {10, 0.33f, 3},
                                                 {0, 0.5f, 0},
                                                 {1, 1.0f, 1}})
    {
        params.interpolation_strands = strands;
        params.interpolation_ratio = ratio;
        const Groom groom = grow(params, whole_scalp());
        EXPECT_EQ(int(groom.drawn.size()), strands);
        EXPECT_EQ(groom.drawn_multi, strands - copies);
        for (int i = groom.drawn_multi; i < strands; ++i)
            EXPECT_TRUE(groom.drawn[size_t(i)].guide0 == groom.drawn[size_t(i)].guide1 &&
                        groom.drawn[size_t(i)].guide1 == groom.drawn[size_t(i)].guide2);
    }
}

TEST(Groom, each_guide_has_as_many_copies_as_any_other_give_or_take_one)
{
    HairParams params;
    params.interpolation_ratio = 1.0f;
    const Groom groom = grow(params, whole_scalp());
    std::vector<int> copies(size_t(groom.guides));
    for (const DrawnStrand& strand : groom.drawn)
        ++copies.at(size_t(strand.guide0));
    const auto [least, most] = std::minmax_element(copies.begin(), copies.end());
    EXPECT_LE(*most - *least, 1);
}

TEST(Groom, mixed_strands_are_spread_over_the_triangles_by_area)
{
    const Scalp scalp = uneven_scalp();
    HairParams params;
    params.interpolation_ratio = 0.0f;
    params.interpolation_strands = 30000;
    const Groom groom = grow(params, scalp);
    const double shares[4] = {1.0 / 30, 3.0 / 30, 6.0 / 30, 20.0 / 30};
    for (size_t t = 0; t < 4; ++t)
    {
        int inside = 0, quarter[4] = {};
        const glm::uvec3 corners = scalp.triangles[t];
        const glm::vec3 a = scalp.positions[corners.x], b = scalp.positions[corners.y], c = scalp.positions[corners.z];
        const glm::vec3 n = glm::cross(b - a, c - a);
        for (const DrawnStrand& strand : groom.drawn)
        {
            unsigned guides[3] = {unsigned(strand.guide0), unsigned(strand.guide1), unsigned(strand.guide2)};
            std::sort(guides, guides + 3);
            if (glm::uvec3(guides[0], guides[1], guides[2]) != corners)
                continue;
            ++inside;
            const glm::vec3 p = vec(strand.root);
            const float wb = glm::dot(glm::cross(p - a, c - a), n) / glm::dot(n, n);
            const float wc = glm::dot(glm::cross(b - a, p - a), n) / glm::dot(n, n);
            // The triangle cut in four at its edges' middles: within it, too, no place is favoured.
            ++quarter[wb > 0.5f ? 1 : wc > 0.5f ? 2 : 1.0f - wb - wc > 0.5f ? 3 : 0];
        }
        EXPECT_NEAR(inside, 30000 * shares[t], 2.0) << t; // stratified
        double chi = 0.0;
        for (const int count : quarter)
            chi += std::pow(count - inside / 4.0, 2) / (inside / 4.0);
        EXPECT_LT(chi, 21.0) << t; // 3 degrees of freedom: once in 10,000
    }
}

TEST(Groom, mixed_strands_stand_on_their_triangle_with_weights_that_sum_to_one)
{
    for (const char* name : {"scalp.obj", "scalp_top.obj", "scalp_strip.obj"})
    {
        const Scalp scalp = load_scalp(shipped(name));
        HairParams params;
        params.root_lift = 80.0f; // opposed guides at the parting lose their weight
        const Groom groom = grow(params, scalp);
        int without_a_guide = 0;
        for (int i = 0; i < groom.drawn_multi; ++i)
        {
            const DrawnStrand& s = groom.drawn[size_t(i)];
            ASSERT_GE(s.weights.z, 0.0f);
            ASSERT_GE(s.weights.y, s.weights.z); // the heaviest first: interpolate_multi counts on it
            ASSERT_GE(s.weights.x, s.weights.y);
            ASSERT_NEAR(s.weights.x + s.weights.y + s.weights.z, 1.0f, 1e-6f);
            const glm::vec3 a = scalp.positions.at(size_t(s.guide0)), b = scalp.positions.at(size_t(s.guide1)),
                            c = scalp.positions.at(size_t(s.guide2));
            ASSERT_LT(triangle_distance(vec(s.root), a, b, c), 1e-6f);
            if (std::min({s.weights.x, s.weights.y, s.weights.z}) > 0.0f)
                ASSERT_LT(glm::length(a * s.weights.x + b * s.weights.y + c * s.weights.z - vec(s.root)), 1e-6f);
            else
                ++without_a_guide;
            ASSERT_GE(s.seed, 0);
            ASSERT_LT(s.seed, 1 << 24);
        }
        EXPECT_GT(without_a_guide, 0) << name;
        EXPECT_LT(without_a_guide, groom.drawn_multi / 2) << name;
    }
}

TEST(Groom, no_weight_is_given_to_guides_that_leave_the_head_the_other_way)
{
    HairParams params;
    params.root_lift = 85.0f;
    const Groom groom = grow(params, whole_scalp());
    for (int i = 0; i < groom.drawn_multi; ++i)
    {
        const DrawnStrand& s = groom.drawn[size_t(i)];
        const int guides[3] = {s.guide0, s.guide1, s.guide2};
        const float weights[3] = {s.weights.x, s.weights.y, s.weights.z};
        const int nearest = int(std::max_element(weights, weights + 3) - weights);
        for (int k = 0; k < 3; ++k)
            if (weights[k] > 0.0f)
            {
                ASSERT_GE(
                    glm::dot(of_lane(groom.root_direction, guides[k]), of_lane(groom.root_direction, guides[nearest])),
                    0.0f);
            }
    }
}

// From a point to the triangles, m.
float off_scalp(const Scalp& scalp, glm::vec3 point)
{
    float nearest = INFINITY;
    for (const glm::uvec3& t : scalp.triangles)
        nearest = std::min(nearest,
                           triangle_distance(point, scalp.positions[t.x], scalp.positions[t.y], scalp.positions[t.z]));
    return nearest;
}

TEST(Groom, copies_are_their_guide_turned_about_the_heads_centre_and_stand_on_the_scalp)
{
    for (const float spread : {0.0f, 9.0f, 60.0f})
    {
        HairParams params;
        params.interpolation_ratio = 1.0f;
        params.interpolation_strands = 1000;
        params.interpolation_spread = spread;
        params.head_scale = 2.0f;
        const Scalp& scalp = whole_scalp();
        const Groom groom = grow(params, scalp);
        int turned = 0;
        for (const DrawnStrand& s : groom.drawn)
        {
            const float yaw = s.weights.x, pitch = s.weights.y;
            ASSERT_LE(std::max(std::abs(yaw), std::abs(pitch)), spread * std::numbers::pi_v<float> / 180.0f + 1e-6f);
            const glm::quat turn = glm::angleAxis(yaw, glm::vec3(0, 1, 0)) * glm::angleAxis(pitch, glm::vec3(1, 0, 0));
            const glm::vec3 from = scalp.positions[size_t(s.guide0)] - scalp.center;
            const glm::vec3 root = vec(s.root) / 2.0f;
            // The head is no ball: what the turn misses of the scalp is made up for.
            ASSERT_LE(glm::length(scalp.center + turn * from - root), 0.02f * scalp.extent + 1e-6f);
            ASSERT_LE(off_scalp(scalp, root), 1e-6f);
            turned += yaw != 0.0f;
        }
        EXPECT_GE(turned, spread > 0.0f ? 700 : 0) << spread;
    }
}

TEST(Groom, where_all_strands_are_simulated_each_drawn_one_is_a_guide_of_its_own_on_the_round_scalp)
{
    HairParams params;
    params.interpolation_guides = GUIDES_ALL;
    params.interpolation_strands = 1000;
    const Groom groom = grow(params, whole_scalp()), few = grow(HairParams(), whole_scalp());
    ASSERT_EQ(groom.guides, 1000);
    ASSERT_EQ(groom.drawn.size(), 1000u);
    EXPECT_EQ(groom.drawn_multi, 0);
    // The fine scalp's triangles are as good as its curve.
    const Scalp fine = refined(whole_scalp(), 2);
    double lowest = 0.0, mean = 0.0;
    for (int s = 0; s < groom.guides; ++s)
    {
        const DrawnStrand& drawn = groom.drawn[size_t(s)];
        const glm::vec3 root = of_lane(groom.root_position, s);
        EXPECT_EQ(drawn.guide0, s);
        EXPECT_EQ(vec(drawn.weights), glm::vec3(0.0f)) << "unturned";
        EXPECT_EQ(vec(drawn.root), root);
        if (s < few.guides)
        {
            EXPECT_EQ(root, of_lane(few.root_position, s)) << "authored vertices come first, and keep their guides";
        }
        double off = INFINITY;
        for (const glm::uvec3& t : fine.triangles)
            off = std::min(
                off, double(triangle_distance(root, fine.positions[t.x], fine.positions[t.y], fine.positions[t.z])));
        lowest = std::max(lowest, off);
        mean += off / groom.guides;
    }
    EXPECT_LT(lowest, 1.5e-3);
    EXPECT_LT(mean, 2e-4);
    params.interpolation_strands = 60;
    const Groom thin = grow(params, whole_scalp());
    EXPECT_EQ(thin.guides, few.guides) << "no fewer than the scalp has vertices";
    ASSERT_EQ(thin.drawn.size(), 60u);
    for (size_t i = 1; i < 60; ++i)
        EXPECT_GT(thin.drawn[i].guide0, thin.drawn[i - 1].guide0);
}

TEST(Groom, cuts_lie_between_one_less_the_variation_and_one)
{
    for (const float variation : {0.0f, 0.15f, 0.95f})
    {
        HairParams params;
        params.strand_length_variation = variation;
        const Groom groom = grow(params, whole_scalp());
        double mean = 0.0;
        for (const DrawnStrand& s : groom.drawn)
        {
            ASSERT_GE(s.root.w, 1.0f - variation - 1e-6f);
            ASSERT_LE(s.root.w, 1.0f);
            mean += double(s.root.w) / double(groom.drawn.size());
        }
        EXPECT_NEAR(mean, 1.0 - variation / 2.0, 0.02 * variation + 1e-6);
    }
}

TEST(Groom, roots_rise_from_the_scalp_at_their_lift_within_its_variation)
{
    const Scalp& scalp = whole_scalp();
    for (const auto& [lift, variation] :
         {std::pair{0.0f, 0.0f}, {0.0f, 6.0f}, {55.0f, 6.0f}, {90.0f, 0.0f}, {95.0f, 60.0f}})
    {
        HairParams params;
        params.root_lift = lift;
        params.root_lift_variation = variation;
        const Groom groom = grow(params, scalp);
        float least = 180.0f, most = 0.0f;
        for (int g = 0; g < groom.guides; ++g)
        {
            const glm::vec3 d = of_lane(groom.root_direction, g);
            ASSERT_NEAR(glm::length(d), 1.0f, 1e-5f);
            const glm::vec3 n = scalp.normals[size_t(g)];
            const float angle =
                std::atan2(glm::length(glm::cross(n, d)), glm::dot(n, d)) * 180.0f / std::numbers::pi_v<float>;
            least = std::min(least, angle);
            most = std::max(most, angle);
        }
        EXPECT_GE(least, std::max(lift - variation, 0.0f) - 0.01f);
        EXPECT_LE(most, lift + variation + 0.01f);
        EXPECT_GE(most - least, variation * 0.9f) << lift; // and it is used
    }
}

TEST(Groom, hair_grows_away_from_the_crown_and_sweep_turns_it_counter_clockwise)
{
    const Scalp& scalp = whole_scalp();
    HairParams params;
    params.root_lift = 60.0f;
    params.root_lift_variation = 0.0f;
    params.root_sweep_variation = 0.0f;
    params.root_part = 0.0f;
    params.root_crown = F4(0, 1, 0, 0);
    const Groom plain = grow(params, scalp);
    params.root_sweep = 90.0f;
    const Groom swept = grow(params, scalp);
    for (int g = 0; g < plain.guides; ++g)
    {
        const glm::vec3 n = scalp.normals[size_t(g)];
        const glm::vec3 a = of_lane(plain.root_direction, g) - n * 0.5f,
                        b = of_lane(swept.root_direction, g) - n * 0.5f;
        EXPECT_TRUE(a.y < 0.0f || n.y > 0.999f) << g;
        EXPECT_NEAR(glm::dot(a, b), 0.0f, 1e-4f) << g;
        EXPECT_NEAR(glm::dot(glm::cross(a, b), n), 0.75f, 1e-3f) << g; // seen from outside
    }
}

TEST(Groom, a_parting_divides_left_from_right)
{
    const Scalp& scalp = whole_scalp();
    HairParams params;
    params.root_lift_variation = params.root_sweep_variation = 0.0f;
    params.root_crown = F4(0, 1, 0, 0);
    params.root_part = 60.0f;
    const Groom groom = grow(params, scalp);
    for (int g = 0; g < groom.guides; ++g)
    {
        const glm::vec3 p = scalp.positions[size_t(g)];
        const bool beside_it = std::abs(p.x) > 0.01f && p.y > 0.06f && p.z > 0.0f;
        EXPECT_TRUE(!beside_it || of_lane(groom.root_direction, g).x * p.x > 0.0f) << g;
    }
}

TEST(Groom, the_last_blocks_spare_lanes_are_the_first_guide)
{
    const Groom groom = grow({}, whole_scalp());
    ASSERT_EQ(groom.guides, 252);
    ASSERT_EQ(groom.blocks, 16);
    ASSERT_EQ(groom.root_position.size(), 16u * 3 * 16);
    ASSERT_EQ(groom.segment_length.size(), 256u);
    for (int s = 252; s < 256; ++s)
    {
        EXPECT_EQ(of_lane(groom.root_position, s), of_lane(groom.root_position, 0));
        EXPECT_EQ(of_lane(groom.root_direction, s), of_lane(groom.root_direction, 0));
        EXPECT_EQ(groom.segment_length[size_t(s)], groom.segment_length[0]);
    }
    for (int g = 0; g < 252; ++g)
        EXPECT_EQ(of_lane(groom.root_position, g), whole_scalp().positions[size_t(g)]);
}

TEST(Groom, the_heads_scale_moves_the_roots_and_leaves_the_strands_as_long)
{
    HairParams params;
    const Groom one = grow(params, whole_scalp());
    params.head_scale = 2.5f;
    const Groom large = grow(params, whole_scalp());
    EXPECT_FLOAT_EQ(large.extent, 2.5f * one.extent);
    EXPECT_EQ(large.center, one.center * 2.5f);
    EXPECT_EQ(large.root_direction, one.root_direction);
    EXPECT_EQ(large.segment_length, one.segment_length);
    for (int g = 0; g < one.guides; ++g)
        EXPECT_LT(glm::length(of_lane(large.root_position, g) - 2.5f * of_lane(one.root_position, g)), 1e-6f);
    for (size_t i = 0; i < one.drawn.size(); ++i)
        EXPECT_LT(glm::length(vec(large.drawn[i].root) - 2.5f * vec(one.drawn[i].root)), 1e-6f);
}

TEST(Groom, all_roots_lie_within_the_farthest_of_the_middle)
{
    for (const char* name : {"scalp.obj", "scalp_top.obj", "scalp_strip.obj"})
    {
        HairParams params;
        params.head_scale = 1.5f;
        const Groom groom = grow(params, load_scalp(shipped(name)));
        float farthest = 0.0f;
        for (int g = 0; g < groom.guides; ++g)
            farthest = std::max(farthest, glm::length(of_lane(groom.root_position, g) - groom.middle));
        EXPECT_FLOAT_EQ(farthest, groom.farthest) << name;
        EXPECT_LE(groom.farthest, 0.87f * groom.extent) << name; // half the diagonal of a cube
    }
}

TEST(Groom, segments_share_the_length_whatever_the_number_of_nodes)
{
    for (const int nodes : {3, 4, 64})
    {
        HairParams params;
        params.strand_nodes = nodes;
        params.strand_length = 0.62f;
        const Groom groom = grow(params, whole_scalp());
        EXPECT_EQ(groom.nodes, nodes);
        EXPECT_EQ(groom.longest, 0.62f);
        for (const float segment : groom.segment_length)
            EXPECT_NEAR(segment * float(nodes - 2), 0.62f, 1e-6f);
    }
}

TEST(Groom, a_scalp_of_slivers_and_loose_vertices_grows_finite_hair)
{
    const Scratch scratch;
    const std::string texts[] = {
        "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",                        // no area
        "v 0 0 0\nv 1 0 0\nv 2 0 1\nf 1 1 1\n",                        // no triangle to speak of
        "v 0 0 0\nv 0.1 0 0\nv 0 0 0.1\nv 5 5 5\nv -5 5 5\nf 1 3 2\n", // guides that no triangle holds
    };
    for (const std::string& text : texts)
        for (const float ratio : {0.0f, 0.5f, 1.0f})
        {
            HairParams params;
            params.interpolation_ratio = ratio;
            params.interpolation_strands = 100;
            params.root_crown = F4(0, 0, 0, 0);
            const Groom groom = grow(params, load_scalp(scratch.write("odd.obj", text)));
            for (const std::vector<float>* values :
                 {&groom.root_position, &groom.root_direction, &groom.segment_length})
                for (const float value : *values)
                    ASSERT_TRUE(std::isfinite(value)) << text;
            for (const DrawnStrand& s : groom.drawn)
            {
                ASSERT_TRUE(std::isfinite(s.root.x + s.root.y + s.root.z + s.weights.x + s.weights.y + s.weights.z))
                    << text;
                ASSERT_LT(std::max({s.guide0, s.guide1, s.guide2}), groom.guides);
            }
        }
}

HairParams curled()
{
    HairParams params;
    params.strand_length = 0.1f;
    params.strand_nodes = 50;
    params.curl_radius = 0.006f;
    params.curl_pitch = 0.025f;
    params.curl_variation = 0.0f;
    params.curl_begin = 0.0f;
    params.interpolation_strands = 500;
    return params;
}

TEST(Form, a_curl_of_eight_nodes_a_turn_is_a_helix_of_its_radius_pitch_and_hand)
{
    for (const int hand : {0, 1})
    {
        HairParams params = curled();
        params.curl_hand = hand;
        ASSERT_TRUE(curls_are_shape(params));
        EXPECT_EQ(device_params(params).curl_radius, 0.0f) << "nothing is left to lay on";
        const Groom groom = grow(params, whole_scalp());
        for (int g = 0; g < groom.guides; ++g)
        {
            const glm::dvec3 root = of_lane(groom.root_position, g), axis = of_lane(groom.root_direction, g);
            glm::dvec3 before(0.0);
            double turned = 0.0, from = 0.0, to = 0.0;
            for (int k = 0; k < groom.nodes; ++k)
            {
                const glm::dvec3 way = vector_at(groom.natural_position.data(), g, k, groom.nodes) - root;
                const double along = glm::dot(way, axis);
                const glm::dvec3 out = way - along * axis;
                if (along < 0.026)
                    continue; // a quarter of the strand: it sets in
                EXPECT_NEAR(glm::length(out), 0.006, 2e-5);
                if (from > 0.0)
                    turned += std::atan2(glm::dot(axis, glm::cross(before, out)), glm::dot(before, out));
                from = from > 0.0 ? from : along;
                to = along;
                before = out;
            }
            EXPECT_NEAR(to, 0.1, 1e-5);
            EXPECT_NEAR(turned / (2.0 * std::numbers::pi), (hand == 0 ? 1.0 : -1.0) * (to - from) / 0.025, 1e-3);
        }
    }
    HairParams few = curled();
    few.strand_nodes = 32;
    EXPECT_FALSE(curls_are_shape(few));
    EXPECT_TRUE(grow(few, whole_scalp()).natural_position.empty());
}

TEST(Form, waves_follow_their_profile)
{
    HairParams params = curled();
    params.wave_along = F4(1.0f, 1.0f, 0.0f, 0.0f);
    const Groom groom = grow(params, whole_scalp());
    const glm::dvec3 root = of_lane(groom.root_position, 0), axis = of_lane(groom.root_direction, 0);
    for (int k = 2; k < groom.nodes; ++k)
    {
        const glm::dvec3 way = vector_at(groom.natural_position.data(), 0, k, groom.nodes) - root;
        const double along = glm::dot(way, axis), size = glm::length(way - along * axis);
        if (along < 0.026)
            continue; // a quarter of the strand: the curl sets in
        EXPECT_NEAR(size, 0.006 * std::clamp(2.0 - along * 30.0, 0.0, 1.0), 3e-5) << along;
    }
}

TEST(Form, strands_whose_guides_curl_each_in_its_own_place_follow_one_of_them)
{
    HairParams params = curled();
    for (const float phase : {0.0f, 1.0f})
    {
        params.curl_phase = phase;
        const Groom groom = grow(params, whole_scalp());
        int mixed = 0;
        for (int i = 0; i < groom.drawn_multi; ++i)
            mixed += groom.drawn[size_t(i)].weights.y > 0.0f;
        EXPECT_EQ(mixed > 0, phase == 0.0f);
    }
}

TEST(Form, clumps_have_leaders_as_far_apart_as_they_are_wide_and_none_beyond_a_parting)
{
    HairParams params;
    params.interpolation_strands = 4000;
    const Groom without = grow(params, whole_scalp());
    for (size_t i = 0; i < without.drawn.size(); ++i)
        ASSERT_EQ(without.drawn[i].leader, int(i));
    params.clump_strength = 0.5f;
    for (const float size : {0.01f, 0.02f, 0.05f})
    {
        params.clump_size = size;
        const Groom groom = grow(params, whole_scalp());
        EXPECT_TRUE(same(groom, grow(params, whole_scalp())));
        const auto direction = [&](const DrawnStrand& s) { return of_lane(groom.root_direction, s.guide0); };
        std::vector<size_t> leaders;
        for (size_t i = 0; i < groom.drawn.size(); ++i)
        {
            const DrawnStrand &s = groom.drawn[i], &leader = groom.drawn[size_t(s.leader)];
            ASSERT_EQ(groom.drawn[size_t(s.leader)].leader, s.leader) << "leaders are led by none";
            EXPECT_LT(glm::distance(vec(s.root), vec(leader.root)), size);
            EXPECT_GE(glm::dot(direction(s), direction(leader)), kSameWay);
            EXPECT_NEAR(s.weights.w, glm::dot(vec(s.root) - vec(leader.root), direction(leader)), 1e-6f);
            if (s.leader == int(i))
                leaders.push_back(i);
        }
        double sum = 0.0, beside = 0.0;
        for (const size_t a : leaders)
        {
            float least = INFINITY;
            for (const size_t b : leaders)
                if (a != b && glm::dot(direction(groom.drawn[a]), direction(groom.drawn[b])) >= kSameWay)
                    least = std::min(least, glm::distance(vec(groom.drawn[a].root), vec(groom.drawn[b].root)));
            EXPECT_GE(least, 0.8f * size);
            if (least > 2.0f * size) // hair there leaves the head its own way
                continue;
            sum += least;
            ++beside;
        }
        EXPECT_GT(beside, 0.9 * double(leaders.size()));
        EXPECT_NEAR(sum / beside, 0.9 * size, 0.1 * size) << "the nearest of some six neighbours";
        // All else is as it was without clumps.
        for (size_t i = 0; i < groom.drawn.size(); ++i)
        {
            DrawnStrand s = groom.drawn[i];
            s.leader = int(i);
            s.weights.w = 0.0f;
            ASSERT_EQ(memcmp(&s, &without.drawn[i], sizeof s), 0);
        }
    }
}

} // namespace
} // namespace coif

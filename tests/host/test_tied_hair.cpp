// What ties make of a groom: hair runs over the head to its ring, through it, and on.
#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/scatter.h"
#include "sim/tied_hair.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coif
{
namespace
{

using test::shipped;

Tie pony_tail()
{
    Tie tie;
    tie.name = "tail";
    return tie;
}

// The shipped scalp, with a ball that fits it for a head.
struct Scene
{
    Hairstyle style;
    Scalp scalp = load_scalp(shipped("scalp.obj"));
    TieGround ground;
    Groom groom;
    TieRoots roots;

    explicit Scene(std::vector<Tie> ties)
    {
        style.params.strand_length = 0.45f;
        style.params.strand_nodes = 26;
        style.params.interpolation_strands = 1500;
        style.host.ties = std::move(ties);
        ground.spheres = {{scalp.center, scalp.radius - 0.001f, true, {}}};
    }
    void tie()
    {
        const Scalp own = guide_scalp(scalp, style.params);
        const Shaping shaping = shape_over(style.params, style.host, scalp, own);
        groom = grow(shaping);
        roots = tie_roots(groom, shaping);
        for (size_t i = 0; i < style.host.ties.size(); ++i)
            check_tie(groom, shaping, i, roots, ground);
        tie_hair(groom, shaping, roots, ground);
    }
    glm::vec3 node(int guide, int k) const
    {
        return glm::vec3(vector_at(groom.natural_position.data(), guide, k, groom.nodes));
    }
    // Where a guide runs through the plane of its ring.
    glm::vec3 in_ring(int guide, const Tie& tie) const
    {
        const glm::vec3 axis = glm::normalize(tie.axis);
        const int held = held_nodes(groom, guide);
        const glm::vec3 a = node(guide, held - 2), b = node(guide, held - 1);
        const float from = glm::dot(a - tie.at, axis), to = glm::dot(b - tie.at, axis);
        return glm::mix(a, b, std::clamp(from / (from - to), 0.0f, 1.0f));
    }
};

TEST(TiedHair, runs_outside_of_the_head_in_equal_segments)
{
    Scene scene({pony_tail()});
    scene.tie();
    for (int g = 0; g < scene.groom.guides; ++g)
        for (int k = 2; k < held_nodes(scene.groom, g); ++k)
        {
            EXPECT_GE(height_above(scene.ground, scene.node(g, k)), 0.0005f) << "guide " << g << ", node " << k;
            EXPECT_NEAR(glm::distance(scene.node(g, k), scene.node(g, k - 1)), scene.groom.segment_length[size_t(g)],
                        2e-6f);
        }
    EXPECT_EQ(scene.groom.short_of_ring, std::vector<int>{0});
}

TEST(TiedHair, comes_through_its_ring_each_strand_at_its_own_place)
{
    const Tie tie = pony_tail();
    Scene scene({tie});
    scene.tie();
    std::vector<glm::vec3> places;
    for (int g = 0; g < scene.groom.guides; ++g)
    {
        ASSERT_GT(held_nodes(scene.groom, g), 2) << g;
        const glm::vec3 place = scene.in_ring(g, tie);
        EXPECT_LE(glm::distance(place, tie.at), tie.radius) << g;
        for (const glm::vec3& other : places)
            EXPECT_GT(glm::distance(place, other), 2e-5f);
        places.push_back(place);
        // And out of it along the axis.
        const int held = held_nodes(scene.groom, g);
        const glm::vec3 leaves = glm::normalize(scene.node(g, held) - scene.node(g, held - 1));
        EXPECT_GT(glm::dot(leaves, glm::normalize(tie.axis)), 0.96f);
    }
}

TEST(TiedHair, neighbours_on_the_scalp_are_neighbours_in_the_ring)
{
    const Tie tie = pony_tail();
    Scene scene({tie});
    scene.tie();
    double near = 0.0, any = 0.0;
    int pairs = 0;
    for (const glm::uvec3& t : scene.scalp.triangles)
    {
        near += double(glm::distance(scene.in_ring(int(t.x), tie), scene.in_ring(int(t.y), tie)));
        any +=
            double(glm::distance(scene.in_ring(int(t.x), tie), scene.in_ring((pairs * 37) % scene.groom.guides, tie)));
        ++pairs;
    }
    EXPECT_LT(near, 0.45 * any);
}

TEST(TiedHair, too_short_for_the_ring_is_left_loose_and_counted)
{
    Scene scene({pony_tail()});
    scene.style.params.strand_length = 0.15f;
    const Groom loose = grow(scene.style.params, scene.scalp);
    scene.tie();
    int short_ones = 0;
    for (int g = 0; g < scene.groom.guides; ++g)
        if (held_nodes(scene.groom, g) == 2)
        {
            ++short_ones;
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_EQ(scene.groom.root_direction[size_t(strand_value(g, 0, axis, 1))],
                          loose.root_direction[size_t(strand_value(g, 0, axis, 1))]);
        }
    EXPECT_GT(short_ones, 10);
    EXPECT_LT(short_ones, scene.groom.guides);
    EXPECT_EQ(scene.groom.short_of_ring, std::vector<int>{short_ones});
}

TEST(TiedHair, of_two_ties_is_never_mixed)
{
    Tie left = pony_tail(), right = pony_tail();
    left.at = {0.093f, 0.045f, -0.03f};
    left.axis = {1.0f, 0.1f, -0.3f};
    right.at = {-0.093f, 0.045f, -0.03f};
    right.axis = {-1.0f, 0.1f, -0.3f};
    right.name = "right";
    Scene scene({left, right});
    scene.tie();
    const Groom& groom = scene.groom;
    ASSERT_EQ(groom.tied.size(), size_t(groom.drawn_multi));
    EXPECT_EQ(groom.drawn.size(), 1500u);
    int of[2] = {};
    for (int i = 0; i < groom.drawn_multi; ++i)
    {
        const DrawnStrand& strand = groom.drawn[size_t(i)];
        const int tie = groom.tied[size_t(i)].tail;
        EXPECT_GT(groom.tied[size_t(i)].ring, 1.0f);
        for (const int guide : {strand.guide0, strand.guide1, strand.guide2})
            EXPECT_EQ(scene.roots.guides[size_t(guide)], tie);
        EXPECT_NEAR(strand.weights.x + strand.weights.y + strand.weights.z, 1.0f, 1e-5f);
        ++of[tie];
        // Where two of the guides' ties meet the strand's own root has the say.
        if (std::abs(strand.root.x) > 0.02f)
        {
            EXPECT_EQ(tie, strand.root.x > 0.0f ? 0 : 1);
        }
    }
    EXPECT_EQ(groom.drawn_multi, 1500) << "copies would miss the rings";
    EXPECT_GT(std::min(of[0], of[1]), 600);
}

TEST(TiedHair, is_cut_behind_the_ring_only)
{
    Scene scene({pony_tail()});
    scene.style.params.strand_length_variation = 0.9f;
    scene.tie();
    float shortest = 1.0f;
    for (int i = 0; i < scene.groom.drawn_multi; ++i)
    {
        const float links = float(scene.groom.nodes - 2), ring = scene.groom.tied[size_t(i)].ring;
        EXPECT_GT(scene.groom.drawn[size_t(i)].root.w * links, ring - 1.0f);
        shortest = std::min(shortest, scene.groom.drawn[size_t(i)].root.w);
    }
    EXPECT_LT(shortest, 0.6f);
}

TEST(TiedHair, holds_each_strand_by_its_own_guide_where_all_are_simulated)
{
    Scene scene({pony_tail()});
    scene.style.params.interpolation_guides = GUIDES_ALL;
    scene.style.params.interpolation_strands = 900;
    scene.tie();
    ASSERT_EQ(scene.groom.guides, 900);
    EXPECT_GT(scene.groom.drawn_multi, 800) << "what is tied hangs in the tail";
    for (int i = 0; i < scene.groom.drawn_multi; ++i)
    {
        const DrawnStrand& strand = scene.groom.drawn[size_t(i)];
        EXPECT_EQ(strand.guide0, strand.guide1);
        EXPECT_EQ(strand.guide0, strand.guide2);
        EXPECT_GT(scene.groom.tied[size_t(i)].ring, 0.0f);
        EXPECT_GT(held_nodes(scene.groom, strand.guide0), 2);
    }
}

TEST(TiedHair, gathers_the_hair_of_its_regions_alone)
{
    Tie tie = pony_tail();
    tie.regions = {"upper"};
    Scene scene({tie});
    Region upper;
    upper.name = "upper";
    upper.planes = {{0.0f, 1.0f, 0.0f, 0.03f}};
    upper.edge = 0.0f;
    scene.style.host.regions = {upper};
    scene.tie();
    int tied = 0;
    for (int g = 0; g < scene.groom.guides; ++g)
    {
        const double y = vector_at(scene.groom.root_position.data(), g, 0, 1).y;
        EXPECT_EQ(held_nodes(scene.groom, g) > 2, y > 0.03) << y;
        tied += y > 0.03;
    }
    EXPECT_GT(tied, 20);
    EXPECT_GT(std::count_if(scene.groom.tied.begin(), scene.groom.tied.end(), [](auto& t) { return t.ring == 0.0f; }),
              100);
}

TEST(TiedHair, keeps_its_shape_behind_the_ring)
{
    // Curls go on there as they were grown, turned to where the hair leaves.
    Scene scene({pony_tail()});
    scene.style.params.strand_nodes = 60;
    scene.style.params.wave_normal_amplitude = scene.style.params.wave_binormal_amplitude = 0.004f;
    scene.style.params.wave_normal_frequency = scene.style.params.wave_binormal_frequency = 12.0f;
    ASSERT_TRUE(waves_are_shape(scene.style.params));
    const Groom loose = grow(scene.style.params, scene.scalp);
    scene.tie();
    for (int g = 0; g < scene.groom.guides; g += 17)
        for (int k = held_nodes(scene.groom, g); k + 1 < scene.groom.nodes; ++k)
        {
            const auto cosine = [&](const Groom& groom)
            {
                const auto at = [&](int i) { return vector_at(groom.natural_position.data(), g, i, groom.nodes); };
                return glm::dot(glm::normalize(at(k + 1) - at(k)), glm::normalize(at(k) - at(k - 1)));
            };
            if (k == held_nodes(scene.groom, g)) // there the hair turns into its flare
                continue;
            EXPECT_NEAR(cosine(scene.groom), cosine(loose), 1e-4) << g << " " << k;
        }
}

TEST(TiedHair, tells_of_rings_that_are_none)
{
    const auto said = [](Tie tie)
    {
        try
        {
            Scene({tie}).tie();
        }
        catch (const Error& e)
        {
            return std::string(e.what());
        }
        return std::string();
    };
    Tie inside = pony_tail(), flat = pony_tail(), wide = pony_tail(), lost = pony_tail();
    inside.at = {0.0f, 0.03f, -0.06f};
    EXPECT_NE(said(inside).find("tie 'tail' has its ring"), std::string::npos) << said(inside);
    EXPECT_NE(said(inside).find("mm inside the head"), std::string::npos);
    flat.axis = glm::vec3(0.0f);
    EXPECT_NE(said(flat).find("axis must not be zero"), std::string::npos) << said(flat);
    wide.radius = NAN;
    EXPECT_NE(said(wide).find("must lie in [0.002, 0.2] m"), std::string::npos) << said(wide);
    lost.regions = {"nowhere"};
    EXPECT_NE(said(lost).find("gathers no hair"), std::string::npos) << said(lost);
}

TEST(TiedHair, keeps_where_it_rests_when_a_ring_is_moved)
{
    Scene before({pony_tail()}), after({pony_tail()});
    before.tie();
    before.groom.rest_position = before.groom.natural_position; // as if it had come to hang, slanted
    for (int g = 0; g < before.groom.blocks * LANES; ++g)
        for (int k = held_nodes(before.groom, g); k < before.groom.nodes; ++k)
            before.groom.rest_position[size_t(strand_value(g, k, 1, before.groom.nodes))] -= 0.01f * float(k);
    after.style.host.ties[0].at.x += 0.01f;
    after.tie();
    Groom moved = after.groom;
    keep_rest(moved, before.groom);
    for (int g = 0; g < moved.guides; ++g)
    {
        const int held = held_nodes(moved, g);
        for (int k = 0; k < moved.nodes; ++k)
        {
            const glm::dvec3 at = vector_at(moved.rest_position.data(), g, k, moved.nodes);
            if (k < held)
            {
                EXPECT_LE(glm::distance(glm::vec3(at), after.node(g, k)), 1e-6f);
            }
            else if (k >= std::max(held, held_nodes(before.groom, g)))
            {
                const auto step = [&](const Groom& groom)
                {
                    return vector_at(groom.rest_position.data(), g, k, groom.nodes) -
                           vector_at(groom.rest_position.data(), g, k - 1, groom.nodes);
                };
                EXPECT_LE(glm::distance(step(moved), step(before.groom)), 1e-6);
            }
        }
    }
}

TEST(RingPlace, stands_off_the_head_at_the_height_that_is_asked_for)
{
    const Scene scene({});
    for (const glm::vec3 at : {glm::vec3(0.01f, 0.02f, 0.03f), glm::vec3(0.3f, 0.1f, -0.2f), glm::vec3(0, 0.098f, 0)})
    {
        const RingPlace place = ring_place(scene.ground, at, 0.012f);
        EXPECT_NEAR(height_above(scene.ground, place.at), 0.012f, 1e-4f);
        EXPECT_NEAR(glm::length(place.out), 1.0f, 1e-5f);
    }
}

} // namespace
} // namespace coif

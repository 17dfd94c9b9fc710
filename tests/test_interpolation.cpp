// Drawn strands against their guides: what the two ways of making them promise, and that nothing drawn enters a body.
#include "sim/error.h"
#include "sim/simulation.h"
#include "tests/on_device.h"
#include "tests/oracle.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <set>

namespace coif
{
namespace
{

using Vec = glm::dvec3;

Hairstyle style_of(std::initializer_list<const char*> sets)
{
    Hairstyle style;
    for (const char* set : {"head.mesh=", "interpolation.strands=500", "grid.resolution=20"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

struct Hair
{
    Simulation simulation;
    std::vector<Vec> guides;   // [guide][node]
    std::vector<float4> drawn; // [strand][node]
    int nodes = 0;

    explicit Hair(const Hairstyle& style) : simulation(test_device(), style) {}
    const Groom& groom() const { return simulation.solver().groom(); }
    void read_back()
    {
        simulation.solver().draw();
        nodes = groom().nodes;
        const Mapped x = simulation.solver().guide_positions();
        guides = from_blocks(std::vector<float>(x.as<float>(), x.as<float>() + x.bytes() / 4), groom().guides, nodes);
        const Mapped d = simulation.solver().drawn_positions();
        drawn.assign(d.as<float4>(), d.as<float4>() + d.bytes() / sizeof(float4));
    }
    Vec guide(int g, int k) const { return guides[size_t(g * nodes + k)]; }
    Vec node(size_t s, int k) const
    {
        const float4 p = drawn[s * size_t(nodes) + size_t(k)];
        return {p.x, p.y, p.z};
    }
};

// Guides that part company are not mixed in barycentric shares; the twin knows how (oracle_drawn.cpp).
bool stay_together(const Hair& hair, const DrawnStrand& strand)
{
    const auto apart = [&](int g, int k) { return glm::distance(hair.guide(g, k), hair.guide(strand.guide0, k)); };
    for (const int g : {strand.guide1, strand.guide2})
        for (const int k : {(hair.nodes + 1) / 2, hair.nodes - 1})
            if (apart(g, k) - apart(g, 1) > double(hair.simulation.solver().info().parting) - 1e-6)
                return false;
    return true;
}

TEST(Interpolation, WithoutCopiesEachNodeIsTheBarycentricMixOfItsGuides)
{
    Hair hair(style_of({"interpolation.ratio=0", "interpolation.layer=0", "strand.length_variation=0"}));
    hair.simulation.play(find_motion("nod"));
    for (int i = 0; i < 40; ++i)
        hair.simulation.step(hair.simulation.hand());
    hair.simulation.solver().set_colliders({});
    hair.simulation.solver().set_body({});
    hair.read_back();
    ASSERT_EQ(hair.groom().drawn_multi, 500);
    double worst = 0.0, off_scalp = 0.0;
    int mixed = 0;
    for (size_t s = 0; s < 500; ++s)
    {
        const DrawnStrand& strand = hair.groom().drawn[s];
        if (!stay_together(hair, strand))
            continue;
        ++mixed;
        const int of[3] = {strand.guide0, strand.guide1, strand.guide2};
        const double w[3] = {strand.weights.x, strand.weights.y, strand.weights.z};
        EXPECT_NEAR(w[0] + w[1] + w[2], 1.0, 1e-6);
        // A strand near a parting follows fewer guides, from a root of its own.
        const bool whole = w[0] > 0.0 && w[1] > 0.0 && w[2] > 0.0;
        for (int k = 0; k < hair.nodes; ++k)
        {
            Vec mix(0.0), way(0.0);
            for (int g = 0; g < 3; ++g)
            {
                mix += w[g] * hair.guide(of[g], k);
                way += w[g] * (hair.guide(of[g], k) - hair.guide(of[g], 1));
            }
            worst = std::max(worst, glm::distance(hair.node(s, k) - hair.node(s, 1), way));
            if (whole)
                off_scalp = std::max(off_scalp, glm::distance(hair.node(s, k), mix));
        }
    }
    EXPECT_GT(mixed, 300);
    // Sums of six products of up to half a metre.
    EXPECT_LE(worst, 5e-7);
    EXPECT_LE(off_scalp, 5e-7);
}

TEST(Interpolation, WithCopiesOnlyEachIsItsGuideTurnedAtARootOfItsOwn)
{
    Hair hair(style_of({"interpolation.ratio=1", "interpolation.layer=0", "strand.length_variation=0"}));
    hair.simulation.play(find_motion("turn"));
    for (int i = 0; i < 40; ++i)
        hair.simulation.step(hair.simulation.hand());
    hair.simulation.solver().set_colliders({});
    hair.simulation.solver().set_body({});
    hair.read_back();
    ASSERT_EQ(hair.groom().drawn_multi, 0);
    const glm::dquat head = hair.simulation.solver().head().turn;
    double worst = 0.0, widest = 0.0;
    std::set<int> used;
    for (size_t s = 0; s < 500; ++s)
    {
        const DrawnStrand& strand = hair.groom().drawn[s];
        used.insert(strand.guide0);
        const glm::dquat turn = glm::angleAxis(double(strand.weights.x), Vec(0, 1, 0)) *
                                glm::angleAxis(double(strand.weights.y), Vec(1, 0, 0));
        const Vec root = head * Vec(oracle::xyz(strand.root));
        for (int k = 0; k < hair.nodes; ++k)
        {
            const Vec from_root = hair.guide(strand.guide0, k) - hair.guide(strand.guide0, 1);
            const Vec expected = root + head * (turn * (glm::conjugate(head) * from_root));
            worst = std::max(worst, glm::distance(hair.node(s, k), expected));
        }
        widest = std::max(widest, glm::angle(turn));
    }
    EXPECT_LE(worst, 1e-6); // three rotations in floats
    EXPECT_GT(widest, 0.1); // spread is 9 degrees about two axes
    EXPECT_LT(widest, 0.25);
    EXPECT_EQ(int(used.size()), hair.groom().guides) << "copies are shared out equally";
}

TEST(Interpolation, StrandsAreCutToBetweenTheLeastLengthAndTheWhole)
{
    Hair hair(style_of({"interpolation.layer=0", "strand.length_variation=0.6"}));
    hair.simulation.solver().set_colliders({});
    hair.simulation.solver().set_body({});
    hair.read_back();
    double shortest = 1.0, longest = 0.0;
    for (size_t s = 0; s < hair.groom().drawn.size(); ++s)
    {
        double length = 0.0, whole = 0.0;
        const DrawnStrand& strand = hair.groom().drawn[s];
        if (!stay_together(hair, strand))
            continue;
        for (int k = 2; k < hair.nodes; ++k)
        {
            length += glm::distance(hair.node(s, k), hair.node(s, k - 1));
            // Straight strands at rest: a mix is as long as the mix of the guides' ways.
            Vec way(0.0);
            const int of[3] = {strand.guide0, strand.guide1, strand.guide2};
            const double w[3] = {strand.weights.x, strand.weights.y, strand.weights.z};
            for (int g = 0; g < 3; ++g)
                way += w[g] * (hair.guide(of[g], k) - hair.guide(of[g], k - 1));
            whole += int(s) < hair.groom().drawn_multi
                         ? glm::length(way)
                         : glm::distance(hair.guide(strand.guide0, k), hair.guide(strand.guide0, k - 1));
        }
        // At the tip the curve has no node to go on to and slows down: half a percent.
        EXPECT_NEAR(length / whole, strand.root.w, 6e-3) << "strand " << s;
        shortest = std::min(shortest, length / whole);
        longest = std::max(longest, length / whole);
    }
    EXPECT_GE(shortest, 0.4 - 6e-3);
    EXPECT_LT(shortest, 0.45);
    EXPECT_LE(longest, 1.0 + 6e-3);
    EXPECT_GT(longest, 0.95);
}

// How much nearer than `room` says a drawn node has come to a collider, m.
double worst_intrusion(const Hair& hair, bool with_waves)
{
    const HairParams params = device_params(hair.simulation.style().params);
    double worst = 0.0;
    const auto& grid = hair.simulation.solver().body().grid;
    const oracle::Body body = grid ? oracle::body_of(*grid) : oracle::Body{};
    for (size_t s = 0; s < hair.groom().drawn.size(); ++s)
        for (int k = 2; k < hair.nodes; ++k)
        {
            const double room = with_waves ? oracle::room_at(k, hair.nodes, hair.groom().drawn[s], params,
                                                             hair.simulation.solver().info())
                                           : 0.0;
            const Vec p = hair.node(s, k);
            for (const Capsule& c : hair.simulation.solver().placed_colliders())
                worst = std::max(worst, c.center.w + room - glm::distance(p, oracle::nearest_on_axis(c, p)));
            if (!body.distance.empty())
                worst = std::max(worst, room - oracle::plane_at(body, p, hair.simulation.solver().info()).distance);
        }
    return worst;
}

TEST(Interpolation, NothingDrawnEntersTheHeadWhenItShakes)
{
    for (const char* motion : {"shake", "drag", "gust"})
    {
        Hair hair(style_of({"interpolation.ratio=0.5"}));
        hair.simulation.settle(0.5);
        hair.simulation.play(find_motion(motion));
        for (int i = 0; i < 60; ++i)
        {
            hair.simulation.step(hair.simulation.hand());
            if (i % 10)
                continue;
            hair.read_back();
            EXPECT_LE(worst_intrusion(hair, false), 1e-4) << motion << ", step " << i;
            EXPECT_LE(worst_intrusion(hair, true), 1e-4) << motion << ", step " << i << ": clearance and layer";
        }
    }
}

TEST(Interpolation, NodesKeepTheWavesAwayFromTheHeadAsWell)
{
    Hair hair(style_of({"wave.normal_amplitude=0.05", "wave.binormal_amplitude=0.03", "wave.binormal_begin=0.5"}));
    hair.simulation.play(find_motion("shake"));
    for (int i = 0; i < 60; ++i)
        hair.simulation.step(hair.simulation.hand());
    hair.read_back();
    EXPECT_LE(worst_intrusion(hair, true), 1e-4);
}

TEST(Interpolation, WithoutShadowAllLightArrives)
{
    Hair hair(style_of({"look.self_shadow=0"}));
    hair.simulation.step({});
    hair.read_back();
    for (const float4& p : hair.drawn)
        ASSERT_EQ(p.w, 1.0f);
    EXPECT_EQ(hair.simulation.solver().optical_depth().bytes(), 0u);
}

} // namespace
} // namespace coif

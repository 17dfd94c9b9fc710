// The passes that make drawn strands against their double-precision twins. They are launched by Solver::draw(), since
// how many strands a work-item takes is between the two of them.
#include "sim/error.h"
#include "tests/on_device.h"
#include "tests/oracle.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace coif
{
namespace
{

struct Case
{
    const char* name;
    int width, nodes, resolution, guides, drawn;
    bool shadow, bodies;
    void (*change)(HairParams&);
    bool body = false;
    bool varied = false; // each strand has a look of its own
    int tails = 0;       // that most mixed strands hang in
    bool braids = false; // every second tail is one
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class DrawnPasses : public testing::TestWithParam<Case>
{
  protected:
    void SetUp() override
    {
        const Case& c = GetParam();
        params.strand_nodes = c.nodes;
        params.grid_resolution = c.resolution;
        params.look_self_shadow = c.shadow ? 1.0f : 0.0f;
        params.interpolation_strands = c.drawn;
        if (c.change)
            c.change(params);
        groom = random_groom(random, c.guides, c.nodes, c.drawn);
        Random places(7);
        for (size_t s = 0; s < groom.drawn.size(); ++s) // one in ten leads those after it
        {
            groom.drawn[s].leader = int(s - s % 10);
            groom.drawn[s].weights.w = s % 10 ? float(places.in(-0.03, 0.03)) : 0.0f;
        }
        for (size_t s = 0; s < groom.drawn.size() && c.varied; ++s)
        {
            const auto up_to = [&](double most) { return float(places.in(0.0, most)); };
            groom.looks.push_back({});
            groom.looks.back().wave = F4(up_to(0.02), 30.0f, up_to(0.01), 30.0f);
            groom.looks.back().own = F4(float(groom.drawn[s].seed), up_to(0.006), up_to(0.004), 0.0f);
        }
        for (int i = 0; i < c.tails; ++i)
            groom.tails.push_back(some_tail(places, i, c.braids && i % 2 == 1));
        for (int s = 0; s < groom.drawn_multi && c.tails > 0; ++s)
        {
            // Between two nodes: behind one that lay in the ring itself the way from there to it would be no way.
            const float ring = float(2 + places.below(c.nodes - 5)) + float(places.in(0.1, 0.9));
            groom.tied.push_back({F4(float(places.in(-0.7, 0.7)), float(places.in(-0.7, 0.7)), 0.0f, 0.0f),
                                  s % 7 == 3 ? 0.0f : ring, s % c.tails, 0, 0});
        }
        const Pose head = {random.vector(3.0), glm::angleAxis(1.1, random.direction()), {}};
        solver = std::make_unique<Solver>(device, params, groom, head);

        std::vector<Collider> spheres;
        for (int i = 0; c.bodies && i < 40; ++i) // some far away, many overlapping
            spheres.push_back(
                {glm::vec3(random.direction() * random.in(0.0, 0.3)), float(random.in(0.01, 0.06)), true});
        for (int i = 0; c.bodies && i < 4; ++i)
        {
            const glm::vec3 at(random.direction() * random.in(0.0, 0.2));
            spheres.push_back({at, float(random.in(0.01, 0.04)), true, at + glm::vec3(0.1 * random.direction())});
        }
        solver->set_colliders(spheres);
        if (c.body)
        {
            solver->set_body({lumpy_body(), 0.8f, {0.0f, 0.01f, 0.0f}});
            body = oracle::body_of(*solver->body().grid);
        }
        colliders = solver->placed_colliders();

        guides.nodes = c.nodes;
        for (int g = 0; g < c.guides; ++g)
        {
            glm::dvec3 at = 0.09 * random.direction();
            const glm::dvec3 on = random.direction() * 0.2 / (c.nodes - 2.0);
            for (int k = 0; k < c.nodes; ++k)
            {
                guides.position.push_back(glm::dvec3(glm::vec3(at)));
                at += on + 0.5 * glm::length(on) * random.vector(1.0);
            }
        }
        const Buffers& buffers = solver->buffers();
        write(device, buffers.at("position"), to_blocks(guides.position, c.guides, c.nodes));
        std::vector<int> density;
        for (int i = 0; i < c.resolution * c.resolution * c.resolution; ++i)
            density.push_back(random.below(4096));
        write(device, buffers.at("density"), density);
        write(device, buffers.at("room"), std::vector<int>{0, 0, 0, c.resolution, c.resolution, c.resolution});
        solver->draw();
        read_params = device_params(params);
        const size_t nodes = groom.drawn.size() * size_t(c.nodes);
        position = read<float4>(device, buffers.at("drawn_position"), nodes);
        frame = read<float4>(device, buffers.at("drawn_frame"), nodes);
    }

    Tail some_tail(Random& places, int number, bool braid) const
    {
        const Case& c = GetParam();
        const glm::dvec3 axis = places.direction(), side = glm::normalize(glm::cross(axis, places.direction()));
        Tail tail = {};
        tail.axis = F4(float(axis.x), float(axis.y), float(axis.z), braid ? 0.06f : 0.0f);
        tail.side = F4(float(side.x), float(side.y), float(side.z), 0.012f);
        tail.depth = 0.006f;
        tail.plait = 0.008f;
        tail.bound = 0.1f;
        tail.length = float(places.in(0.1, 0.2));
        tail.ring = float(2 + number % (c.nodes - 5)) + 0.3f;
        tail.radius = 0.01f;
        tail.fullest = 0.03f;
        tail.together = float(places.in(0.5, 1.0));
        tail.guide = places.below(c.guides);
        return tail;
    }

    oracle::Besides besides(size_t strand) const
    {
        const bool tied = strand < groom.tied.size() && groom.tied[strand].ring > 0.0f;
        return {groom.looks.empty() ? nullptr : &groom.looks[strand], tied ? &groom.tied[strand] : nullptr,
                tied ? &groom.tails[size_t(groom.tied[strand].tail)] : nullptr};
    }

    // A strand's nodes before clumps, by the twin.
    std::vector<oracle::Vec> made(size_t strand) const
    {
        const auto make = int(strand) < groom.drawn_multi ? oracle::interpolate_multi : oracle::interpolate_single;
        return make(guides, groom.drawn[strand], int(strand), read_params, colliders, solver->info(), body,
                    besides(strand));
    }

    glm::dvec3 node(size_t strand, int k) const
    {
        const float4 p = position[strand * size_t(groom.nodes) + size_t(k)];
        return {p.x, p.y, p.z};
    }

    Random random{unsigned(GetParam().nodes * 31 + GetParam().resolution + GetParam().drawn)};
    const Device device = with_width(GetParam().width);
    HairParams params, read_params; // authored, and as the device reads them
    Groom groom;
    std::unique_ptr<Solver> solver;
    std::vector<Capsule> colliders;
    oracle::Body body;
    oracle::Strands guides;
    std::vector<float4> position, frame;
};

TEST_P(DrawnPasses, NodesLieWhereTheTwinPutsThem)
{
    std::vector<double> errors;
    std::vector<std::vector<oracle::Vec>> expected;
    for (size_t s = 0; s < groom.drawn.size(); ++s)
        expected.push_back(made(s));
    for (size_t s = 0; s < groom.drawn.size(); ++s)
    {
        const DrawnStrand& own = groom.drawn[s];
        const size_t leader = size_t(own.leader);
        const std::vector<oracle::Vec> at =
            has_clumps(params) ? oracle::clump(expected[s], expected[leader], own, int(s), groom.drawn[leader].root.w,
                                               read_params, colliders, solver->info(), body, besides(s).look)
                                     .node
                               : expected[s];
        for (int k = 0; k < groom.nodes; ++k)
        {
            const double error = glm::distance(node(s, k), at[size_t(k)]);
            errors.push_back(std::isfinite(error) ? error : INFINITY);
        }
    }
    std::sort(errors.begin(), errors.end());
    // Sums of a dozen products of up to half a metre round to 1e-7 m. Where a node is pushed out, its direction away
    // from a centre 1 cm off, over a way of up to 20 cm, carries that to 2e-6 m; one in a thousand leaves a sphere so
    // nearly along its surface that the root of the rounding counts.
    EXPECT_LE(errors[errors.size() / 2], 2e-7);
    EXPECT_LE(errors[errors.size() * 99 / 100], 5e-6);
    // Out of the head's grid rounding may decide whether a last step is needed that is worth a fraction of a
    // millimetre.
    EXPECT_LE(errors[errors.size() * 999 / 1000], GetParam().body ? 3e-4 : 1e-4);
    // In a clump each node begins where the one before it has come to lie: roundings add up along the strand.
    EXPECT_LE(errors.back(), GetParam().bodies ? 2e-3 : has_clumps(params) ? 4e-6 : 1e-6);
}

TEST_P(DrawnPasses, LightIsWhatTheTwinFetches)
{
    const Case& c = GetParam();
    if (has_clumps(params))
        GTEST_SKIP() << "that of a clump is mixed, as below";
    const StepInfo& info = solver->info();
    const std::vector<float> depth =
        read<float>(device, solver->buffers().at("depth"), size_t(c.resolution * c.resolution * c.resolution));
    double worst = 0.0, darkest = 1.0;
    for (size_t i = 0; i < position.size(); ++i)
    {
        const float4 p = position[i];
        const double tau =
            c.shadow ? oracle::light_depth(depth, {p.x, p.y, p.z}, c.resolution, read_params, info) : 0.0;
        worst = std::max(worst, std::abs(p.w - std::exp(-tau)));
        darkest = std::min(darkest, double(p.w));
    }
    // Grid coordinates of up to 64 carry 1e-5 of rounding, and tau changes by up to a few units from ray to ray.
    EXPECT_LE(worst, c.shadow ? 1e-4 : 0.0);
    EXPECT_LT(darkest, c.shadow ? 0.8 : 1.1);
}

TEST_P(DrawnPasses, InAClumpEachGetsAsMuchOfItsLeadersLightAsItIsDrawnToIt)
{
    const Case& c = GetParam();
    if (!has_clumps(params) || !c.shadow)
        GTEST_SKIP();
    const StepInfo& info = solver->info();
    const std::vector<float> depth =
        read<float>(device, solver->buffers().at("depth"), size_t(c.resolution * c.resolution * c.resolution));
    const int n = groom.nodes;
    std::vector<double> errors;
    for (int s = 0; s < int(groom.drawn.size()); ++s)
    {
        const DrawnStrand &own = groom.drawn[size_t(s)], &leads = groom.drawn[size_t(own.leader)];
        const std::vector<oracle::Vec> at = made(size_t(s)), leader = made(size_t(own.leader));
        const oracle::Clumped clumped = oracle::clump(at, leader, own, s, leads.root.w, read_params, colliders, info,
                                                      body, besides(size_t(s)).look);
        const auto light_of = [&](int k) { return double(position[size_t(own.leader * n + k)].w); };
        for (int k = 2; k < n; ++k)
        {
            const double ahead = own.weights.w / glm::distance(leader[2], leader[1]);
            const double on = std::max(1.0, 1.0 + ahead + (k - 1.0) * own.root.w / leads.root.w);
            const int i = std::min(int(on), n - 2);
            double w[4];
            oracle::curve_weights(3, std::min(on - i, 1.0), w);
            double led = std::max(0.0, on - (n - 1.0)) * (light_of(n - 1) - light_of(n - 2));
            for (int j = 0; j < 4; ++j)
                led += w[j] * light_of(std::min(i - 1 + j, n - 1));
            const double alone = std::exp(-oracle::light_depth(depth, at[size_t(k)], c.resolution, read_params, info));
            const double expected = glm::mix(alone, std::clamp(led, 0.0, 1.0), clumped.share[size_t(k)]);
            errors.push_back(std::abs(position[size_t(s * n + k)].w - expected));
        }
    }
    std::sort(errors.begin(), errors.end());
    // As above; but light fetched where rounding has carried a node that was pushed out.
    EXPECT_LE(errors[errors.size() * 98 / 100], 1e-4);
    EXPECT_LE(errors.back(), 0.05);
}

TEST_P(DrawnPasses, FramesAreCarriedAsTheTwinCarriesThem)
{
    double worst = 0.0, worst_length = 0.0, worst_unit = 0.0;
    for (size_t s = 0; s < groom.drawn.size(); ++s)
    {
        std::vector<oracle::Vec> nodes;
        for (int k = 0; k < groom.nodes; ++k)
            nodes.push_back(node(s, k));
        const std::vector<oracle::FrameNode> expected =
            oracle::transport_frames(nodes, solver->info(), besides(s), groom.drawn[s].root.w);
        const double from = has_clumps(params) ? double(groom.drawn[s].weights.w) : 0.0;
        for (int k = 0; k < groom.nodes; ++k)
        {
            if (k > 0 && glm::distance(nodes[size_t(k)], nodes[size_t(k - 1)]) < 1e-4)
                break; // pushed onto one another: the direction between them is made of rounding
            if (expected[size_t(k)].told < 0.01)
                break; // turns back on itself: about which axis is not well told
            const float4 f = frame[s * size_t(groom.nodes) + size_t(k)];
            const glm::dvec3 normal(f.x, f.y, f.z);
            worst = std::max(worst, glm::distance(normal, expected[size_t(k)].normal) * expected[size_t(k)].told);
            worst_unit = std::max(worst_unit, std::abs(glm::length(normal) - 1.0));
            worst_length = std::max(worst_length, std::abs(f.w - from - expected[size_t(k)].length));
        }
    }
    // Segments of a centimetre between coordinates that round at 3e-8 m have directions good to 1e-5; the error grows
    // with the number of nodes, and with a sharp turn, whose axis is told worse.
    EXPECT_LE(worst, 1e-4);
    EXPECT_LE(worst_unit, 1e-6);
    EXPECT_LE(worst_length, 2e-6);
}

void waves(HairParams& p)
{
    p.wave_normal_amplitude = 0.02f;
    p.wave_binormal_amplitude = 0.01f;
    p.wave_binormal_begin = 0.4f;
    p.interpolation_layer = 0.02f;
}
void clumps(HairParams& p)
{
    p.clump_strength = 0.8f;
    p.clump_along = F4(0.1f, 0.5f, 1.0f, 0.7f);
    p.curl_radius = 0.006f;
    p.frizz_amount = 0.004f;
    p.wave_along = F4(0.5f, 1.0f, 1.5f, 0.0f);
}
void flying(HairParams& p)
{
    p.flyaway_share = 0.3f;
    p.flyaway_distance = 0.05f;
}
void flying_clumps(HairParams& p)
{
    clumps(p);
    flying(p);
}
void from_below(HairParams& p) { p.look_light_direction = F4(0.2f, -0.3f, -0.9f, 0.0f); }
void from_the_side(HairParams& p) { p.look_light_direction = F4(1.0f, 0.0f, 0.1f, 0.0f); }

INSTANTIATE_TEST_SUITE_P(
    All, DrawnPasses,
    testing::Values(Case{"usual", 16, 16, 64, 248, 1000, true, true, nullptr},
                    Case{"wavy", 16, 16, 20, 17, 500, true, true, waves},
                    Case{"wavy_8_wide", 8, 16, 20, 17, 500, true, true, waves},
                    Case{"one_wide", 1, 5, 20, 20, 200, true, true, from_below},
                    Case{"free_and_unshaded", 16, 33, 8, 17, 101, false, false, nullptr},
                    Case{"of_33", 8, 33, 64, 40, 300, true, true, from_the_side},
                    Case{"of_3", 16, 3, 8, 1, 17, true, true, waves},
                    Case{"of_5_unshaded", 16, 5, 20, 30, 200, false, true, nullptr},
                    Case{"on_a_grid", 16, 16, 64, 100, 500, true, false, nullptr, true},
                    Case{"on_a_grid_8_wide", 8, 16, 20, 40, 300, true, true, waves, true},
                    Case{"on_a_grid_1_wide", 1, 9, 20, 40, 200, false, true, nullptr, true},
                    Case{"clumps", 16, 16, 20, 40, 500, true, true, clumps},
                    Case{"clumps_8_wide", 8, 16, 20, 40, 501, false, false, clumps, true},
                    Case{"clumps_1_wide", 1, 9, 20, 40, 200, true, true, clumps},
                    Case{"flying", 16, 16, 20, 40, 500, true, true, flying},
                    Case{"flying_8_wide", 8, 33, 20, 40, 301, true, true, flying},
                    Case{"flying_1_wide", 1, 16, 20, 40, 200, false, false, flying},
                    Case{"flying_clumps", 16, 16, 20, 40, 500, true, true, flying_clumps, true},
                    Case{"varied", 16, 16, 20, 40, 500, true, false, waves, true, true},
                    Case{"varied_8_wide", 8, 16, 20, 40, 301, false, false, clumps, true, true},
                    Case{"varied_1_wide", 1, 9, 20, 40, 200, true, true, clumps, false, true},
                    Case{"tails", 16, 16, 20, 40, 500, true, false, nullptr, false, false, 3},
                    Case{"tails_8_wide", 8, 22, 20, 40, 301, true, false, waves, true, true, 3},
                    Case{"tails_1_wide", 1, 9, 20, 40, 200, false, true, flying, false, false, 2},
                    Case{"braids", 16, 22, 20, 40, 500, true, false, nullptr, true, false, 4, true},
                    Case{"braids_8_wide", 8, 16, 20, 40, 301, true, false, clumps, false, false, 4, true},
                    Case{"braids_1_wide", 1, 16, 20, 40, 200, true, true, waves, true, true, 2, true}),
    [](const auto& test) { return std::string(test.param.name); });

} // namespace
} // namespace coif

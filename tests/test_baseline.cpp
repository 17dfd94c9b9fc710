// The thesis' own kernel against its double-precision twin, written from section 5.1.2 rather than from the kernel.
#include "sim/error.h"
#include "sim/models/baseline.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace coif::study
{
namespace
{

// One strand, nodes moved in the order that batches allow: a batch's links share no node.
struct Twin
{
    const BaselineSetup& setup;
    glm::dvec3 root;
    double rest;
    std::vector<glm::dvec3> now, before;

    Twin(const BaselineSetup& of, const float4& r, glm::dvec3 scalp) : setup(of), root(r.x, r.y, r.z), rest(r.w)
    {
        for (int i = 0; i < setup.nodes; ++i)
            now.push_back(scalp + root + (i - 1.0) * rest * glm::normalize(root));
    }

    void pull(glm::dvec3& inner, glm::dvec3& outer, double length, double strength, bool inner_moves)
    {
        const glm::dvec3 excess = (outer - inner) * (1.0 - length / glm::distance(inner, outer)) * strength;
        inner += inner_moves ? excess / 2.0 : glm::dvec3(0.0);
        outer -= inner_moves ? excess / 2.0 : excess;
    }

    void step(glm::dvec3 scalp)
    {
        const double h = 1.0 / setup.rate, keep = std::exp(-setup.drag * h);
        const double fall = setup.gravity * h * (setup.drag > 0.0f ? (1.0 - keep) / setup.drag : h);
        const std::vector<glm::dvec3> old = now;
        now[0] = scalp + root - rest * glm::normalize(root);
        now[1] = scalp + root;
        for (size_t i = 2; i < now.size(); ++i)
        {
            // At first there is no motion, and half a step of falling.
            const glm::dvec3 moved = before.empty() ? glm::dvec3(0.0) : keep * (old[i] - before[i]);
            now[i] = old[i] + moved + glm::dvec3(0.0, before.empty() ? fall / 2.0 : fall, 0.0);
        }
        before = old;
        const auto share = [&](double all) { return 1.0 - std::pow(1.0 - all, 1.0 / setup.iterations); }; // eq. 5.5
        for (int n = 0; n < setup.iterations; ++n)
        {
            for (size_t i = 2; i < now.size(); ++i)
                for (const float4& s : setup.spheres)
                {
                    const glm::dvec3 center = scalp + glm::dvec3(s.x, s.y, s.z);
                    if (glm::distance(now[i], center) < s.w)
                        now[i] = center + double(s.w) * glm::normalize(now[i] - center);
                }
            for (const size_t first : {2, 1})
                for (size_t i = first; i + 1 < now.size(); i += 2)
                    pull(now[i], now[i + 1], rest, share(setup.stretching), i > 1);
            for (size_t i = 2; i < now.size() && setup.bending > 0.0f; ++i)
                pull(now[0], now[i], setup.bending_scale * rest * double(i),
                     share(setup.bending) / std::pow(double(i - 1), setup.bending_attenuation), false);
        }
    }
};

BaselineSetup setup_of(int strands, int nodes, int iterations)
{
    Random random(11);
    BaselineSetup setup;
    setup.nodes = nodes;
    setup.iterations = iterations;
    for (int s = 0; s < strands; ++s)
    {
        const glm::vec3 root = 0.10 * random.direction();
        setup.roots.push_back(F4(root.x, root.y, root.z, float(random.in(0.01, 0.02))));
    }
    return setup;
}

// A scalp that shakes, so that the first segment has something to hand on.
glm::dvec3 scalp_at(int frame) { return {0.02 * std::sin(0.3 * frame), 0.0, 0.01 * std::cos(0.2 * frame)}; }

struct Case
{
    const char* name;
    int strands, nodes, iterations, frames;
    double tolerance; // m
    void (*change)(BaselineSetup&);
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class BaselineKernel : public testing::TestWithParam<Case>
{
};

TEST_P(BaselineKernel, does_what_its_twin_does)
{
    const Case& c = GetParam();
    BaselineSetup setup = setup_of(c.strands, c.nodes, c.iterations);
    if (c.change)
        c.change(setup);
    Baseline baseline(test_device(), setup, scalp_at(0));
    std::vector<Twin> twins;
    for (const float4& root : setup.roots)
        twins.emplace_back(setup, root, scalp_at(0));
    for (int frame = 1; frame <= c.frames; ++frame)
    {
        EXPECT_GT(baseline.step(scalp_at(frame)), 0.0);
        for (Twin& twin : twins)
            twin.step(scalp_at(frame));
    }
    const std::vector<glm::vec3> positions = baseline.positions();
    ASSERT_EQ(positions.size(), size_t(c.strands * c.nodes));
    double worst = 0.0;
    for (size_t i = 0; i < positions.size(); ++i)
        worst = std::max(worst,
                         glm::distance(glm::dvec3(positions[i]), twins[i / size_t(c.nodes)].now[i % size_t(c.nodes)]));
    EXPECT_LT(worst, c.tolerance);
}

// With bending only a few frames: what presses outwards against lengths that hold buckles, and a strand about to buckle
// makes four of each rounding error a frame.
INSTANTIATE_TEST_SUITE_P(
    Cases, BaselineKernel,
    testing::Values(Case{"first_step", 5, 16, 1, 1, 1e-7, nullptr}, Case{"plain", 33, 16, 8, 20, 1e-5, nullptr},
                    Case{"odd_nodes", 7, 5, 4, 20, 1e-5, nullptr}, Case{"three_nodes", 3, 3, 4, 20, 1e-5, nullptr},
                    Case{"many_nodes", 3, 64, 4, 10, 1e-5, nullptr},
                    Case{"drag", 9, 16, 8, 20, 1e-5, [](BaselineSetup& s) { s.drag = 300.0f; }},
                    Case{"bending", 9, 16, 8, 4, 1e-6,
                         [](BaselineSetup& s)
                         {
                             s.bending = 0.6f;
                             s.bending_attenuation = 1.5f;
                             s.bending_scale = 1.1f;
                             s.stretching = 0.7f;
                         }},
                    Case{"spheres", 9, 16, 8, 20, 1e-5,
                         [](BaselineSetup& s) {
                             s.spheres = {F4(0.0f, 0.0f, 0.0f, 0.10f), F4(0.05f, -0.12f, 0.0f, 0.08f)};
                         }}),
    [](const auto& each) { return std::string(each.param.name); });

// What the listing got wrong: strengths beyond 1, and strands whose nodes all fall on one place.
TEST(Baseline, bears_what_the_listing_did_not)
{
    BaselineSetup setup = setup_of(4, 16, 3);
    setup.stretching = 2.0f;
    setup.bending = 2.0f;
    setup.roots[1].w = 0.0f;
    for (const glm::vec3& node : run_baseline(test_device(), setup, 30).positions)
        ASSERT_TRUE(std::isfinite(node.x) && std::isfinite(node.y) && std::isfinite(node.z));
}

TEST(Baseline, hangs_by_its_roots_and_costs_more_with_each_iteration)
{
    BaselineSetup setup = setup_of(256, 16, 1);
    setup.drag = 2.0f;
    const BaselineResult few = run_baseline(test_device(), setup, 20);
    setup.iterations = 64;
    const BaselineResult many = run_baseline(test_device(), setup, 20);
    EXPECT_GT(many.ns, 2.0 * few.ns);
    for (size_t s = 0; s < setup.roots.size(); ++s)
    {
        const float4 r = setup.roots[s];
        EXPECT_LT(glm::distance(many.positions[s * 16 + 1], glm::vec3(r.x, r.y, r.z)), 1e-7f);
        for (size_t i = 1; i < 15; ++i)
        {
            const float length = glm::distance(many.positions[s * 16 + i], many.positions[s * 16 + i + 1]);
            EXPECT_NEAR(length / r.w, 1.0f, 0.15f);
        }
    }
}

TEST(Baseline, refuses_what_no_work_group_holds)
{
    EXPECT_THROW(Baseline(test_device(), setup_of(2, 1 << 20, 4), glm::vec3(0.0f)), Error);
    EXPECT_THROW(Baseline(test_device(), setup_of(2, 2, 4), glm::vec3(0.0f)), Error);
    EXPECT_THROW(Baseline(test_device(), setup_of(2, 16, 0), glm::vec3(0.0f)), Error);
    EXPECT_THROW(Baseline(test_device(), setup_of(0, 16, 4), glm::vec3(0.0f)), Error);
}

} // namespace
} // namespace coif::study

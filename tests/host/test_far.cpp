// Which blocks are far enough to step with half their nodes, and what lies between those nodes.
#include "sim/far.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <cmath>
#include <random>

namespace coif
{
namespace
{

using Vec = glm::dvec3;

struct Chance
{
    std::mt19937 engine{5};
    double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
    Vec direction()
    {
        const Vec d(in(-1.0, 1.0), in(-1.0, 1.0), in(-1.0, 1.0));
        return glm::length(d) > 1e-3 ? glm::normalize(d) : Vec(1.0, 0.0, 0.0);
    }
};

Groom bent_groom(int nodes)
{
    Groom groom;
    groom.nodes = nodes;
    groom.guides = groom.blocks = 1;
    groom.segment_length.assign(LANES, 0.01f);
    groom.root_position.assign(3 * LANES, 0.0f);
    groom.root_direction.assign(3 * LANES, 0.0f);
    groom.natural_position.assign(size_t(nodes) * 3 * LANES, 0.0f);
    groom.rest_multiplier.assign(size_t(nodes) * LANES, 0.0f);
    for (int s = 0; s < LANES; ++s)
    {
        put_vector(groom.root_direction, s, 0, 1, {0.0, 1.0, 0.0});
        for (int k = 0; k < nodes; ++k)
        {
            put_vector(groom.natural_position, s, k, nodes,
                       {std::pow(0.02 * std::max(0, k - 1), 2), 0.01 * (k - 1), 0.0});
            groom.rest_multiplier[size_t(k * LANES + s)] = float(nodes - k);
        }
    }
    return groom;
}

// How far apart a picture shows two points, in pixels, by matrices as a renderer has them.
double on_screen(const View& view, Vec up, Vec a, Vec b, double height)
{
    const double fov = 2.0 * std::atan(0.5 * height / view.pixels);
    const glm::dmat4 to_clip =
        glm::perspective(fov, 1.0, 1e-3, 1e3) * glm::lookAt(view.eye, view.eye + view.forward, up);
    const auto place = [&](Vec p)
    {
        const glm::dvec4 at = to_clip * glm::dvec4(p, 1.0);
        return 0.5 * height * glm::dvec2(at.x, at.y) / at.w;
    };
    return glm::distance(place(a), place(b));
}

// No node of the block that errs by as much as is said is shown further off than is said, but for how pictures stretch
// towards their edges; and where it is nearest, it is.
TEST(Far, ErrorIsWhatAPictureShowsOfIt)
{
    Chance chance;
    int within = 0;
    for (int trial = 0; trial < 2000; ++trial)
    {
        const FarBlock block = {0.1 * chance.direction(), chance.in(0.01, 0.5), chance.in(0.01, 0.5)};
        const double error = chance.in(1e-3, 0.05);
        const Pose head = {
            chance.direction() * chance.in(0.0, 10.0), glm::angleAxis(chance.in(-3.0, 3.0), chance.direction()), {}};
        const Vec middle = head.origin + head.turn * block.middle;
        const View view = {middle + chance.direction() * chance.in(0.7, 30.0), chance.direction(),
                           chance.in(100.0, 3000.0)};
        const double said = far_error(block, error, view, head);
        const Vec up =
            glm::normalize(glm::cross(view.forward, std::abs(view.forward.x) > 0.6 ? Vec(0, 1, 0) : Vec(1, 0, 0)));
        for (int i = 0; i < 20; ++i)
        {
            const Vec node = middle + chance.in(0.0, block.reach) * chance.direction();
            const double ahead = glm::dot(node - view.eye, view.forward), far = glm::distance(node, view.eye);
            if (!(ahead > 0.6 * far) ||
                glm::dot(middle - view.eye, view.forward) < 0.6 * glm::distance(middle, view.eye))
                continue;
            ++within;
            const double shown =
                on_screen(view, up, node, node + 0.01 * error * block.length * chance.direction(), 720.0);
            EXPECT_LE(100.0 * shown, said * far / ahead * 1.02) << trial; // 1.02: it is nearer by its own error
        }
        // Straight ahead.
        const View at = {middle - (block.reach + 2.0) * view.forward, view.forward, view.pixels};
        const Vec nearest = middle - block.reach * view.forward;
        EXPECT_NEAR(100.0 * on_screen(at, up, nearest, nearest + 0.01 * error * block.length * up, 720.0),
                    far_error(block, error, at, head), 1e-6 * far_error(block, error, at, head));
    }
    EXPECT_GT(within, 2000);
}

TEST(Far, NothingThatMayTouchTheEyeIsFar)
{
    const FarBlock block = {{0.0, 0.0, 0.0}, 0.3, 0.3};
    const View view = {{0.0, 0.0, 0.2}, {0.0, 0.0, -1.0}, 1.0};
    EXPECT_EQ(far_error(block, 1e-9, view, {}), INFINITY);
    EXPECT_FALSE(is_far(block, 1e-9, view, {}, 20.0, true));
    const View away = {{0.0, 0.0, 0.5}, {0.0, 0.0, 1.0}, 1.0}; // behind, but it could turn round
    EXPECT_EQ(far_error(block, 1e-9, away, {}), INFINITY);
}

// A camera that trembles about the limit changes nothing.
TEST(Far, GoesAndComesAtDifferentDistances)
{
    const FarBlock block = {{0.0, 0.0, 0.0}, 0.1, 0.1};
    const auto seen = [&](double pixels) // from as far as shows so large an error
    {
        return View{{0.0, 0.0, 0.1 + 0.01 * 1000.0 / pixels}, {0.0, 0.0, -1.0}, 1000.0};
    };
    bool far = false;
    const auto look = [&](double pixels) { return far = is_far(block, 0.1, seen(pixels), {}, 1.0, far); };
    EXPECT_FALSE(look(1.2));
    EXPECT_FALSE(look(0.9));
    EXPECT_TRUE(look(0.7));
    EXPECT_TRUE(look(0.9));
    EXPECT_TRUE(look(0.99));
    EXPECT_FALSE(look(1.01));
    EXPECT_FALSE(look(0.9));
}

TEST(Far, ThinStrandsAreEveryOtherNode)
{
    const int nodes = 10;
    const Groom groom = bent_groom(nodes), thin = thinned(groom);
    EXPECT_EQ(thin.nodes, 6);
    EXPECT_FLOAT_EQ(thin.segment_length[3] * float(thin.nodes - 2), groom.segment_length[3] * float(nodes - 2));
    for (int k = 1; k < thin.nodes; ++k)
        EXPECT_EQ(vector_at(thin.natural_position.data(), 3, k, thin.nodes),
                  vector_at(groom.natural_position.data(), 3, 2 * k - 1, nodes));
    // What pulls at a node, mass times length times multiplier, is as strong as between its two segments.
    for (int k = 2; k < thin.nodes; ++k)
        EXPECT_FLOAT_EQ(4.0f * thin.rest_multiplier[size_t(k * LANES + 3)], float(nodes) - float(2 * k) + 1.5f) << k;

    Groom odd = bent_groom(9), held = groom, few = bent_groom(4), hung = groom;
    held.held.assign(LANES, 4);
    hung.tip_mass = INFINITY;
    EXPECT_TRUE(may_thin(groom));
    for (const Groom& other : {odd, held, few, hung})
        EXPECT_FALSE(may_thin(other));
}

// An arc through half its nodes has the others where they were, to fourth order, and each at its length.
TEST(Far, FillsInBetween)
{
    double before = 0.0;
    for (const int links : {8, 16, 32})
    {
        const double angle = 1.5 / links, rest = 0.3 / links;
        std::vector<Vec> full;
        for (int k = -1; k <= links; ++k) // chords of `rest` on a circle
            full.push_back(0.5 * rest / std::sin(0.5 * angle) *
                           Vec(1.0 - std::cos(k * angle), std::sin(k * angle), 0.0));
        std::vector<Vec> thin = {full[1] + 2.0 * (full[0] - full[1])};
        for (size_t k = 1; k < full.size(); k += 2)
            thin.push_back(full[k]);
        const std::vector<Vec> x = filled_in(thin, rest);
        ASSERT_EQ(x.size(), full.size());
        double most = 0.0;
        for (size_t k = 2; k < x.size(); ++k)
        {
            EXPECT_NEAR(glm::distance(x[k], x[k - 1]), rest, 1e-12);
            most = std::max(most, glm::distance(x[k], full[k]));
        }
        EXPECT_LT(most, before == 0.0 ? 2e-3 * 0.3 : before / 4.0) << links;
        before = most;
    }
    const std::vector<Vec> straight = filled_in({{0, -2, 0}, {0, 0, 0}, {0, 2, 0}, {0, 4, 0}, {0, 6, 0}}, 1.0);
    for (size_t k = 0; k < straight.size(); ++k)
        EXPECT_LT(glm::distance(straight[k], Vec(0.0, double(k) - 1.0, 0.0)), 1e-12);
}

} // namespace
} // namespace coif

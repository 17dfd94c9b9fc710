// How solid things scatter light (app/traced/solid.h).
#include "app/traced/solid.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace coif
{
namespace
{

constexpr double kPi = std::numbers::pi;

glm::dvec3 at_angle(double cosine, double turn = 0.0)
{
    const double sine = std::sqrt(1.0 - cosine * cosine);
    return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

// Over all ways for light to come, of what `take` makes of each.
template <typename Take> glm::dvec3 over_sky(const Take& take)
{
    constexpr int kUp = 600, kAround = 400;
    glm::dvec3 sum(0.0);
    for (int i = 0; i < kUp; ++i)
        for (int j = 0; j < kAround; ++j) // symmetric about the plane of the eye
            sum += take(at_angle((i + 0.5) / kUp, kPi * (j + 0.5) / kAround));
    return sum * (2.0 * kPi / (kUp * kAround));
}

glm::dvec3 reflected(const SolidLook& look, const glm::dvec3& eye)
{
    return over_sky([&](const glm::dvec3& light) { return scatter(look, eye, light); });
}

TEST(Solid, white_things_give_back_all_light_and_no_more)
{
    for (const double gloss : {0.0, 0.4, 1.0})
        for (const double cosine : {1.0, 0.9, 0.6, 0.3, 0.1, 0.03})
        {
            const glm::dvec3 share = reflected({glm::dvec3(1.0), gloss}, at_angle(cosine));
            EXPECT_NEAR(share.x, 1.0, 1e-3) << gloss << " at " << cosine;
            EXPECT_NEAR(mirrored_share(cosine), reflected({glm::dvec3(0.0), 1.0}, at_angle(cosine)).y, 1e-3) << cosine;
        }
    EXPECT_NEAR(mirrored_share(1.0), 0.028, 0.002) << "about Fresnel's, straight on";
    EXPECT_GT(mirrored_share(0.1), 5.0 * mirrored_share(1.0)) << "more and more where it is seen flat";
}

TEST(Solid, what_is_matt_follows_lamberts_law)
{
    const SolidLook matt = {{0.8, 0.5, 0.2}, 0.0};
    for (const double cosine : {1.0, 0.5, 0.01})
        EXPECT_EQ(scatter(matt, at_angle(0.3), at_angle(cosine)).y, 0.5 * (cosine / kPi));
    EXPECT_EQ(scatter(matt, at_angle(0.3), {0.6, 0.0, -0.8}), glm::dvec3(0.0));
    EXPECT_EQ(sample(matt, at_angle(0.3), {0.2, 0.7, 0.0}).weight, matt.albedo);
}

TEST(Solid, the_way_back_is_the_same)
{
    const SolidLook skin = {{0.6, 0.4, 0.3}, 1.0};
    for (const double one : {0.95, 0.5, 0.1})
        for (const double other : {0.8, 0.2})
            for (const double turn : {0.3, 2.0, 3.1})
            {
                const glm::dvec3 a = at_angle(one), b = at_angle(other, turn);
                EXPECT_NEAR(scatter(skin, a, b).x / b.z, scatter(skin, b, a).x / a.z, 1e-12);
            }
}

TEST(Solid, gloss_shines_where_it_mirrors)
{
    const SolidLook skin = {{0.6, 0.4, 0.3}, 1.0}, matt = {skin.albedo, 0.0};
    const glm::dvec3 eye = at_angle(0.7), mirror(-eye.x, -eye.y, eye.z);
    EXPECT_GT(scatter(skin, eye, mirror).z, 1.5 * scatter(matt, eye, mirror).z);
    const glm::dvec3 away = at_angle(0.7); // back to where the eye is
    EXPECT_LT(scatter(skin, eye, away).z, scatter(matt, eye, away).z) << "the coat takes its share";
}

// Of the ways that are chosen, the mean of anything is what it is over the sky.
TEST(Solid, ways_are_chosen_as_light_is_scattered)
{
    std::mt19937_64 generator(3);
    std::uniform_real_distribution<double> random;
    for (const double gloss : {0.0, 0.5, 1.0})
        for (const double cosine : {0.9, 0.2})
        {
            const SolidLook look = {{0.7, 0.4, 0.1}, gloss};
            const glm::dvec3 eye = at_angle(cosine);
            const auto bright = [](const glm::dvec3& way) { return way.x < 0.0 ? 2.0 : 0.5 + way.z; };
            glm::dvec3 mean(0.0);
            constexpr int kSamples = 400'000;
            for (int i = 0; i < kSamples; ++i)
            {
                const SolidSample one = sample(look, eye, {random(generator), random(generator), random(generator)});
                ASSERT_TRUE(std::isfinite(one.weight.x) && one.weight.x >= 0.0 && one.weight.x < 3.0);
                ASSERT_NEAR(glm::length(one.to_light), 1.0, 1e-9);
                if (one.to_light.z > 0.0)
                    mean += one.weight * bright(one.to_light) / double(kSamples);
            }
            const glm::dvec3 wanted =
                over_sky([&](const glm::dvec3& light) { return scatter(look, eye, light) * bright(light); });
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(mean[c], wanted[c], 0.004) << gloss << " at " << cosine;
        }
}

TEST(Solid, the_flattest_views_are_lit_too)
{
    const SolidLook skin = {glm::dvec3(1.0), 1.0};
    for (const glm::dvec3& eye : {glm::dvec3(1, 0, 0), glm::dvec3(0.8, 0, -0.6), glm::dvec3(0, 0, 1)})
        for (const double random : {0.0, 0.5, 1.0 - 1e-16})
            for (const double lobe : {0.0, 0.999})
            {
                const SolidSample one = sample(skin, eye, {random, random, lobe});
                ASSERT_TRUE(std::isfinite(one.weight.x) && one.weight.x >= 0.0);
                ASSERT_TRUE(std::isfinite(one.to_light.x + one.to_light.y + one.to_light.z));
                const double back = scatter(skin, eye, at_angle(0.001)).x;
                ASSERT_TRUE(std::isfinite(back) && back >= 0.0);
            }
}

} // namespace
} // namespace coif

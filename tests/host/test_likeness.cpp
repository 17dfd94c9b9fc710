#include "app/likeness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace coif
{
namespace
{

// Light that wanders over the picture, with a glint here and there.
LinearImage some_light(float gain = 1.0f)
{
    LinearImage light{64, 48, {}};
    std::mt19937 engine(5);
    std::uniform_real_distribution<float> chance(0.0f, 1.0f);
    for (int i = 0; i < 64 * 48; ++i)
    {
        const float base = 0.2f + 0.1f * std::sin(0.3f * float(i % 64)) + 0.2f * chance(engine);
        light.pixels.insert(light.pixels.end(), {gain * base, gain * 0.8f * base, gain * 0.5f * base, 1.0f});
    }
    return light;
}

TEST(Likeness, a_picture_is_like_itself_and_half_of_it_is_half_off)
{
    HairParams params;
    params.look_level = LOOK_DUAL_SCATTERING;
    const std::vector<float> hair(64 * 48, 1.0f);
    const Likeness same = likeness(some_light(), some_light(), hair, params);
    EXPECT_EQ(same.radiance, glm::dvec3(1.0));
    EXPECT_EQ(same.roughly, 0.0);
    EXPECT_NEAR(same.locks, 1.0, 1e-12);
    const Likeness half = likeness(some_light(0.5f), some_light(), hair, params);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(half.radiance[c], 0.5, 1e-6);
    EXPECT_NEAR(half.roughly, 0.5, 1e-6);
    EXPECT_LT(half.locks, 0.9);
    EXPECT_EQ(likeness_text(half), "has 0.50 0.50 0.50 of the light, 50 % off");
}

TEST(Likeness, only_hair_counts_and_where_there_is_none_nothing_is_told)
{
    const HairParams params;
    LinearImage other = some_light();
    std::vector<float> hair(64 * 48, 1.0f);
    for (size_t i = 0; i < 64 * 20; ++i)
    {
        hair[i] = 0.0f;
        for (size_t c = 0; c < 3; ++c)
            other.pixels[4 * i + c] = 9.0f;
    }
    const Likeness like = likeness(other, some_light(), hair, params);
    EXPECT_EQ(like.radiance, glm::dvec3(1.0));
    EXPECT_EQ(like.roughly, 0.0);
    const Likeness bald = likeness(other, some_light(), std::vector<float>(64 * 48, 0.0f), params);
    EXPECT_TRUE(std::isnan(bald.roughly) && std::isnan(bald.radiance.x) && std::isnan(bald.locks));
    const Likeness dark = likeness(other, some_light(0.0f), hair, params);
    EXPECT_TRUE(std::isnan(dark.roughly) && std::isnan(dark.radiance.x));
}

} // namespace
} // namespace coif

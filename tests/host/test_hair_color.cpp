// Absorption and colour of hair (sim/hair_color.h).
#include "sim/hair_color.h"
#include "sim/params.h"

#include <gtest/gtest.h>

#include <cmath>

namespace coif
{
namespace
{

TEST(HairColor, eq_9_by_hand)
{
    // n = 0 leaves 5.969; n = 1 the sum of the coefficients, 3.375. ln 0.5 = -0.693147.
    EXPECT_NEAR(absorption_of_color(glm::vec3(0.5f), 0.0f).x, std::pow(0.693147 / 5.969, 2), 1e-7);
    EXPECT_NEAR(absorption_of_color(glm::vec3(0.5f), 1.0f).y, std::pow(0.693147 / 3.375, 2), 1e-7);
    EXPECT_EQ(absorption_of_color(glm::vec3(1.0f), 0.3f), glm::vec3(0.0f));
}

TEST(HairColor, there_and_back_over_all_roughness)
{
    for (const float n : {0.0f, 0.1f, 0.3f, 0.6f, 0.9f, 1.0f})
        for (const float c : {1e-12f, 1e-4f, 0.01f, 0.2f, 0.5f, 0.9f, 1.0f})
        {
            const glm::vec3 back = color_of_absorption(absorption_of_color(glm::vec3(c, 0.5f, 1.0f), n), n);
            EXPECT_NEAR(back.x / c, 1.0f, 1e-4f) << n << " " << c;
            EXPECT_NEAR(back.y, 0.5f, 1e-5f);
            EXPECT_EQ(back.z, 1.0f);
        }
}

TEST(HairColor, more_absorbs_more_and_nothing_is_endless)
{
    float before = INFINITY;
    for (const float c : {-1.0f, 0.0f, 1e-30f, 1e-10f, 0.1f, 0.5f, 1.0f, 2.0f, INFINITY})
    {
        const float now = absorption_of_color(glm::vec3(c), 0.3f).z;
        EXPECT_TRUE(std::isfinite(now) && now >= 0.0f && now <= before) << c;
        before = now;
    }
    for (const float sigma : {-1.0f, 0.0f, 60.0f, 1e6f, INFINITY})
    {
        const float color = color_of_absorption(glm::vec3(sigma), 0.3f).x;
        EXPECT_TRUE(color > 0.0f && color <= 1.0f) << sigma;
    }
}

TEST(HairColor, melanin_is_per_radius_as_published)
{
    const glm::vec3 brown = absorption_of_melanin(1.3f, 0.2f);
    EXPECT_NEAR(brown.x, 1.3 * 0.419 + 0.2 * 0.187, 1e-6);
    EXPECT_NEAR(brown.y, 1.3 * 0.697 + 0.2 * 0.4, 1e-6);
    EXPECT_NEAR(brown.z, 1.3 * 1.37 + 0.2 * 1.05, 1e-6);
}

TEST(HairColor, melanin_becomes_dye_and_comes_out_again)
{
    HairParams authored;
    const HairParams dyed = device_params(authored);
    EXPECT_EQ(dyed.look_root_color.x, linear_of_srgb(authored.look_root_color.x)) << "colours say so where they do";

    authored.look_pigment = 1;
    authored.look_eumelanin = 1.3f;
    authored.look_pheomelanin = 0.2f;
    authored.look_root_darkening = 0.4f;
    for (const float n : {0.1f, 0.3f, 0.8f})
    {
        authored.look_azimuthal_roughness = n;
        const HairParams grown = device_params(authored);
        const float4 root = grown.look_root_color, tip = grown.look_tip_color;
        const glm::vec3 brown = absorption_of_melanin(1.3f, 0.2f);
        const glm::vec3 at_root = absorption_of_color({root.x, root.y, root.z}, n) / brown;
        const glm::vec3 at_tip = absorption_of_color({tip.x, tip.y, tip.z}, n) / brown;
        for (int c = 0; c < 3; ++c)
        {
            EXPECT_NEAR(at_root[c], 1.4f, 2e-4f);
            EXPECT_NEAR(at_tip[c], 0.8f, 2e-4f);
        }
        EXPECT_LT(root.z, root.y) << "brown: blue is lost first";
        EXPECT_LT(root.y, root.x);
    }
}

} // namespace
} // namespace coif

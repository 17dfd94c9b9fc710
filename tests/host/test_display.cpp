// From light to bytes: exposure, the display transforms and sRGB against doubles, what no light may break, and files of
// light.
#include "app/display.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>
#include <stb/stb_image.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;
using Rgb = std::array<double, 3>;

constexpr int kNeutral = 1, kAgx = 2, kNone = 3;

HairParams with(int choice, float exposure = 0.0f)
{
    HairParams params;
    params.look_display = choice;
    params.look_exposure = exposure;
    return params;
}

glm::vec3 shown_as(int choice, glm::vec3 light, float exposure = 0.0f)
{
    return shown(light, display_of(with(choice, exposure)));
}

double srgb(double c)
{
    c = std::clamp(c, 0.0, 1.0);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

// The specification's own words: F90 0.04, K_s 0.8 - F90, K_d 0.15; f, p, p_n and g.
Rgb neutral(const Rgb& in)
{
    const double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
    const double x = *std::ranges::min_element(in), f = x <= 2.0 * f90 ? x - x * x / (4.0 * f90) : f90;
    const double p = *std::ranges::max_element(in) - f;
    Rgb out;
    for (size_t c = 0; c < 3; ++c)
        if (p <= ks)
            out[c] = in[c] - f;
        else
        {
            const double pn = 1.0 - (1.0 - ks) * (1.0 - ks) / (p + 1.0 - 2.0 * ks);
            const double g = 1.0 / (kd * (p - pn) + 1.0);
            out[c] = (in[c] - f) * pn / p * g + pn * (1.0 - g);
        }
    return out;
}

// With the polynomial that is mostly used for the curve (Wrensch 2023), which strays from it by a few thousandths.
Rgb agx(const Rgb& in)
{
    const double m[3][3] = {{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                            {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                            {0.0423756549057051, 0.0784336, 0.879142973793104}};
    const double back[3][3] = {{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                               {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                               {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}};
    Rgb curved, out;
    for (size_t c = 0; c < 3; ++c)
    {
        const double light = m[c][0] * in[0] + m[c][1] * in[1] + m[c][2] * in[2];
        const double x = (std::clamp(std::log2(light), -12.47393, 4.026069) + 12.47393) / (4.026069 + 12.47393);
        curved[c] = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3) +
                    0.4298 * x * x + 0.1191 * x - 0.00232;
    }
    for (size_t c = 0; c < 3; ++c)
        out[c] = back[c][0] * curved[0] + back[c][1] * curved[1] + back[c][2] * curved[2];
    return out;
}

std::vector<glm::vec3> lights()
{
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> ev(-14.0f, 12.0f);
    std::vector<glm::vec3> all;
    for (int i = 0; i < 20000; ++i)
        all.emplace_back(std::exp2(ev(engine)), std::exp2(ev(engine)), std::exp2(ev(engine)));
    return all;
}

TEST(Display, transforms_are_those_of_their_papers)
{
    double worst[4] = {};
    for (const glm::vec3& light : lights())
    {
        const Rgb in = {double(light.x), double(light.y), double(light.z)};
        const Rgb pressed = neutral(in), filmed = agx(in);
        for (int c = 0; c < 3; ++c)
        {
            const auto off = [&](int choice, double expected)
            { worst[choice] = std::max(worst[choice], std::abs(double(shown_as(choice, light)[c]) - expected)); };
            off(kNeutral, srgb(pressed[size_t(c)]));
            off(kAgx, std::clamp(filmed[size_t(c)], 0.0, 1.0));
            off(kNone, srgb(in[size_t(c)]));
        }
    }
    EXPECT_LT(worst[kNone], 0.25 / 255.0) << "square roots for the power";
    EXPECT_LT(worst[kNeutral], 0.3 / 255.0);
    EXPECT_LT(worst[kAgx], 0.01) << "the curve's polynomial";
}

TEST(Display, exposure_is_so_many_doublings)
{
    for (const int choice : {kNeutral, kAgx, kNone})
        for (const glm::vec3& light : {glm::vec3(0.1f, 0.2f, 0.05f), glm::vec3(0.7f, 0.01f, 0.3f)})
        {
            EXPECT_EQ(shown_as(choice, light, 2.0f), shown_as(choice, 4.0f * light));
            EXPECT_EQ(shown_as(choice, light, -3.0f), shown_as(choice, light / 8.0f));
            EXPECT_NE(shown_as(choice, light, 0.5f), shown_as(choice, light));
        }
}

// Below its shoulder neutral only takes the mirrored 4 % away: what channels differ by, and so the hue, is kept.
TEST(Display, neutral_keeps_hues)
{
    const auto linear = [](float c) { return double(linear_of_srgb(c)); };
    int colors = 0;
    for (const glm::vec3& light : lights())
    {
        const float most = std::max({light.x, light.y, light.z});
        if (most > 0.75f || most < 0.1f)
            continue;
        const glm::vec3 s = shown_as(kNeutral, light);
        EXPECT_NEAR(linear(s.x) - linear(s.y), double(light.x - light.y), 0.004);
        EXPECT_NEAR(linear(s.z) - linear(s.y), double(light.z - light.y), 0.004);
        ++colors;
    }
    EXPECT_GT(colors, 500);
    for (const float grey : {0.01f, 0.1f, 0.5f, 0.9f, 3.0f, 100.0f})
        for (const int choice : {kNeutral, kAgx, kNone})
        {
            const glm::vec3 s = shown_as(choice, glm::vec3(grey));
            const double even = choice == kAgx ? 2e-4 : 2e-5; // shares of AgX' channels sum up to 1.0001
            EXPECT_NEAR(s.x, s.y, even) << grey;
            EXPECT_NEAR(s.z, s.y, even) << grey;
        }
    EXPECT_NEAR(linear(shown_as(kNeutral, glm::vec3(0.5f)).x), 0.46, 0.002);
}

TEST(Display, more_light_is_never_darker)
{
    for (const int choice : {kNeutral, kAgx, kNone})
        for (const glm::vec3& color : {glm::vec3(1.0f), glm::vec3(1.0f, 0.4f, 0.1f), glm::vec3(0.05f, 0.3f, 1.0f)})
        {
            glm::vec3 before(0.0f);
            float brightest = 0.0f;
            for (double ev = -16.0; ev < 24.0; ev += 1.0 / 64.0)
            {
                const glm::vec3 s = shown_as(choice, color * float(std::exp2(ev)));
                const float luminance = glm::dot(s, glm::vec3(0.2126f, 0.7152f, 0.0722f));
                ASSERT_GE(luminance, brightest - 2e-6f) << choice << " at " << ev;
                brightest = std::max(brightest, luminance);
                for (int c = 0; c < 3 && color == glm::vec3(1.0f); ++c)
                    ASSERT_GE(s[c], before[c] - 2e-6f) << choice << " at " << ev;
                before = s;
            }
            EXPECT_GT(brightest, color == glm::vec3(1.0f) || choice != kNone ? 0.98f : 0.1f);
        }
}

TEST(Display, no_light_breaks_it)
{
    const float sizes[] = {-INFINITY, -1e30f, -1.0f,    -1e-30f, -0.0f,   0.0f,     1e-42f, 1e-20f,
                           0.02f,     0.76f,  65504.0f, 1e20f,   3.4e38f, INFINITY, NAN};
    for (const int choice : {kNeutral, kAgx, kNone})
        for (const float exposure : {-10.0f, 0.0f, 10.0f})
            for (const float r : sizes)
                for (const float g : sizes)
                    for (const float b : sizes)
                    {
                        const glm::vec3 s = shown_as(choice, {r, g, b}, exposure);
                        for (int c = 0; c < 3; ++c)
                            ASSERT_TRUE(s[c] >= 0.0f && s[c] <= 1.0f) << r << " " << g << " " << b << ": " << s[c];
                    }
    for (const int choice : {kNeutral, kAgx, kNone})
    {
        EXPECT_NEAR(shown_as(choice, glm::vec3(INFINITY)).y, 1.0, 1e-3);
        EXPECT_NEAR(shown_as(choice, glm::vec3(-1.0f)).y, 0.0, 2e-3);
        EXPECT_NEAR(shown_as(choice, glm::vec3(NAN)).y, 0.0, 2e-3);
    }
}

TEST(Display, left_to_itself_kajiya_kay_is_shown_as_it_is)
{
    HairParams params;
    for (const auto& level : {std::pair("auto", kNeutral), {"kajiya_kay", kNone}, {"karis", kNeutral}})
    {
        Hairstyle style;
        assign(style, std::string("look.level=") + level.first);
        EXPECT_EQ(display_of(style.params).choice, level.second) << level.first;
        assign(style, "look.display=agx");
        EXPECT_EQ(display_of(style.params).choice, kAgx);
    }
    EXPECT_EQ(display_of(params).gain, 1.0f) << "exactly, so that old pictures keep their bytes";
}

TEST(Display, a_transparent_picture_has_plain_alpha)
{
    const glm::vec3 color(0.2f, 0.5f, 0.05f);
    LinearImage light{4, 1, {}};
    const float alphas[] = {1.0f, 0.5f, 0.0f, NAN};
    for (const float alpha : alphas)
        for (const float v : {alpha * color.x, alpha * color.y, alpha * color.z, alpha})
            light.pixels.push_back(v);
    for (const int choice : {kNeutral, kAgx, kNone})
    {
        const Image image = displayed(light, with(choice));
        ASSERT_EQ(image.pixels.size(), 16u);
        for (size_t c = 0; c < 3; ++c)
        {
            EXPECT_NEAR(image.pixels[c], 255.0f * shown_as(choice, color)[int(c)], 0.51);
            EXPECT_EQ(image.pixels[4 + c], image.pixels[c]) << "what is behind does not change the colour";
        }
        EXPECT_EQ(image.pixels[3], 255);
        EXPECT_EQ(image.pixels[7], 128);
        EXPECT_EQ(image.pixels[11], 0);
    }
}

TEST(Display, light_in_a_file_is_the_light_there_was)
{
    const Scratch scratch;
    LinearImage light{37, 5, {}};
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> ev(-10.0f, 10.0f);
    for (int i = 0; i < 37 * 5; ++i)
        light.pixels.insert(light.pixels.end(),
                            {std::exp2(ev(engine)), std::exp2(ev(engine)), std::exp2(ev(engine)), 1.0f});
    const auto loaded = [&](float gain)
    {
        save_hdr(scratch / "a.hdr", light, gain);
        int width = 0, height = 0, channels = 0;
        float* pixels = stbi_loadf((scratch / "a.hdr").c_str(), &width, &height, &channels, 3);
        EXPECT_TRUE(pixels && width == 37 && height == 5);
        std::vector<float> all(pixels, pixels + 3 * 37 * 5);
        stbi_image_free(pixels);
        return all;
    };
    for (const float gain : {1.0f, 4.0f})
    {
        const std::vector<float> file = loaded(gain);
        for (size_t i = 0; i < 37 * 5; ++i)
        {
            const float* l = &light.pixels[4 * i];
            for (size_t c = 0; c < 3; ++c) // a mantissa of eight bits, for the brightest channel's exponent
                ASSERT_NEAR(file[3 * i + c], gain * l[c], gain * std::max({l[0], l[1], l[2]}) / 128.0f);
        }
    }
    std::fill_n(light.pixels.begin(), 16, -1.0f);
    light.pixels[0] = NAN;
    light.pixels[4] = INFINITY;
    const std::vector<float> file = loaded(1024.0f);
    EXPECT_EQ(file[0], 0.0f);
    EXPECT_GT(file[3], 1e36f);
    EXPECT_EQ(file[4], 0.0f);
    EXPECT_NE(error_of([&] { save_hdr(scratch / "no" / "a.hdr", light); }).find("a.hdr"), std::string::npos);
}

} // namespace
} // namespace coif

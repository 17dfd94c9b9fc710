// Light that is followed through strands (app/traced/tracer.h), and its record.
#include "app/traced/accumulation.h"
#include "sim/error.h"
#include "sim/hairstyle.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace coif
{
namespace
{

constexpr int kWidth = 24, kHeight = 20;

// A camera on the z axis that looks at the origin from a metre away.
TracedScene empty_scene()
{
    TracedScene scene;
    scene.eye = {0, 0, 1};
    scene.forward = {0, 0, -1};
    scene.right = {1, 0, 0};
    scene.up = {0, 1, 0};
    scene.tangent = 0.1;
    return scene;
}

// Straight strands through a ball of 10 cm.
TracedScene tangle(size_t strands, float radius, glm::vec3 absorption)
{
    TracedScene scene = empty_scene();
    scene.points = 4;
    std::mt19937 generator(5);
    std::normal_distribution<float> normal;
    for (size_t s = 0; s < strands; ++s)
    {
        const glm::vec3 middle = 0.04f * glm::vec3(normal(generator), normal(generator), normal(generator));
        const glm::vec3 way = glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
        for (int k = -1; k <= 4; ++k)
            scene.curve.emplace_back(middle + (float(k) - 1.5f) * 0.03f * way, radius);
        for (int k = 0; k < 4; ++k)
            scene.absorption.push_back(absorption);
    }
    return scene;
}

// A white wall behind the origin, that faces the camera.
void add_wall(TracedScene& scene)
{
    scene.position = {{-9, -9, -0.2f}, {9, -9, -0.2f}, {9, 9, -0.2f}, {-9, 9, -0.2f}};
    scene.normal.assign(4, {0, 0, 1});
    scene.albedo.assign(4, {0.8f, 0.5f, 0.2f});
    scene.triangles = {{0, 1, 2}, {0, 2, 3}};
}

Accumulation traced(TracedScene scene, uint32_t samples, const TraceLimits& limits = {})
{
    const Tracer tracer(std::move(scene));
    Accumulation picture = empty_accumulation(kWidth, kHeight);
    tracer.trace(picture, samples, limits);
    return picture;
}

glm::dvec4 sum_of(const Accumulation& picture)
{
    glm::dvec4 sum(0.0);
    for (const glm::vec4& pixel : picture.sum)
        sum += glm::dvec4(pixel);
    return sum;
}

TEST(Traced, white_hair_in_a_white_sky_is_as_bright_as_the_sky)
{
    TracedScene scene = tangle(300, 0.001f, glm::vec3(0.0f));
    scene.lighting.sky = glm::vec3(0.7f);
    scene.fibre.tilt = 0.035;
    const glm::dvec4 sum = sum_of(traced(scene, 32));
    EXPECT_GT(sum.w, 1000.0) << "samples that meet hair";
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c] / sum.w, 0.7, 0.007);
}

TEST(Traced, pigment_darkens_hair_channel_by_channel)
{
    TracedScene scene = tangle(300, 0.001f, glm::vec3(0.05f, 0.3f, 3.0f));
    scene.lighting.sky = glm::vec3(1.0f);
    const glm::dvec4 sum = sum_of(traced(scene, 8));
    EXPECT_LT(sum.x, 0.97 * sum.w);
    EXPECT_LT(sum.y, sum.x);
    EXPECT_LT(sum.z, sum.y);
    EXPECT_GT(sum.z, 0.02 * sum.w) << "its surface reflects";
}

TEST(Traced, a_wall_follows_lamberts_law)
{
    TracedScene scene = empty_scene();
    add_wall(scene);
    const float third = std::numbers::pi_v<float> / 3.0f;
    scene.lighting.suns = {{{std::sin(third), 0.0f, std::cos(third)}, {2.0f, 3.0f, 4.0f}, 0.0f}};
    TraceLimits direct;
    direct.bounces = 0;
    const glm::vec4 wanted(0.8f * 2.0f * 0.5f, 0.5f * 3.0f * 0.5f, 0.2f * 4.0f * 0.5f, std::numbers::pi_v<float>);
    for (const glm::vec4& pixel : traced(scene, 1, direct).sum)
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(pixel[c], wanted[c] / std::numbers::pi_v<float>, 1e-5f);

    // A wide sun brings as much light, to a wall that all of it shines on.
    scene.lighting.suns[0].radius = 0.2f;
    const glm::dvec4 sum = sum_of(traced(scene, 64, direct));
    EXPECT_NEAR(sum.x / sum.w, 0.8 / std::numbers::pi * std::cos(0.1) * std::cos(0.1), 0.002)
        << "but for the slant of its rim: the mean cosine over the disc";

    scene.lighting.suns.clear();
    scene.lighting.sky = glm::vec3(0.5f);
    const glm::dvec4 lit = sum_of(traced(scene, 4));
    EXPECT_NEAR(lit.y / lit.w, 0.25, 1e-6) << "all ways from it lead to the sky";
}

TEST(Traced, hair_shades_the_wall)
{
    TracedScene scene = empty_scene();
    add_wall(scene);
    scene.lighting.suns = {{{0, 0, 1}, glm::vec3(3.0f), 0.0f}};
    scene.points = 2; // one strand as thick as the picture is wide, behind the camera
    for (int k = 0; k < 4; ++k)
        scene.curve.emplace_back(0.0f, float(k) - 1.5f, 2.0f, 0.5f);
    scene.absorption.assign(2, glm::vec3(1.0f));
    TraceLimits direct;
    direct.bounces = 0;
    EXPECT_EQ(sum_of(traced(scene, 2, direct)).x, 0.0);
}

// Mean light of one thick strand along x, row by row from its upper edge down, lit from `around` it: 0 is the eye's
// side, a quarter turn above it.
std::vector<double> profile_of(glm::vec3 absorption, double around)
{
    TracedScene scene = empty_scene();
    scene.points = 2;
    for (int k = 0; k < 4; ++k)
        scene.curve.emplace_back(4.0f * (float(k) - 1.5f), 0.0f, 0.0f, 0.1f); // as high as the picture
    scene.absorption.assign(2, absorption);
    scene.fibre = {0.3, 0.05, 0.0, 1.55};
    scene.lighting.suns = {{glm::vec3(0.0, std::sin(around), std::cos(around)), glm::vec3(1.0f), 0.0f}};
    TraceLimits direct;
    direct.bounces = 0;
    const Accumulation picture = traced(scene, 16, direct);
    std::vector<double> rows;
    for (int y = 0; y < kHeight; ++y)
        rows.push_back(picture.sum[size_t(y * kWidth + kWidth / 2)].y / 16.0);
    return rows;
}

TEST(Traced, a_strand_mirrors_light_where_it_faces_halfway_to_it)
{
    const double sixty = std::numbers::pi / 3.0;
    for (const double up : {1.0, -1.0})
    {
        const std::vector<double> rows = profile_of(glm::vec3(1e6f), up * sixty);
        const auto peak = std::ranges::max_element(rows) - rows.begin();
        // At the sine of 30 degrees from the middle, over the perspective's little.
        EXPECT_NEAR(1.0 - 2.0 * (double(peak) + 0.5) / kHeight, up * 0.5, 0.1);
    }
}

TEST(Traced, a_strand_is_a_lens)
{
    // What enters above the middle is bent down: with light from behind and below, the upper half shines.
    const std::vector<double> rows = profile_of(glm::vec3(0.0f), -std::numbers::pi * 150.0 / 180.0);
    double above = 0.0, below = 0.0;
    for (int y = 0; y < kHeight / 2; ++y)
    {
        above += rows[size_t(y)];
        below += rows[size_t(kHeight - 1 - y)];
    }
    EXPECT_GT(above, 5.0 * below);
}

TEST(Traced, neither_threads_nor_stops_change_a_bit)
{
    TracedScene scene = tangle(60, 0.002f, glm::vec3(0.2f));
    add_wall(scene);
    scene.lighting.sky = glm::vec3(0.3f);
    scene.lighting.suns = {{glm::normalize(glm::vec3(1, 1, 1)), glm::vec3(2.0f), 0.05f},
                           {glm::normalize(glm::vec3(-1, 0.2f, 1)), glm::vec3(1.0f), 0.0f}};
    TraceLimits limits;
    limits.threads = 1;
    const Accumulation at_once = traced(scene, 7, limits);
    EXPECT_EQ(at_once.fewest(), 7u);

    limits.threads = 3;
    const Tracer tracer(scene);
    Accumulation picture = empty_accumulation(kWidth, kHeight);
    int heard = 0;
    tracer.trace(picture, 7, limits, [&](double, double) { return ++heard < 1; });
    EXPECT_GE(heard, 1);
    tracer.trace(picture, 3, limits);
    tracer.trace(picture, 7, limits);
    EXPECT_EQ(picture.samples, at_once.samples);
    EXPECT_EQ(picture.sum, at_once.sum);
    tracer.trace(picture, 5, limits);
    EXPECT_EQ(picture.sum, at_once.sum) << "there are more already";

    limits.seed = 1;
    EXPECT_NE(traced(scene, 7, limits).sum, at_once.sum);
}

TEST(Traced, extremes_are_pictures_too)
{
    for (const double roughness : {0.0, 1.0})
        for (const float sigma : {0.0f, 61.0f, 1e30f})
            for (const float irradiance : {0.0f, 100.0f})
            {
                TracedScene scene = tangle(40, 0.004f, glm::vec3(sigma));
                scene.fibre = {roughness, roughness, -0.17, 1.05};
                scene.eye = {0, 0, 0.01}; // within
                const glm::vec3 along = glm::normalize(glm::vec3(scene.curve[2]) - glm::vec3(scene.curve[1]));
                scene.lighting.suns = {{along, glm::vec3(irradiance), 0.0f}};
                const Accumulation picture = traced(scene, 2);
                for (const glm::vec4& pixel : picture.sum)
                    for (int c = 0; c < 4; ++c)
                        ASSERT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0.0f) << roughness << " " << sigma;
            }
    EXPECT_EQ(sum_of(traced(empty_scene(), 2)), glm::dvec4(0.0)) << "nothing at all";
}

TEST(Traced, says_where_hair_is)
{
    const Tracer hairy(tangle(300, 0.001f, glm::vec3(0.0f)));
    double share = 0.0;
    for (const float s : hairy.hair(kWidth, kHeight, 8))
    {
        ASSERT_TRUE(s >= 0.0f && s <= 1.0001f);
        share += s / (kWidth * kHeight);
    }
    EXPECT_GT(share, 0.1);
    EXPECT_LT(share, 0.9);
    TracedScene wall = empty_scene();
    add_wall(wall);
    for (const float s : Tracer(wall).hair(4, 4, 2))
        EXPECT_EQ(s, 0.0f);
}

TEST(Traced, every_input_has_a_hash_of_its_own)
{
    const TracedScene scene = tangle(10, 0.001f, glm::vec3(0.2f));
    const auto differs = [&](auto change)
    {
        TracedScene other = scene;
        change(other);
        return hash_of(other).word[0] != hash_of(scene).word[0];
    };
    EXPECT_FALSE(differs([](TracedScene&) {}));
    EXPECT_TRUE(differs([](TracedScene& s) { s.curve[7].w *= 2.0f; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.absorption[3].y += 0.1f; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.fibre.tilt = 0.1; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.lighting.sky.z = 1.0f; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.lighting.suns.push_back({}); }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.eye.x = 1e-3; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.lens = 1e-3; }));
}

TEST(Traced, a_record_is_read_as_it_was_written)
{
    const test::Scratch scratch;
    const std::filesystem::path file = record_of(scratch / "bob.png");
    EXPECT_EQ(file.filename(), "bob.traced");
    EXPECT_FALSE(read_record(file).has_value());
    Accumulation picture = empty_accumulation(3, 2);
    picture.samples = {4, 5};
    for (size_t i = 0; i < picture.sum.size(); ++i)
        picture.sum[i] = glm::vec4(float(i), 0.5f, -1.0f, 3.0f);
    const Hash hash = {{123, 456}};
    write_record(file, hash, picture);
    const std::optional<Record> read = read_record(file);
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->of.word[1], 456u);
    EXPECT_EQ(read->picture.width, 3);
    EXPECT_EQ(read->picture.samples, picture.samples);
    EXPECT_EQ(read->picture.sum, picture.sum);
    const LinearImage mean = mean_of(picture);
    EXPECT_FLOAT_EQ(mean.pixels[4 * 5 + 0], 1.0f) << "5 in 5 samples";
    EXPECT_FLOAT_EQ(mean.pixels[4 * 2 + 3], 0.75f);

    const std::string bytes = read_file(file);
    for (const std::string& bad : {std::string("my novel"), std::string(), bytes.substr(0, 30), bytes + "x"})
    {
        write_file(file, bad);
        EXPECT_THROW(read_record(file), Error) << bad.size();
    }
}

} // namespace
} // namespace coif

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

// A ball of 5 cm about a place, of flat faces.
void add_ball(TracedScene& scene, glm::vec3 middle, glm::vec3 albedo, float gloss)
{
    constexpr int kRings = 24, kSides = 32;
    const auto on = [&](int i, int j)
    {
        const double up = std::numbers::pi * i / kRings, turn = 2.0 * std::numbers::pi * j / kSides;
        return glm::vec3(std::sin(up) * std::cos(turn), std::cos(up), std::sin(up) * std::sin(turn));
    };
    const auto add = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c)
    {
        const unsigned first = unsigned(scene.position.size());
        const glm::vec3 across = glm::normalize(glm::cross(b - a, c - a));
        for (const glm::vec3& corner : {a, b, c})
        {
            scene.position.push_back(middle + 0.05f * corner);
            scene.normal.push_back(glm::dot(across, a) > 0.0f ? across : -across);
            scene.albedo.push_back(albedo);
            scene.gloss.push_back(gloss);
        }
        scene.triangles.emplace_back(first, first + 1, first + 2);
    };
    for (int i = 0; i < kRings; ++i)
        for (int j = 0; j < kSides; ++j)
        {
            if (i > 0)
                add(on(i, j), on(i, j + 1), on(i + 1, j));
            if (i + 1 < kRings)
                add(on(i, j + 1), on(i + 1, j + 1), on(i + 1, j));
        }
}

TEST(Traced, a_white_ball_never_outshines_the_sky)
{
    for (const float gloss : {0.0f, 1.0f})
    {
        TracedScene scene = empty_scene();
        add_ball(scene, {0, 0, 0}, {1.0f, 0.5f, 0.0f}, gloss);
        scene.lighting.sky = glm::vec3(1.0f);
        const Accumulation picture = traced(scene, 256);
        glm::dvec3 sum(0.0);
        double whole = 0.0;
        for (const glm::vec4& pixel : picture.sum)
            if (pixel.w == 256.0f)
            {
                // But for chance, which takes the mean of 256 so far.
                EXPECT_LE(pixel.x / 256.0f, gloss > 0.0f ? 1.03f : 1.0f + 1e-5f);
                sum += glm::dvec3(pixel) / 256.0;
                ++whole;
            }
        ASSERT_GT(whole, 50.0);
        sum /= whole;
        EXPECT_NEAR(sum.x, 1.0, gloss > 0.0f ? 0.003 : 1e-6);
        if (gloss > 0.0f)
        {
            EXPECT_GT(sum.z, 0.03) << "its coat mirrors the sky though it is black";
            EXPECT_LT(sum.z, 0.10);
            EXPECT_LT(sum.y, 0.5 + 0.5 * sum.z + 0.003) << "and takes what it mirrors from what lies under it";
        }
        else
        {
            EXPECT_NEAR(sum.y, 0.5, 1e-6) << "just the albedo";
            EXPECT_EQ(sum.z, 0.0);
        }
    }
}

// The camera a metre over the origin, looking straight down on a ground 20 cm below that; up in the picture is -z.
TracedScene ground_scene(double radius)
{
    TracedScene scene = empty_scene();
    scene.eye = {0, 1, 0};
    scene.forward = {0, -1, 0};
    scene.right = {1, 0, 0};
    scene.up = {0, 0, -1};
    scene.ground = {{0, -0.2, 0}, radius, {0.8, 0.5, 0.2}};
    return scene;
}

TEST(Traced, the_ground_follows_lamberts_law)
{
    TracedScene scene = ground_scene(50.0);
    const float third = std::numbers::pi_v<float> / 3.0f;
    scene.lighting.suns = {{{std::sin(third), std::cos(third), 0.0f}, {2.0f, 3.0f, 4.0f}, 0.0f},
                           {{0.6f, -0.8f, 0.0f}, glm::vec3(9.0f), 0.0f}}; // which shines on it from below
    scene.lighting.sky = {0.5f, 0.25f, 1.0f};
    const double pi = std::numbers::pi;
    const glm::dvec4 wanted(0.8 * (2.0 * 0.5 / pi + 0.5), 0.5 * (3.0 * 0.5 / pi + 0.25), 0.2 * (4.0 * 0.5 / pi + 1.0),
                            1.0);
    for (const glm::vec4& pixel : traced(scene, 1).sum)
        for (int c = 0; c < 4; ++c)
            ASSERT_NEAR(pixel[c], wanted[c], 1e-5);

    // From below it is not there.
    scene.eye = {0, -1, 0};
    scene.forward = {0, 1, 0};
    EXPECT_EQ(sum_of(traced(scene, 2)), glm::dvec4(0.0));
}

TEST(Traced, the_ground_fades_towards_its_rim)
{
    TracedScene scene = ground_scene(0.1);
    scene.lighting.sky = glm::vec3(1.0f);
    const Accumulation picture = traced(scene, 400);
    const double pixel = 1.2 * 2.0 * 0.1 / kHeight; // m on the ground
    for (int x = 0; x < kWidth; ++x)
    {
        const glm::vec4 sum = picture.sum[size_t((kHeight / 2) * kWidth + x)] / 400.0f;
        const double out = std::hypot((x + 0.5 - 0.5 * kWidth) * pixel, 0.5 * pixel) / 0.1;
        const double t = std::clamp((out - 0.35) / 0.65, 0.0, 1.0), cover = 1.0 - t * t * (3.0 - 2.0 * t);
        EXPECT_NEAR(sum.w, cover, 0.09) << out;
        EXPECT_NEAR(sum.x, 0.8 * sum.w, 1e-4) << "premultiplied";
    }
    EXPECT_EQ(picture.sum[0].w, 0.0f) << "past the rim";
}

TEST(Traced, a_ball_shades_the_ground_below_it)
{
    TracedScene scene = ground_scene(50.0);
    scene.eye = {0, -0.19, 0};
    scene.lighting.sky = glm::vec3(1.0f);
    const auto bright = [](const TracedScene& of)
    { return double(traced(of, 1024).sum[size_t(kHeight / 2 * kWidth + kWidth / 2)].x) / 1024.0; };
    EXPECT_NEAR(bright(scene), 0.8, 1e-4);
    // A black ball of radius r whose middle is d above takes (r / d)^2 of an even sky's light: 5 and 10 cm.
    add_ball(scene, {0.0f, -0.1f, 0.0f}, glm::vec3(0.0f), 0.0f);
    EXPECT_NEAR(bright(scene) / 0.8, 0.75, 0.05);
    scene.lighting.sky = glm::vec3(0.0f);
    scene.lighting.suns = {{{0, 1, 0}, glm::vec3(3.0f), 0.0f}};
    EXPECT_EQ(bright(scene), 0.0);
}

TEST(Traced, the_ground_lights_hair_from_below)
{
    TracedScene bare = tangle(300, 0.001f, glm::vec3(0.2f));
    bare.lighting.suns = {{{0, 1, 0}, glm::vec3(3.0f), 0.0f}};
    TracedScene white = bare, black = bare;
    white.ground = {{0, -0.3, 0}, 9.0, glm::dvec3(0.9)};
    black.ground = {{0, -0.3, 0}, 9.0, glm::dvec3(0.0)};
    // The camera looks level; rows in the upper half show nothing of the ground.
    const auto above = [](const TracedScene& scene)
    {
        double sum = 0.0;
        const Accumulation picture = traced(scene, 32);
        for (size_t i = 0; i < picture.sum.size() / 2; ++i)
            sum += double(picture.sum[i].x);
        return sum;
    };
    const double none = above(bare);
    EXPECT_GT(above(white), 1.2 * none);
    EXPECT_NEAR(above(black) / none, 1.0, 0.01) << "a black one hands nothing on";

    TraceLimits direct;
    direct.bounces = 0;
    TracedScene under = bare; // a sun below the ground, which is not there from below, and hair above it
    under.lighting.suns[0].direction = {0, -1, 0};
    EXPECT_GT(sum_of(traced(under, 8, direct)).x, 0.0);
    under.ground = white.ground;
    EXPECT_EQ(sum_of(traced(under, 8, direct)).x, 0.0) << "it takes the light of a sun below it";
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
    EXPECT_TRUE(differs([](TracedScene& s) { s.ground.radius = 1.0; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.ground.middle.y = -0.1; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.ground.albedo.x = 0.1; }));
    EXPECT_TRUE(differs([](TracedScene& s) { s.gloss.push_back(1.0f); }));
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

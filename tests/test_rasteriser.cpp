// The strand rasteriser: its pixels against exact areas, its order, its bounds, and its pictures against the geometry
// shader's.
#include "app/rasteriser.h"
#include "app/renderer.h"
#include "app/ssim.h"
#include "sim/source.h"
#include "sim/wave.h"
#include "tests/on_device.h"
#include "tests/oracle.h"
#include "tests/pixels.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numeric>

namespace coif
{
namespace
{

constexpr int kNodes = 6;
constexpr int kWidth = 200, kHeight = 150; // pixels; the last tiles are not whole
constexpr float kPixel = 0.001f;           // m that one covers at the origin
constexpr float kNear = kViewNear, kFar = kViewFar, kDistance = kViewDistance;

RasterView far_view() { return view_along_z(kWidth, kHeight, kPixel); }

double window_depth(double z) // of what lies at z
{
    const double w = kDistance - z, a = (kFar + kNear) / (kFar - kNear), b = -2.0 * kFar * kNear / (kFar - kNear);
    return 0.5 + 0.5 * (a + b / w);
}

// All light, evenly: a strand has just its colour.
HairParams plain_params()
{
    HairParams p;
    p.strand_nodes = kNodes;
    p.look_ambient = 1.0f;
    p.look_diffuse = p.look_specular = p.look_variation = p.look_taper = 0.0f;
    p.look_opacity = 1.0f;
    p.look_root_color = p.look_tip_color = F4(1.0f, 1.0f, 1.0f, 1.0f);
    p.look_width = 3.0f * kPixel;
    return p;
}

struct Strand
{
    std::vector<glm::vec3> nodes; // m
    glm::vec3 color{1.0f};
    float opacity = 1.0f, width = 3.0f * kPixel;
};

// From `a` (its second node: the first piece lies under the scalp) to `b`, in pixels about the picture's middle.
Strand straight(glm::vec2 a, glm::vec2 b, float z = 0.0f)
{
    Strand strand;
    for (int k = 0; k < kNodes; ++k)
        strand.nodes.emplace_back(
            kPixel * glm::mix(a, b, float(k - 1) / float(kNodes - 2)) * (kDistance - z) / kDistance, z);
    return strand;
}

struct Pixels
{
    std::vector<float> values; // red, green, blue, alpha, row by row from the lowest
    std::vector<unsigned char> bytes;
    int batches = 0;
    const float* at(int x, int y) const { return &values[size_t(4 * (y * kWidth + x))]; }
    double alpha_sum() const
    {
        double sum = 0.0;
        for (size_t i = 3; i < values.size(); i += 4)
            sum += values[i];
        return sum;
    }
};

class Scene
{
  public:
    Scene(const Device& device, const std::vector<Strand>& strands, const HairParams& params = plain_params())
        : device_(device), rasteriser(device_)
    {
        Groom groom = one_strand(kNodes, 0.1f, {0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
        groom.drawn.resize(strands.size());
        groom.drawn_multi = int(strands.size());
        std::vector<float4> positions, frames;
        for (size_t s = 0; s < strands.size(); ++s)
        {
            const Strand& strand = strands[s];
            StrandLook look = {};
            look.root_color = F4(strand.color.x, strand.color.y, strand.color.z, strand.width);
            look.tip_color = F4(strand.color.x, strand.color.y, strand.color.z, strand.opacity);
            look.own.x = float(s);
            groom.looks.push_back(look);
            groom.drawn[s].leader = int(s);
            float length = 0.0f;
            for (size_t k = 0; k < strand.nodes.size(); ++k)
            {
                const glm::vec3 p = strand.nodes[k];
                length += k > 1 ? glm::distance(p, strand.nodes[k - 1]) : 0.0f;
                positions.push_back(F4(p.x, p.y, p.z, 1.0f));
                frames.push_back(F4(0.0f, 0.0f, 1.0f, length));
            }
        }
        solver = std::make_unique<Solver>(device_, params, groom, Pose{});
        write(device_, solver->buffers().at("drawn_position"), positions);
        write(device_, solver->buffers().at("drawn_frame"), frames);
        drawn = {solver.get(), device_params(params), wave_table(params), {}, {}, {}};
    }

    // `solid`: depth in the window of what lies there already.
    Pixels draw(const std::vector<float>& solid = {}, const RasterView& view = far_view())
    {
        const size_t count = size_t(view.width) * size_t(view.height);
        float* depth = rasteriser.solid_depth(view.width, view.height);
        for (size_t i = 0; i < count; ++i)
            depth[i] = solid.empty() ? 1.0f : solid[i];
        rasteriser.measure(drawn, view);
        const RasterPicture picture = rasteriser.draw(drawn);
        const Mapped mapped(rasteriser.device(), picture.pixels, picture.bytes);
        Pixels pixels;
        pixels.values.resize(4 * count);
        pixels.bytes.resize(8 * count);
        pixels.batches = rasteriser.batches();
        for (int y = picture.y; y < picture.y + picture.height; ++y)
            for (int i = 4 * (y * view.width + picture.x); i < 4 * (y * view.width + picture.x + picture.width); ++i)
            {
                const uint16_t half = mapped.as<uint16_t>()[i];
                pixels.values[size_t(i)] = of_half(half);
                std::memcpy(&pixels.bytes[size_t(2 * i)], &half, 2);
            }
        return pixels;
    }

  private:
    Device device_;

  public:
    Rasteriser rasteriser;
    std::unique_ptr<Solver> solver;
    RasterStrands drawn;
};

// The share of a pixel that a ribbon from a to b covers, by 64 x 64 samples.
double exact_cover(glm::dvec2 pixel, glm::dvec2 a, glm::dvec2 b, double width)
{
    const glm::dvec2 along = glm::normalize(b - a), across(-along.y, along.x);
    int inside = 0;
    for (int j = 0; j < 64; ++j)
        for (int i = 0; i < 64; ++i)
        {
            const glm::dvec2 p = pixel + (glm::dvec2(i, j) + 0.5) / 64.0 - a;
            inside += std::abs(glm::dot(p, across)) < 0.5 * width && glm::dot(p, along) > 0.0 &&
                      glm::dot(p, along) < glm::distance(a, b);
        }
    return inside / 4096.0;
}

TEST(Rasteriser, ARibbonCoversItsExactArea)
{
    for (const double degrees : {0.0, 12.0, 33.0, 45.0, 68.0, 90.0, 161.0})
        for (const double width : {0.3, 1.0, 2.6, 7.0})
        {
            const double angle = degrees * 3.14159265358979 / 180.0;
            const glm::dvec2 half = 41.3 * glm::dvec2(std::cos(angle), std::sin(angle)), middle(3.2, -1.7);
            Strand strand = straight(glm::vec2(middle - half), glm::vec2(middle + half));
            strand.width = float(width) * kPixel;
            const Pixels pixels = Scene(test_device(), {strand}).draw();
            // But for its ends, which fade on their own.
            const double area = 2.0 * 41.3 * width;
            EXPECT_NEAR(pixels.alpha_sum(), area, 0.006 * area + 0.05) << degrees << " degrees, " << width << " pixels";
            const glm::dvec2 a = middle - half + glm::dvec2(0.5 * kWidth, 0.5 * kHeight), b = a + 2.0 * half;
            double worst = 0.0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x)
                    worst = std::max(
                        worst, std::abs(double(pixels.at(x, y)[3]) - exact_cover({double(x), double(y)}, a, b, width)));
            EXPECT_LT(worst, 0.17) << degrees << " degrees, " << width << " pixels";
        }
}

TEST(Rasteriser, NoPixelOfABentStrandIsCoveredTwiceOrMissed)
{
    Strand arc;
    for (int k = 0; k < kNodes; ++k)
    {
        const float angle = 0.9f * float(k - 1);
        arc.nodes.emplace_back(kPixel * 45.0f * std::cos(angle), kPixel * 45.0f * std::sin(angle), 0.0f);
    }
    arc.opacity = 0.5f;
    arc.width = 8.0f * kPixel;
    const Pixels pixels = Scene(test_device(), {arc}).draw();
    int whole = 0;
    for (size_t i = 3; i < pixels.values.size(); i += 4)
    {
        ASSERT_LE(pixels.values[i], 0.501f);
        whole += pixels.values[i] > 0.499f;
    }
    // A ring's part 7 pixels wide (less half a pixel at either edge): 3.6 rad of radius 45, the chords a little within.
    EXPECT_NEAR(whole, 3.6 * 45.0 * 7.0, 60.0);
    EXPECT_NEAR(pixels.alpha_sum(), 0.5 * 3.6 * 45.0 * 8.0, 10.0);
}

TEST(Rasteriser, NearerStrandsCoverFartherOnesByTheirOpacity)
{
    Strand red = straight({-60, 0}, {60, 0}, 0.02f), blue = straight({0, -60}, {0, 60}, -0.02f);
    red.width = blue.width = 20.0f * kPixel;
    red.color = {1.0f, 0.0f, 0.0f};
    blue.color = {0.0f, 0.0f, 1.0f};
    red.opacity = 0.6f;
    blue.opacity = 0.5f;
    const Pixels pixels[] = {Scene(test_device(), {red, blue}).draw(), Scene(test_device(), {blue, red}).draw()};
    for (const Pixels& p : pixels)
    {
        const float* both = p.at(kWidth / 2, kHeight / 2);
        EXPECT_NEAR(both[0], 0.6, 1e-3);
        EXPECT_NEAR(both[2], 0.4 * 0.5, 1e-3);
        EXPECT_NEAR(both[3], 1.0 - 0.4 * 0.5, 1e-3);
        EXPECT_NEAR(p.at(kWidth / 2 + 30, kHeight / 2)[3], 0.6, 1e-3);
        EXPECT_NEAR(p.at(kWidth / 2, kHeight / 2 + 30)[3], 0.5, 1e-3);
        EXPECT_EQ(p.at(kWidth / 2 + 30, kHeight / 2 + 30)[3], 0.0f);
    }
}

TEST(Rasteriser, WhatIsSolidHidesWhatLiesBehindIt)
{
    const Strand strand = straight({-80, 0}, {80, 0}, 0.0f);
    std::vector<float> solid(size_t(kWidth) * kHeight, 1.0f);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            solid[size_t(y * kWidth + x)] = float(window_depth(x < 70 ? 0.05 : x < 130 ? -0.05 : -40.0));
    Scene scene(test_device(), {strand});
    const Pixels hidden = scene.draw(solid), open = scene.draw();
    for (int x = 25; x < 175; ++x)
    {
        EXPECT_GT(open.at(x, kHeight / 2)[3], 0.9f) << x;
        EXPECT_EQ(hidden.at(x, kHeight / 2)[3], x < 70 ? 0.0f : open.at(x, kHeight / 2)[3]) << x;
    }
    std::fill(solid.begin(), solid.end(), float(window_depth(0.05)));
    EXPECT_EQ(scene.draw(solid).alpha_sum(), 0.0);
    EXPECT_EQ(scene.rasteriser.pieces(), 0u) << "what is wholly hidden is not even binned";
}

// Many strands that each keep one depth, so that any cut into batches by depth has them in the right order.
std::vector<Strand> layers(int count)
{
    Random random(11);
    std::vector<Strand> strands;
    for (int i = 0; i < count; ++i)
    {
        Strand strand = straight({random.in(-110, 110), random.in(-85, 85)}, {random.in(-110, 110), random.in(-85, 85)},
                                 float(random.in(-0.5, 0.5)));
        strand.color = glm::vec3(random.in(0.1, 1.0), random.in(0.1, 1.0), random.in(0.1, 1.0));
        strand.opacity = float(random.in(0.1, 0.5));
        strand.width = float(random.in(0.3, 4.0)) * kPixel;
        strands.push_back(strand);
    }
    return strands;
}

double greatest_difference(const Pixels& a, const Pixels& b)
{
    double most = 0.0;
    for (size_t i = 0; i < a.values.size(); ++i)
        most = std::max(most, double(std::abs(a.values[i] - b.values[i])));
    return most;
}

TEST(Rasteriser, WhatDoesNotFitIsDrawnInFurtherBatches)
{
    Scene scene(test_device(), layers(150));
    const Pixels at_once = scene.draw();
    ASSERT_EQ(at_once.batches, 1);
    EXPECT_GT(at_once.alpha_sum(), 5000.0);
    scene.rasteriser.most_points = 200;
    const Pixels few_points = scene.draw();
    EXPECT_GT(few_points.batches, 3);
    // What is open is kept as a half between batches.
    EXPECT_LT(greatest_difference(few_points, at_once), 0.01);
    scene.rasteriser.most_pieces = 40;
    const Pixels few_pieces = scene.draw();
    EXPECT_GT(few_pieces.batches, few_points.batches);
    EXPECT_LT(greatest_difference(few_pieces, at_once), 0.02);
    EXPECT_NEAR(few_pieces.alpha_sum(), at_once.alpha_sum(), 0.002 * at_once.alpha_sum());
}

TEST(Rasteriser, AStrandGoneBadDrawsNothingAndHarmsNobody)
{
    std::vector<Strand> strands = layers(40);
    for (glm::vec3& node : strands[7].nodes)
        node.x += 5.0f; // out of view
    const Pixels without = Scene(test_device(), strands).draw();
    const float nan = std::nanf(""), infinity = INFINITY;
    const glm::vec3 bad[] = {{nan, nan, nan}, {infinity, 0.0f, 0.0f}, {0.0f, -infinity, nan}, {1e30f, 1e30f, -1e30f}};
    for (const glm::vec3& value : bad)
    {
        std::fill(strands[7].nodes.begin(), strands[7].nodes.end(), value);
        EXPECT_TRUE(Scene(test_device(), strands).draw().bytes == without.bytes) << value.x << ' ' << value.y;
    }
    for (glm::vec3& node : strands[7].nodes) // behind the camera
        node = {0.01f * node.y, 0.0f, kDistance + 1.0f};
    EXPECT_TRUE(Scene(test_device(), strands).draw().bytes == without.bytes) << "behind the camera";
    strands[7] = straight({-20, -20}, {20, 20});
    strands[7].nodes[3].y = nan;
    for (const float value : Scene(test_device(), strands).draw().values)
        ASSERT_TRUE(std::isfinite(value) && value >= 0.0f);
}

TEST(Rasteriser, AStrandThatPassesTheCameraEndsAtTheNearPlane)
{
    Strand strand; // below the line of sight, from before the camera to far behind it
    for (int k = 0; k < kNodes; ++k)
        strand.nodes.emplace_back(0.0002f, -0.001f, kDistance + 4.0f - 3.0f * float(k));
    strand.width = 0.0001f;
    const Pixels pixels = Scene(test_device(), {strand}).draw();
    EXPECT_GT(pixels.alpha_sum(), 1.0);
    for (const float value : pixels.values)
        ASSERT_TRUE(std::isfinite(value) && value >= 0.0f && value <= 1.001f);
}

TEST(Rasteriser, EqualInputGivesEqualBytes)
{
    Scene scene(test_device(), layers(100)), other(test_device(), layers(100));
    const Pixels first = scene.draw();
    EXPECT_TRUE(scene.draw().bytes == first.bytes);
    EXPECT_TRUE(other.draw().bytes == first.bytes);
}

TEST(Rasteriser, AllWidthsDrawTheSame)
{
    HairParams params = plain_params();
    params.wave_normal_amplitude = 0.0f;
    params.look_diffuse = params.look_specular = 0.4f;
    const auto drawn_by = [&](const Device& device, float held_width)
    {
        Scene scene(device, layers(60), params);
        scene.rasteriser.held_width = held_width;
        return scene.draw();
    };
    Device as_gpu = with_width(1);
    as_gpu.is_gpu = true; // a row a work-item, groups of many
    for (const float held_width : {0.0f, 1e9f})
    {
        const Pixels wide = drawn_by(with_width(16), held_width);
        EXPECT_GT(wide.alpha_sum(), 2000.0);
        for (const Device& device : {with_width(8), with_width(1), as_gpu})
        {
            const Pixels narrow = drawn_by(device, held_width);
            // Powers and roots may round another way, and halves with them.
            EXPECT_LT(greatest_difference(narrow, wide), 0.004) << device.width << (device.is_gpu ? ", as a GPU" : "");
        }
    }
}

// Two strands along each other, into the depth. Their pieces lie half a piece apart, so that the middles of the farther
// one's are nearer than those of some that they are hidden by.
TEST(Rasteriser, StrandsThatLieAlongEachOtherKeepTheirOrder)
{
    const auto sloping = [](float from, float behind, glm::vec3 color)
    {
        Strand strand;
        for (int k = 0; k < kNodes; ++k)
        {
            const float x = from + 30.0f * float(k), z = kPixel * (x - behind);
            strand.nodes.emplace_back(kPixel * x * (kDistance - z) / kDistance, 0.0f, z);
        }
        strand.width = 20.0f * kPixel;
        strand.color = color;
        return strand;
    };
    const Strand red = sloping(-90.0f, 0.0f, {1, 0, 0}), blue = sloping(-75.0f, 5.0f, {0, 0, 1});
    for (const bool red_first : {true, false})
    {
        Scene scene(test_device(), red_first ? std::vector<Strand>{red, blue} : std::vector<Strand>{blue, red});
        const Pixels pixels = scene.draw();
        int wrong = 0;
        for (int x = kWidth / 2 - 40; x < kWidth / 2 + 40; ++x)
            for (int y = kHeight / 2 - 8; y < kHeight / 2 + 8; ++y)
                wrong += pixels.at(x, y)[2] > 0.01f || pixels.at(x, y)[0] < 0.99f;
        EXPECT_EQ(wrong, 0);
        scene.rasteriser.held_width = 1e9f;
        EXPECT_GT(scene.draw().at(kWidth / 2 + 12, kHeight / 2)[2] + scene.draw().at(kWidth / 2 - 3, kHeight / 2)[2],
                  0.5f)
            << "no piece is out of order here";
    }
}

// Points against doubles: Catmull-Rom, waves, curls and frizz laid on, projection, width and light.
TEST(Rasteriser, PointsAreWhereDoublesHaveThem)
{
    HairParams params = plain_params();
    params.look_diffuse = 0.7f;
    params.look_specular = 0.3f;
    params.look_taper = 0.5f;
    params.smoothing_subdivisions = 7;
    params.curl_radius = 0.006f;
    params.curl_pitch = 0.05f;
    params.wave_normal_amplitude = 0.003f;
    params.wave_binormal_amplitude = 0.002f;
    params.wave_normal_randomness = params.wave_binormal_randomness = 0.6f;
    params.frizz_amount = 0.002f;
    Strand strand;
    Random random(5);
    for (int k = 0; k < kNodes; ++k)
        strand.nodes.emplace_back(-0.04f + 0.015f * float(k), float(random.in(-0.02, 0.02)),
                                  float(random.in(-0.02, 0.02)));
    Scene scene(test_device(), {strand}, params);
    // The scene's looks have no curls of their own; without looks the style's hold.
    const HairParams style = device_params(params);
    const std::vector<float> table = wave_table(params);
    const auto wave = [&](size_t side, double place) // linear between its samples, which begin again
    {
        const double at = (place - std::floor(place)) * kWaveSamples - 0.5, below = std::floor(at);
        const auto sample = [&](double i)
        { return double(table[2 * ((size_t(i) + kWaveSamples) % kWaveSamples) + side]); };
        return glm::mix(sample(below + kWaveSamples), sample(below + 1.0 + kWaveSamples), at - below);
    };
    int fewest = 0;
    for (const bool varied : {true, false})
    {
        if (!varied)
        {
            Groom groom = scene.solver->groom();
            groom.looks.clear();
            scene.solver->set_groom(groom);
        }
        scene.draw();
        const Device& device = scene.rasteriser.device();
        const std::vector<unsigned char> cuts =
            read<unsigned char>(device, scene.rasteriser.buffers().at("pieces"), kNodes);
        std::vector<glm::dvec3> places;
        std::vector<double> along;
        const int total = std::accumulate(cuts.begin() + 1, cuts.end() - 1, 0);
        EXPECT_GT(total, fewest) << "curls ask for more pieces";
        fewest = total;
        for (int k = 1; k < kNodes - 1; ++k)
        {
            ASSERT_GT(cuts[size_t(k)], 0);
            for (int i = k == 1 ? 0 : 1; i <= cuts[size_t(k)]; ++i)
            {
                const double t = double(float(i) / float(cuts[size_t(k)]));
                double w[4];
                oracle::curve_weights(3, t, w);
                const auto node = [&](int of) { return glm::dvec3(strand.nodes[size_t(std::min(of, kNodes - 1))]); };
                glm::dvec3 p = w[0] * node(k - 1) + w[1] * node(k) + w[2] * node(k + 1) + w[3] * node(k + 2);
                const double at = (k - 1 + t) / (kNodes - 2.0);
                if (!varied)
                {
                    const glm::dvec3 tangent =
                        glm::normalize(glm::mix(node(k + 1) - node(k - 1), node(k + 2) - node(k), t));
                    glm::dvec3 normal(0.0, 0.0, 1.0);
                    normal = glm::normalize(normal - tangent * glm::dot(normal, tangent));
                    double length[2] = {};
                    for (int j = 2; j <= k + 1; ++j)
                    {
                        length[1] += glm::distance(node(j), node(j - 1));
                        length[0] += j <= k ? glm::distance(node(j), node(j - 1)) : 0.0;
                    }
                    const double onset = std::clamp((at - double(style.curl_begin)) * 4.0, 0.0, 1.0);
                    const int seed = 7919 * style.interpolation_seed;
                    const oracle::Across by = oracle::curl_at(
                        seed, double(style.curl_phase) * oracle::strand_random(seed, 5),
                        glm::mix(length[0], length[1], t), style.curl_pitch, style.curl_variation, style.curl_hand);
                    const double far = glm::mix(length[0], length[1], t);
                    const double curl = double(style.curl_radius) * onset * onset * (3.0 - 2.0 * onset);
                    const oracle::Across frizz = oracle::frizz_at(seed, far, style.frizz_frequency);
                    const double frizzed = double(style.frizz_amount) * at * (2.0 - at);
                    const double across[2] = {
                        curl * by.normal + frizzed * frizz.normal +
                            double(style.wave_normal_amplitude) * oracle::wave_onset(at, style.wave_normal_begin) *
                                wave(0, oracle::wave_place(seed, far, style.wave_normal_frequency, 0.6f)),
                        curl * by.binormal + frizzed * frizz.binormal +
                            double(style.wave_binormal_amplitude) * oracle::wave_onset(at, style.wave_binormal_begin) *
                                wave(1, oracle::wave_place(seed, far, style.wave_binormal_frequency, 0.6f))};
                    p += across[0] * normal + across[1] * glm::cross(tangent, normal);
                }
                places.push_back(p);
                along.push_back(at);
            }
        }
        const std::vector<float> points =
            read<float>(device, scene.rasteriser.buffers().at("points"), places.size() * 8);
        for (size_t i = 0; i < places.size(); ++i)
        {
            const glm::dvec3 p = places[i];
            const double w = kDistance - p.z, scale = double(kDistance) / (w * double(kPixel));
            const float* point = &points[8 * i];
            EXPECT_NEAR(point[0], 0.5 * kWidth + p.x * scale, 3e-3) << i; // pixels
            EXPECT_NEAR(point[1], 0.5 * kHeight + p.y * scale, 3e-3) << i;
            EXPECT_NEAR(point[2], window_depth(p.z), 1e-6) << i;
            const double width = (varied ? 0.003 : double(style.look_width)) * (1.0 - 0.5 * along[i] * along[i]);
            EXPECT_NEAR(point[3], width * scale, 1e-3) << i;
            if (i == 0 || i + 1 == places.size())
                continue;
            const glm::dvec3 tangent = glm::normalize(places[i + 1] - places[i - 1]);
            const glm::dvec4 l(style.look_light_direction.x, style.look_light_direction.y, style.look_light_direction.z,
                               0.0);
            const double tl = glm::dot(tangent, glm::dvec3(l));
            const double te = glm::dot(tangent, glm::normalize(glm::dvec3(0.0, 0.0, kDistance) - p));
            const double sl = std::sqrt(1.0 - tl * tl), se = std::sqrt(1.0 - te * te);
            const double diffuse = 0.7 * std::pow(sl, double(style.look_diffuse_exponent));
            const double shine = 0.3 * std::pow(std::max(0.0, sl * se - tl * te), double(style.look_specular_exponent));
            uint32_t rg;
            std::memcpy(&rg, &point[4], sizeof rg);
            const double red = 1.0 + (diffuse + shine) * double(style.look_light_color.x);
            EXPECT_NEAR(of_half(uint16_t(rg & 0x7fff)), red, 2e-3 * red) << i;
        }
    }
}

// Hair that all things are laid on, each strand as it likes.
HairParams curly_params()
{
    HairParams params = plain_params();
    params.smoothing_subdivisions = 30;
    params.curl_radius = 0.006f;
    params.curl_pitch = 0.05f;
    params.curl_variation = 0.6f;
    params.wave_normal_amplitude = 0.003f;
    params.wave_binormal_amplitude = 0.004f;
    params.wave_normal_randomness = params.wave_binormal_randomness = 0.6f;
    params.frizz_amount = 0.004f;
    return params;
}

// Strands about the picture's middle whose looks are the style's.
std::unique_ptr<Scene> curly_scene(int count, float depth)
{
    Random random(5);
    std::vector<Strand> strands;
    for (int i = 0; i < count; ++i)
    {
        Strand strand;
        for (int k = 0; k < kNodes; ++k)
            strand.nodes.emplace_back(-0.04f + 0.015f * float(k), float(random.in(-0.02, 0.02)),
                                      depth * float(random.in(-0.02, 0.02)));
        strands.push_back(strand);
    }
    auto scene = std::make_unique<Scene>(test_device(), strands, curly_params());
    Groom groom = scene->solver->groom();
    groom.looks.clear();
    scene->solver->set_groom(groom);
    return scene;
}

TEST(Rasteriser, HowFarACurlReachesHidesItNoLess)
{
    const auto scene = curly_scene(20, 0.0f);
    const std::vector<float> solid(size_t(kWidth) * kHeight, float(window_depth(0.1)));
    scene->draw(solid);
    EXPECT_EQ(scene->rasteriser.pieces(), 0u);
    scene->draw();
    EXPECT_GT(scene->rasteriser.pieces(), 500u);
}

constexpr double kTolerance = 0.5; // pixels: BEND_TOLERANCE of kernels/ribbon.h

// Pieces against those that the same strands are cut into when they are seen eight times as large.
TEST(Rasteriser, PiecesStrayAsFarAsIsToleratedAndNotMuchLess)
{
    constexpr int kStrands = 60, kLarger = 8;
    const auto scene = curly_scene(kStrands, 1.0f);
    struct Cut
    {
        std::vector<unsigned char> pieces;
        std::vector<float> points;
    };
    const auto cut = [&](int larger)
    {
        RasterView view = far_view();
        view.pixel /= float(larger);
        view.width *= larger;
        view.height *= larger;
        scene->draw({}, view);
        const Device& device = scene->rasteriser.device();
        const Buffers& buffers = scene->rasteriser.buffers();
        Cut of;
        of.pieces = read<unsigned char>(device, buffers.at("pieces"), size_t(kStrands) * kNodes);
        size_t points = 0;
        for (const int own : read<int>(device, buffers.at("strand_points"), kStrands))
            points += size_t(own);
        of.points = read<float>(device, buffers.at("points"), 8 * points);
        return of;
    };
    const Cut coarse = cut(1), fine = cut(kLarger);
    const auto point = [](const Cut& of, size_t i, double larger)
    { return glm::dvec2(double(of.points[8 * i]), double(of.points[8 * i + 1])) / larger; };
    std::vector<double> strays; // pixels, of each segment
    size_t in_coarse = 0, in_fine = 0;
    for (size_t s = 0; s < kStrands; ++s, ++in_coarse, ++in_fine)
        for (size_t k = 1; k + 1 < kNodes; ++k)
        {
            const int few = coarse.pieces[s * kNodes + k], many = fine.pieces[s * kNodes + k];
            ASSERT_GT(few, 0);
            ASSERT_GT(many, few) << "there are enough of them to tell";
            double most = 0.0;
            for (int i = 0; i <= many; ++i)
            {
                const int piece = std::min(i * few / many, few - 1);
                const glm::dvec2 a = point(coarse, in_coarse + size_t(piece), 1.0),
                                 b = point(coarse, in_coarse + size_t(piece) + 1, 1.0) - a,
                                 p = point(fine, in_fine + size_t(i), kLarger) - a;
                most = std::max(most, glm::length(p - b * std::clamp(glm::dot(p, b) / glm::dot(b, b), 0.0, 1.0)));
            }
            strays.push_back(most);
            in_coarse += size_t(few);
            in_fine += size_t(many);
        }
    // The first and last segments' curve bends by a neighbour that is guessed, and what is laid on sets in: one in
    // fifty may stray further.
    std::ranges::sort(strays);
    EXPECT_LT(strays[strays.size() * 49 / 50], kTolerance);
    EXPECT_LT(strays.back(), 2.0 * kTolerance);
    EXPECT_GT(strays[strays.size() / 2], 0.25 * kTolerance) << "more pieces than are asked for";
}

TEST(Rasteriser, NeitherWidthNorSizeBreaksIt)
{
    std::vector<Strand> strands = layers(6);
    strands[0].width = 100.0f; // wider than the picture by far
    strands[0].opacity = 1.0f;
    strands[0].nodes = straight({-10, 0}, {10, 0}, -0.6f).nodes;
    EXPECT_GT(Scene(test_device(), strands).draw().alpha_sum(), 0.9 * 20.0 * kHeight);
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 97), glm::ivec2(2048, 3)})
    {
        RasterView view = far_view();
        view.width = size.x;
        view.height = size.y;
        for (const float value : Scene(test_device(), strands).draw({}, view).values)
            ASSERT_TRUE(std::isfinite(value));
    }
    Scene none(test_device(), {});
    EXPECT_EQ(none.draw().alpha_sum(), 0.0);
}

// From ever further away fewer strands stand for all; what they cover stays, and none comes or goes at once.
TEST(Rasteriser, ThinStrandsAreDrawnFewerAndWider)
{
    HairParams params = plain_params();
    params.look_width = 0.02f * kPixel;
    std::vector<Strand> strands = layers(2000);
    for (Strand& strand : strands)
    {
        strand.width = params.look_width;
        strand.opacity = 0.2f;
    }
    Scene scene(test_device(), strands, params);
    scene.rasteriser.least_width = 0.0f;
    const double all = scene.draw().alpha_sum();
    const size_t pieces_of_all = scene.rasteriser.pieces();
    EXPECT_GT(all, 100.0);
    Pixels before;
    for (int i = 0; i <= 40; ++i)
    {
        scene.rasteriser.least_width = 0.05f * (1.0f + 0.01f * float(i)); // 40 % of them and fewer
        Pixels fewer = scene.draw();
        EXPECT_NEAR(fewer.alpha_sum(), all, 0.06 * all) << i;
        EXPECT_LT(double(scene.rasteriser.pieces()), 0.5 * double(pieces_of_all)) << i;
        if (i > 0)
        {
            // One that came or went at once would change its pixels by its opacity times 0.05 pixels.
            EXPECT_LT(greatest_difference(fewer, before), 0.4 * 0.2 * 0.05) << i;
        }
        before = std::move(fewer);
    }
}

// The reference has 16 samples a pixel: four times as wide and as high, by the geometry shader.
TEST(Rasteriser, ItsPicturesAreNoWorseThanTheGeometryShaders)
{
    const Window window(16, 16, Window::HIDDEN);
    Renderer renderer(data_folder() / "shaders");
    Hairstyle style;
    for (const char* set : {"interpolation.strands=1500", "grid.resolution=32", "camera.distance=0.7"})
        assign(style, set);
    Simulation simulation(test_device(), style);
    simulation.settle(0.7);
    simulation.solver().draw();
    FrameInput frame = frame_input(simulation, camera_of(style.params));
    const int width = 320, height = 240;
    const auto picture = [&](Method method, int multisample, int by)
    {
        frame.params.render_method = method;
        frame.params.render_multisample = multisample;
        return shrunk(renderer.picture(frame, by * width, by * height), by);
    };
    const Image geometry = picture(BY_GEOMETRY, 2, 1), rasterised = picture(BY_OPENCL, 1, 1);
    const Image again = picture(BY_OPENCL, 1, 1), reference = picture(BY_GEOMETRY, 1, 4);
    EXPECT_TRUE(again.pixels == rasterised.pixels);
    frame.params.render_show = 1;
    const Mask hair = changed_pixels(picture(BY_GEOMETRY, 1, 4), reference, 8);
    frame.params.render_show = 0;
    const double of_geometry = ssim(geometry, reference, hair), of_rasteriser = ssim(rasterised, reference, hair);
    EXPECT_GE(of_rasteriser, of_geometry);
    EXPECT_GT(of_rasteriser, 0.8);
    EXPECT_TRUE(renderer.method_of(style.params) == (is_software_renderer() ? BY_OPENCL : BY_GEOMETRY));
    // Guides lie among the strands, seen through what is open before them.
    frame.params.render_show = 2;
    const Image guides = picture(BY_OPENCL, 1, 1);
    const Mask shown = changed_pixels(guides, rasterised, 24);
    EXPECT_GT(std::ranges::count(shown, true), 200);
    frame.params.render_show = 1;
    const Mask alone = changed_pixels(picture(BY_OPENCL, 1, 1), guides, 24);
    EXPECT_GT(std::ranges::count(alone, true), 2000) << "there is still hair";
    // Values told by colours, and multisampling of what GL draws.
    for (const char* set : {"render.colors=kind", "render.multisample=4x", "look.opacity=0"})
    {
        Hairstyle other = style;
        assign(other, set);
        simulation.set_style(other);
        simulation.solver().draw();
        FrameInput told = frame_input(simulation, camera_of(style.params));
        told.params.render_method = BY_OPENCL;
        const Image by_opencl = renderer.picture(told, width, height);
        told.params.render_method = BY_GEOMETRY;
        const Image by_geometry = renderer.picture(told, width, height);
        double apart = 0.0;
        for (size_t i = 0; i < by_opencl.pixels.size(); ++i)
            apart += std::abs(int(by_opencl.pixels[i]) - int(by_geometry.pixels[i])) / double(by_opencl.pixels.size());
        EXPECT_LT(apart, 2.5) << set;
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << set;
    }
}

} // namespace
} // namespace coif

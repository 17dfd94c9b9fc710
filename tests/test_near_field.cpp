// Strands so wide that it is seen how they are lit from side to side: what the rasteriser makes of it against a twin,
// which side is which, and pictures against traced ones.
#include "app/look_error.h"
#include "app/rasteriser.h"
#include "app/shading.h"
#include "sim/source.h"
#include "sim/wave.h"
#include "tests/on_device.h"
#include "tests/oracle_look.h"
#include "tests/pixels.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

namespace coif
{
namespace
{

using oracle::Vec, oracle::xyz;

constexpr int kNodes = 8;
constexpr int kWidth = 120, kHeight = 100; // pixels
constexpr float kPixel = 0.0005f;          // m that one covers at the origin
constexpr float kStrand = 14.0f;           // pixels that it is wide

RasterView close_view() { return view_along_z(kWidth, kHeight, kPixel); }

HairParams params_of(float width)
{
    HairParams p;
    p.strand_nodes = kNodes;
    p.grid_resolution = 16;
    p.look_volume = 24;
    p.look_taper = p.look_variation = 0.0f;
    p.wave_normal_amplitude = p.wave_binormal_amplitude = 0.0f;
    p.look_width = width * kPixel;
    p.look_azimuthal_roughness = 0.25f;
    p.look_self_shadow = 0.02f; // it stands in a light of its own
    return p;
}

// A straight strand through the picture's middle that runs at so many degrees, lit and drawn.
class Close
{
  public:
    explicit Close(double degrees, const Lighting& lighting, glm::vec3 color = glm::vec3(0.3f, 0.2f, 0.1f),
                   const HairParams& authored = params_of(kStrand), const Device& device = test_device())
        : device_(device), shading(device_), rasteriser(device_)
    {
        const double angle = degrees * 3.14159265358979 / 180.0;
        along = {std::cos(angle), std::sin(angle), 0.0};
        Groom groom = one_strand(kNodes, 0.1f, {0.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f});
        groom.drawn.resize(1);
        groom.drawn_multi = 1;
        look = {};
        look.root_color = F4(color.x, color.y, color.z, authored.look_width);
        look.tip_color = F4(0.5f * color.x, 0.5f * color.y, 0.5f * color.z, 1.0f);
        groom.looks.push_back(look);
        std::vector<float4> positions, frames;
        for (int k = 0; k < kNodes; ++k)
        {
            const glm::vec3 p(along * double(kPixel) * double(40 * k - 140));
            positions.push_back(F4(p.x, p.y, p.z, 1.0f));
            frames.push_back(F4(0.0f, 0.0f, 1.0f, 40.0f * kPixel * float(k - 1)));
        }
        solver = std::make_unique<Solver>(device_, authored, groom, Pose{});
        solver->step({{Pose{}, 1.0 / 60.0, 1.0f / 60.0f}});
        solver->draw();
        write(device_, solver->buffers().at("drawn_position"), positions);
        write(device_, solver->buffers().at("drawn_frame"), frames);
        drawn = {solver.get(), device_params(authored), wave_table(authored), {}, {}, {}};
        suns = lighting.suns.size();
        shading.light(
            {solver.get(), drawn.params, drawn.waves, {}, lighting, glm::vec3(INFINITY), glm::vec3(-INFINITY)});
    }

    // Red, green, blue, alpha of each pixel, row by row from the lowest.
    std::vector<float> draw(float near, int level = LOOK_DUAL_SCATTERING, const RasterView& view = close_view())
    {
        drawn.shaded = &shading.shade(view.eye, level, 1.0f, nullptr, near);
        const size_t count = size_t(view.width) * size_t(view.height);
        std::fill_n(rasteriser.solid_depth(view.width, view.height), count, 1.0f);
        rasteriser.measure(drawn, view);
        const RasterPicture picture = rasteriser.draw(drawn);
        std::vector<float> pixels(4 * count);
        const Mapped mapped(rasteriser.device(), picture.pixels, picture.bytes);
        for (int y = picture.y; y < picture.y + picture.height; ++y)
            for (int i = 4 * (y * view.width + picture.x); i < 4 * (y * view.width + picture.x + picture.width); ++i)
                pixels[size_t(i)] = of_half(mapped.as<uint16_t>()[i]);
        return pixels;
    }

    template <typename T> std::vector<T> values(const char* name, size_t count) const
    {
        return read<T>(device_, shading.buffers().at(name), count);
    }

  private:
    Device device_;

  public:
    glm::dvec3 along{0.0};
    StrandLook look = {};
    size_t suns = 0;
    std::unique_ptr<Solver> solver;
    Shading shading;
    Rasteriser rasteriser;
    RasterStrands drawn;
};

Lighting light_from(std::initializer_list<glm::vec3> directions, float radius = 0.0f)
{
    Lighting lighting;
    for (const glm::vec3& d : directions)
        lighting.suns.push_back({glm::normalize(d), {2.0f, 1.8f, 1.5f}, radius});
    return lighting;
}

const float* pixel_at(const std::vector<float>& pixels, int x, int y) { return &pixels[size_t(4 * (y * kWidth + x))]; }

TEST(NearField, PixelsAreTheTwins)
{
    for (const double degrees : {0.0, 25.0, 65.0, 90.0, 150.0, -120.0})
    {
        Close close(degrees, light_from({{1.0f, 0.4f, 0.5f}, {-0.3f, 0.9f, 0.2f}, {0.2f, -0.5f, -1.0f}}, 0.1f));
        for (const float near : {1.0f, 0.4f})
        {
            const std::vector<float> pixels = close.draw(near);
            oracle::Lit lit;
            lit.frame = close.values<LookFrame>("near_frame", 1)[0];
            lit.rays = close.values<LookRay>("rays", close.suns);
            const int places = close.shading.volume().places;
            const std::vector<uint16_t> shaded = close.values<uint16_t>("shaded", size_t(places) * 4);
            const std::vector<uint16_t> straight =
                close.values<uint16_t>("straight_light", size_t(places) * close.suns);
            const glm::dvec2 on(close.along), left(-on.y, on.x);
            const double crossing = 1.0 / std::max(std::abs(left.x), std::abs(left.y)),
                         wide = double(kStrand) * crossing;
            double worst = 0.0, swing[2] = {1e9, 0.0};
            int compared = 0;
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x)
                {
                    const glm::dvec2 from_middle = glm::dvec2(x, y) + 0.5 - 0.5 * glm::dvec2(kWidth, kHeight);
                    const double aside = glm::dot(from_middle, left) * crossing, run = glm::dot(from_middle, on);
                    if (std::abs(aside) > 0.5 * wide - 0.1 || std::abs(run) > 30.0)
                        continue;
                    const double half = std::max(1.0 / wide, 1.0 / NEAR_CELLS), middle = 2.0 * aside / wide;
                    const double to = std::min(middle + half, 1.0), from = std::max(middle - half, -1.0);
                    // The second node is the first place, 100 pixels before the middle, and the last is 140 beyond.
                    const double at = (run + 100.0) / 240.0 * (places - 1), share = at - std::floor(at);
                    const auto between = [&](const std::vector<uint16_t>& halves, size_t begin, size_t stride)
                    {
                        return glm::mix(double(of_half(halves[begin + size_t(at) * stride])),
                                        double(of_half(halves[begin + size_t(at + 1.0) * stride])), share);
                    };
                    std::vector<double> shares;
                    for (size_t k = 0; k < close.suns; ++k)
                        shares.push_back(between(straight, k * size_t(places), 1));
                    const double tip = (run + 100.0) / 240.0;
                    Vec absorb;
                    for (int c = 0; c < 3; ++c)
                        absorb[c] = in_doubles::absorption_of(
                            glm::mix(xyz(close.look.root_color)[c], xyz(close.look.tip_color)[c], tip),
                            lit.frame.per_log);
                    const Vec p = double(kPixel) * run * close.along;
                    const Vec lit_near = oracle::near_light(lit, p, close.along, absorb, shares, from, to);
                    const float* pixel = pixel_at(pixels, x, y);
                    ASSERT_GT(pixel[3], 0.05f);
                    for (size_t c = 0; c < 3; ++c)
                    {
                        const double expected = between(shaded, c, 4) + lit_near[int(c)];
                        worst = std::max(worst, std::abs(double(pixel[c]) / double(pixel[3]) - expected) / expected);
                        ++compared;
                    }
                    swing[0] = std::min(swing[0], lit_near.y);
                    swing[1] = std::max(swing[1], lit_near.y);
                }
            EXPECT_GT(compared, 1000);
            EXPECT_GT(swing[1], 3.0 * swing[0]) << "it is lit from side to side";
            // Halves, and places of colours at the ends of pieces between which all is linear.
            EXPECT_LT(worst, 0.01) << degrees << ' ' << near;
        }
    }
}

// For the geometry shader: the same at the places.
TEST(NearField, PlacesAreTheTwins)
{
    for (const double degrees : {25.0, 90.0, -120.0})
    {
        Close close(degrees, light_from({{1.0f, 0.4f, 0.5f}, {-0.3f, 0.9f, 0.2f}, {0.2f, -0.5f, -1.0f}}, 0.1f));
        close.draw(0.7f);
        oracle::Lit lit;
        lit.frame = close.values<LookFrame>("near_frame", 1)[0];
        lit.rays = close.values<LookRay>("rays", close.suns);
        const size_t places = size_t(close.shading.volume().places);
        const std::vector<uint16_t> straight = close.values<uint16_t>("straight_light", places * close.suns);
        close.shading.across();
        const std::vector<uint16_t> found = close.values<uint16_t>("near_light", places * NEAR_LIGHT);
        double worst = 0.0;
        for (size_t k = 0; k < places; ++k)
        {
            const double tip = double(k) / double(places - 1);
            std::vector<double> shares;
            for (size_t sun = 0; sun < close.suns; ++sun)
                shares.push_back(of_half(straight[sun * places + k]));
            Vec absorb;
            for (int c = 0; c < 3; ++c)
                absorb[c] = in_doubles::absorption_of(
                    glm::mix(xyz(close.look.root_color)[c], xyz(close.look.tip_color)[c], tip), lit.frame.per_log);
            const Vec p = double(kPixel) * (240.0 * tip - 100.0) * close.along;
            for (int cell = 0; cell < NEAR_CELLS; ++cell)
            {
                const double from = -1.0 + 2.0 * cell / NEAR_CELLS;
                const Vec expected =
                    oracle::near_light(lit, p, close.along, absorb, shares, from, from + 2.0 / NEAR_CELLS);
                for (int c = 0; c < 3; ++c)
                    worst = std::max(
                        worst,
                        std::abs(of_half(found[k * NEAR_LIGHT + size_t(c * NEAR_CELLS + cell)]) / expected[c] - 1.0));
            }
        }
        EXPECT_GT(places, 10u);
        EXPECT_LT(worst, 3e-3) << degrees; // halves hold eleven bits
    }
}

// Mean green of the pixels that a vertical strand covers within so many pixels to the right of its middle.
double green_between(const std::vector<float>& pixels, int from, int to)
{
    double sum = 0.0;
    for (int y = kHeight / 2 - 20; y < kHeight / 2 + 20; ++y)
        for (int x = from; x < to; ++x)
            sum += double(pixel_at(pixels, kWidth / 2 + x, y)[1]) / (40.0 * (to - from));
    return sum;
}

TEST(NearField, LightFromTheLeftShowsOnTheLeft)
{
    const glm::vec3 black(0.005f);
    for (const double degrees : {90.0, -90.0}) // whichever way it grows
        for (const float side : {-1.0f, 1.0f})
        {
            Close close(degrees, light_from({{side, 0.0f, 0.6f}}), black);
            const std::vector<float> pixels = close.draw(1.0f), flat = close.draw(0.0f);
            const double on_left = green_between(pixels, -6, -2), on_right = green_between(pixels, 2, 6);
            EXPECT_GT(side < 0.0f ? on_left / on_right : on_right / on_left, 4.0) << degrees << ' ' << side;
            EXPECT_NEAR(green_between(flat, -6, -2), green_between(flat, 2, 6), 1e-3 * green_between(flat, 2, 6));
        }
}

TEST(NearField, TheMeanOverThePixelsStays)
{
    for (const float width : {1.0f, 3.0f, 6.0f, 14.0f})
    {
        HairParams params = params_of(width);
        params.look_azimuthal_roughness = 0.4f; // sharper lobes fall between the far field's four places
        Close close(90.0, light_from({{1.0f, 0.3f, 0.5f}, {-0.2f, 0.1f, -1.0f}}), glm::vec3(0.3f, 0.2f, 0.1f), params);
        const std::vector<float> far = close.draw(0.0f), half = close.draw(0.5f), near = close.draw(1.0f);
        const double means[] = {green_between(far, -9, 9), green_between(half, -9, 9), green_between(near, -9, 9)};
        EXPECT_GT(means[0], 0.001);
        EXPECT_NEAR(means[2], means[0], 0.03 * means[0]) << width;
        EXPECT_NEAR(means[1], 0.5 * (means[0] + means[2]), 2e-3 * means[0]) << width;
    }
}

TEST(NearField, NothingShowsAtOnce)
{
    Close close(35.0, light_from({{1.0f, 0.3f, 0.5f}, {0.2f, 0.1f, -1.0f}}));
    const std::vector<float> far = close.draw(0.0f), some = close.draw(0.01f), near = close.draw(1.0f);
    const float width = mean_width(*close.solver, close.drawn.params, close_view());
    EXPECT_NEAR(width, kStrand, 0.01f * kStrand); // the head's middle is a little aside
    EXPECT_EQ(near_share(kStrand, 3.0f), 1.0f);
    EXPECT_EQ(near_share(kStrand, kStrand), 0.0f);
    EXPECT_EQ(near_share(kStrand, kStrand - 0.25f), 0.25f);
    EXPECT_EQ(near_share(kStrand, 1e9f), 0.0f);
    double most_some = 0.0, most_near = 0.0;
    for (size_t i = 0; i < far.size(); ++i)
    {
        most_some = std::max(most_some, std::abs(double(some[i]) - double(far[i])));
        most_near = std::max(most_near, std::abs(double(near[i]) - double(far[i])));
    }
    EXPECT_GT(most_near, 0.05);
    EXPECT_LT(most_some, 0.015 * most_near);
    EXPECT_EQ(close.drawn.shaded->near, 1.0f);
    close.draw(1.0f, LOOK_KARIS);
    EXPECT_EQ(close.drawn.shaded->near, 0.0f) << "a fit knows no places";
    close.shading.most_lit_places = 4;
    EXPECT_TRUE(close.draw(1.0f) == far) << "there is no room for it";
}

TEST(NearField, AllWidthsAndBatchesDrawTheSame)
{
    const auto drawn_by = [&](const Device& device)
    {
        Close close(35.0, light_from({{1.0f, 0.3f, 0.5f}, {0.2f, 0.1f, -1.0f}}), glm::vec3(0.4f), params_of(kStrand),
                    device);
        const std::vector<float> pixels = close.draw(1.0f);
        EXPECT_TRUE(close.draw(1.0f) == pixels) << "equal input gives equal bytes";
        return pixels;
    };
    Device as_gpu = with_width(1);
    as_gpu.is_gpu = true;
    const std::vector<float> wide = drawn_by(with_width(16));
    for (const Device& device : {with_width(8), with_width(1), as_gpu})
    {
        const std::vector<float> narrow = drawn_by(device);
        double most = 0.0, brightest = 0.0;
        for (size_t i = 0; i < wide.size(); ++i)
        {
            most = std::max(most, std::abs(double(wide[i]) - double(narrow[i])));
            brightest = std::max(brightest, double(wide[i]));
        }
        EXPECT_LT(most, 0.004 * brightest) << device.width << (device.is_gpu ? ", as a GPU" : "");
    }
}

Hairstyle close_up(std::initializer_list<const char*> sets = {})
{
    Hairstyle style;
    for (const char* set :
         {"interpolation.strands=1500", "grid.resolution=16", "look.volume=48", "look.level=dual_scattering",
          "look.width=0.001", "look.pigment=melanin", "look.lights=rim.toml", "camera.target=[0.08, 0.02, 0]",
          "camera.yaw=60", "camera.distance=0.3", "camera.fov=2", "render.method=opencl"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

class NearPictures : public testing::Test
{
  protected:
    static void SetUpTestSuite()
    {
        window = std::make_unique<Window>(16, 16, Window::HIDDEN);
        renderer = std::make_unique<Renderer>(data_folder() / "shaders");
        simulation = std::make_unique<Simulation>(test_device(), close_up());
        simulation->settle(0.7);
    }
    static void TearDownTestSuite()
    {
        simulation.reset();
        renderer.reset();
        window.reset();
    }
    static LinearImage picture(const Hairstyle& style, int width = 96, int height = 96)
    {
        simulation->set_style(style);
        simulation->solver().draw();
        return renderer->linear_picture(frame_input(*simulation, camera_of(style.params)), width, height);
    }

    static std::unique_ptr<Window> window;
    static std::unique_ptr<Renderer> renderer;
    static std::unique_ptr<Simulation> simulation;
};
std::unique_ptr<Window> NearPictures::window;
std::unique_ptr<Renderer> NearPictures::renderer;
std::unique_ptr<Simulation> NearPictures::simulation;

TEST_F(NearPictures, ThinStrandsAreDrawnAsIfThereWereNone)
{
    renderer = std::make_unique<Renderer>(data_folder() / "shaders"); // one that has drawn nothing wide
    const LinearImage thin = picture(close_up({"look.width=0.0002"}));
    EXPECT_FALSE(renderer->rasteriser()->buffers().contains("near_light"));
    renderer->near_width = 1e9f;
    EXPECT_TRUE(picture(close_up({"look.width=0.0002"})).pixels == thin.pixels);
    const LinearImage flat = picture(close_up());
    renderer->near_width = 3.0f;
    const LinearImage wide = picture(close_up());
    EXPECT_TRUE(renderer->rasteriser()->buffers().contains("near_light"));
    EXPECT_FALSE(wide.pixels == flat.pixels);
    EXPECT_TRUE(picture(close_up()).pixels == wide.pixels);
    const LinearImage told = picture(close_up({"render.colors=kind"}));
    renderer->near_width = 1e9f;
    EXPECT_TRUE(picture(close_up({"render.colors=kind"})).pixels == told.pixels) << "a legend's colours stay";
    renderer->near_width = 3.0f;
}

TEST_F(NearPictures, NothingIsNoNumber)
{
    const auto brightest = [](const LinearImage& image)
    {
        float most = 0.0f;
        for (const float value : image.pixels)
            most = std::isfinite(value) && most < 1e9f ? std::max(most, value) : INFINITY;
        return most;
    };
    for (const char* set :
         {"look.roughness=0", "look.roughness=1", "look.azimuthal_roughness=0", "look.azimuthal_roughness=1",
          "look.ior=3", "look.width=0.01", "camera.distance=0.09", "look.root_color='#ffffff'", "look.scale_tilt=-10",
          "curl.radius=0.01", "look.opacity=0.3", "interpolation.strands=1"})
        for (const char* level : {"look.level=far_field", "look.level=dual_scattering"})
        {
            const float most = brightest(picture(close_up({set, level})));
            EXPECT_GT(most, 0.01f) << set << ' ' << level;
            EXPECT_LT(most, 1e5f) << set << ' ' << level;
        }
    Hairstyle inside = close_up(); // the camera, among the strands
    assign(inside, "camera.distance=0.05");
    EXPECT_LT(brightest(picture(inside)), 1e5f);
}

// Unblurred, over the pixels that are hair's.
double off_by(const LinearImage& image, const LinearImage& truth, const std::vector<float>& hair)
{
    double off = 0.0, size = 0.0;
    for (size_t i = 0; i < hair.size(); ++i)
        for (size_t c = 0; c < 3 && hair[i] > 0.9f; ++c)
        {
            off += std::pow(double(image.pixels[4 * i + c]) - double(truth.pixels[4 * i + c]), 2);
            size += std::pow(double(truth.pixels[4 * i + c]), 2);
        }
    return std::sqrt(off / size);
}

TEST_F(NearPictures, TheyAreNearerToTracedOnes)
{
    const SmallPicture small = {64, 64, 8};
    TruthLimits limits;
    limits.samples = 64;
    limits.seconds = 600.0;
    LinearImage near_by[2];
    LookTruth truth;
    for (const char* method : {"render.method=opencl", "render.method=geometry"})
    {
        const bool first = truth.samples == 0;
        const Hairstyle style = close_up({method});
        simulation->set_style(style);
        simulation->solver().draw();
        const Camera camera = camera_of(style.params);
        if (first)
            truth = look_truth(Tracer(truth_scene(*simulation, camera)), small, limits);
        ASSERT_EQ(truth.samples, 64u);
        EXPECT_GT(std::ranges::count_if(truth.hair, [](float share) { return share > 0.9f; }), 1000);
        LinearImage& near = near_by[first ? 0 : 1];
        near = light_at_level(*renderer, *simulation, camera, LOOK_DUAL_SCATTERING, small);
        renderer->near_width = 1e9f;
        const LinearImage far = light_at_level(*renderer, *simulation, camera, LOOK_DUAL_SCATTERING, small);
        renderer->near_width = 3.0f;
        EXPECT_LT(off_by(near, truth.light, truth.hair), 0.85 * off_by(far, truth.light, truth.hair)) << method;
        // Both light strands from the same side, whatever they make of edges.
        EXPECT_LT(off_by(near, near_by[0], truth.hair), 0.4 * off_by(far, near_by[0], truth.hair)) << method;
    }
}

} // namespace
} // namespace coif

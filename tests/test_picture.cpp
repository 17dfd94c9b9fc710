// Pictures: that they hang on their input alone, and show what they should.
#include "app/renderer.h"
#include "app/renderer_rings.h"
#include "sim/error.h"
#include "sim/source.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <memory>

namespace coif
{
namespace
{

Hairstyle small_style(std::initializer_list<const char*> sets = {})
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=1200", "grid.resolution=32", "camera.yaw=0"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

class Picture : public testing::Test
{
  protected:
    static void SetUpTestSuite()
    {
        window = std::make_unique<Window>(16, 16, Window::HIDDEN);
        renderer = std::make_unique<Renderer>(data_folder() / "shaders");
        simulation = std::make_unique<Simulation>(test_device(), small_style());
        simulation->settle(0.7);
    }
    static void TearDownTestSuite()
    {
        simulation.reset();
        renderer.reset();
        window.reset();
    }
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)); }

    // The same hair in another style, drawn anew.
    static FrameInput frame_of(const Hairstyle& style)
    {
        simulation->set_style(style);
        simulation->solver().draw();
        return frame_input(*simulation, camera_of(style.params));
    }
    static Image picture(const Hairstyle& style, int width = 320, int height = 180)
    {
        return renderer->picture(frame_of(style), width, height);
    }

    static std::unique_ptr<Window> window;
    static std::unique_ptr<Renderer> renderer;
    static std::unique_ptr<Simulation> simulation;
};
std::unique_ptr<Window> Picture::window;
std::unique_ptr<Renderer> Picture::renderer;
std::unique_ptr<Simulation> Picture::simulation;

// Mean brightness of a part of a picture, 0 to 255.
double brightness(const Image& image, int x0, int x1, int y0, int y1)
{
    double sum = 0.0;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x)
            for (int c = 0; c < 3; ++c)
                sum += image.pixels[size_t(4 * (y * image.width + x) + c)];
    return sum / (3.0 * (x1 - x0) * (y1 - y0));
}
double brightness(const Image& image) { return brightness(image, 0, image.width, 0, image.height); }

const unsigned char* pixel(const Image& image, int x, int y)
{
    return &image.pixels[size_t(4 * (y * image.width + x))];
}

double mean_difference(const Image& a, const Image& b)
{
    double sum = 0.0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        sum += std::abs(int(a.pixels[i]) - int(b.pixels[i]));
    return sum / double(a.pixels.size());
}

TEST_F(Picture, EqualInputGivesEqualPictures)
{
    FrameInput frame = frame_of(small_style());
    frame.samples = 2;
    const Image first = renderer->picture(frame, 320, 180);
    ASSERT_EQ(first.pixels.size(), size_t(4 * 320 * 180));
    renderer->picture(frame, 64, 64); // whatever came in between
    EXPECT_TRUE(renderer->picture(frame, 320, 180).pixels == first.pixels);
    // One renderer at a time: they share the context's block bindings.
    renderer.reset();
    renderer = std::make_unique<Renderer>(data_folder() / "shaders");
    EXPECT_TRUE(renderer->picture(frame, 320, 180).pixels == first.pixels) << "by a new renderer";
    EXPECT_GT(brightness(first), 10.0);
}

// As the editor shows what stands still.
TEST_F(Picture, samples_drawn_a_few_at_a_time_are_those_drawn_at_once)
{
    FrameInput frame = frame_of(small_style());
    frame.samples = 6;
    const Image at_once = renderer->picture(frame, 320, 180);
    frame.samples = 2;
    Image first, last;
    for (frame.before = 0; frame.before < 6; frame.before += 2)
    {
        last = renderer->picture(frame, 320, 180);
        if (frame.before == 0)
            first = last;
    }
    EXPECT_GT(mean_difference(first, at_once), 0.05) << "more samples are another picture";
    for (size_t i = 0; i < last.pixels.size(); ++i)
        ASSERT_NEAR(int(last.pixels[i]), int(at_once.pixels[i]), 1) << i;
}

// As the editor draws while something is dragged: what is left out is made up for by width.
TEST_F(Picture, half_the_strands_cover_as_much)
{
    for (const char* method : {"render.method=geometry", "render.method=opencl"})
    {
        FrameInput frame = frame_of(
            small_style({"look.root_color='#ffffff'", "look.tip_color='#ffffff'", "look.self_shadow=0", method}));
        frame.samples = 4;
        const Image all = renderer->picture(frame, 320, 180);
        frame.kept = 0.5f;
        const Image half = renderer->picture(frame, 320, 180);
        EXPECT_NEAR(brightness(half), brightness(all), 0.04 * brightness(all)) << method;
        EXPECT_GT(mean_difference(half, all), 0.1) << method;
    }
}

TEST_F(Picture, ATransparentOneHasAlphaInsteadOfABackdrop)
{
    FrameInput frame = frame_of(small_style());
    frame.transparent = true;
    const Image clear = renderer->picture(frame, 320, 180);
    for (const int x : {0, 319})
        for (const int y : {0, 179})
            EXPECT_EQ(pixel(clear, x, y)[3], 0) << x << ", " << y;
    EXPECT_EQ(pixel(clear, 160, 100)[3], 255) << "on the face";
    int edges = 0; // of strands
    for (size_t i = 3; i < clear.pixels.size(); i += 4)
        edges += clear.pixels[i] > 0 && clear.pixels[i] < 255;
    EXPECT_GT(edges, 100);

    frame.transparent = false;
    const Image full = renderer->picture(frame, 320, 180);
    for (size_t i = 3; i < full.pixels.size(); i += 4)
        ASSERT_EQ(full.pixels[i], 255);
    EXPECT_GT(pixel(full, 0, 0)[2], 0) << "a backdrop";
}

TEST_F(Picture, LargeOnesArePutTogetherOfTilesWithoutASeam)
{
    // Wider than a tile; the seam at column 2048 is laid through the hair by looking past the head.
    const Hairstyle style = small_style({"camera.target=[-0.71, 0.05, 0]", "camera.distance=0.5"});
    FrameInput frame = frame_of(style);
    frame.samples = 1;
    const Image large = renderer->picture(frame, 2500, 300);
    const auto step_at = [&](int x)
    {
        double sum = 0.0;
        for (int y = 0; y < 300; ++y)
            for (int c = 0; c < 3; ++c)
                sum += std::abs(int(pixel(large, x, y)[c]) - int(pixel(large, x - 1, y)[c]));
        return sum / 900.0;
    };
    double near = 0.0;
    for (int x = 2028; x < 2068; ++x)
        near += x == 2048 ? 0.0 : step_at(x) / 39.0;
    EXPECT_GT(near, 0.5) << "there is nothing at the seam to test with";
    EXPECT_LT(step_at(2048), 2.0 * near + 1.0);

    frame.samples = 16;
    const Image small = renderer->picture(frame, 500, 60);
    EXPECT_LT(mean_difference(shrunk(large, 5), small), 3.0); // strands thinner than a pixel are drawn at its width
}

TEST_F(Picture, TheSideThatFacesTheLightIsBright)
{
    double left[2], right[2];
    for (const bool from_left : {false, true}) // of the picture: the head's right
    {
        const Image image = picture(
            small_style({from_left ? "look.light_direction=[-1, 0.3, 0.3]" : "look.light_direction=[1, 0.3, 0.3]"}));
        left[from_left] = brightness(image, 110, 150, 20, 160);
        right[from_left] = brightness(image, 170, 210, 20, 160);
    }
    EXPECT_GT(left[true], right[true] + 5.0);
    EXPECT_GT(right[false], left[false] + 5.0);
}

TEST_F(Picture, LightsOfAListOrAFileComeFromWhereTheyAre)
{
    const Image plain = picture(small_style());
    double left[2], right[2];
    for (const bool from_left : {false, true})
    {
        Hairstyle style = small_style();
        style.host.lights = {Light{"weak", {0, 1, 0}, {1, 1, 1}, 0.1f},
                             Light{"strong", {from_left ? -1.0f : 1.0f, 0.3f, 0.3f}, {1, 1, 1}, 5.0f}};
        const FrameInput frame = frame_of(style);
        EXPECT_EQ(frame.lighting.suns.size(), 2u);
        const Image image = renderer->picture(frame, 320, 180);
        left[from_left] = brightness(image, 110, 150, 20, 160);
        right[from_left] = brightness(image, 170, 210, 20, 160);
    }
    EXPECT_GT(left[true], right[true] + 5.0);
    EXPECT_GT(right[false], left[false] + 5.0);

    const double lit = brightness(plain);
    const FrameInput rim = frame_of(small_style({"look.lights=rim.toml"}));
    EXPECT_EQ(rim.lighting.suns.size(), 2u);
    EXPECT_LT(brightness(renderer->picture(rim, 320, 180)), lit - 2.0) << "lit from behind";
    const FrameInput again = frame_of(small_style());
    EXPECT_EQ(again.lighting.suns.size(), 1u);
    EXPECT_EQ(renderer->picture(again, 320, 180).pixels, plain.pixels) << "and without the file as ever";
}

// Dark hair before a dark backdrop, as most is, has little light to lose and hides little.
Hairstyle white_style(const char* set)
{
    return small_style({"look.root_color='#ffffff'", "look.tip_color='#ffffff'", set});
}

TEST_F(Picture, SelfShadowTakesLight)
{
    const double without = brightness(picture(white_style("look.self_shadow=0")));
    const double with = brightness(picture(white_style("look.self_shadow=1")));
    const double deep = brightness(picture(white_style("look.self_shadow=4")));
    EXPECT_GT(without, with + 1.0);
    EXPECT_GT(with, deep + 1.0);
}

TEST_F(Picture, HairOfNoOpacityIsNotThere)
{
    const Image unseen = picture(small_style({"look.opacity=0", "look.self_shadow=0"}));
    const Image hair = picture(white_style("look.self_shadow=0"));
    Hairstyle bald = small_style({"look.self_shadow=0", "interpolation.strands=0"});
    Simulation none(test_device(), bald);
    none.solver().draw();
    const Image head = renderer->picture(frame_input(none, camera_of(bald.params)), 320, 180);
    EXPECT_TRUE(unseen.pixels == head.pixels);
    EXPECT_GT(mean_difference(unseen, hair), 3.0);
}

TEST_F(Picture, GuidesAreShownWhenAskedFor)
{
    const Image drawn = picture(small_style()), guides = picture(small_style({"render.show=guides"})),
                both = picture(small_style({"render.show=both"}));
    EXPECT_FALSE(drawn.pixels == guides.pixels);
    EXPECT_FALSE(drawn.pixels == both.pixels);
    EXPECT_FALSE(guides.pixels == both.pixels);
}

TEST_F(Picture, NoSliderOfTheLookIsDead)
{
    // Waves and the light's shadow give all of them something to act on; one multisample more is nothing to see where
    // a software renderer is asked for what it does anyway.
    const std::initializer_list<const char*> base = {"wave.normal_amplitude=0.01", "wave.binormal_amplitude=0.01",
                                                     "curl.radius=0.01",           "frizz.amount=0.005",
                                                     "smoothing.subdivisions=4",   "camera.aperture=20"};
    const auto two_samples = [](const Hairstyle& style) // a lens is nothing to one
    {
        FrameInput frame = frame_of(style);
        frame.samples = 2;
        return renderer->picture(frame, 160, 90);
    };
    const Image reference = two_samples(small_style(base));
    EXPECT_TRUE(two_samples(small_style(base)).pixels == reference.pixels);
    // For what Kajiya-Kay knows nothing of.
    Hairstyle lit = small_style(base);
    for (const char* set : {"look.level=dual_scattering", "look.pigment=melanin", "look.volume=32"})
        assign(lit, set);
    const Image lit_reference = two_samples(lit);
    int acting = 0;
    for (const ParamInfo& info : param_table())
    {
        const bool listed = read_by_shaders_only().contains(info.path()) || info.path() == "head.mesh_scale";
        if (info.on_host() || (info.effect != Effect::VIEW && !listed) || info.path() == "render.multisample" ||
            info.path() == "render.method" || info.path() == "camera.shutter" || // of what moves: test_blur.cpp
            info.path() == "look.tolerance") // which level auto is, not how it looks
            continue;
        Hairstyle style = small_style(base);
        float now[kMostNumbers];
        get_numbers(style.params, info, now);
        double other[kMostNumbers];
        for (int i = 0; i < info.components(); ++i)
            other[i] = info.kind == Kind::INT || info.kind == Kind::CHOICE ? now[i] + (now[i] < info.max ? 1 : -1)
                       : info.kind == Kind::VECTOR                         ? now[i] + 0.05
                       : info.max - now[i] < now[i] - info.min             ? 0.5 * (now[i] + info.min)
                                                                           : now[i] + 0.05 * (info.max - now[i]);
        if (info.path() == "smoothing.subdivisions")
            other[0] = 1;
        set_numbers(style.params, info, other);
        bool acts = two_samples(style).pixels != reference.pixels;
        if (!acts)
        {
            Hairstyle other_lit = lit;
            set_numbers(other_lit.params, info, other);
            acts = two_samples(other_lit).pixels != lit_reference.pixels;
        }
        EXPECT_TRUE(acts) << info.path();
        ++acting;
    }
    EXPECT_GT(acting, 25);
}

TEST_F(Picture, TheCameraFollowsItsNumbersThereAndBack)
{
    Camera camera;
    camera.target = {0.1, -0.2, 0.3};
    camera.yaw = 0.7;
    camera.pitch = -0.2;
    camera.distance = 1.234;
    HairParams params;
    keep_camera(camera, params);
    const Camera kept = camera_of(params);
    EXPECT_NEAR(kept.yaw, camera.yaw, 1e-3); // rounded to a tenth of a degree, and to a millimetre
    EXPECT_NEAR(kept.pitch, camera.pitch, 1e-3);
    EXPECT_NEAR(kept.distance, camera.distance, 1e-3);
    EXPECT_LE(glm::distance(kept.target, camera.target), 1e-3);
    EXPECT_NEAR(glm::distance(camera.position(), camera.target), camera.distance, 1e-12);
}

// Light falls on the outside of a band: its corners' normals and its triangles face away from the line that it is wound
// about.
TEST(Rings, FaceOutward)
{
    for (const glm::vec3 axis : {glm::vec3(0, 0, 1), glm::vec3(1, 0.2f, 0), glm::vec3(-0.1f, -2.0f, 0.3f)})
    {
        const Band band = {{0.01f, 0.1f, -0.1f}, axis, 0.014f, 0.004f};
        const std::vector<float> corners = corners_of(band);
        const auto triple = [&](size_t i) { return glm::vec3(corners[i], corners[i + 1], corners[i + 2]); };
        const auto out_of = [&](glm::vec3 p)
        {
            const glm::vec3 from = p - band.center, t = glm::normalize(axis);
            return glm::normalize(p - (band.center + band.radius * glm::normalize(from - t * glm::dot(t, from))));
        };
        for (size_t i = 0; i < corners.size(); i += 7)
            EXPECT_GT(glm::dot(triple(i + 3), out_of(triple(i))), 0.3f) << i / 7;
        for (const glm::uvec3& triangle : band_triangles())
        {
            const glm::vec3 a = triple(7 * triangle.x), b = triple(7 * triangle.y), c = triple(7 * triangle.z);
            EXPECT_GT(glm::dot(glm::cross(b - a, c - a), out_of((a + b + c) / 3.0f)), 0.0f) << triangle.x;
        }
    }
}

TEST_F(Picture, SizesThatCannotBeAreRefused)
{
    const FrameInput frame = frame_of(small_style());
    for (const int wrong : {0, -1, 8193})
    {
        EXPECT_THROW(renderer->picture(frame, wrong, 16), Error);
        EXPECT_THROW(renderer->picture(frame, 16, wrong), Error);
    }
    EXPECT_EQ(renderer->picture(frame, 1, 1).pixels.size(), 4u);
}

} // namespace
} // namespace coif

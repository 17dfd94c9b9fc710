// Pictures that are the mean of many: depth of field, motion blur, and light read instead of bytes. And the ground.
#include "app/display.h"
#include "app/lens.h"
#include "app/shot.h"
#include "app/traced/accumulation.h"
#include "sim/source.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace coif
{
namespace
{

// Balls before a backdrop, and no hair: edges whose place is known.
Hairstyle balls(std::initializer_list<Collider> colliders, std::initializer_list<const char*> sets = {})
{
    Hairstyle style;
    for (const char* set : {"head.mesh=", "head.spheres=", "interpolation.strands=0", "look.self_shadow=0",
                            "camera.yaw=0", "camera.pitch=0", "camera.distance=1", "camera.target=[0, 0, 0]",
                            "look.background='#000000'", "render.multisample=off"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    style.host.colliders = colliders;
    return style;
}

// How far a row or a column of a transparent picture is covered, from (x, y) on.
std::vector<double> line(const LinearImage& image, int x, int y, int dx, int dy, int count)
{
    std::vector<double> values;
    for (int i = 0; i < count; ++i)
        values.push_back(image.pixels[size_t(4 * ((y + i * dy) * image.width + x + i * dx) + 3)]);
    return values;
}

// Of an edge from bare to covered, pixels between a tenth and nine tenths.
double edge_width(const std::vector<double>& values)
{
    const double most = *std::ranges::max_element(values);
    const auto crossing = [&](double share)
    {
        for (size_t i = 1; i < values.size(); ++i)
            if (values[i] >= share * most)
                return double(i) - (values[i] - share * most) / std::max(values[i] - values[i - 1], 1e-9);
        return double(values.size());
    };
    return crossing(0.9) - crossing(0.1);
}

class Blur : public testing::Test
{
  protected:
    static void SetUpTestSuite()
    {
        window = std::make_unique<Window>(16, 16, Window::HIDDEN);
        renderer = std::make_unique<Renderer>(data_folder() / "shaders");
    }
    static void TearDownTestSuite()
    {
        renderer.reset();
        window.reset();
    }
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)); }

    static FrameInput frame_of(Simulation& simulation, int samples)
    {
        simulation.solver().draw();
        FrameInput frame = frame_input(simulation, camera_of(simulation.params()));
        frame.samples = samples;
        return frame;
    }

    static std::unique_ptr<Window> window;
    static std::unique_ptr<Renderer> renderer;
};
std::unique_ptr<Window> Blur::window;
std::unique_ptr<Renderer> Blur::renderer;

TEST_F(Blur, places_fill_pixel_and_lens_evenly)
{
    glm::dvec2 pixel(0.0), disc(0.0);
    int inner = 0, quarters[4] = {};
    for (int n = 0; n < 256; ++n)
    {
        const glm::vec2 p = place_in_pixel(n), d = place_on_disc(n);
        ASSERT_LE(std::max(std::abs(p.x), std::abs(p.y)), 0.5f);
        ASSERT_LE(glm::length(d), 1.0f + 1e-6f);
        pixel += glm::dvec2(p) / 256.0;
        disc += glm::dvec2(d) / 256.0;
        inner += glm::length(d) < std::sqrt(0.5f);
        ++quarters[(d.x > 0.0f) + 2 * (d.y > 0.0f)];
    }
    EXPECT_LT(glm::length(pixel), 0.01);
    EXPECT_LT(glm::length(disc), 0.02);
    EXPECT_NEAR(inner, 128, 6) << "of half the area";
    for (const int quarter : quarters)
        EXPECT_NEAR(quarter, 64, 5);
}

TEST_F(Blur, light_is_what_its_picture_shows)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=800", "camera.yaw=0"})
        assign(style, set);
    Simulation simulation(test_device(), style);
    for (const char* set : {"look.display=none", "look.display=neutral", "look.display=agx"})
        for (const bool transparent : {false, true})
        {
            assign(style, set);
            assign(style, "look.exposure=1.5");
            simulation.set_style(style);
            FrameInput frame = frame_of(simulation, 3);
            frame.transparent = transparent;
            const Image bytes = renderer->picture(frame, 160, 120);
            const LinearImage light = renderer->linear_picture(frame, 160, 120);
            const Image displayed_light = displayed(light, style.params);
            ASSERT_EQ(bytes.pixels.size(), displayed_light.pixels.size());
            int off = 0;
            for (size_t i = 0; i < bytes.pixels.size(); ++i)
                off = std::max(off, std::abs(int(bytes.pixels[i]) - int(displayed_light.pixels[i])));
            EXPECT_LE(off, 1) << set << (transparent ? ", transparent" : "");
            EXPECT_EQ(light.pixels[3], transparent ? 0.0f : 1.0f) << "a corner";
        }
    // Half a column of one tile and half of the next, in rows that go the other way than GL's.
    const LinearImage wide = renderer->linear_picture(frame_of(simulation, 1), 2100, 8);
    const Image same = renderer->picture(frame_of(simulation, 1), 2100, 8);
    const Image shown_wide = displayed(wide, style.params);
    for (size_t i = 0; i < same.pixels.size(); ++i)
        ASSERT_NEAR(int(same.pixels[i]), int(shown_wide.pixels[i]), 1) << i;
}

// A ball where the lens is focused and one behind: an edge out of focus is as wide as the disc that a point becomes,
// whose edge takes 0.687 of its width from a tenth to nine tenths.
TEST_F(Blur, what_is_out_of_focus_is_as_blurred_as_the_lens_is_wide)
{
    const Hairstyle style =
        balls({{{-0.12f, 0.0f, 0.0f}, 0.06f}, {{0.24f, 0.0f, -1.0f}, 0.12f}}, {"camera.aperture=30"});
    Simulation simulation(test_device(), style);
    const int width = 400, height = 300;
    const double pixel = 2.0 * std::tan(0.5 * camera_of(style.params).fov) / height; // at 1 m
    const auto taken = [&](int samples)
    {
        FrameInput frame = frame_of(simulation, samples);
        frame.transparent = true;
        return renderer->linear_picture(frame, width, height);
    };
    const LinearImage blurred = taken(256);
    const auto edges = [&](const LinearImage& image, double x)
    {
        const int middle = int(width / 2 + x / pixel), reach = 50;
        return edge_width(line(image, middle, height / 2 - reach, 0, 1, reach));
    };
    // Pixels that a point 2 m away becomes with the focus at 1 m, or the other way round.
    const double away = 0.03 * (1.0 / 1.0 - 1.0 / 2.0) / pixel;
    EXPECT_GT(away, 8.0);
    EXPECT_LT(edges(blurred, -0.12), 2.5) << "in focus";
    EXPECT_NEAR(edges(blurred, 0.12), 0.687 * away, 0.2 * 0.687 * away) << "behind it";

    Hairstyle back = style;
    assign(back, "camera.focus=2");
    simulation.set_style(back);
    const LinearImage behind = taken(256);
    EXPECT_LT(edges(behind, 0.12), 2.5);
    EXPECT_NEAR(edges(behind, -0.12), 0.687 * away, 0.2 * 0.687 * away) << "before it";

    assign(back, "camera.aperture=0");
    simulation.set_style(back);
    const LinearImage sharp = taken(16);
    EXPECT_LT(edges(sharp, -0.12), 2.5);
    EXPECT_LT(edges(sharp, 0.12), 2.5);
}

// What a picture holds of detail: mean difference of neighbours.
double detail(const Image& image)
{
    double sum = 0.0;
    for (size_t i = 4; i < image.pixels.size(); ++i)
        sum += std::abs(int(image.pixels[i]) - int(image.pixels[i - 4]));
    return sum / double(image.pixels.size());
}

TEST_F(Blur, hair_is_blurred_by_whatever_draws_it)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=1500", "camera.yaw=180", "camera.distance=0.8"})
        assign(style, set);
    Simulation simulation(test_device(), style);
    for (const char* method : {"render.method=geometry", "render.method=opencl"})
    {
        assign(style, method);
        double of[3];
        for (int i = 0; i < 3; ++i)
        {
            assign(style, i == 0 ? "camera.aperture=0" : "camera.aperture=20");
            assign(style, i == 2 ? "camera.focus=3" : "camera.focus=0.7"); // the nape's distance
            simulation.set_style(style);
            of[i] = detail(renderer->picture(frame_of(simulation, 32), 240, 240));
        }
        EXPECT_GT(of[1], 0.75 * of[0]) << method << ": in focus";
        EXPECT_LT(of[2], 0.6 * of[0]) << method << ": out of it";
    }
}

// As the editor shows what stands still.
TEST_F(Blur, a_lens_shows_in_samples_drawn_a_few_at_a_time)
{
    const Hairstyle style = balls({{{0.0f, 0.0f, -0.5f}, 0.1f}}, {"camera.aperture=40"});
    Simulation simulation(test_device(), style);
    const LinearImage at_once = renderer->linear_picture(frame_of(simulation, 16), 160, 120);
    LinearImage last;
    for (int before = 0; before < 16; before += 2)
    {
        FrameInput frame = frame_of(simulation, 2);
        frame.before = before;
        last = renderer->linear_picture(frame, 160, 120);
    }
    for (size_t i = 0; i < last.pixels.size(); ++i)
        ASSERT_NEAR(last.pixels[i], at_once.pixels[i], 2e-3) << i;
}

Motion sideways(double speed) // m/s, from 0.2 s on
{
    Motion motion;
    motion.name = "sideways";
    motion.seconds = 3.0;
    for (int i = 0; i < 60; ++i) // ramps are at rest at their ends; two at a time, half a length apart, are not
        motion.ramps.push_back({Motion::X, 0.5 * speed / 30.0, 0.2 + i / 60.0, 0.2 + (i + 2) / 60.0});
    return motion;
}

TEST_F(Blur, what_moves_is_blurred_along_its_way_alone)
{
    // The camera looks at where the ball is going to be.
    const Hairstyle style = balls({{{0.0f, 0.0f, 0.0f}, 0.06f, true}}, {"camera.shutter=0.5"});
    const double speed = 1.2, at = 0.6;
    const Motion motion = sideways(speed);
    ShotOptions shot;
    shot.width = 400;
    shot.height = 300;
    shot.samples = 128;
    shot.transparent = true;
    const double pixel = 2.0 * std::tan(0.5 * camera_of(style.params).fov) / shot.height;
    Hairstyle aimed = style;
    const double end = pose_at(motion, at).origin.x, way = end - pose_at(motion, at - 0.5 / 24.0).origin.x;
    EXPECT_NEAR(way, speed * 0.5 / 24.0, 1e-3);
    assign(aimed, fmt::format("camera.target=[{}, 0, 0]", end - 0.5 * way));
    const auto taken = [&](const Hairstyle& taken_style)
    {
        Studio studio(test_device(), taken_style, motion, shot);
        studio.play_to(at);
        return studio.linear_picture();
    };
    const auto edges = [&](const LinearImage& image, int dx, int dy) // widths, towards the middle
    { return edge_width(line(image, shot.width / 2 - 60 * dx, shot.height / 2 - 60 * dy, dx, dy, 60)); };
    const LinearImage blurred = taken(aimed);
    const double along = way / pixel; // pixels, of which eight tenths lie between a tenth and nine
    EXPECT_GT(along, 10.0);
    EXPECT_NEAR(edges(blurred, 1, 0), 0.8 * along, 0.2 * along);
    EXPECT_NEAR(edges(blurred, -1, 0), 0.8 * along, 0.2 * along);
    EXPECT_LT(edges(blurred, 0, 1), 2.5);
    EXPECT_LT(edges(blurred, 0, -1), 2.5);

    assign(aimed, "camera.shutter=0");
    EXPECT_LT(edges(taken(aimed), 1, 0), 2.5);
}

TEST_F(Blur, what_stands_still_does_not_know_of_the_shutter)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=600", "grid.resolution=32"})
        assign(style, set);
    ShotOptions shot;
    shot.width = 160;
    shot.height = 120;
    shot.samples = 8;
    const auto taken = [&](const char* shutter, double at, const Motion& motion)
    {
        Hairstyle one = style;
        assign(one, shutter);
        Studio studio(test_device(), one, motion, shot);
        studio.play_to(at);
        return studio.picture();
    };
    const auto worst = [](const Image& a, const Image& b)
    {
        int off = 0;
        for (size_t i = 0; i < a.pixels.size(); ++i)
            off = std::max(off, std::abs(int(a.pixels[i]) - int(b.pixels[i])));
        return off;
    };
    const Motion still = find_motion("still"), shake = find_motion("shake");
    // At the very beginning nothing has moved yet, whatever is to come.
    EXPECT_LE(worst(taken("camera.shutter=0", 0.0, shake), taken("camera.shutter=1", 0.0, shake)), 1);
    // Hair at rest still creeps by hundredths of a millimetre.
    EXPECT_LE(worst(taken("camera.shutter=0", 0.5, still), taken("camera.shutter=1", 0.5, still)), 2);
    EXPECT_GT(worst(taken("camera.shutter=0", 0.5, shake), taken("camera.shutter=1", 0.5, shake)), 30);
}

// A picture that was taken on the way must not change what comes after it.
TEST_F(Blur, pictures_of_moving_hair_hang_on_their_time_alone)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=600", "grid.resolution=32", "camera.shutter=1"})
        assign(style, set);
    ShotOptions shot;
    shot.width = 160;
    shot.height = 120;
    shot.samples = 6;
    const Motion shake = find_motion("shake");
    Studio one(test_device(), style, shake, shot), other(test_device(), style, shake, shot);
    for (const double at : {0.1, 0.12, 0.3})
    {
        one.play_to(at);
        one.picture();
    }
    for (Studio* studio : {&one, &other})
        studio->play_to(0.5);
    EXPECT_TRUE(one.picture().pixels == other.picture().pixels);
}

TEST_F(Blur, the_ground_takes_shadows)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=1500", "camera.yaw=20", "camera.pitch=25", "camera.distance=1.6",
                            "camera.target=[0, -0.15, 0]", "look.background='#a0a0a0'"})
        assign(style, set);
    Simulation simulation(test_device(), style);
    const auto picture = [&](std::initializer_list<const char*> sets, bool transparent = false)
    {
        Hairstyle one = style;
        for (const char* set : sets)
            assign(one, set);
        simulation.set_style(one);
        FrameInput frame = frame_of(simulation, 2);
        frame.transparent = transparent;
        return renderer->linear_picture(frame, 240, 180);
    };
    const LinearImage bare = picture({}), ground = picture({"look.ground=on"}),
                      unshaded = picture({"look.ground=on", "look.self_shadow=0"});
    int other = 0, darker = 0;
    for (size_t i = 0; i < bare.pixels.size(); i += 4)
    {
        other += std::abs(ground.pixels[i] - bare.pixels[i]) > 1e-3f;
        // Of the ground alone: what the head covers is the same without it.
        if (std::abs(unshaded.pixels[i] - bare.pixels[i]) > 1e-3f ||
            std::abs(ground.pixels[i] - bare.pixels[i]) > 1e-3f)
            darker += ground.pixels[i] < 0.8f * unshaded.pixels[i];
    }
    EXPECT_GT(other, 240 * 180 / 4);
    EXPECT_GT(darker, 500) << "shadow on it";

    const LinearImage below = picture({"look.ground=on", "camera.pitch=-40"}), without = picture({"camera.pitch=-40"});
    EXPECT_TRUE(below.pixels == without.pixels) << "seen from below it hides nothing";

    const LinearImage clear = picture({"look.ground=on"}, true);
    int partly = 0;
    for (size_t i = 0; i < clear.pixels.size(); i += 4)
    {
        partly += clear.pixels[i + 3] > 0.05f && clear.pixels[i + 3] < 0.95f;
        for (size_t c = 0; c < 3; ++c)
            ASSERT_LE(clear.pixels[i + c], 4.0f * clear.pixels[i + 3] + 1e-6f) << "premultiplied";
    }
    EXPECT_GT(partly, 200) << "it fades towards its rim";
}

TEST_F(Blur, the_traced_ground_is_the_one_that_is_drawn)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=600", "camera.yaw=20", "camera.pitch=25", "camera.distance=2",
                            "camera.target=[0, -0.15, 0]", "look.background='#a0a0a0'", "look.level=dual_scattering",
                            "look.lights=outdoors.toml", "look.ground=on"})
        assign(style, set);
    // The head is elsewhere than at the world's origin, and leaps.
    Motion motion;
    motion.seconds = 1.0;
    motion.steps.push_back({Motion::X, 0.5, 0.01});
    Simulation simulation(test_device(), style);
    simulation.play(motion);
    for (int i = 0; i < 3; ++i)
        simulation.step(simulation.hand());
    FrameInput frame = frame_of(simulation, 16);
    frame.camera.target += simulation.jumped();
    frame.transparent = true;
    EXPECT_GT(glm::length(simulation.jumped()), 0.4);
    const int width = 120, height = 90;
    const LinearImage drawn = renderer->linear_picture(frame, width, height);
    const Tracer tracer(traced_scene(frame));
    Accumulation sums = empty_accumulation(width, height);
    tracer.trace(sums, 64, {});
    const LinearImage traced = mean_of(sums);
    double off = 0.0, ours = 0.0, theirs = 0.0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            const size_t i = 4 * size_t(y * width + x);
            off += std::pow(double(traced.pixels[i + 3]) - double(drawn.pixels[i + 3]), 2.0) / (width * height);
            if (y > height * 5 / 6 && x > width * 3 / 4) // open ground in the corner
            {
                ours += double(traced.pixels[i + 1]);
                theirs += double(drawn.pixels[i + 1]);
            }
        }
    EXPECT_LT(std::sqrt(off), 0.05) << "how much is covered: chance alone takes it by 0.06 where it is half";
    EXPECT_GT(theirs, 10.0);
    EXPECT_NEAR(ours / theirs, 1.0, 0.05);
}

// Where light is followed, what is drawn takes its colours from one list, the ground's first.
TEST_F(Blur, the_ground_leaves_the_light_on_head_and_hair)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=1500", "camera.pitch=25", "camera.target=[0, -0.15, 0]",
                            "look.background='#a0a0a0'", "look.level=far_field"})
        assign(style, set);
    Simulation simulation(test_device(), style);
    const auto picture = [&](const char* ground, bool transparent)
    {
        Hairstyle one = style;
        assign(one, ground);
        simulation.set_style(one);
        FrameInput frame = frame_of(simulation, 2);
        frame.transparent = transparent;
        return renderer->linear_picture(frame, 240, 180);
    };
    const LinearImage bare = picture("look.ground=off", true), ground = picture("look.ground=on", true),
                      below = picture("look.ground=on", false);
    int covered = 0, other = 0, lit = 0, open = 0;
    for (size_t i = 0; i < bare.pixels.size(); i += 4)
        if (bare.pixels[i + 3] > 0.9999f)
        {
            ++covered;
            other += std::abs(ground.pixels[i] - bare.pixels[i]) > 1e-3f;
        }
        else if (bare.pixels[i + 3] == 0.0f && ground.pixels[i + 3] > 0.99f)
        {
            ++open;
            lit += below.pixels[i] > 0.02f && below.pixels[i] <= below.pixels[i + 2] * 1.6f;
        }
    EXPECT_GT(covered, 3000);
    EXPECT_EQ(other, 0);
    EXPECT_GT(open, 500);
    EXPECT_GT(lit, 9 * open / 10) << "most of the ground lies in the light, and is grey";
}

} // namespace
} // namespace coif

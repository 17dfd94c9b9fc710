// Pictures of the levels above Kajiya-Kay: drawn either way, and of what nobody should ask for.
#include "app/look_level.h"
#include "app/renderer.h"
#include "app/shading.h"
#include "app/ssim.h"
#include "sim/drawn_curve.h"
#include "sim/source.h"
#include "sim/tied_hair.h"
#include "sim/wave.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <memory>

namespace coif
{
namespace
{

Hairstyle lit_style(std::initializer_list<const char*> sets = {})
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=1200", "grid.resolution=16", "camera.distance=0.7", "look.volume=32",
                            "look.level=dual_scattering", "look.display=none"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

class LookPicture : public testing::Test
{
  protected:
    static void SetUpTestSuite()
    {
        window = std::make_unique<Window>(16, 16, Window::HIDDEN);
        renderer = std::make_unique<Renderer>(data_folder() / "shaders");
        simulation = std::make_unique<Simulation>(test_device(), lit_style());
        simulation->settle(0.7);
    }
    static void TearDownTestSuite()
    {
        simulation.reset();
        renderer.reset();
        window.reset();
    }
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)); }

    static FrameInput frame_of(const Hairstyle& style)
    {
        simulation->set_style(style);
        simulation->solver().draw();
        return frame_input(*simulation, camera_of(style.params));
    }
    static Image picture(const Hairstyle& style) { return renderer->picture(frame_of(style), 160, 120); }

    static std::unique_ptr<Window> window;
    static std::unique_ptr<Renderer> renderer;
    static std::unique_ptr<Simulation> simulation;
};
std::unique_ptr<Window> LookPicture::window;
std::unique_ptr<Renderer> LookPicture::renderer;
std::unique_ptr<Simulation> LookPicture::simulation;

// Mean of the pixels that count, 0 to 255.
glm::dvec3 mean_color(const Image& image, const Mask& mask)
{
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (size_t i = 0; i < mask.size(); ++i)
        if (mask[i])
        {
            count += 1.0;
            for (size_t c = 0; c < 3; ++c)
                sum[int(c)] += image.pixels[4 * i + c];
        }
    return sum / std::max(count, 1.0);
}

double brightness(const Image& image)
{
    const glm::dvec3 mean = mean_color(image, Mask(image.pixels.size() / 4, true));
    return (mean.x + mean.y + mean.z) / 3.0;
}

// As Rasteriser.ItsPicturesAreNoWorseThanTheGeometryShaders has it for Kajiya-Kay.
TEST_F(LookPicture, EitherWayOfDrawingShowsTheSameLight)
{
    FrameInput frame = frame_of(lit_style());
    const int width = 320, height = 240;
    const auto picture = [&](Method method, int multisample, int by)
    {
        frame.params.render_method = method;
        frame.params.render_multisample = multisample;
        return shrunk(renderer->picture(frame, by * width, by * height), by);
    };
    const Image geometry = picture(BY_GEOMETRY, 2, 1), rasterised = picture(BY_OPENCL, 1, 1);
    EXPECT_TRUE(picture(BY_OPENCL, 1, 1).pixels == rasterised.pixels);
    const Image reference = picture(BY_GEOMETRY, 1, 4);
    frame.params.render_show = 1;
    const Mask hair = changed_pixels(picture(BY_GEOMETRY, 1, 4), reference, 8);
    frame.params.render_show = 0;
    EXPECT_GE(ssim(rasterised, reference, hair), ssim(geometry, reference, hair));
    EXPECT_GT(ssim(rasterised, reference, hair), 0.8);
    const glm::dvec3 by_opencl = mean_color(rasterised, hair), by_geometry = mean_color(reference, hair);
    for (int c = 0; c < 3; ++c) // Kajiya-Kay's are 1.8 % apart: what they cover is
        EXPECT_NEAR(by_opencl[c], by_geometry[c], 0.03 * by_geometry[c]) << c;
    frame.params.look_level = LOOK_KAJIYA_KAY;
    EXPECT_GT(glm::distance(mean_color(picture(BY_OPENCL, 1, 1), hair), by_opencl), 3.0) << "another light";
}

TEST_F(LookPicture, KajiyaKayHangsOnNothingThatTheOthersAreMadeOf)
{
    const Image plain = picture(lit_style({"look.level=kajiya_kay"}));
    const Image other = picture(
        lit_style({"look.level=kajiya_kay", "look.roughness=1", "look.azimuthal_roughness=0", "look.scale_tilt=-10",
                   "look.ior=3", "look.light_irradiance=0", "look.sky_radiance=100", "look.volume=16"}));
    EXPECT_TRUE(plain.pixels == other.pixels);
}

TEST_F(LookPicture, NoLightIsBlackHairAndMoreIsBrighter)
{
    const std::initializer_list<const char*> dark = {"look.light_irradiance=0", "look.sky_radiance=0",
                                                     "look.background='#000000'"};
    EXPECT_EQ(brightness(picture(lit_style(dark))), 0.0);
    const double sky = brightness(picture(lit_style({"look.light_irradiance=0", "look.background='#000000'"})));
    const double sun = brightness(picture(lit_style({"look.sky_radiance=0", "look.background='#000000'"})));
    const double both = brightness(picture(lit_style({"look.background='#000000'"})));
    EXPECT_GT(sky, 2.0);
    EXPECT_GT(sun, 2.0);
    EXPECT_GT(both, std::max(sky, sun) + 1.0);
    const double black = brightness(
        picture(lit_style({"look.light_color='#000000'", "look.sky_radiance=0", "look.background='#000000'"})));
    EXPECT_EQ(black, 0.0);
}

TEST_F(LookPicture, WhatIsReportedIsLitByTheLightsThatAreSeen)
{
    const FrameInput frame = frame_of(lit_style({"look.lights=rim.toml"}));
    const Lighting reported = lit_scene(*simulation).lighting;
    ASSERT_EQ(frame.lighting.suns.size(), 2u);
    ASSERT_EQ(reported.suns.size(), 2u);
    for (size_t i = 0; i < 2; ++i)
        EXPECT_EQ(reported.suns[i].irradiance, frame.lighting.suns[i].irradiance);
    EXPECT_EQ(reported.sky, frame.lighting.sky);
}

TEST_F(LookPicture, WhatNobodyShouldAskForIsDrawn)
{
    const double usual = brightness(picture(lit_style()));
    for (const char* level : {"look.level=karis", "look.level=far_field", "look.level=dual_scattering"})
        for (const char* set :
             {"look.roughness=0", "look.roughness=1", "look.azimuthal_roughness=0", "look.azimuthal_roughness=1",
              "look.ior=1.05", "look.ior=3", "look.light_direction=[0, -1, 0]", "look.self_shadow=0",
              "look.self_shadow=4", "look.width=0.01", "look.width=0.00001", "look.opacity=0", "camera.distance=0.09",
              "look.root_color='#000000'", "look.root_color='#ffffff'"})
        {
            const double is = brightness(picture(lit_style({level, set})));
            EXPECT_GT(is, 0.2 * usual) << level << ' ' << set;
            EXPECT_LT(is, 3.0 * usual) << level << ' ' << set;
        }
}

TEST_F(LookPicture, HeadsWithoutHairAndHairWithoutAHeadAreLit)
{
    for (const char* set : {"interpolation.strands=0", "interpolation.strands=1", "head.mesh=''"})
    {
        Hairstyle style = lit_style({set});
        Simulation other(test_device(), style);
        other.solver().draw();
        for (const Method method : {BY_GEOMETRY, BY_OPENCL})
        {
            FrameInput frame = frame_input(other, camera_of(style.params));
            frame.params.render_method = method;
            EXPECT_GT(brightness(renderer->picture(frame, 160, 120)), 10.0) << set << ' ' << method;
        }
    }
}

// How far the places that light is looked at in are from the curves that other tools get, at most, m.
double farthest_place(const Simulation& simulation)
{
    const HairParams params = simulation.params();
    const Groom& groom = simulation.solver().groom();
    Shading shading(test_device());
    shading.light({&simulation.solver(),
                   device_params(params),
                   wave_table(params),
                   braid_values(groom),
                   {},
                   glm::vec3(INFINITY),
                   glm::vec3(-INFINITY)});
    const LookVolume volume = shading.volume();
    const Taken taken{false, 0, (volume.places - 1) / (groom.nodes - 2)};
    const Curves curves = curves_of(simulation, taken);
    const std::vector<float4> places =
        read<float4>(test_device(), shading.buffers().at("places"), size_t(volume.strands) * size_t(volume.places));
    EXPECT_EQ(curves.position.size(), places.size());
    EXPECT_GT(taken.pieces, 1);
    const glm::vec3 origin(simulation.solver().head().origin);
    double farthest = 0.0;
    for (size_t i = 0; i < std::min(places.size(), curves.position.size()); ++i)
    {
        const glm::vec3 place(places[i].x, places[i].y, places[i].z);
        farthest = std::max(farthest, double(glm::distance(curves.position[i], origin + place)));
    }
    return farthest;
}

TEST_F(LookPicture, CurlsAreLitWhereTheyAreDrawn)
{
    frame_of(lit_style({"wave.normal_amplitude=0.01", "wave.binormal_amplitude=0.008", "curl.radius=0.01",
                        "frizz.amount=0.005", "wave.normal_randomness=0.4"}));
    EXPECT_LT(farthest_place(*simulation), 1e-6);
}

TEST_F(LookPicture, BraidsAreLitWhereTheyAreDrawn)
{
    Hairstyle style = load_hairstyle(data_folder() / "hairstyles" / "braid.toml");
    for (const char* set : {"interpolation.strands=600", "grid.resolution=16", "head.contact=spheres"})
        assign(style, set);
    Simulation braided(test_device(), style);
    braided.solver().draw();
    EXPECT_LT(farthest_place(braided), 1e-6);
}

} // namespace
} // namespace coif

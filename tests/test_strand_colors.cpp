// What the strands' colours tell, and kernels that are read again while hair moves.
#include "app/renderer.h"
#include "app/strand_colors.h"
#include "sim/error.h"
#include "sim/source.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace coif
{
namespace
{
namespace fs = std::filesystem;

Hairstyle style_with(const std::string& colors)
{
    Hairstyle style;
    for (const std::string& set :
         {std::string("interpolation.strands=1200"), std::string("grid.resolution=32"), "render.colors=" + colors})
        assign(style, set);
    return style;
}

StrandColors colors_of(Simulation& simulation, const std::string& colors)
{
    simulation.set_style(style_with(colors));
    simulation.solver().draw();
    return frame_input(simulation, camera_of(simulation.params())).colors;
}

TEST(StrandColors, tell_one_value_a_node_on_the_scale_that_they_name)
{
    Simulation simulation(test_device(), style_with("hair"));
    EXPECT_TRUE(colors_of(simulation, "hair").value.empty()) << "no cost when they are off";
    const size_t nodes = size_t(simulation.solver().groom().nodes) * simulation.solver().groom().drawn.size();
    for (const char* colors : {"stretch", "density", "kind"})
    {
        const StrandColors told = colors_of(simulation, colors);
        ASSERT_EQ(told.value.size(), nodes) << colors;
        EXPECT_TRUE(std::ranges::all_of(told.value, [](float v) { return v >= 0.0f && v <= 1.0f; })) << colors;
        EXPECT_GE(told.readings.size(), 2u);
        EXPECT_FALSE(told.title.empty());
    }
    const StrandColors density = colors_of(simulation, "density");
    EXPECT_EQ(*std::ranges::max_element(density.value), 1.0f);
    EXPECT_LT(std::accumulate(density.value.begin(), density.value.end(), 0.0) / double(nodes), 0.8);
    const StrandColors kind = colors_of(simulation, "kind");
    EXPECT_EQ(std::ranges::count(kind.value, kMixedPlace),
              ptrdiff_t(simulation.solver().groom().drawn_multi * simulation.solver().groom().nodes));
}

TEST(StrandColors, tell_regions_and_maps)
{
    Hairstyle style = style_with("region");
    Simulation simulation(test_device(), style);
    const auto told = [&]
    {
        simulation.set_style(style);
        simulation.solver().draw();
        return frame_input(simulation, camera_of(simulation.params())).colors;
    };
    EXPECT_TRUE(std::ranges::all_of(told().value, [](float v) { return v == 0.0f; }));
    for (const char* area : {"top", "left"})
    {
        style.host.regions.emplace_back().name = area;
        style.host.regions.back().where = {area};
    }
    const StrandColors regions = told();
    EXPECT_EQ(regions.readings, (std::vector<std::string>{"none", "top", "left"}));
    for (const float place : {0.0f, 0.5f, 1.0f})
        EXPECT_GT(std::ranges::count(regions.value, place), 100) << place;
    assign(style, "render.colors=map");
    style.host.maps = {{"strand.length", MAP_OFFSET, {}, {}}};
    for (const glm::vec3& p : simulation.assets().scalp.positions)
        style.host.maps[0].values.push_back(p.x);
    const StrandColors map = told();
    EXPECT_EQ(map.title, "map of strand.length");
    EXPECT_EQ(std::ranges::max(map.value), 1.0f);
    EXPECT_EQ(std::ranges::min(map.value), 0.0f);
    const Groom& groom = simulation.solver().groom();
    for (size_t i = 0; i < groom.drawn.size(); i += 50)
        EXPECT_GT((map.value[i * size_t(groom.nodes)] - 0.5f) * groom.drawn[i].root.x, -0.01f) << i;
}

TEST(StrandColors, of_stretch_are_those_of_the_guides)
{
    Simulation simulation(test_device(), style_with("stretch"));
    const Groom& groom = simulation.solver().groom();
    const Mapped guides = simulation.solver().guide_positions();
    std::vector<float> longer(guides.as<float>(), guides.as<float>() + guides.bytes() / sizeof(float));
    // A guide of which the last segment is a tenth too long.
    for (int axis = 0; axis < 3; ++axis)
    {
        const int last = strand_value(3, groom.nodes - 1, axis, groom.nodes);
        const int before = strand_value(3, groom.nodes - 2, axis, groom.nodes);
        longer[size_t(last)] += 0.1f * (longer[size_t(last)] - longer[size_t(before)]);
    }
    const std::vector<float> stretch = guide_stretch(simulation, longer.data());
    EXPECT_NEAR(stretch[size_t(4 * groom.nodes - 1)], 0.1f, 2e-3f);
    EXPECT_LT(stretch[size_t(4 * groom.nodes - 2)], 0.01f);
}

TEST(StrandColors, show_in_the_picture)
{
    const Window window(16, 16, Window::HIDDEN);
    Renderer renderer(data_folder() / "shaders");
    Simulation simulation(test_device(), style_with("hair"));
    std::vector<std::vector<unsigned char>> pictures;
    for (const char* colors : {"hair", "stretch", "density", "kind", "hair"})
    {
        simulation.set_style(style_with(colors));
        simulation.solver().draw();
        pictures.push_back(renderer.picture(frame_input(simulation, camera_of(simulation.params())), 160, 120).pixels);
    }
    EXPECT_EQ(pictures.front(), pictures.back());
    for (size_t i = 0; i < 4; ++i)
        for (size_t k = 0; k < i; ++k)
            EXPECT_NE(pictures[i], pictures[k]) << i << " and " << k;
}

TEST(ReloadedKernels, take_effect_and_broken_ones_leave_the_last_good)
{
    const fs::path folder = fs::path(COIF_BUILD_FOLDER) / "reloaded_kernels";
    fs::remove_all(folder);
    fs::copy(data_folder() / "kernels", folder, fs::copy_options::recursive);
    const Device device = open_device("", folder);
    Hairstyle style = style_with("hair");
    Simulation simulation(device, style);
    simulation.step({});
    const fs::path pass = folder / "transport_frames.cl";
    const std::string good = [&]
    {
        std::ifstream in(pass);
        return std::string(std::istreambuf_iterator<char>(in), {});
    }();
    simulation.solver().draw(); // which builds it
    std::ofstream(pass) << good << "\nthis is no kernel\n";
    EXPECT_THROW(simulation.solver().reload_kernels(), Error);
    const auto frames = [&]
    {
        simulation.solver().keep_awake();
        simulation.solver().draw();
        const Mapped mapped = simulation.solver().drawn_frames();
        return std::vector<float>(mapped.as<float>(), mapped.as<float>() + mapped.bytes() / sizeof(float));
    };
    const std::vector<float> before = frames();
    std::ofstream(pass) << good << "\n// mended\n";
    simulation.solver().reload_kernels();
    EXPECT_EQ(frames(), before);
    // One that does nothing.
    const size_t body = good.find('{', good.find("kernel void"));
    std::ofstream(pass) << good.substr(0, body + 1) << "\n    return;\n" << good.substr(body + 1);
    simulation.step({});
    simulation.solver().reload_kernels();
    simulation.step({});
    EXPECT_NO_THROW(frames());
    fs::remove_all(folder);
}

} // namespace
} // namespace coif

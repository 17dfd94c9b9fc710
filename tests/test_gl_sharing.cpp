// Hair that reaches GL in shared memory: its pictures are those of hair that goes over the host, and what cannot be
// shared goes that way. Where nothing shares, SharedGl's tests run in a process of their own, with a layer that lends
// any device what it takes (tests/gl_sharing/layer.cpp).
#include "app/gl_sharing.h"
#include "app/renderer.h"
#include "sim/error.h"
#include "sim/source.h"
#include "tests/commands.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <SDL.h>
#include <dlfcn.h>

namespace coif
{
namespace
{

namespace fs = std::filesystem;

constexpr const char* kLayer = COIF_BUILD_FOLDER "/libgl_sharing_layer.so";

// Does the loader that this process has hand its calls through the layer?
bool has_layer()
{
    test_device(); // a first call
    void* const layer = dlopen(kLayer, RTLD_LAZY | RTLD_NOLOAD);
    if (layer)
        dlclose(layer);
    return layer != nullptr;
}

// For as long as it lives, the layer refuses what is named.
struct Refusing
{
    explicit Refusing(const char* what) { setenv("COIF_LAYER_REFUSES", what, 1); }
    ~Refusing() { unsetenv("COIF_LAYER_REFUSES"); }
};

Hairstyle style_of(const std::vector<const char*>& sets = {})
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=900", "grid.resolution=32", "camera.distance=0.7"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

class SharedGl : public testing::Test
{
  protected:
    static constexpr int kWidth = 240, kHeight = 180;

    void SetUp() override
    {
        shared = shared_with_gl(test_device());
        if (!shares_gl(shared))
        {
            ASSERT_FALSE(has_layer()) << "the layer lends what it takes";
            GTEST_SKIP() << test_device().name << " shares no memory with GL";
        }
    }
    void TearDown() override { EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)); }

    Image picture(Simulation& simulation, const Hairstyle& style)
    {
        simulation.set_style(style);
        simulation.solver().draw();
        return renderer.picture(frame_input(simulation, camera_of(style.params)), kWidth, kHeight);
    }

    Window window{16, 16, Window::HIDDEN}; // goes last
    Renderer renderer{data_folder() / "shaders"};
    Device shared;
};

TEST_F(SharedGl, pictures_are_those_of_hair_that_goes_over_the_host)
{
    EXPECT_FALSE(shares_gl(test_device()));
    // With more strands, fewer, and with other things to be handed over.
    const std::vector<std::vector<const char*>> settings = {
        {"render.method=geometry", "look.level=kajiya_kay"},
        {"render.method=opencl", "look.level=kajiya_kay"},
        {"render.method=geometry", "look.level=dual_scattering"},
        {"render.method=opencl", "look.level=dual_scattering"},
        {"render.method=geometry", "look.level=dual_scattering", "interpolation.strands=2100"},
        {"render.method=opencl", "camera.distance=0.4", "camera.aperture=2"},
        {"render.method=geometry", "curl.radius=0.01", "interpolation.strands=300"},
        {"render.method=geometry", "look.level=kajiya_kay", "render.colors=kind"}};
    const auto drawn_on = [&](const Device& device, bool bald)
    {
        Simulation simulation(device, style_of());
        simulation.settle(0.5);
        std::vector<Image> pictures;
        for (const std::vector<const char*>& sets : settings)
        {
            Hairstyle style = style_of(sets);
            style.params.render_show = bald;
            pictures.push_back(picture(simulation, style));
        }
        return pictures;
    };
    const std::vector<Image> here = drawn_on(shared, false), over_host = drawn_on(test_device(), false),
                             without_hair = drawn_on(test_device(), true);
    for (size_t i = 0; i < settings.size(); ++i)
    {
        const std::string what = fmt::format("{}", fmt::join(settings[i], ", "));
        EXPECT_TRUE(here[i].pixels == over_host[i].pixels) << what;
        EXPECT_FALSE(here[i].pixels == without_hair[i].pixels) << what << ": there is no hair";
        for (size_t k = 0; k < i; ++k)
            EXPECT_FALSE(here[i].pixels == here[k].pixels) << what << ": as " << k;
    }
}

// One renderer draws both, in turn.
TEST_F(SharedGl, hair_that_moves_reaches_each_picture_anew)
{
    const Hairstyle style = style_of({"look.level=dual_scattering", "render.method=geometry"});
    Simulation here(shared, style), over_host(test_device(), style);
    Image before;
    for (int i = 0; i < 4; ++i)
    {
        for (Simulation* simulation : {&here, &over_host})
        {
            simulation->play(find_motion("shake"));
            simulation->advance(0.05, simulation->hand(), 1 << 20);
        }
        const Image one = picture(here, style);
        EXPECT_TRUE(one.pixels == picture(over_host, style).pixels) << i;
        EXPECT_FALSE(one.pixels == before.pixels) << i;
        before = one;
    }
}

TEST_F(SharedGl, a_buffer_that_cannot_be_shared_is_told_of)
{
    SharedBuffer buffer;
    const cl::Buffer from = filled(shared, std::vector<float>(64, 1.0f));
    EXPECT_TRUE(buffer.take(shared, from, 64 * sizeof(float)));
    EXPECT_THROW(buffer.take(shared, from, 65 * sizeof(float)), Error) << "more than there is";
    EXPECT_TRUE(buffer.take(shared, from, 64 * sizeof(float))) << "goes on after that";
    EXPECT_TRUE(buffer.take(shared, from, 0));
    EXPECT_FALSE(buffer.take(test_device(), filled(test_device(), 1.0f), sizeof(float)));
}

TEST_F(SharedGl, a_device_that_refuses_draws_the_same_picture_over_the_host)
{
    if (!has_layer())
        GTEST_SKIP() << "this device does not refuse";
    Simulation here(shared, style_of());
    const Image expected = picture(here, style_of({"render.method=geometry"}));
    for (const char* what : {"contexts", "buffers", "data"})
    {
        const Refusing refusing(what);
        const Device refused = shared_with_gl(test_device());
        EXPECT_FALSE(shares_gl(refused)) << what;
        Simulation simulation(refused, style_of());
        EXPECT_TRUE(picture(simulation, style_of({"render.method=geometry"})).pixels == expected.pixels) << what;
    }
}

// There it may be GLX that has made the context, and no longer EGL.
TEST(SharedGlOnDisplay, a_window_that_is_seen_shares_as_well)
{
    if (!std::getenv("DISPLAY"))
        GTEST_SKIP() << "there is no display: run under xvfb-run";
    // The window is to open under its own driver, not the headless one of other tests.
    unsetenv("SDL_VIDEODRIVER");
    SDL_SetHint(SDL_HINT_VIDEODRIVER, nullptr);
    const Window window(64, 64, Window::SHOWN);
    const Device shared = shared_with_gl(test_device());
    EXPECT_FALSE(has_layer() && !shares_gl(shared));
    if (!shares_gl(shared))
        GTEST_SKIP() << test_device().name << " shares no memory with GL";
    SharedBuffer buffer;
    EXPECT_TRUE(buffer.take(shared, filled(shared, 1.5f), sizeof(float)));
    float value = 0.0f;
    glBindBuffer(GL_COPY_READ_BUFFER, buffer.id());
    glGetBufferSubData(GL_COPY_READ_BUFFER, 0, sizeof value, &value);
    EXPECT_EQ(value, 1.5f);
}

// What the layer sees, so that the pictures above say something.
TEST_F(SharedGl, the_layer_finds_what_is_used_out_of_turn)
{
    if (!has_layer())
        GTEST_SKIP() << "without the layer, what happens is undefined";
    const std::vector<float> old(4, 1.0f), fresh(4, 2.0f);
    const size_t bytes = 4 * sizeof(float);
    const cl::Buffer from = filled(shared, fresh);
    GLuint name = 0;
    glGenBuffers(1, &name);
    glBindBuffer(GL_COPY_WRITE_BUFFER, name);
    glBufferData(GL_COPY_WRITE_BUFFER, GLsizeiptr(bytes), old.data(), GL_STREAM_DRAW);
    const cl::BufferGL view(shared.context, CL_MEM_READ_WRITE, name);
    const std::vector<cl::Memory> views = {view};
    const auto error_of = [](const auto& command)
    {
        try
        {
            command();
        }
        catch (const cl::Error& e)
        {
            return e.err();
        }
        return CL_SUCCESS;
    };
    const auto copy = [&] { shared.queue.enqueueCopyBuffer(from, view, 0, 0, bytes); };
    const auto acquire = [&] { shared.queue.enqueueAcquireGLObjects(&views); };
    const auto release = [&] { shared.queue.enqueueReleaseGLObjects(&views); };
    const auto in_gl = [&]
    {
        std::vector<float> values(4);
        glBindBuffer(GL_COPY_WRITE_BUFFER, name);
        glGetBufferSubData(GL_COPY_WRITE_BUFFER, 0, GLsizeiptr(bytes), values.data());
        return values;
    };
    EXPECT_EQ(error_of(copy), CL_INVALID_GL_OBJECT) << "not acquired";
    EXPECT_EQ(error_of([&] { read<float>(shared, view, 4); }), CL_INVALID_GL_OBJECT);
    EXPECT_EQ(error_of([&] { Mapped(shared, view, bytes); }), CL_INVALID_GL_OBJECT);
    EXPECT_EQ(error_of([&] { shared.queue.enqueueFillBuffer(view, 0.0f, 0, bytes); }), CL_INVALID_GL_OBJECT);
    EXPECT_EQ(error_of(acquire), CL_INVALID_OPERATION) << "GL has not finished";
    glFinish();
    EXPECT_EQ(error_of(acquire), CL_SUCCESS);
    EXPECT_EQ(read<float>(shared, view, 4), old);
    EXPECT_EQ(error_of(copy), CL_SUCCESS);
    EXPECT_EQ(error_of(release), CL_SUCCESS);
    EXPECT_EQ(in_gl(), old) << "OpenCL has not finished";
    EXPECT_EQ(error_of(copy), CL_INVALID_GL_OBJECT) << "released";
    shared.queue.finish();
    EXPECT_EQ(in_gl(), fresh);
    glFinish();
    glBufferData(GL_COPY_WRITE_BUFFER, GLsizeiptr(2 * bytes), nullptr, GL_STREAM_DRAW);
    EXPECT_EQ(error_of(acquire), CL_INVALID_GL_OBJECT) << "GL's memory is another";
    glDeleteBuffers(1, &name);
}

class GlSharing : public test::Commands
{
};

TEST_F(GlSharing, without_a_window_nothing_is_shared)
{
    EXPECT_FALSE(shares_gl(test_device()));
    EXPECT_EQ(shared_with_gl(test_device()).context(), test_device().context());
}

TEST_F(GlSharing, what_shares_draws_as_what_does_not_with_a_layer_that_lends_it)
{
    if (!fs::exists(kLayer))
        GTEST_SKIP() << "the layer was not built: OpenCL's header CL/cl_layer.h is missing";
    void* const layer = dlopen(kLayer, RTLD_NOW);
    ASSERT_TRUE(layer) << dlerror();
    dlclose(layer);
    const std::string out = (folder / "tests.txt").string();
    const char* filter = std::getenv("DISPLAY") ? "SharedGl.*:SharedGlOnDisplay.*" : "SharedGl.*";
    const std::string command = fmt::format("OPENCL_LAYERS='{}' '{}/tests' --gtest_filter='{}' > '{}' 2>&1", kLayer,
                                            COIF_BUILD_FOLDER, filter, out);
    const int status = std::system(command.c_str());
    const std::string said = contents("tests.txt");
    EXPECT_EQ(status, 0) << said;
    if (said.find("shares no memory with GL") != said.npos)
        GTEST_SKIP() << "this machine's OpenCL loader knows no layers";
    EXPECT_EQ(said.find("SKIPPED"), said.npos) << said;
    EXPECT_NE(said.find("OK ] SharedGl.pictures_are"), said.npos) << said;
}

TEST_F(GlSharing, the_program_shares_where_it_can_and_its_picture_tells_nothing_of_it)
{
    if (!fs::exists(kLayer))
        GTEST_SKIP() << "the layer was not built: OpenCL's header CL/cl_layer.h is missing";
    for (const char* method : {"geometry", "opencl"})
    {
        const std::string shot = fmt::format("shot small.toml --time 0.3 --size 160x120 --set render.method={} "
                                             "--set look.level=dual_scattering -o ",
                                             method);
        const std::string layer = fmt::format("OPENCL_LAYERS='{}' COIF_LAYER_LOG=given.txt", kLayer);
        fs::remove(folder / "given.txt");
        ASSERT_EQ(coif(shot + "mapped.png").status, 0);
        ASSERT_EQ(coif(shot + "shared.png", layer).status, 0);
        if (!fs::exists(folder / "given.txt"))
            GTEST_SKIP() << "this machine's OpenCL loader knows no layers";
        const std::string given = contents("given.txt");
        // The trial's few bytes; then 200 strands' positions, frames and colours, or a picture a sample.
        const bool by_opencl = std::string(method) == "opencl";
        EXPECT_GE(std::count(given.begin(), given.end(), '\n'), by_opencl ? 2 : 4) << given;
        EXPECT_NE(given.find(fmt::format("{} bytes\n", by_opencl ? 160 * 120 * 8 : 200 * 16 * 16)), given.npos)
            << given;
        fs::remove(folder / "given.txt");
        ASSERT_EQ(coif(shot + "refused.png", layer + " COIF_LAYER_REFUSES=contexts").status, 0);
        EXPECT_FALSE(fs::exists(folder / "given.txt"));
        ASSERT_FALSE(contents("mapped.png").empty());
        EXPECT_TRUE(contents("shared.png") == contents("mapped.png")) << method;
        EXPECT_TRUE(contents("refused.png") == contents("mapped.png")) << method;
    }
}

} // namespace
} // namespace coif

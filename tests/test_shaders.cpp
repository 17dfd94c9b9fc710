// The GLSL programs: that they build, that a broken one is told and harms nothing, and that what they share with OpenCL
// (kernels/strand_curve.h) is the same in both and in plain doubles.
#include "app/renderer.h"
#include "sim/error.h"
#include "sim/source.h"
#include "tests/on_device.h"
#include "tests/oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace coif
{
namespace
{

namespace fs = std::filesystem;

// A copy of shaders/ to do harm to.
fs::path shader_copy(const char* name)
{
    const fs::path folder = fs::path(COIF_BUILD_FOLDER) / name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::copy(data_folder() / "shaders", folder);
    return folder;
}

TEST(Shaders, EveryProgramCompilesAndLinks)
{
    const Window window(16, 16, Window::HIDDEN);
    int programs = 0;
    for (const auto& entry : fs::directory_iterator(data_folder() / "shaders"))
        if (entry.path().extension() == ".frag")
        {
            const std::string name = entry.path().stem().string();
            const bool own = fs::exists(data_folder() / "shaders" / (name + ".vert"));
            EXPECT_NO_THROW(ShaderProgram(data_folder() / "shaders", name, own ? "" : "screen")) << name;
            ++programs;
        }
    EXPECT_GE(programs, 6);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST(Shaders, ABrokenShaderIsToldByItsName)
{
    const Window window(16, 16, Window::HIDDEN);
    for (const char* broken : {"strand.vert", "strand.geom", "strand.frag", "surface.frag", "show_agx.frag"})
    {
        const fs::path folder = shader_copy("broken_shaders");
        const std::string text = read_file(folder / broken);
        write_file(folder / broken, text + "\nthis is no shader;\n");
        try
        {
            Renderer renderer(folder);
            ADD_FAILURE() << broken << " passed";
        }
        catch (const Error& e)
        {
            EXPECT_NE(std::string(e.what()).find(broken), std::string::npos) << e.what();
        }
        fs::remove(folder / broken);
        EXPECT_THROW(Renderer{folder}, Error) << broken << " is missing";
    }
}

TEST(Shaders, AFailedReloadKeepsTheOldPrograms)
{
    Hairstyle style;
    for (const char* set : {"head.mesh=", "interpolation.strands=200", "grid.resolution=20", "render.method=geometry"})
        assign(style, set);
    Simulation simulation(test_device(), style);
    simulation.step({});
    simulation.solver().draw();
    const Window window(16, 16, Window::HIDDEN);
    const fs::path folder = shader_copy("reloaded_shaders");
    Renderer renderer(folder);
    const FrameInput frame = frame_input(simulation, camera_of(style.params));
    const Image before = renderer.picture(frame, 64, 36);

    const std::string text = read_file(folder / "strand.frag");
    write_file(folder / "strand.frag", "#version 150\nvoid main() { oops }\n");
    EXPECT_THROW(renderer.reload_shaders(), Error);
    EXPECT_TRUE(renderer.picture(frame, 64, 36).pixels == before.pixels);

    write_file(folder / "strand.frag",
               "#version 150\nout vec4 color;\nvoid main() { color = vec4(1.0, 0.0, 0.0, 1.0); }\n");
    renderer.reload_shaders();
    EXPECT_FALSE(renderer.picture(frame, 64, 36).pixels == before.pixels) << "a reload must be seen";

    write_file(folder / "strand.frag", text);
    renderer.reload_shaders();
    EXPECT_TRUE(renderer.picture(frame, 64, 36).pixels == before.pixels);
}

// Inputs of one sample, all of them exact in floats, so that three languages compute from the same numbers.
constexpr int kSamples = 1025;
// Four curves' weights, onset, random number, place, profile, curl, frizz and its onset, a braid's share and offset.
constexpr int kValues = 29;
double t_of(int i) { return i / 1024.0; }
double begin_of(int i) { return i % 4 * 0.25; }
double randomness_of(int i) { return i % 5 * 0.25; }
int seed_of(int i) { return i * 16411 - 300; }
// Of a braid: in the plait's radii, and its phase.
oracle::Vec place_of(int i) { return {i % 4 * 0.25 - 0.375, i % 5 * 0.25 - 0.5, i % 3 * 2.0}; }
constexpr float4 kProfile = F4(0.25f, 1.5f, 0.0f, 0.75f);

std::vector<double> in_doubles()
{
    std::vector<double> values;
    for (int i = 0; i < kSamples; ++i)
    {
        for (int curve = 0; curve < 4; ++curve)
        {
            double w[4];
            oracle::curve_weights(curve, t_of(i), w);
            values.insert(values.end(), w, w + 4);
        }
        values.push_back(oracle::wave_onset(t_of(i), begin_of(i)));
        values.push_back(oracle::strand_random(seed_of(i), i % 7));
        values.push_back(oracle::wave_place(seed_of(i), t_of(i), 30.0, randomness_of(i)));
        values.push_back(oracle::profile_at(kProfile, t_of(i)));
        const oracle::Across curl = oracle::curl_at(seed_of(i), begin_of(i), t_of(i), 0.25, randomness_of(i), i % 3);
        const oracle::Across frizz = oracle::frizz_at(seed_of(i), t_of(i) - 0.125, 16.0);
        values.insert(values.end(), {curl.normal, curl.binormal, frizz.normal, frizz.binormal});
        values.push_back(t_of(i) * (2.0 - t_of(i)));
        values.push_back(oracle::braid_share(0.5 * t_of(i), 0.125));
        const oracle::Vec by =
            oracle::braid_offset(0.5 * t_of(i), place_of(i), 0.125, 0.015625, 0.0078125, 0.0078125, 0.375);
        values.insert(values.end(), {by.x, by.y, by.z});
    }
    return values;
}

void compare(const std::vector<float>& values, const char* language)
{
    const std::vector<double> expected = in_doubles();
    ASSERT_EQ(values.size(), expected.size());
    for (int i = 0; i < kSamples; ++i)
        for (int v = 0; v < kValues; ++v)
        {
            const size_t at = size_t(i * kValues + v);
            // Polynomials of t with factors up to 2.5, a cosine good to 4 ulp, and places below 3: a few roundings of
            // numbers about 1. Random numbers are whole numbers over 2^24. Curls turn up to eight times, and frizz
            // changes its mind sixteen times: a place rounds at 1e-6 there, and what hangs on it by a few times that.
            const double allowed = v == 17 ? 0.0 : v >= 20 && v <= 23 ? 1.5e-5 : 1e-6;
            ASSERT_NEAR(values[at], expected[at], allowed) << language << ", sample " << i << ", value " << v;
        }
}

TEST(Curves, OpenClAgreesWithDoubles)
{
    const fs::path folder = fs::path(COIF_BUILD_FOLDER) / "curve_kernels";
    fs::create_directories(folder);
    for (const char* header : {"curve.h", "strand_curve.h"})
        fs::copy_file(data_folder() / "kernels" / header, folder / header, fs::copy_options::overwrite_existing);
    write_file(folder / "sample_curves.cl", R"(#include "curve.h"
kernel void sample_curves(global float* values)
{
    const int i = get_global_id(0);
    global float* v = values + i * 29;
    const float t = (float)i / 1024.0f;
    for (int curve = 0; curve < 4; ++curve)
        vstore4(curve_weights(curve, t), curve, v);
    v[16] = wave_onset(t, (float)(i % 4) * 0.25f);
    v[17] = strand_random(i * 16411 - 300, i % 7);
    v[18] = wave_place(i * 16411 - 300, t, 30.0f, (float)(i % 5) * 0.25f);
    v[19] = profile_at((float4)(0.25f, 1.5f, 0.0f, 0.75f), t);
    vstore2(curl_at(i * 16411 - 300, (float)(i % 4) * 0.25f, t, 0.25f, (float)(i % 5) * 0.25f, i % 3).xy, 10, v);
    vstore2(frizz_at(i * 16411 - 300, t - 0.125f, 16.0f).xy, 11, v);
    v[24] = frizz_onset(t);
    v[25] = braid_share(0.5f * t, 0.125f);
    const float4 place = (float4)((float)(i % 4) * 0.25f - 0.375f, (float)(i % 5) * 0.25f - 0.5f, (float)(i % 3) * 2.0f,
                                  0.0f);
    vstore3(braid_offset(0.5f * t, place, 0.125f, 0.015625f, 0.0078125f, 0.0078125f, 0.375f).xyz, 0, v + 26);
}
)");
    Device device = test_device();
    device.kernel_folder = folder;
    Kernel kernel = load_kernel(device, "sample_curves", "");
    const Buffers buffers = {{"values", filled(device, std::vector<float>(kSamples * kValues, NAN))}};
    run(device, kernel, buffers, cl::NDRange(kSamples));
    compare(read<float>(device, buffers.at("values"), kSamples * kValues), "OpenCL");
}

TEST(Curves, GlslAgreesWithDoubles)
{
    const Window window(16, 16, Window::HIDDEN);
    // A vertex shader whose outputs are kept: transform feedback.
    std::string source =
        "#version 150\n" + load_source(data_folder() / "shaders" / "curve.glsl", data_folder() / "kernels") +
        "out vec4 linear, cosine, cubic, catmull_rom;\nout vec4 rest, form, braid;\nout float onset;\n"
        "void main() {\n"
        "    int i = gl_VertexID;\n"
        "    float t = float(i) / 1024.0;\n"
        "    linear = curve_weights(CURVE_LINEAR, t);\n"
        "    cosine = curve_weights(CURVE_COSINE, t);\n"
        "    cubic = curve_weights(CURVE_CUBIC, t);\n"
        "    catmull_rom = curve_weights(CURVE_CATMULL_ROM, t);\n"
        "    rest = vec4(wave_onset(t, float(i % 4) * 0.25), strand_random(i * 16411 - 300, i % 7),\n"
        "                wave_place(i * 16411 - 300, t, 30.0, float(i % 5) * 0.25),\n"
        "                profile_at(vec4(0.25, 1.5, 0.0, 0.75), t));\n"
        "    form = vec4(curl_at(i * 16411 - 300, float(i % 4) * 0.25, t, 0.25,\n"
        "                        float(i % 5) * 0.25, i % 3).xy,\n"
        "                frizz_at(i * 16411 - 300, t - 0.125, 16.0).xy);\n"
        "    onset = frizz_onset(t);\n"
        "    vec4 place = vec4(float(i % 4) * 0.25 - 0.375, float(i % 5) * 0.25 - 0.5,\n"
        "                      float(i % 3) * 2.0, 0.0);\n"
        "    braid = vec4(braid_share(0.5 * t, 0.125), braid_offset(0.5 * t, place, 0.125, 0.015625,\n"
        "                                                           0.0078125, 0.0078125, 0.375).xyz);\n"
        "    gl_Position = vec4(0.0);\n}\n";
    const char* text = source.c_str();
    const GLuint shader = glCreateShader(GL_VERTEX_SHADER), program = glCreateProgram();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    char log[2048] = {};
    glGetShaderInfoLog(shader, sizeof log - 1, nullptr, log);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    ASSERT_TRUE(ok) << log;
    glAttachShader(program, shader);
    const char* const outputs[] = {"linear", "cosine", "cubic", "catmull_rom", "rest", "form", "onset", "braid"};
    glTransformFeedbackVaryings(program, 8, outputs, GL_INTERLEAVED_ATTRIBS);
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    ASSERT_TRUE(ok);

    GLuint array = 0, buffer = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
    std::vector<float> values(size_t(kSamples) * kValues, NAN);
    const GLsizeiptr bytes = GLsizeiptr(values.size() * sizeof(float));
    glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, values.data(), GL_STATIC_READ);
    glUseProgram(program);
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, kSamples);
    glEndTransformFeedback();
    glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, bytes, values.data());
    compare(values, "GLSL");
    glDeleteBuffers(1, &buffer);
    glDeleteVertexArrays(1, &array);
    glDeleteProgram(program);
    glDeleteShader(shader);
}

TEST(Curves, WeightsAddUpToOneAndMeetTheNodes)
{
    for (int curve = 0; curve < 4; ++curve)
    {
        double w[4];
        for (int i = 0; i <= 100; ++i)
        {
            oracle::curve_weights(curve, i / 100.0, w);
            EXPECT_NEAR(w[0] + w[1] + w[2] + w[3], 1.0, 1e-12) << "curve " << curve << " at " << i / 100.0;
        }
        for (const int end : {0, 1})
        {
            oracle::curve_weights(curve, end, w);
            for (int k = 0; k < 4; ++k)
                EXPECT_NEAR(w[k], k == 1 + end ? 1.0 : 0.0, 1e-12) << "curve " << curve << ", end " << end;
        }
    }
    // Catmull-Rom leaves a node as it came in: half the way from the node before to the node after.
    const double h = 1e-6;
    double at[4], after[4];
    oracle::curve_weights(3, 0.0, at);
    oracle::curve_weights(3, h, after);
    const double slope[4] = {-0.5, 0.0, 0.5, 0.0};
    for (int k = 0; k < 4; ++k)
        EXPECT_NEAR((after[k] - at[k]) / h, slope[k], 1e-5);
}

} // namespace
} // namespace coif

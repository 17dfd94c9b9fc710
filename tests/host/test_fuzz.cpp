// Files with a few bytes wrong: whatever they say, coif answers with a value or with coif::Error. Any other exception,
// and anything that the sanitizers see, fails.
#include "sim/simulation.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{
namespace
{

using test::between;
using test::bytes_of;
using test::error_of;
using test::Scratch;
using test::shipped;

// A few random changes: a byte, a stretch left out, doubled or put elsewhere, and words that readers stumble over.
std::string mutated(std::string text, std::mt19937& random)
{
    static const char* const kWords[] = {"nan",
                                         "-inf",
                                         "1e999",
                                         "-1",
                                         "99999999999999999999",
                                         "\"",
                                         "[",
                                         "]",
                                         "[[",
                                         "{",
                                         "}",
                                         "=",
                                         ".",
                                         "#",
                                         "\n",
                                         "\r",
                                         "\"\"\"",
                                         "'''",
                                         "\\u",
                                         "\xff",
                                         "\xEF\xBB\xBF",
                                         "0x",
                                         "f 1 2 3\n",
                                         "v 1\n",
                                         "f -1 -2 -3\n",
                                         "-2147483648",
                                         "t a 9/9/9\n",
                                         "\t",
                                         " ",
                                         "/",
                                         "true",
                                         "1979-05-27"};
    for (unsigned changes = 1 + random() % 4; changes > 0; --changes)
    {
        const size_t at = text.empty() ? 0 : random() % text.size();
        const size_t length = std::min<size_t>(text.size() - at, random() % 40);
        switch (random() % 6)
        {
        case 0:
            if (!text.empty())
                text[at] = char(random());
            break;
        case 1:
            text.erase(at, length);
            break;
        case 2:
            text.insert(at, text.substr(at, length));
            break;
        case 3:
            text.insert(text.empty() ? 0 : random() % text.size(), text.substr(at, length));
            break;
        case 4:
            text.insert(at, kWords[random() % std::size(kWords)]);
            break;
        case 5:
            if (!text.empty())
                text[at] = char(text[at] ^ (1 << random() % 8));
            break;
        }
    }
    return text;
}

// Every parameter once, with comments and colliders.
std::string full_style()
{
    Hairstyle defaults;
    std::string text = "# everything\n", group;
    for (const ParamInfo& info : param_table())
    {
        if (info.kind == Kind::LIST)
            continue;
        if (group != info.group)
            text += fmt::format("\n[{}] # {}\n", group = info.group, info.help);
        text += fmt::format("{} = {}\n", info.name, value_text(defaults, info));
    }
    return text + "[[collider]]\ncenter = [0, 0.5, -1e-3]\nradius = 0.1\n[[collider]]\nradius = 1\ncenter = [1, 2, "
                  "3]\non = 'head'\n";
}

TEST(Fuzz, a_mutated_style_is_read_or_refused_and_what_is_read_can_be_saved)
{
    std::mt19937 random(1);
    const std::string whole = full_style();
    int read = 0;
    for (int trial = 0; trial < 3000; ++trial)
    {
        // A short piece is likelier to stay valid, and quicker.
        const size_t begin = whole.find('[', random() % (whole.size() / 2));
        const std::string text = mutated(trial % 8 ? whole.substr(begin, random() % 600) : whole, random);
        const std::string error = error_of(
            [&]
            {
                Hairstyle style = parse_hairstyle(text, "bob.toml");
                ++read;
                EXPECT_EQ(hairstyle_text(style, "bob.toml"), text);
                assign(style, "strand.length=0.123");
                style.host.colliders.push_back({{1, 2, 3}, 4, true});
                const std::string saved = error_of(
                    [&]
                    {
                        const Hairstyle again = parse_hairstyle(hairstyle_text(style, "bob.toml"), "bob.toml");
                        for (const ParamInfo& info : param_table())
                            EXPECT_TRUE(same_value(style, again, info)) << info.path();
                    });
                EXPECT_EQ(saved, "no error") << text;
            });
        EXPECT_TRUE(error == "no error" || error.rfind("bob.toml:", 0) == 0) << error;
        if (testing::Test::HasFailure())
            FAIL() << "trial " << trial << ":\n" << text;
    }
    EXPECT_GT(read, 100);
    EXPECT_LT(read, 2900);
}

TEST(Fuzz, the_shipped_styles_mutated_are_read_or_refused)
{
    std::mt19937 random(2);
    for (const auto& entry : fs::directory_iterator(fs::path(COIF_SOURCE_FOLDER) / "hairstyles"))
    {
        if (!entry.is_regular_file())
            continue;
        const std::string whole = bytes_of(entry.path());
        for (int trial = 0; trial < 200; ++trial)
            error_of([&] { parse_hairstyle(mutated(whole, random), "bob.toml"); });
    }
}

TEST(Fuzz, mutated_lights_are_read_or_refused_and_what_is_read_can_be_saved)
{
    const Scratch scratch;
    std::mt19937 random(6);
    int read = 0, trials = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(COIF_SOURCE_FOLDER) / "hairstyles" / "lights"))
        for (int trial = 0; trial < 150; ++trial, ++trials)
        {
            const std::string text = mutated(bytes_of(entry.path()), random);
            const fs::path file = scratch.write("lights.toml", text);
            const std::string error = error_of(
                [&]
                {
                    LightRig rig = load_lights(file);
                    ++read;
                    ASSERT_LE(rig.lights.size(), kMostLights);
                    Hairstyle style;
                    set_own_lights(style, rig);
                    style = lit(style, rig);
                    for (const Sun& sun : lighting_of(style.params, style.host).suns)
                    {
                        EXPECT_NEAR(glm::length(sun.direction), 1.0f, 1e-5f);
                        EXPECT_TRUE(std::isfinite(sun.irradiance.x + sun.irradiance.y + sun.irradiance.z + sun.radius));
                    }
                    rig.sky.radiance = 0.123f;
                    rig.lights.resize(rig.lights.size() / 2);
                    save_lights(rig, file);
                    EXPECT_EQ(load_lights(file), rig);
                });
            EXPECT_TRUE(error == "no error" || error.rfind(file.string() + ":", 0) == 0) << error;
            if (testing::Test::HasFailure())
                FAIL() << error << "\n" << text;
        }
    EXPECT_EQ(trials, 600);
    EXPECT_GT(read, 50);
    EXPECT_LT(read, 550);
}

TEST(Fuzz, mutated_assignments_are_taken_or_refused)
{
    std::mt19937 random(3);
    const std::vector<std::string> seeds = {"strand.length=0.2", "forces.wind=[1, 2, 3]", "look.tip_color=#8a5a3c",
                                            "smoothing.curve=\"linear\"", "scalp.mesh=a.obj"};
    for (int trial = 0; trial < 2000; ++trial)
    {
        Hairstyle style;
        error_of([&] { assign(style, mutated(seeds[random() % seeds.size()], random)); });
    }
}

TEST(Fuzz, mutated_motions_are_read_or_refused_and_stay_finite)
{
    std::mt19937 random(4);
    const Scratch scratch;
    for (const std::string& name : motion_names())
    {
        const std::string whole = bytes_of(shipped("motions") / (name + ".toml"));
        for (int trial = 0; trial < 80; ++trial)
        {
            const fs::path file = scratch.write("script.toml", mutated(whole, random));
            error_of(
                [&]
                {
                    const Motion motion = load_motion(file);
                    for (const double time : {0.0, 0.5, 1e9})
                    {
                        const Pose pose = pose_at(motion, time);
                        EXPECT_TRUE(std::isfinite(glm::dot(pose.origin, pose.origin) + glm::dot(pose.wind, pose.wind) +
                                                  glm::dot(pose.turn, pose.turn)));
                    }
                });
        }
    }
}

// Positions that a float32 scalp may hold, and hair that grows on them.
void expect_sound(const Scalp& scalp)
{
    HairParams params;
    params.interpolation_strands = 20;
    const Groom groom = grow(params, scalp);
    for (const std::vector<float>* values : {&groom.root_position, &groom.root_direction})
        for (const float value : *values)
            ASSERT_TRUE(std::isfinite(value));
    for (const DrawnStrand& s : groom.drawn)
        ASSERT_TRUE(std::isfinite(s.root.x + s.root.y + s.root.z + s.weights.x + s.weights.y + s.weights.z));
}

TEST(Fuzz, a_mutated_scalp_is_read_or_refused_and_grows_finite_hair)
{
    std::mt19937 random(5);
    const Scratch scratch;
    std::string small = "# small\no cap\n";
    for (int i = 0; i < 12; ++i)
        small += fmt::format("v {} {} {}\n", 0.02 * (i % 4), 0.1 - 0.001 * i * i, 0.03 * (i / 4));
    for (int i = 1; i < 7; ++i)
        small += fmt::format("f {} {} {}\nf {}/1 {}//2 -1\n", i, i + 1, i + 5, i, i + 2);
    int read = 0;
    for (int trial = 0; trial < 1500; ++trial)
    {
        const fs::path file = scratch.write("scalp.obj", mutated(small, random));
        const std::string error = error_of(
            [&]
            {
                expect_sound(load_scalp(file));
                ++read;
            });
        EXPECT_TRUE(error == "no error" || error.rfind(file.string() + ":", 0) == 0) << error;
        if (testing::Test::HasFailure())
            FAIL() << "trial " << trial << ":\n" << bytes_of(file);
    }
    EXPECT_GT(read, 150);
    EXPECT_LT(read, 1400);
    for (const char* name : {"scalp.obj", "scalp_top.obj", "scalp_strip.obj"})
    {
        const std::string whole = bytes_of(shipped(name));
        for (int trial = 0; trial < 20; ++trial)
        {
            const fs::path file = scratch.write("scalp.obj", mutated(whole, random));
            error_of([&] { expect_sound(load_scalp(file)); });
        }
    }
}

TEST(Fuzz, a_mutated_mesh_is_read_or_refused)
{
    const test::TimeLimit limit(60);
    std::mt19937 random(6);
    const Scratch scratch;
    const std::string head = bytes_of(shipped("head.obj"));
    const size_t faces = head.find("\nf ");
    // A small piece of the head, and the same as PLY.
    const std::string obj = head.substr(0, head.find('\n', 2000)) + "\nf 1 2 3\nf 2 3 4\nf 4 5 6 7\n";
    ASSERT_NE(faces, head.npos);
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 1 2 3\n";
    for (int trial = 0; trial < 500; ++trial)
    {
        const fs::path file = trial % 2 ? scratch.write("head.obj", mutated(obj, random))
                                        : scratch.write("head.ply", mutated(ply, random));
        const std::string error = error_of(
            [&]
            {
                const Mesh mesh = load_mesh(file);
                for (const glm::uvec3& t : mesh.triangles)
                    ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
                for (const glm::vec3& n : mesh.normals)
                    ASSERT_NEAR(glm::length(n), 1.0f, 1e-3f);
            });
        EXPECT_TRUE(error == "no error" || error.rfind(file.string() + ":", 0) == 0) << error;
        if (testing::Test::HasFailure())
            FAIL() << "trial " << trial << ":\n" << bytes_of(file);
    }
}

} // namespace
} // namespace coif

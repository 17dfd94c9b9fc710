// The stress suite itself: that it runs, covers what it says, and fails when something is wrong. And what it has found,
// each as a case of its own.
#include "app/stress/random_style.h"
#include "app/stress/stage.h"
#include "sim/health.h"
#include "sim/source.h"
#include "tests/rig.h"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace fs = std::filesystem;

namespace coif
{
namespace
{

class Stress : public testing::Test
{
  protected:
    void SetUp() override
    {
        folder = fs::temp_directory_path() / ("coif_stress_" + std::to_string(getpid()));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    static std::string contents(const fs::path& file)
    {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    // Runs coif in the folder; `data` holds kernels and the like. Returns its status.
    int coif(const std::string& arguments, const fs::path& data = data_folder()) const
    {
        const int status =
            std::system(("cd '" + folder.string() + "' && COIF_DATA='" + data.string() +
                         "' '" COIF_BUILD_FOLDER "/coif' " + arguments + " > out.txt 2> err.txt < /dev/null")
                            .c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    // coif's data with one line of a kernel changed.
    fs::path changed_data(const std::string& file, const std::string& from, const std::string& to) const
    {
        const fs::path data = folder / "data";
        fs::create_directories(data);
        for (const char* part : {"kernels", "hairstyles", "assets", "shaders"})
            fs::copy(data_folder() / part, data / part, fs::copy_options::recursive);
        std::string text = contents(data / "kernels" / file);
        const size_t at = text.find(from);
        EXPECT_NE(at, text.npos) << file << " no longer says " << from;
        if (at != text.npos)
            text.replace(at, from.size(), to);
        std::ofstream(data / "kernels" / file) << text;
        return data;
    }
    fs::path folder;
};

TEST_F(Stress, RunsCasesByNameAndWritesTables)
{
    ASSERT_EQ(coif("stress --quick --only bad-input,teleport,random --cases 1 --seed 37 -o out"), 0)
        << contents(folder / "out.txt");
    const std::string csv = contents(folder / "out/stress.csv"), json = contents(folder / "out/stress.json");
    EXPECT_EQ(csv.rfind("case,solver,passed,", 0), 0u);
    EXPECT_NE(csv.find("\nteleport,direct,true,true,"), csv.npos) << csv;
    EXPECT_NE(csv.find("\nteleport,pbd,true,true,"), csv.npos) << csv;
    EXPECT_NE(json.find("\"case\": \"bad-input\""), json.npos);
    EXPECT_NE(contents(folder / "out.txt").find("3 of 3 cases passed"), std::string::npos);
    const std::string random = contents(folder / "out/random.csv");
    EXPECT_EQ(std::count(random.begin(), random.end(), '\n'), 3) << "one style by two solvers";
    EXPECT_EQ(coif("stress --only nonsense"), 1);
    EXPECT_NE(contents(folder / "err.txt").find("nonsense"), std::string::npos);
}

TEST_F(Stress, ASolverThatStretchesFailsItAndLeavesWhatPlaysItAgain)
{
    const fs::path data = changed_data("simulate_direct.cl", "x[i] = plus(x[i], move[i]);",
                                       "x[i] = plus(x[i], move[i]); x[i].y += i == 5 ? 0.1f * rest : 0.0f * rest;");
    EXPECT_EQ(coif("stress --only random --cases 1 --seed 45 -o out", data), 1);
    EXPECT_NE(contents(folder / "out.txt").find("FAIL"), std::string::npos);
    EXPECT_NE(contents(folder / "out.txt").find("again: coif report out/random/45-0-direct.toml"), std::string::npos)
        << contents(folder / "out.txt");
    EXPECT_EQ(
        coif("report out/random/45-0-direct.toml --motion out/random/45-0-direct-motion.toml --seconds 0.2", data), 0)
        << contents(folder / "err.txt");
}

TEST_F(Stress, AWriteOutsideOfABufferIsSeen)
{
    Device device = test_device();
    device.guards = std::make_shared<Guards>();
    Random random(3);
    const Groom groom = random_groom(random, 17, 16, 0);
    const auto play = [&](const Device& on)
    {
        Solver solver(on, uncoupled(), groom, {});
        for (int i = 1; i <= 5; ++i)
            solver.step({{pose({0.02 * i, 0, 0}), i / 60.0, kStep}});
        return find_trespasses(on);
    };
    EXPECT_EQ(play(device), std::vector<std::string>());
    Device planted = device;
    planted.kernel_folder = changed_data("simulate_direct.cl", "pace_next[block] = 1 + pace_now;",
                                         "pace_next[block + 2] = pace_next[block] = 1 + pace_now;") /
                            "kernels";
    const std::vector<std::string> found = play(planted);
    ASSERT_FALSE(found.empty());
    EXPECT_NE(found.front().find("behind the 8 bytes of the guides"), std::string::npos) << found.front();
    EXPECT_EQ(find_trespasses(planted), std::vector<std::string>()) << "told once";
}

TEST_F(Stress, RandomStylesReachBothEndsOfEveryParameter)
{
    constexpr int kStyles = 400;
    for (const ParamInfo& info : param_table())
    {
        // What costs hours or kernels is drawn from less.
        if (info.on_host() || info.path() == "strand.nodes" || info.path() == "grid.resolution" ||
            info.path() == "interpolation.strands" || info.path() == "interpolation.refine" || info.max == info.min)
            continue;
        float low = INFINITY, high = -INFINITY;
        double middle = 0.0;
        for (int i = 0; i < kStyles; ++i)
        {
            float v[kMostNumbers];
            get_numbers(stress::random_style(1, i, "s.obj").params, info, v);
            ASSERT_GE(v[0], info.min) << info.path();
            ASSERT_LE(v[0], info.max) << info.path();
            low = std::min(low, v[0]);
            high = std::max(high, v[0]);
            middle += v[0] > info.min && v[0] < info.max;
        }
        EXPECT_EQ(low, info.min) << info.path();
        EXPECT_EQ(high, info.max) << info.path();
        // The grid's passes and the wind are off in every other style, a tolerance in nine of ten.
        const bool often_off =
            info.path() == "forces.repulsion" || info.path() == "look.self_shadow" || info.path() == "forces.wind";
        const double share = info.path() == "quality.tolerance" ? 0.05 : often_off ? 0.3 : 0.7;
        if (info.kind == Kind::FLOAT)
        {
            EXPECT_GT(middle, share * kStyles) << info.path();
        }
    }
    // Neither does a tolerance choose what it costs hours to play.
    int refined = 0;
    for (int i = 0; i < kStyles; ++i)
    {
        const HairParams p = stress::random_style(1, i, "s.obj").params;
        refined += p.interpolation_refine;
        EXPECT_LE(p.interpolation_refine, 1) << i;
        EXPECT_TRUE(p.quality_tolerance == 0.0f || p.interpolation_refine == 1) << i;
    }
    EXPECT_GT(refined, kStyles / 20);
    const Hairstyle a = stress::random_style(7, 11, "s.obj"), b = stress::random_style(7, 11, "s.obj");
    EXPECT_EQ(hairstyle_text(a, "x.toml"), hairstyle_text(b, "x.toml"));
    EXPECT_NE(hairstyle_text(a, "x.toml"), hairstyle_text(stress::random_style(8, 11, "s.obj"), "x.toml"));
}

TEST_F(Stress, AWrittenMotionIsTheMotion)
{
    for (int i = 0; i < 20; ++i)
    {
        const Motion motion = stress::random_motion(5, i);
        std::ofstream(folder / "m.toml") << stress::motion_text(motion);
        const Motion again = load_motion(folder / "m.toml");
        for (const double t : {0.0, 0.123, 0.5, 0.6})
        {
            const Pose a = pose_at(motion, t), b = pose_at(again, t);
            EXPECT_LT(glm::distance(a.origin, b.origin), 1e-12);
            EXPECT_LT(glm::distance(a.wind, b.wind), 1e-12);
            EXPECT_NEAR(std::abs(glm::dot(a.turn, b.turn)), 1.0, 1e-12);
        }
    }
}

// Hair that hangs free falls by g t^2 / 2 in its first step, however long that is.
TEST_F(Stress, TheFirstStepGivesNoKickAtAnyRate)
{
    for (const float seconds : {1.0f / 60.0f, 1.0f / 240.0f, 1e-4f})
    {
        HairParams params = uncoupled();
        params.bending_droop = 1e4f;
        params.forces_drag = 0.0f;
        params.solver_substeps = 8;
        Rig rig(params, one_strand(16, 0.3f, {0, 0, 0}, {1, 0, 0}));
        const double before = rig.positions()[15].y;
        rig.solver.step({{{}, seconds, seconds}});
        const double fallen = before - rig.positions()[15].y, due = 0.5 * 9.81 * double(seconds) * double(seconds);
        EXPECT_NEAR(fallen / due, 1.0, 0.05) << seconds;
    }
}

// A free swing keeps its energy also where the length solve fails; under a thousand g hair hangs, if it never quite
// comes to rest.
TEST_F(Stress, WhatRescuesAStrandAddsNoEnergy)
{
    HairParams params = uncoupled();
    params.forces_gravity = params.forces_drag = 0.0f;
    params.bending_droop = 1e4f;
    const auto energy = [](const Rig& rig)
    {
        double sum = 0.0;
        for (const Vec& v : rig.velocities())
            sum += 0.5 * glm::dot(v, v);
        return sum;
    };
    Rig swung(params, one_strand(16, 0.3f, {0, 0, 0}, glm::normalize(glm::vec3(0.3f, -1, 0))));
    for (int i = 1; i <= 12; ++i)
        swung.step(pose({0.1 * (1.0 - std::cos(0.26 * i)), 0, 0}));
    swung.rest(2);
    const double start = energy(swung);
    for (int i = 0; i < 60; ++i)
    {
        swung.rest(1);
        EXPECT_LT(energy(swung), 1.5 * start) << i;
    }

    params.forces_drag = 3.0f;
    params.forces_gravity = 1000.0f;
    Rig heavy(params, one_strand(16, 0.3f, {0, 0, 0}, glm::normalize(glm::vec3(1, 0.3f, 0))));
    heavy.rest(60);
    double height = 0.0;
    for (int i = 0; i < 120; ++i)
    {
        heavy.rest(1);
        height += heavy.positions()[15].y / 120.0;
    }
    EXPECT_LT(height, -0.285); // of 0.3 m
    EXPECT_LT(heavy.worst_stretch(), 0.01);
}

// Bodies that sweep hair into the creases between them: nearest body after nearest body goes to and fro there.
TEST_F(Stress, InTheCreaseBetweenTwoBodiesHairIsOutsideOfBoth)
{
    HairParams params = uncoupled();
    params.bending_droop = 1e4f;
    const std::vector<Collider> bodies = {
        {{0, 0, 0}, 0.1f, true}, {{0.3f, -0.05f, 0}, 0.1f, false}, {{0, 0.05f, -0.3f}, 0.1f, true}};
    Rig rig(params, stress::ball(32, 9, 0.25));
    rig.solver.set_colliders(bodies);
    for (int i = 1; i <= 60; ++i)
    {
        rig.step(pose({0, 0, 0}, 0.436 * i)); // 25 degrees
        EXPECT_LT(i < 30 ? 0.0 : measure_health(rig.solver, params, false).penetration_max, 1e-4) << i;
    }
    EXPECT_LT(rig.worst_stretch(), 0.01);
}

TEST_F(Stress, PbdIsBoundedWithoutAnyStretchingAndTakesStrengthsBeyondItsEnds)
{
    HairParams params = uncoupled();
    params.solver_kind = 1;
    for (const float k : {-1.0f, 0.0f, 2.0f})
    {
        params.solver_stretching = k;
        Rig rig(params, one_strand(16, 0.3f, {0, 0, 0}, {0, -1, 0}));
        rig.rest(120);
        EXPECT_LT(glm::length(rig.positions()[15]), k > 1.0f ? 0.31 : 1.25) << k;
        EXPECT_EQ(rig.solver.resets(), std::vector<int>(1, 0)) << k;
    }
}

TEST_F(Stress, AStrandGoneBadIsNamedWithItsCauseByBothSolvers)
{
    for (const int kind : {0, 1})
    {
        HairParams params = uncoupled();
        params.solver_kind = kind;
        Random random(6);
        const Groom groom = random_groom(random, 20, 16, 0);
        Rig rig(params, groom);
        rig.rest(3);
        std::vector<int> seen = rig.solver.resets();
        EXPECT_TRUE(find_resets(rig.solver, seen).empty());
        std::vector<float> v = read<float>(test_device(), rig.solver.buffers().at("velocity"), 32 * 16 * 3);
        v[size_t(strand_value(7, 4, 2, 16))] = 3e38f;
        write(test_device(), rig.solver.buffers().at("velocity"), v);
        rig.rest(1);
        const std::vector<Reset> found = find_resets(rig.solver, seen);
        ASSERT_EQ(found.size(), 1u) << kind;
        EXPECT_EQ(found[0].strand, 7);
        EXPECT_EQ(found[0].times, 1);
        EXPECT_EQ(found[0].fault, FAULT_VELOCITY);
        EXPECT_NE(likely_cause(found[0], rig.solver.info()).find("velocity"), std::string::npos);
        EXPECT_TRUE(find_resets(rig.solver, seen).empty()) << "told once";
    }
}

} // namespace
} // namespace coif

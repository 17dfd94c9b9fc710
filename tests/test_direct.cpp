// The direct solver against references that it did not make (tests/reference/README.md): one strand on its own.
#include "app/measure/strand.h"
#include "sim/lab.h"
#include "sim/models/reference.h"
#include "tests/rig.h"

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

namespace coif
{
namespace
{

constexpr double kGravity = 9.81;

std::filesystem::path reference_file(const std::string& name)
{
    return std::filesystem::path(COIF_SOURCE_FOLDER) / "tests/reference" / name;
}

// The strand of a scene in the lab. `substeps`: at least so many, and no more where tension does not ask for it.
LabRun run(const study::Scene& scene, double seconds, double fps = 60.0, int substeps = 1, float courant = 1.0f)
{
    HairParams params;
    params.forces_drag = float(scene.drag);
    params.solver_substeps = substeps;
    params.solver_courant = courant;
    return run_lab(test_device(), params, strand_of(scene), scene.root, seconds, fps);
}

study::Difference error_of(const std::string& name, int substeps, float courant, LabRun* result = nullptr)
{
    const study::Reference& reference = study::reference(name);
    study::Frames frames = study::read_frames(reference_file("chain15_" + name + ".csv"));
    frames.resize(size_t(std::lround(reference.seconds * reference.fps)) + 1);
    const LabRun own = run(reference.scene, reference.seconds, reference.fps, substeps, courant);
    if (result)
        *result = own;
    return study::compare(own.nodes, frames, reference.scene.length);
}

TEST(Direct, IsOfSecondOrder)
{
    // Root mean squares over three seconds of a strand let go at 30 degrees. Substeps that tension does not add to;
    // with fewer the fastest wave is not followed yet.
    std::map<int, double> error;
    for (const int substeps : {4, 8, 16})
        error[substeps] = error_of("release30_b0", substeps, 1.8f).rms;
    EXPECT_GE(std::log2(error[4] / error[16]) / 2.0, 1.9);
    EXPECT_GE(std::log2(error[8] / error[16]), 1.95);
    EXPECT_LE(error[16], 1e-4);
}

TEST(Direct, FollowsTheReferencesAsItsDefaultsAre)
{
    for (const auto& [name, most] : {std::pair("shake_b2", 0.0015), std::pair("release90_b1", 0.0015),
                                     std::pair("release30_b0", 0.0015), std::pair("turn_b1", 0.01)})
    {
        LabRun own;
        const study::Difference difference = error_of(name, 1, 1.0f, &own);
        EXPECT_LE(difference.rms, most) << name;
        EXPECT_LE(own.stretch, 1e-3) << name;
    }
}

TEST(Direct, FallsFreelyAsAFreeBodyDoes)
{
    // The root falls as a free body does, so all of the strand must, and keeps its shape.
    for (const double drag : {0.0, 2.0, 50.0})
    {
        study::Scene scene;
        scene.drag = drag;
        scene.direction = {0.6, -0.8, 0.0};
        const auto fall = [drag](double t)
        { return drag > 0.0 ? kGravity / drag * (t + std::expm1(-drag * t) / drag) : 0.5 * kGravity * t * t; };
        scene.root = [&](double t) { return Vec(0.0, -fall(std::max(t, 0.0)), 0.0); };
        const LabRun own = run(scene, 1.0);
        double worst = 0.0;
        for (size_t f = 1; f < own.nodes.size(); ++f)
            for (size_t k = 0; k < own.nodes[f].size(); ++k)
                worst = std::max(worst, glm::distance(own.nodes[f][k], scene.root(own.times[f]) + own.nodes[0][k]));
        // What drag leaves of a velocity is a float: a part in 2^24 each step.
        EXPECT_LE(worst, 4e-6 * fall(1.0)) << "drag " << drag;
    }
}

// The mean period from crossings of zero in the same sense, straight lines between samples.
double period(const std::vector<double>& times, const std::vector<double>& values)
{
    std::vector<double> crossings;
    for (size_t i = 1; i < values.size(); ++i)
        if (values[i - 1] > 0.0 && values[i] <= 0.0)
            crossings.push_back(times[i - 1] + (times[i] - times[i - 1]) * values[i - 1] / (values[i - 1] - values[i]));
    return crossings.size() < 2 ? NAN : (crossings.back() - crossings.front()) / double(crossings.size() - 1);
}

TEST(Direct, SwingsAsAPendulum)
{
    // pendulum_period.csv. In 11,520 substeps floats lose a part in 20,000 of the energy, which near the top is 15
    // times as much of the period.
    for (const auto& [degrees, expected, most] :
         {std::tuple(30.0, 1.017408798, 1e-4), std::tuple(90.0, 1.180340599, 1e-4),
          std::tuple(170.0, 2.439362720, 1e-3)})
    {
        study::Scene scene;
        scene.links = 1;
        const double angle = degrees * std::numbers::pi / 180.0;
        scene.direction = {std::sin(angle), -std::cos(angle), 0.0};
        const LabRun own = run(scene, 12.0, 60.0, 16);
        std::vector<double> x;
        for (const std::vector<Vec>& nodes : own.nodes)
            x.push_back(nodes[1].x);
        const double small = 2.0 * std::numbers::pi * std::sqrt(scene.length / kGravity);
        EXPECT_NEAR(period(own.times, x) / small / expected, 1.0, most) << degrees << " degrees";
    }
}

// Laguerre's polynomial: bottom up, a hanging chain of equal masses swings by L_0, L_1, L_2 of a zero of L_N.
double laguerre(int n, double x)
{
    double before = 1.0, now = 1.0 - x;
    for (int k = 1; k < n; ++k)
        before = std::exchange(now, ((2 * k + 1 - x) * now - k * before) / (k + 1));
    return n == 0 ? 1.0 : now;
}

TEST(Direct, SwingsInItsModesWithoutDampingThem)
{
    const int links = 15;
    const double length = 0.3;
    for (const double omega : {1.183054175, 2.718524619, 4.270120745}) // hanging_chain_modes.csv, in sqrt(g / L)
    {
        const double lambda = omega * omega / links;
        EXPECT_NEAR(laguerre(links, lambda), 0.0, 1e-6);
        HairParams params = uncoupled();
        params.forces_drag = 0.0f;
        params.bending_droop = 10000.0f;
        params.solver_substeps = 16;
        Groom groom = one_strand(links + 2, float(length), {0, 0, 0}, {0, -1, 0});
        groom.longest = float(length);
        const float link = float(length / links);
        groom.segment_length.assign(16, link);
        groom.tip_mass = 1.0f;
        Rig rig(params, groom);
        std::vector<Vec> x = rig.positions();
        std::vector<double> shape;
        for (int k = 1; k <= links; ++k)
            shape.push_back(laguerre(links - k, lambda));
        Vec at(0.0);
        for (int k = 1; k <= links; ++k)
        {
            const double sideways = 0.002 * length * shape[size_t(k - 1)];
            const double way = sideways - at.x;
            at += Vec(way, -std::sqrt(double(link) * link - way * way), 0.0);
            x[size_t(k + 1)] = at;
        }
        write(test_device(), rig.solver.buffers().at("position"), to_blocks(x, 1, links + 2));
        std::vector<double> q;
        for (int i = 0; i < 600; ++i)
        {
            rig.rest(1);
            x = rig.positions();
            double sum = 0.0;
            for (int k = 1; k <= links; ++k)
                sum += shape[size_t(k - 1)] * x[size_t(k + 1)].x;
            q.push_back(sum);
        }
        // Samples of a pure tone: q[i - 1] + q[i + 1] = 2 cos(w h) q[i].
        double of_both = 0.0, of_square = 0.0;
        for (size_t i = 1; i + 1 < q.size(); ++i)
        {
            of_both += q[i] * (q[i - 1] + q[i + 1]);
            of_square += q[i] * q[i];
        }
        const double h = 1.0 / 60.0, found = std::acos(0.5 * of_both / of_square) / h;
        const double expected = omega * std::sqrt(kGravity / length);
        const auto amplitude = [&](size_t i) // from two samples
        { return std::hypot(q[i], (q[i + 1] - q[i] * std::cos(found * h)) / std::sin(found * h)); };
        const double damping = std::log(amplitude(10) / amplitude(q.size() - 12)) / (double(q.size() - 22) * h);
        EXPECT_NEAR(found / expected, 1.0, 2e-4) << "mode of " << omega;
        EXPECT_LE(std::abs(damping), 1e-3) << "mode of " << omega;
    }
}

TEST(Direct, HangsStillAtItsLength)
{
    study::Scene scene;
    const LabRun own = run(scene, 10.0);
    const std::vector<Vec>&last = own.nodes.back(), &before = own.nodes[own.nodes.size() - 2];
    EXPECT_LE(own.stretch, 1e-5);
    EXPECT_LE(farthest(last, before) * 60.0, 1e-5) << "m/s";
}

TEST(Direct, DroopsByItsDroopNumberAtAnyRate)
{
    // links,Gamma,H_over_L,W_over_L,H_over_W,residual
    std::map<double, double> exact;
    std::ifstream file(reference_file("cantilever_second_difference.csv"));
    for (std::string line; std::getline(file, line);)
    {
        double row[5];
        if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", row, row + 1, row + 2, row + 3, row + 4) == 5 &&
            row[0] == 14.0)
            exact[row[1]] = row[4];
    }
    for (const double gamma : {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 100.0, 200.0})
        for (const double fps : {60.0, 120.0, 240.0})
        {
            ASSERT_TRUE(exact.contains(gamma)) << gamma;
            const LabRun own = run(study::cantilever(14, gamma), 5.0, fps);
            const double off = study::droop({own.nodes.back()}) / exact[gamma] - 1.0;
            // To a millionth, were it not for hair that falls asleep when it hardly moves any more.
            EXPECT_LE(std::abs(off), 0.005) << gamma << " at " << fps;
            EXPECT_LE(own.stretch, 1e-3) << gamma << " at " << fps;
        }
}

} // namespace
} // namespace coif

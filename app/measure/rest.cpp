// Where a strand comes to rest: A6 hanging, A7 in the wind, A8 clamped level, A9 between two held ends.
#include "app/measure/strand.h"

#include "app/measure/cantilever.h"
#include "sim/material.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

constexpr double kSettle = 8.0; // s, in drag that stops a swing within one

std::vector<Row> measure_hang(const Measuring& with)
{
    std::vector<Row> rows;
    for (const HairParams& solver : product_solvers())
    {
        const LabRun run = play(with, solver, study::Scene(), 60.0, 10.0);
        double fastest = 0.0;
        for (const glm::dvec3& v : run.velocities.back())
            fastest = std::max(fastest, glm::length(v));
        rows.push_back(strand_row("A6", "", "stretch", solver, run.stretch, "fraction", "none", {0.01, 1e-5}));
        rows.push_back(strand_row("A6", "", "speed after 10 s", solver, 1e3 * fastest, "mm/s", "none", {1.0, 1e-3}));
    }
    return rows;
}

std::vector<Row> measure_wind(const Measuring& with)
{
    std::vector<Row> rows;
    for (const double ratio : with.quick ? std::vector<double>{0.1, 1.0, 10.0, 100.0}
                                         : std::vector<double>{0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 100.0})
        for (const HairParams& solver : product_solvers())
        {
            with.progress(fmt::format("wind of {} g, {}", ratio, solver_name(solver)));
            study::Scene scene;
            scene.drag = 8.0;
            scene.wind = glm::dvec3(ratio * kGravity, 0.0, 0.0);
            scene.direction = {std::sin(0.3), -std::cos(0.3), 0.0};
            const LabRun run = play(with, solver, scene, 60.0, kSettle);
            const double degree = std::numbers::pi / 180.0;
            const double angle = std::asin((-1.0 + std::sqrt(1.0 + 4.0 * ratio * ratio)) / (2.0 * ratio));
            double worst = 0.0;
            const auto& nodes = run.nodes.back();
            for (size_t i = 1; i < nodes.size(); ++i)
            {
                const glm::dvec3 link = nodes[i] - nodes[i - 1];
                worst = std::max(worst, std::abs(std::atan2(link.x, -link.y) - angle) / degree);
            }
            Row row = strand_row("A7", "", "angle", solver, worst, "deg", "eq. 5.2 in equilibrium", {0.01, 0.01});
            row.knob = "wind, g";
            row.value = ratio;
            row.stretch = run.stretch;
            rows.push_back(row);
        }
    return rows;
}

// The droop of a strand of 14 links that second differences bend, from the file.
static double discrete_droop(const std::vector<std::vector<double>>& table, int links, double gamma)
{
    for (const std::vector<double>& row : table)
        if (int(row[0]) == links && std::abs(row[1] / gamma - 1.0) < 1e-6)
            return row[4];
    return NAN;
}

std::vector<Row> measure_cantilever(const Measuring& with)
{
    const int links = 14;
    const auto table = reference_table("cantilever_second_difference.csv");
    const std::string reference = "second differences, 14 links";
    const HairParams usual;
    const auto droop_of = [&](const HairParams& solver, double gamma, double rate, double& stretch)
    {
        const LabRun run = play(with, solver, study::cantilever(links, gamma), rate, kSettle);
        stretch = run.stretch;
        return study::droop(run.nodes);
    };

    std::vector<Row> rows;
    const std::vector<double> gammas = {0.5, 1.0, 2.0, 5.0, 10.0, 50.0, 100.0, 200.0};
    for (const double gamma : gammas)
    {
        const double exact = discrete_droop(table, links, gamma), bound = gamma <= 10.0 ? 0.005 : 0.01;
        std::vector<double> all;
        const auto add = [&](const std::string& setting, const HairParams& solver, double rate, Bounds bounds)
        {
            with.progress(fmt::format("Gamma {}, {}, {}", gamma, solver_name(solver), setting));
            double stretch = 0.0;
            const double droop = droop_of(solver, gamma, rate, stretch);
            Row row =
                strand_row("A8", setting, "H/W", solver, std::abs(droop / exact - 1.0), "fraction", reference, bounds);
            row.knob = "Gamma";
            row.value = gamma;
            row.measured = droop;
            row.stretch = stretch;
            rows.push_back(row);
            all.push_back(droop);
        };
        add("", usual, 60.0, {bound, bound});
        const double one = all[0];
        if (!with.quick || gamma == 1.0 || gamma == 10.0 || gamma == 100.0)
        {
            const std::vector<Row> kept = rows; // the spread is one row
            for (const double rate : with.quick ? std::vector<double>{240.0} : std::vector<double>{120.0, 240.0})
                add("", usual, rate, {});
            for (const int substeps : with.quick ? std::vector<int>{16} : std::vector<int>{2, 4, 8, 16})
            {
                HairParams finer;
                finer.solver_substeps = substeps;
                add("", finer, 60.0, {});
            }
            for (const int iterations : with.quick ? std::vector<int>{64} : std::vector<int>{1, 8, 64})
            {
                HairParams swept; // which the direct solver must not heed
                swept.solver_iterations = iterations;
                add("", swept, 60.0, {});
            }
            rows = kept;
            const auto [least, most] = std::minmax_element(all.begin(), all.end());
            rows.push_back(strand_row("A8", "steps 1/240 to 1/60 s, any substeps and iterations", "spread of H/W",
                                      usual, (*most - *least) / exact, "fraction", "one droop", {bound, bound}));
            rows.back().knob = "Gamma";
            rows.back().value = gamma;
        }
        rows.push_back(strand_row("A8", "", "continuum", usual, std::abs(one / droop_at(gamma).ratio() - 1.0),
                                  "fraction", "heavy elastica: what 14 links cost"));
        rows.back().knob = "Gamma";
        rows.back().value = gamma;
    }
    // The thesis' bending has no Gamma: what it does at one strength hangs on sweeps and step.
    std::vector<double> all;
    double worst = 0.0;
    for (const int iterations : {8, 64})
        for (const double rate : {60.0, 240.0})
        {
            HairParams swept = product_solvers()[1];
            swept.solver_iterations = iterations;
            swept.solver_bending = 0.5f;
            swept.solver_bending_attenuation = 0.0f;
            double stretch = 0.0;
            all.push_back(droop_of(swept, 1.0, rate, stretch));
            worst = std::max(worst, stretch);
        }
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    rows.push_back(strand_row("A8", "8 and 64 iterations, 60 and 240 steps a second", "most against least H/W",
                              product_solvers()[1], *most / *least, "times", "one droop, 1 times"));
    rows.back().stretch = worst;
    return rows;
}

// Nodes at equal distances on an arc of a circle over `span`, bulging down: links of the right length, and not the
// answer.
static std::vector<glm::dvec3> arc(int links, double link, double span)
{
    double low = 1e-9, high = 2.0 * std::numbers::pi / links; // angle that each link subtends
    for (int i = 0; i < 80; ++i)
    {
        const double middle = 0.5 * (low + high);
        (link * std::sin(0.5 * links * middle) / std::sin(0.5 * middle) > span ? low : high) = middle;
    }
    std::vector<glm::dvec3> nodes = {glm::dvec3(0.0)};
    for (int i = 0; i < links; ++i)
    {
        const double slope = (i - 0.5 * (links - 1)) * low;
        nodes.push_back(nodes.back() + link * glm::dvec3(std::cos(slope), std::sin(slope), 0.0));
    }
    return nodes;
}

std::vector<Row> measure_catenary(const Measuring& with)
{
    std::vector<Row> rows;
    const HairParams solver;
    for (const std::vector<double>& line : reference_table("catenary.csv"))
    {
        study::Scene scene;
        scene.drag = 8.0;
        const double link = scene.length / scene.links;
        scene.start = arc(scene.links, link, line[0] * scene.length);
        scene.tip = scene.start.back();
        with.progress(fmt::format("span {} L", line[0]));
        const LabRun run = play(with, solver, scene, 60.0, kSettle);
        double lowest = 0.0;
        for (const glm::dvec3& node : run.nodes.back())
            lowest = std::max(lowest, -node.y / scene.length);
        Row row = strand_row("A9", "", "sag", solver, std::abs(lowest / line[2] - 1.0), "fraction",
                             "chain of 15 links, both ends held", {1e-4, 1e-4});
        row.knob = "span, L";
        row.value = line[0];
        row.measured = lowest;
        row.stretch = run.stretch;
        rows.push_back(row);
    }
    return rows;
}

} // namespace coif

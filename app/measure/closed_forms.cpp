// Motion whose answer is a formula: A1 free fall, A2 the pendulum, A3 and A4 small swings of a chain, A11 energy.
#include "app/measure/strand.h"
#include "sim/material.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace coif
{

constexpr double kPi = std::numbers::pi;

std::vector<Row> measure_fall(const Measuring& with)
{
    std::vector<Row> rows;
    for (const double drag : {0.0, 2.0})
        for (const HairParams& solver : product_solvers())
        {
            const auto fallen = [drag](double t)
            { return drag > 0.0 ? kGravity / drag * (t + std::expm1(-drag * t) / drag) : 0.5 * kGravity * t * t; };
            study::Scene scene;
            scene.drag = drag;
            scene.direction = {1.0, 0.0, 0.0};
            scene.root = [&](double t) { return glm::dvec3(0.0, -fallen(t), 0.0); };
            const LabRun run = play(with, solver, scene, 60.0, 1.0);
            double worst = 0.0;
            for (size_t i = 1; i < run.nodes.back().size(); ++i)
                worst = std::max(worst, std::abs(run.nodes.back()[i].y / -fallen(1.0) - 1.0));
            Row row = strand_row(
                "A1", drag > 0.0 ? "drag 2 1/s" : "no drag", "distance after 1 s", solver, worst, "fraction",
                "formula; the root falls by it too and the strand lies across, so nothing pulls", {1e-3, 1e-6});
            row.stretch = run.stretch;
            rows.push_back(row);
        }
    return rows;
}

// Times at which the samples rise through zero, each from the cubic through the four samples about it.
static std::vector<double> rises(const std::vector<double>& q, double fps)
{
    std::vector<double> times;
    for (size_t i = 1; i + 2 < q.size(); ++i)
    {
        if (!(q[i] < 0.0 && q[i + 1] >= 0.0))
            continue;
        const auto cubic = [&](double u) // Lagrange, through u = -1, 0, 1, 2
        {
            return -u * (u - 1) * (u - 2) / 6 * q[i - 1] + (u + 1) * (u - 1) * (u - 2) / 2 * q[i] -
                   (u + 1) * u * (u - 2) / 2 * q[i + 1] + (u + 1) * u * (u - 1) / 6 * q[i + 2];
        };
        double low = 0.0, high = 1.0;
        for (int n = 0; n < 50; ++n)
            (cubic(0.5 * (low + high)) < 0.0 ? low : high) = 0.5 * (low + high);
        times.push_back((double(i) + low) / fps);
    }
    return times;
}

static double mean_period(const std::vector<double>& q, double fps)
{
    const std::vector<double> times = rises(q, fps);
    return times.size() < 2 ? NAN : (times.back() - times.front()) / double(times.size() - 1);
}

// Amplitude of a swing of this angular frequency in part of the samples: least squares of a sine and a cosine.
static double amplitude(const std::vector<double>& q, size_t begin, size_t end, double frequency, double fps)
{
    double cc = 0, cs = 0, ss = 0, qc = 0, qs = 0;
    for (size_t i = begin; i < end; ++i)
    {
        const double c = std::cos(frequency * double(i) / fps), s = std::sin(frequency * double(i) / fps);
        cc += c * c, cs += c * s, ss += s * s, qc += q[i] * c, qs += q[i] * s;
    }
    const double det = cc * ss - cs * cs;
    return std::hypot((qc * ss - qs * cs) / det, (qs * cc - qc * cs) / det);
}

// Rate at which a swing fades, 1/s: its amplitude in the first third against that in the last.
static double fading(const std::vector<double>& q, double frequency, double fps)
{
    const size_t third = q.size() / 3;
    const double first = amplitude(q, 0, third, frequency, fps),
                 last = amplitude(q, q.size() - third, q.size(), frequency, fps);
    return std::log(first / last) / (double(q.size() - third) / fps);
}

static HairParams with_substeps(HairParams solver, int substeps)
{
    solver.solver_substeps = substeps;
    return solver;
}

static void say_substeps(Row& row, const HairParams& solver)
{
    if (!is_default_solver(solver))
        return;
    row.knob = "substeps";
    row.value = solver.solver_substeps;
}

std::vector<Row> measure_pendulum(const Measuring& with)
{
    const int substeps = 16;
    std::vector<Row> rows;
    for (const double degrees : {30.0, 90.0, 170.0})
        for (const HairParams& kind : product_solvers())
        {
            const HairParams solver = with_substeps(kind, substeps);
            const double swing = degrees * kPi / 180.0;
            study::Scene scene;
            scene.links = 1;
            scene.direction = {std::sin(swing), -std::cos(swing), 0.0};
            with.progress(fmt::format("{} degrees, {}", degrees, solver_name(solver)));
            const LabRun run = play(with, solver, scene, 60.0, 8.0);
            std::vector<double> angle;
            for (const auto& nodes : run.nodes)
                angle.push_back(std::atan2(nodes[1].x - nodes[0].x, nodes[0].y - nodes[1].y));
            // T = 4 sqrt(L / g) K(k), k = sin(swing / 2), with K by the arithmetic-geometric mean.
            double a = 1.0, b = std::cos(swing / 2.0);
            for (int i = 0; i < 8; ++i)
            {
                const double mean = 0.5 * (a + b);
                b = std::sqrt(a * b);
                a = mean;
            }
            const double period = 2.0 * kPi * std::sqrt(scene.length / kGravity) / a;
            Row row = strand_row("A2", fmt::format("{:g} degrees", degrees), "period", solver,
                                 std::abs(mean_period(angle, 60.0) / period - 1.0), "fraction", "elliptic integral",
                                 {1e-4, 1e-4});
            row.stretch = run.stretch;
            say_substeps(row, solver);
            rows.push_back(row);
        }
    return rows;
}

// Laguerre's polynomials L_0 to L_n at x. A chain of n equal masses hanging at rest swings at w^2 = (g / l) x where
// L_n(x) = 0, and node n - j by L_j(x).
static std::vector<double> laguerre(int n, double x)
{
    std::vector<double> l = {1.0, 1.0 - x};
    for (int k = 1; k < n; ++k)
        l.push_back(((2 * k + 1 - x) * l[size_t(k)] - k * l[size_t(k - 1)]) / (k + 1));
    return l;
}

static double laguerre_zero(int n, int which)
{
    double low = 0.0, high = 0.0;
    for (int found = 0; found < which; high += 1e-3)
        if (laguerre(n, high)[size_t(n)] * laguerre(n, high + 1e-3)[size_t(n)] < 0.0)
        {
            low = high;
            ++found;
        }
    high = low + 1e-3;
    const bool rising = laguerre(n, low)[size_t(n)] < 0.0;
    for (int i = 0; i < 60; ++i)
    {
        const double middle = 0.5 * (low + high);
        ((laguerre(n, middle)[size_t(n)] < 0.0) == rising ? low : high) = middle;
    }
    return low;
}

namespace
{
struct Mode
{
    double frequency; // rad/s
    std::vector<double> shape;
    study::Scene scene;

    // How much of the mode is in the nodes; modes are orthogonal, as masses are equal.
    double part(const std::vector<glm::dvec3>& nodes) const
    {
        double sum = 0.0, all = 0.0;
        for (size_t i = 1; i < nodes.size(); ++i)
        {
            sum += shape[i] * nodes[i].x;
            all += shape[i] * shape[i];
        }
        return sum / all;
    }
};
} // namespace

static Mode mode(int which)
{
    Mode m;
    const int links = m.scene.links;
    const double zero = laguerre_zero(links, which), link = m.scene.length / links;
    const std::vector<double> l = laguerre(links, zero);
    m.frequency = std::sqrt(kGravity / link * zero);
    m.shape = {l.rbegin(), l.rend()};
    double steepest = 0.0;
    for (size_t i = 1; i < m.shape.size(); ++i)
        steepest = std::max(steepest, std::abs(m.shape[i] - m.shape[i - 1]));
    const double size = 0.01 * link / steepest; // small: no link leans by more than 0.6 degrees
    m.scene.start = {glm::dvec3(0.0)};
    for (size_t i = 1; i < m.shape.size(); ++i)
    {
        const double across = size * (m.shape[i] - m.shape[i - 1]);
        m.scene.start.push_back(m.scene.start.back() +
                                glm::dvec3(across, -std::sqrt(link * link - across * across), 0.0));
    }
    return m;
}

std::vector<Row> measure_modes(const Measuring& with)
{
    std::vector<Row> rows;
    for (int which = 1; which <= 3; ++which)
        for (const HairParams& kind : product_solvers())
        {
            const HairParams solver = with_substeps(kind, 16);
            const Mode m = mode(which);
            const std::string setting = fmt::format("mode {}", which);
            with.progress(setting + ", " + solver_name(solver));
            const LabRun run = play(with, solver, m.scene, 60.0, with.quick ? 10.0 : 20.0);
            std::vector<double> q;
            for (const auto& nodes : run.nodes)
                q.push_back(m.part(nodes));
            const double frequency = 2.0 * kPi / mean_period(q, 60.0);
            Row row = strand_row("A3", setting, "frequency", solver, std::abs(frequency / m.frequency - 1.0),
                                 "fraction", "zeros of Laguerre's polynomial", {1e-4, 1e-4});
            row.stretch = run.stretch;
            say_substeps(row, solver);
            rows.push_back(row);
            // "None" is what so many seconds of float can tell.
            row = strand_row("A3", setting, "fading", solver, std::abs(fading(q, frequency, 60.0)), "1/s", "none",
                             {1e-3, 1e-3});
            say_substeps(row, solver);
            rows.push_back(row);
        }
    return rows;
}

std::vector<Row> measure_decay(const Measuring& with)
{
    const double drag = 2.0;
    Mode m = mode(1);
    m.scene.drag = drag;
    const double frequency = std::sqrt(m.frequency * m.frequency - 0.25 * drag * drag);
    std::vector<Row> rows;
    for (const HairParams& solver : product_solvers())
    {
        const LabRun run = play(with, solver, m.scene, 60.0, 4.0);
        std::vector<double> q; // without the decay that should be there
        for (size_t f = 0; f < run.nodes.size(); ++f)
            q.push_back(m.part(run.nodes[f]) * std::exp(0.5 * drag * run.times[f]));
        rows.push_back(strand_row("A4", "mode 1, drag 2 1/s", "rate of decay", solver,
                                  std::abs(fading(q, frequency, 60.0)) / (0.5 * drag), "fraction", "half the drag",
                                  {0.05, 0.001}));
        rows.back().stretch = run.stretch;
    }
    return rows;
}

std::vector<Row> measure_energy(const Measuring& with)
{
    const study::Reference& free = study::reference("release30_b0");
    const double seconds = with.quick ? 20.0 : 60.0, window = 3.0;
    std::vector<Row> rows;
    for (const HairParams& solver : product_solvers())
    {
        with.progress(solver_name(solver));
        const LabRun run = play(with, solver, free.scene, 60.0, seconds);
        // Of all nodes, against links * g * length. Velocities are half a substep old, which over some swings evens
        // out.
        std::vector<double> energy;
        for (size_t f = 0; f < run.nodes.size(); ++f)
        {
            double sum = 0.0;
            for (size_t i = 1; i < run.nodes[f].size(); ++i)
                sum += 0.5 * glm::dot(run.velocities[f][i], run.velocities[f][i]) + kGravity * run.nodes[f][i].y;
            energy.push_back(sum / (free.scene.links * kGravity * free.scene.length));
        }
        const size_t count = size_t(window * 60.0);
        double worst = 0.0;
        const auto mean = [&](size_t from)
        {
            double sum = 0.0;
            for (size_t i = from; i < from + count; ++i)
                sum += energy[i];
            return sum / double(count);
        };
        for (size_t from = 1; from + count <= energy.size(); from += count)
            worst = std::max(worst, std::abs(mean(from) - energy[0]));
        Row row = strand_row("A11", fmt::format("{:g} s", seconds), "energy drift", solver, worst, "fraction",
                             "what it began with, in N g L; means over 3 s", {0.05, 0.001});
        row.stretch = run.stretch;
        rows.push_back(row);
    }
    return rows;
}

} // namespace coif

// One knob at a time, and one solver against another: error, worst stretch and price on the same two motions, one calm
// and one violent. Prices are medians over frames of that motion, in which all take turns.
#include "app/measure/strand.h"
#include "app/statistics.h"
#include "sim/models/baseline.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coif
{

static const char* const kMotions[] = {"shake_b2", "release90_b1"};

namespace
{
// One point of a sweep.
struct Point
{
    HairParams solver;
    double value;       // of the knob
    double rate = 60.0; // steps a second
    int links = 15;
};

using Frame = std::function<double()>; // plays one, and says what it cost: ns a strand
} // namespace

static int strands_of(const Measuring& with) { return with.quick ? 512 : 4096; }
static int frames_of(const Measuring& with) { return with.quick ? 12 : 30; }

// Plays many copies of the strand.
static Frame priced(const Measuring& with, const Point& point, const study::Scene& scene, int copies)
{
    const auto lab = std::make_shared<Lab>(with.device, params_of(point.solver, scene), strand_of(scene), scene.root,
                                           point.rate, copies);
    const int frames = std::max(1, int(std::lround(point.rate / 60.0)));
    return [lab, frames, rate = point.rate]
    {
        double ns = 0.0;
        for (int i = 0; i < frames; ++i)
            ns += lab->frame();
        return ns / (frames * 60.0 / rate);
    };
}

// Where node `i` of so many links lies on a strand of more links.
static glm::dvec3 along(const std::vector<glm::dvec3>& nodes, int i, int links)
{
    const double at = double(i) / links * double(nodes.size() - 1);
    const size_t a = std::min(size_t(at), nodes.size() - 2);
    return glm::mix(nodes[a], nodes[a + 1], at - double(a));
}

// Of a strand of as many links as the reference or fewer, at the times that both have.
static double error_of(const LabRun& run, const study::Frames& reference, double rate, double length)
{
    const study::Frames played = common_frames(run.nodes, rate, 60.0);
    const study::Frames all = common_frames(reference, 60.0, rate);
    study::Frames fitting;
    for (const auto& nodes : all)
    {
        fitting.emplace_back();
        const int links = int(played[0].size()) - 1;
        for (int i = 0; i <= links; ++i)
            fitting.back().push_back(along(nodes, i, links));
    }
    const double error = study::compare(played, fitting, length).rms;
    return std::isfinite(error) ? error : std::numeric_limits<double>::quiet_NaN();
}

// A row for each motion and point.
static std::vector<Row> sweep(const Measuring& with, const char* id, const char* knob, const std::vector<Point>& points,
                              int copies, int reference_links = 0)
{
    std::vector<Row> rows;
    for (const char* name : kMotions)
    {
        study::Reference motion = study::reference(name);
        study::Frames reference;
        if (reference_links == 0)
            reference = reference_frames(name, motion.fps, motion.seconds);
        else
        {
            with.progress(fmt::format("{} of {} links", name, reference_links));
            motion.scene.tip_mass = 0.5; // the better rod, and what styles have
            study::Scene fine = motion.scene;
            fine.links = reference_links;
            reference = study::model("shake").run(fine, motion.fps, motion.seconds, 2 * reference_links).frames;
        }
        std::vector<Frame> frames;
        const size_t first = rows.size();
        for (const Point& point : points)
        {
            with.progress(fmt::format("{}, {} {}", name, knob, point.value));
            study::Scene scene = motion.scene;
            scene.links = point.links;
            const LabRun run = play(with, point.solver, scene, point.rate, motion.seconds);
            rows.push_back(strand_row(
                id, name, "rms", point.solver, error_of(run, reference, point.rate, scene.length), "L",
                reference_links ? fmt::format("shake of {} links", reference_links) : "index-1 DAE, DOP853 at 1e-13"));
            rows.back().knob = knob;
            rows.back().value = point.value;
            rows.back().stretch = run.stretch;
            frames.push_back(priced(with, point, scene, copies));
        }
        with.progress(fmt::format("{}, prices", name));
        interleaved_medians(frames, 1);
        const std::vector<double> ns = interleaved_medians(frames, frames_of(with));
        for (size_t i = 0; i < ns.size(); ++i)
            rows[first + i].ns_strand_frame = ns[i];
    }
    return rows;
}

static std::vector<int> some(const Measuring& with, const std::vector<int>& all, const std::vector<int>& quick)
{
    return with.quick ? quick : all;
}

std::vector<Row> measure_iterations(const Measuring& with)
{
    std::vector<Point> points;
    for (const int n : some(with, {1, 2, 4, 8, 16, 32, 64, 128, 300, 1000}, {1, 8, 64}))
    {
        points.push_back({product_solvers()[1], double(n)});
        points.back().solver.solver_iterations = n;
    }
    return sweep(with, "iterations", "iterations", points, std::min(strands_of(with), 512));
}

std::vector<Row> measure_substeps(const Measuring& with)
{
    std::vector<Point> points;
    for (const int n : {1, 2, 4, 8, 16})
    {
        points.push_back({HairParams(), double(n)});
        points.back().solver.solver_substeps = n;
    }
    return sweep(with, "substeps", "substeps at least", points, strands_of(with));
}

std::vector<Row> measure_courant(const Measuring& with)
{
    std::vector<Point> points;
    for (const float c : with.quick ? std::vector<float>{0.25f, 1.0f, 1.8f}
                                    : std::vector<float>{0.1f, 0.25f, 0.5f, 0.75f, 1.0f, 1.4f, 1.8f})
    {
        points.push_back({HairParams(), double(c)});
        points.back().solver.solver_courant = c;
    }
    return sweep(with, "courant", "courant", points, strands_of(with));
}

std::vector<Row> measure_rate(const Measuring& with)
{
    std::vector<Point> points;
    for (const HairParams& solver : product_solvers())
        for (const double rate : {30.0, 60.0, 120.0, 240.0})
            points.push_back({solver, rate, rate});
    return sweep(with, "rate", "steps a second", points, strands_of(with));
}

std::vector<Row> measure_nodes(const Measuring& with)
{
    std::vector<Point> points;
    for (const int links : some(with, {1, 3, 7, 15, 31, 63, 127, 255}, {3, 15, 63}))
        points.push_back({HairParams(), links + 1.0, 60.0, links});
    return sweep(with, "nodes", "nodes", points, std::min(strands_of(with), 512), with.quick ? 127 : 255);
}

// The thesis' own kernel, under a scalp that moves so that the strand's first free segment hangs from the root's path.
static study::BaselineSetup thesis(const study::Scene& scene, int iterations, int strands)
{
    study::BaselineSetup setup;
    setup.nodes = scene.links + 2;
    setup.iterations = iterations;
    setup.drag = float(scene.drag);
    const glm::dvec3 place = 0.1 * glm::normalize(scene.direction);
    setup.roots.assign(size_t(strands),
                       F4(float(place.x), float(place.y), float(place.z), float(scene.length / scene.links)));
    return setup;
}
static glm::vec3 scalp_at(const study::Scene& scene, double seconds)
{
    return glm::vec3(scene.root(seconds) - 0.1 * glm::normalize(scene.direction));
}

static LabRun play_thesis(const Measuring& with, const study::Reference& motion, int iterations)
{
    study::Baseline baseline(with.device, thesis(motion.scene, iterations, 1), scalp_at(motion.scene, 0.0));
    LabRun run;
    for (int f = 0; f <= int(std::lround(motion.seconds * motion.fps)); ++f)
    {
        if (f > 0)
            baseline.step(scalp_at(motion.scene, f / motion.fps));
        const std::vector<glm::vec3> all = baseline.positions();
        run.nodes.emplace_back(all.begin() + 1, all.end());
        const auto& nodes = run.nodes.back();
        const double rest = motion.scene.length / motion.scene.links;
        for (size_t i = 1; i < nodes.size(); ++i)
            run.stretch = std::max(run.stretch, std::abs(glm::distance(nodes[i], nodes[i - 1]) / rest - 1.0));
    }
    return run;
}

static Frame priced_thesis(const Measuring& with, const study::Scene& scene, int iterations, int strands)
{
    const auto baseline =
        std::make_shared<study::Baseline>(with.device, thesis(scene, iterations, strands), scalp_at(scene, 0.0));
    return [baseline, scene, frame = 0]() mutable { return baseline->step(scalp_at(scene, ++frame / 60.0)); };
}

// Models in plain C++ are timed as they run, one strand on one thread.
static void add_models(std::vector<Row>& rows, const Measuring& with, const study::Reference& motion,
                       const study::Frames& reference)
{
    for (const study::Model& model : study::models())
    {
        std::string name = model.name;
        std::replace(name.begin(), name.end(), '_', ' ');
        with.progress(motion.name + ", " + name);
        for (const int knob : model.knobs)
        {
            const study::Result result = model.run(motion.scene, motion.fps, motion.seconds, knob);
            const double error = study::compare(result.frames, reference, motion.scene.length).rms;
            if (!result.finite || !(error < 1.0) || !(result.stretch < 10.0)) // flown apart
                continue;
            Row row;
            row.scene = "solver";
            row.setting = motion.name;
            row.metric = "rms";
            row.solver = name + ", plain C++";
            row.knob = model.knob;
            row.value = knob;
            row.error = error;
            row.unit = "L";
            row.reference = "index-1 DAE, DOP853 at 1e-13";
            row.stretch = result.stretch;
            row.ns_strand_frame = result.ns;
            rows.push_back(row);
        }
    }
}

std::vector<Row> measure_solvers(const Measuring& with)
{
    const int strands = strands_of(with);
    std::vector<Row> rows;
    for (const char* name : kMotions)
    {
        const study::Reference& motion = study::reference(name);
        const study::Frames reference = reference_frames(name, motion.fps, motion.seconds);
        std::vector<Frame> frames;
        const size_t first = rows.size();
        const auto add = [&](const std::string& solver, const char* knob, double value, const LabRun& run, Frame frame)
        {
            Row row =
                strand_row("solver", name, "rms", HairParams(), error_of(run, reference, 60.0, motion.scene.length),
                           "L", "index-1 DAE, DOP853 at 1e-13");
            row.solver = solver;
            row.knob = knob;
            row.value = value;
            row.stretch = run.stretch;
            rows.push_back(row);
            frames.push_back(std::move(frame));
        };
        for (const int n : {1, 2, 4, 8, 16}) // the first is what styles have
        {
            Point point{HairParams(), double(n)};
            point.solver.solver_substeps = n;
            with.progress(fmt::format("{}, direct, {} substeps", name, n));
            add("direct", "substeps at least", n, play(with, point.solver, motion.scene, 60.0, motion.seconds),
                priced(with, point, motion.scene, strands));
        }
        for (const int n : some(with, {1, 2, 4, 8, 10, 16, 32, 64}, {1, 8, 32}))
        {
            Point point{product_solvers()[1], double(n)};
            point.solver.solver_iterations = n;
            with.progress(fmt::format("{}, pbd, {} iterations", name, n));
            add("pbd", "iterations", n, play(with, point.solver, motion.scene, 60.0, motion.seconds),
                priced(with, point, motion.scene, strands));
        }
        size_t eight = 0;
        for (const int n : some(with, {1, 2, 4, 8, 16, 32, 64}, {8}))
        {
            with.progress(fmt::format("{}, the thesis' kernel, {} iterations", name, n));
            if (n == 8)
                eight = frames.size();
            add("thesis' kernel", "iterations", n, play_thesis(with, motion, n),
                priced_thesis(with, motion.scene, n, strands));
        }
        with.progress(fmt::format("{}, prices", name));
        interleaved_medians(frames, 1);
        const std::vector<double> ns = interleaved_medians(frames, frames_of(with));
        for (size_t i = 0; i < ns.size(); ++i)
            rows[first + i].ns_strand_frame = ns[i];
        add_models(rows, with, motion, reference);

        Row ratio = strand_row("solver", name, "price against the thesis' kernel", HairParams(), ns[0] / ns[eight],
                               "times", "its 8 iterations, same strands, in turns; wanted: at most 1");
        ratio.ns_strand_frame = ns[0];
        rows.push_back(ratio);
    }
    return rows;
}

} // namespace coif

// Motion against motion: A5 and A5m against references of double precision, A10 the order at which the error falls
// with the step, A14 the same scheme in double precision.
#include "app/measure/strand.h"
#include "app/statistics.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <numbers>

namespace coif
{

constexpr const char* kReference = "index-1 DAE, DOP853 at 1e-13";

std::vector<Row> measure_motion(const Measuring& with)
{
    // Bounds of the rms; of the stretch they are 0.5 % in all.
    const auto bounds_of = [](const std::string& name) -> Bounds
    {
        if (name == "turn_b1") // sensitive: a perturbation grows tenfold in these 2 s
            return {0.02, 0.001};
        return {name == "release30_b0" ? 0.02 : 0.003, 0.001};
    };
    std::vector<Row> rows;
    for (const study::Reference& reference : study::references())
    {
        const study::Frames frames = reference_frames(reference.name, reference.fps, reference.seconds);
        for (const HairParams& solver : product_solvers())
        {
            with.progress(reference.name + ", " + solver_name(solver));
            const LabRun run = play(with, solver, reference.scene, reference.fps, reference.seconds);
            const study::Difference difference = study::compare(run.nodes, frames, reference.scene.length);
            const auto row = [&](const char* metric, double error, const char* unit, Bounds bounds)
            {
                rows.push_back(strand_row("A5", reference.name, metric, solver, error, unit, kReference, bounds));
                rows.back().stretch = run.stretch;
            };
            row("rms", difference.rms, "L", bounds_of(reference.name));
            row("worst", difference.worst, "L", {});
            row("stretch", run.stretch, "fraction", {0.005, 0.001});
        }
    }
    return rows;
}

std::vector<Row> measure_small_swing(const Measuring& with)
{
    const double amplitude = 0.005; // of the tip, L
    const double seconds = with.quick ? 4.0 : 10.0;
    const study::Frames frames = reference_frames("mode1_b0", 60.0, seconds);
    study::Scene scene;
    scene.start = frames[0];
    std::vector<Row> rows;
    for (const HairParams& solver : product_solvers())
    {
        const LabRun run = play(with, solver, scene, 60.0, double(frames.size() - 1) / 60.0);
        const study::Difference difference = study::compare(run.nodes, frames, scene.length);
        rows.push_back(strand_row("A5m", "", "rms of the amplitude", solver, difference.rms / amplitude, "fraction",
                                  kReference, {0.003, 0.003}));
        rows.back().stretch = run.stretch;
    }
    return rows;
}

constexpr double kRounding = 1e-5; // L: what float leaves after some seconds, which no finer step mends

// Errors over the step, and the slope of their logarithms, which is asked of steps that solve the same equations: no
// longer than the wave across the strand allows.
static void add_order(std::vector<Row>& rows, const Measuring& with, const char* setting, const study::Scene& scene,
                      const study::Frames& frames, double fps, double seconds, const std::string& reference,
                      double least_order)
{
    std::vector<double> steps, errors;
    const HairParams usual;
    for (const int per_frame : with.quick ? std::vector<int>{4, 8, 16, 32} : std::vector<int>{4, 8, 16, 32, 64})
    {
        HairParams solver;
        solver.solver_substeps = std::min(per_frame, 16);
        solver.solver_courant = 1.8f; // the substeps asked for, as long as they are stable
        const double rate = 60.0 * std::max(1, per_frame / 16);
        with.progress(fmt::format("{}, {} substeps a frame", setting, per_frame));
        const LabRun run = play(with, solver, scene, rate, seconds);
        const double error = study::compare(common_frames(run.nodes, rate, fps), frames, scene.length).rms;
        rows.push_back(strand_row("A10", setting, "rms", solver, error, "L", reference));
        rows.back().knob = "substep, ms";
        rows.back().value = 1e3 / (60.0 * per_frame);
        rows.back().stretch = run.stretch;
        if (error > kRounding)
        {
            steps.push_back(rows.back().value);
            errors.push_back(error);
        }
    }
    rows.push_back(strand_row("A10", setting, "order", usual, observed_order(steps, errors), "", reference,
                              {least_order, least_order}));
    rows.back().at_least = true;
}

std::vector<Row> measure_order(const Measuring& with)
{
    std::vector<Row> rows;
    const study::Reference& free = study::reference("release30_b0");
    const double seconds = 2.0;
    add_order(rows, with, "no bending", free.scene, reference_frames(free.name, free.fps, seconds), free.fps, seconds,
              kReference, 1.9);
    study::Scene stiff = study::cantilever(14, 10.0);
    stiff.drag = 1.0;
    const study::Result finest = study::model("shake").run(stiff, 60.0, seconds, with.quick ? 256 : 512);
    add_order(rows, with, "bending, Gamma 10", stiff, finest.frames, 60.0, seconds,
              "shake in double precision, far finer steps", 0.9);
    return rows;
}

std::vector<Row> measure_twin(const Measuring& with)
{
    const study::Reference& shake = study::reference("shake_b2");
    const int substeps = 16;
    const double seconds = 1.0;
    HairParams solver;
    solver.solver_substeps = substeps;
    const LabRun run = play(with, solver, shake.scene, 60.0, seconds);
    const study::Result twin = study::model("shake").run(shake.scene, 60.0, seconds, substeps);
    Row row =
        strand_row("A14", shake.name, "worst", solver, study::compare(run.nodes, twin.frames, shake.scene.length).worst,
                   "L", "the same scheme in double precision", {1e-3, 1e-5});
    row.knob = "substeps";
    row.value = substeps;
    return {row};
}

} // namespace coif

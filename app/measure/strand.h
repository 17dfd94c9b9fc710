// What the scenes of a single strand share: how the lab plays a scene of the comparison models, and how rows of it
// look.
#pragma once
#include "app/measure/measure.h"
#include "sim/lab.h"
#include "sim/models/reference.h"

#include <fmt/format.h>

namespace coif
{

// The solvers that styles can choose, as they are by default; the first is what they get.
std::vector<HairParams> product_solvers();
bool is_default_solver(const HairParams& params); // by kind: the knobs may be turned

// The lab's strand and parameters for a scene: its drag, gravity, wind (steady), tip and start.
LabStrand strand_of(const study::Scene& scene);
HairParams params_of(HairParams solver, const study::Scene& scene);
LabRun play(const Measuring& with, const HairParams& solver, const study::Scene& scene, double fps, double seconds);

// A file of tests/reference, which comes with coif's sources. Throws Error naming it where it is not.
std::filesystem::path reference_file(const std::string& name);
// Columns of numbers under one line of headings.
std::vector<std::vector<double>> reference_table(const std::string& name);
// The frames of a chain15 file, up to `seconds`.
study::Frames reference_frames(const std::string& name, double fps, double seconds);

// Only rows of the default solver are held to bounds.
struct Bounds
{
    double pass = NAN, state_of_the_art = NAN;
};
Row strand_row(const char* scene, const std::string& setting, const char* metric, const HairParams& solver,
               double error, const char* unit, const std::string& reference, Bounds bounds = {});

// Frames of `played` at a rate of `fps` at the times that are also those of a rate of `other`.
study::Frames common_frames(const study::Frames& played, double fps, double other);

} // namespace coif

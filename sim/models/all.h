// Each model's own file defines its run; the table of them is in model.cpp.
#pragma once
#include "sim/models/model.h"

namespace coif::study
{

Result run_mass_spring_explicit(const Scene& scene, double fps, double seconds, int substeps);
Result run_anjyo(const Scene& scene, double fps, double seconds, int substeps);
Result run_mass_spring_implicit(const Scene& scene, double fps, double seconds, int substeps);
Result run_articulated(const Scene& scene, double fps, double seconds, int substeps);
Result run_shake(const Scene& scene, double fps, double seconds, int substeps);
Result run_pbd(const Scene& scene, double fps, double seconds, int iterations);
Result run_pbd_over_relaxed(const Scene& scene, double fps, double seconds, int iterations);
Result run_ftl(const Scene& scene, double fps, double seconds, int substeps);
Result run_xpbd(const Scene& scene, double fps, double seconds, int substeps);

} // namespace coif::study

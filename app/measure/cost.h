#pragma once
#include "sim/solver.h"

#include <memory>
#include <vector>

namespace coif
{

using Solvers = std::vector<std::unique_ptr<Solver>>;

// Milliseconds that the device spends on a frame of 1/60 s of each, in all passes, those of the drawn strands too if
// `drawn`: medians of repeats that take turns (A15). Moves the solvers on.
std::vector<double> frame_ms(const Solvers& solvers, bool drawn, int repeats);

} // namespace coif

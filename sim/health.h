#pragma once
#include "sim/solver.h"

#include <string>
#include <vector>

namespace coif
{

// How well the hair holds together at one moment. Stretch is |length / rest - 1| of a segment, nodes 1 and outwards;
// penetration is how deep a node lies inside the head or a collider, nodes 2 and outwards (0 and 1 lie under the scalp
// by design), before wave offsets.
struct Health
{
    double stretch_max = 0.0, stretch_mean = 0.0; // fractions
    double penetration_max = 0.0;                 // m, guides
    double drawn_penetration_max = 0.0;           // m, drawn strands
    bool finite = true;
};

// Reads the guides, and with `drawn` the drawn strands of the last draw() as well.
Health measure_health(const Solver& solver, const HairParams& params, bool drawn);

// A strand that went bad and was put back to its rest shape.
struct Reset
{
    int strand = 0;
    int times = 0;
    int fault = 0; // FAULT_* of kernels/shared.h
};

// What has been reset since `seen` was what Solver::resets() gave; now it is again. Waits for the device.
std::vector<Reset> find_resets(const Solver& solver, std::vector<int>& seen);

// The likeliest cause in words, from what the kernel saw and what acted on the hair in that step.
std::string likely_cause(const Reset& reset, const StepInfo& info);

} // namespace coif

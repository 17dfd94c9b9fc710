#pragma once
#include "sim/solver.h"

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

} // namespace coif

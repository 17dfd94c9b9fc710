#pragma once
#include "sim/hairstyle.h"
#include "sim/solver.h"

#include <vector>

namespace coif
{

// What one setting of the direct solver's substeps gives: measured on sixteen of the style's own guides, free of
// contact and of each other, through two seconds of shaking the head.
struct Rung
{
    float courant = 1.0f;
    int substeps = 1;         // at least
    double error = 0.0;       // rms of all nodes over time, as a fraction of the strand's length: predicted
    double nanoseconds = 0.0; // a strand and step; shown, never decided by
};

// What quality.tolerance has come to for a style.
struct Quality
{
    std::vector<Rung> rungs; // from the cheapest; empty: nothing was asked for
    size_t chosen = 0;
    double time_error = 0.0;  // of the rung chosen, predicted
    double node_error = 0.0;  // of that many nodes: tests/reference/node_count_error.csv
    double guide_error = 0.0; // of drawn strands that follow guides that far apart: accuracy.md's law, not a choice yet
    double predicted() const; // of what is simulated: time and nodes, as independent errors add
    std::string said;         // what was chosen and what the style pins, in a sentence
};

// The style as it is to be simulated: whatever it leaves at its default and bears on accuracy (solver.courant and
// substeps, strand.nodes, grid.resolution, smoothing.subdivisions) as coarse as quality.tolerance allows. What it says
// itself is pinned. Without a tolerance, the style as it is. Throws Error as grow() and Solver do.
Hairstyle meet_tolerance(const Device& device, const Hairstyle& style, const Scalp& scalp, Quality& quality);

// The error of these parameters over a motion, measured: sixteen guides against themselves at eight times the substeps,
// as a fraction of the strand's length.
double measure_time_error(const Device& device, const HairParams& params, const Groom& groom, const Motion& motion,
                          double seconds);

// The error of drawn strands between so many guides on this scalp, free of contact, as a fraction of their length:
// predicted, by accuracy's second order in the guides' spacing (`coif measure --only A12`).
double error_of_guides(const HairParams& params, const Scalp& scalp, int guides);

} // namespace coif

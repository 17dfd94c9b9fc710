#pragma once
#include "sim/hairstyle.h"
#include "sim/solver.h"

#include <vector>

namespace coif
{

struct Assets;

// What one setting of the direct solver's substeps gives: measured on sixteen of the style's own guides, free of
// contact and of each other, through two seconds of shaking the head.
struct Rung
{
    float courant = 1.0f;
    int substeps = 1;         // at least
    float rate = 60.0f;       // steps a second: where a step would need more than MOST_SUBSTEPS, it is cut too
    double error = 0.0;       // rms of all nodes over time, as a fraction of the strand's length: predicted
    double nanoseconds = 0.0; // a strand and step; shown, never decided by
};

// What a tolerance may choose.
constexpr const char* kTolerant[] = {"solver.courant",       "solver.substeps", "solver.rate",           "strand.nodes",
                                     "interpolation.refine", "grid.resolution", "smoothing.subdivisions"};

// What quality.tolerance has come to for a style.
struct Quality
{
    std::vector<Rung> rungs; // from the cheapest; empty: there was nothing to choose
    size_t chosen = 0;
    double time_error = 0.0;  // of the rung chosen, predicted
    double node_error = 0.0;  // of that many nodes: tests/reference/node_count_error.csv
    double guide_error = 0.0; // of drawn strands that follow guides that far apart
    double predicted() const; // of what is simulated: time and nodes, as independent errors add
    std::string said;         // what was chosen and what the style pins, in a sentence; empty: nothing was asked for
};

// All of it in lines for people: what was chosen, what error is predicted, and what each choice would cost.
std::string quality_text(const Quality& quality);

// The style as it is to be simulated: whatever it leaves unsaid and bears on accuracy (kTolerant) as coarse as
// quality.tolerance allows, the cheapest that the tables of `coif measure` say will do. What it says itself is pinned.
// Of the solvers the direct one is cheaper at any accuracy, so pbd is only where a style says so: then nothing is
// chosen or predicted, because no number of its iterations bounds its error. Without a tolerance, the style as it is.
// `assets` are the style's. Throws Error as grow() and Solver do.
Hairstyle meet_tolerance(const Device& device, const Hairstyle& style, Assets& assets, Quality& quality);

// The error of these parameters over the first `seconds` of a motion, measured: sixteen guides against themselves at
// eight times the substeps, as a fraction of the strand's length. `params` as authored. Throws Error as Solver does.
double measure_time_error(const Device& device, const HairParams& params, const Groom& groom, const Motion& motion,
                          double seconds);

// What half the nodes would change of this hair: of up to sixteen of its blocks that rest for half a second and shake
// for two and a half, against themselves with all nodes. Rms over nodes at the worst time, or over time in the worst
// block, and a quarter; as a share of the length. `params` as authored. Throws Error as Solver does.
double measure_thin_error(const Device& device, const HairParams& params, const Solver& hair);

// The error of drawn strands between so many guides on this scalp, free of contact, as a fraction of their length:
// predicted, by accuracy's second order in the guides' spacing (`coif measure --only A12`).
double error_of_guides(const HairParams& params, const Scalp& scalp, int guides);

} // namespace coif

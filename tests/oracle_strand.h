// What the direct solver's twin does to one strand in a substep: bending, lengths, and what happens where those fail.
#pragma once
#include "tests/oracle_direct.h"

namespace coif::oracle
{

// `of` floats of this size, rounded at random: each by up to a part in 2^24.
struct Rounder
{
    const Rounding& draw;
    double one(double of) const { return draw ? of * draw() / 16777216.0 : 0.0; }
    Vec operator()(double of) const { return draw ? Vec(one(of), one(of), one(of)) : Vec(0.0); }
};

struct Strand
{
    int n;
    int held; // nodes that are prescribed
    double rest;
    std::vector<Vec> x, v;
    std::vector<double> pull; // of the segment that ends at the node
};

// Of a node against the others; 1 over it, and 0 where it is prescribed.
double mass(int node, int nodes, double tip_mass);
double mobility(int node, const Strand& strand, double tip_mass);

// The implicit bending step, added to the momentum in `move`, which holds the moves of the prescribed nodes.
void bend(const Strand& strand, const DirectStep& step, const std::vector<Vec>& rest_bend, Vec along, Vec normal,
          double h, double gain_now, double gain_steady, std::vector<Vec>& move, const Rounder& round);

// The largest of | |d|^2 / l^2 - 1 |; infinite where it is no number.
double worst_residual(const Strand& strand, const std::vector<Vec>& a, const std::vector<Vec>& move);

// A round of Newton's method for |a + change| = l with corrections along a (SHAKE, Ryckaert et al. 1977).
void shake(Strand& strand, const std::vector<Vec>& a, std::vector<Vec>& move, double hg, double tip_mass,
           const Rounder& round);

// From the prediction: nodes farther than twice their place along the strand are fetched to there, over-relaxed sweeps
// with every second segment at once, then each node at its length from its parent (Mueller, Kim, Chentanez 2012).
// Returns whether the prediction was a number.
bool rescue(Strand& strand, std::vector<Vec>& move, double tip_mass, double& kept, const Rounder& round);

} // namespace coif::oracle

// The direct solver's twin: one step of it in plain double precision, written from the papers that the kernel cites.
// Every system of equations is filled in whole and solved by elimination; nothing is banded, nothing goes in blocks.
//
// What it takes over from the kernel is what makes results comparable: the rounds of Newton's method and their
// tolerance, the order of the sweeps that rescue a strand, the rounds of the walk out of bodies, and what is decided
// for sixteen strands alike.
#pragma once
#include "sim/motion.h"
#include "sim/solver.h"
#include "tests/oracle.h"

namespace coif::oracle
{

struct DirectStrands : Strands
{
    std::vector<double> multiplier; // [strand][node], of the segment that ends there, 1/s^2
    std::vector<double> tension;    // [strand], the largest multiplier of the last step
    std::vector<int> pace;          // [block of 16], 0 at the start, else 1 + pace of the last step
    std::vector<int> faults;        // [strand]
    std::vector<Vec> rest_bend;     // [strand][node], along tangent, normal and binormal
    std::vector<Vec> root_normal;   // [strand], in the head's frame
};

// All within a radius of a stretch, which for a sphere has no length.
struct Round
{
    Vec center; // one end, in the head's frame or in the world
    Vec axis;   // to the other
    double radius;
    bool on_head;
};

// Everything that one step is told. Gusts, grid and gravity are taken from `info`; drag, the head's way, stiffness and
// the acceleration that strands may hang in are worked out anew.
struct DirectStep
{
    bool bending = false, curled = false, wind = false, repulsion = false;
    std::vector<Round> bodies;
    bool on_grid = false; // a distance grid stands for the head; `info` places it
    Body grid;
    std::vector<Vec> gradient; // per voxel, in fixed-point units a voxel
    HairParams params;         // as the device reads them
    StepInfo info = {};
    Pose before;
    Substep now;
    bool teleport = false;
    Vec head_velocity{0.0};      // before the step
    double seconds_before = 0.0; // of the last step
    double tip_mass = 0.5;
    double reach = 0.0; // of the farthest root from the head's origin, m
};

// A number from -1 to 1, for every single operation that a float would round: with it the twin shows how far rounding
// may carry the result, strand by strand.
using Rounding = std::function<double()>;

// Moves the strands. Returns how close the choice of substeps was anywhere, as a fraction of what it hung on: floats
// decide alike only where this is well above their rounding.
double simulate_direct(DirectStrands& strands, const DirectStep& step, const Rounding& rounding = {});

// Mean velocity of a substep from that of the one before under drag b and force f: V' = keep V + gain f.
struct Drag
{
    double keep, gain;
};
Drag drag_over(double b, double seconds_before, double seconds);

} // namespace coif::oracle

#pragma once
#include "sim/solver.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace coif::stress
{

// The worst that was seen.
struct Figures
{
    double stretch = 0.0;     // |length / rest - 1| of a segment, less what a float cannot tell
    double penetration = 0.0; // m, of nodes 2 and outwards that could be outside
    double reach = 0.0;       // at the last look: distance of a node from its root, or from the body that holds that,
                              // against the strand's length
    bool finite = true;
    long resets = 0;
    long looks = 0;
    std::string where, where_inside; // the worst stretch and penetration
    std::string fault;               // why a strand was reset, or what was not finite
};
void add(Figures& sum, const Figures& more);

// An eye on a solver, step after step.
struct Watch
{
    Figures worst;
    std::vector<int> resets;      // seen so far, of each guide
    std::vector<double> grace;    // s, of each guide, until which it may be inside of a body
    std::vector<double> root_out; // m, of each guide: way of its root out of the bodies
    double time = 0.0;
    glm::dvec3 jumped{0.0};
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};
};

// Hair that starts inside of bodies leaves them at a bounded speed (kPushOut), and a node whose
// chain does not reach out of them cannot: neither counts as penetration.
void look(Watch& watch, const Solver& solver, const HairParams& params, double seconds);

// Every number that the step left, all nodes and lanes; with `drawn` those of the drawn strands too.
bool finite_everywhere(const Device& device, const Solver& solver, bool drawn, std::string& which);

} // namespace coif::stress

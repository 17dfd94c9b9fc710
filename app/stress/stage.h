#pragma once
#include "app/stress/watch.h"
#include "sim/simulation.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace coif::stress
{

// What all cases share.
struct Ground
{
    Device device; // with guards about its buffers
    std::filesystem::path folder;
    int seed = 1;
    long from = 0;      // number of the first random style
    long styles = 2000; // random ones
    bool keep = true;   // do the files in the folder stay?
    bool untimed = false;
    int jobs = 1;        // processes for the random ones
    std::string wish;    // what --device says
    double soak = 600.0; // s simulated
    bool quick = false;
    std::function<void(const std::string&)> say; // progress
};

// How a case went.
struct Outcome
{
    std::vector<std::string> faults; // what should not be, a sentence each; none: it passed
    Figures figures[2];              // of solver.kind
    std::string note;                // a figure worth knowing
};

// One row of the table.
struct Case
{
    const char* name;
    const char* expected;
    Outcome (*run)(const Ground& ground);
};

std::span<const Case> cases();

constexpr const char* kSolvers[] = {"direct", "pbd"};

// Hair all over a ball of 10 cm, leaning this way and that; no strand drawn.
Groom ball(int guides, int nodes, double length, int seed = 1);

// Strands side by side, 2 cm apart, that start along `direction`.
Groom row(int guides, int nodes, double length, glm::vec3 direction);

// Defaults for `kind` without what couples strands: then no grid is needed.
HairParams lone(int kind);

inline Pose pose(glm::dvec3 origin, double angle = 0.0, glm::dvec3 axis = {0, 1, 0})
{
    return {origin, glm::angleAxis(angle, axis), glm::dvec3(0.0)};
}

// One groom on a solver of its own, stepped by hand, with an eye on it at every step.
struct Trial
{
    HairParams params;
    Solver solver;
    Watch watch;
    double time = 0.0;

    Trial(const Ground& ground, const HairParams& params, const Groom& groom,
          const std::vector<Collider>& colliders = {}, const Pose& head = {});
    void step(const Pose& head, float seconds = 1.0f / 60.0f);
    void rest(int steps);
    std::vector<glm::dvec3> nodes() const; // guides only, strand after strand, relative to the head's origin, m
};

// Adds to the outcome what the figures of a trial of solver `kind` are beyond: everything finite; lengths and bodies
// kept by the direct solver; none farther from its root than it is long, about, for pbd, which must recover.
struct Bounds
{
    double stretch = 0.01;
    double penetration = 0.001; // m
    double reach = 1.5;         // pbd, at the end, of a strand's length
    long resets = 0;
};
void judge(Outcome& outcome, int kind, const std::string& what, const Figures& figures, const Bounds& bounds = {});
void judge(Outcome& outcome, const std::string& what, Trial& trial, const Bounds& bounds = {});

// Adds a fault unless it is as it should be.
void expect(Outcome& outcome, bool good, const std::string& fault);

} // namespace coif::stress

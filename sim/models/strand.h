// What the models of a strand share: its state, the forces that all of them take alike, and the frames.
#pragma once
#include "sim/median.h"
#include "sim/models/model.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace coif::study
{

// Masses are counted in those of an inner node, so that forces are accelerations but for the tip's.
struct Strand
{
    explicit Strand(const Scene& of);

    const Scene& scene;
    int links;
    double rest;               // length of a link, m
    double stiffness;          // E I, m^3/s^2 for masses of 1; 0 without gamma
    std::vector<glm::dvec3> x; // nodes 0 to links, m
    std::vector<glm::dvec3> v; // m/s
    std::vector<double> w;     // inverse masses; 0 for nodes that are held
    double kick = 0.5; // of the substep that forces act on velocities: half the first one, because then velocities
                       // stand half a substep behind positions (Verlet 1967), all of the others

    // Second differences x[i-1] - 2 x[i] + x[i+1] have the energy hinge(i) / 2 times their square (Bergou et al. A
    // quadratic bending model for inextensible surfaces. 2006); the one at the clamp stands for half a cell.
    double hinge(int i) const { return (i == 0 ? 2.0 : 1.0) * stiffness / (rest * rest * rest); }
    // The fixed node that clamps the strand, one link behind node 0 at `root`.
    glm::dvec3 clamp(glm::dvec3 root) const { return root - rest * glm::normalize(scene.direction); }
    // Gravity and wind, m/s^2.
    glm::dvec3 acceleration(int i) const;
};

// Linear drag over h seconds, exactly: v(h) = keep v + gain a for a constant acceleration a. Every force takes the same
// gain, or what rests would rest elsewhere with drag than without.
struct Drag
{
    Drag(double per_second, double h)
        : keep(std::exp(-per_second * h)), gain(per_second > 0.0 ? -std::expm1(-per_second * h) / per_second : h)
    {
    }
    double keep, gain;
};

// Where velocities and forces alone would take the nodes in h seconds, and the held ones where they are then.
// Velocities become those of this motion.
void predict(Strand& strand, double t, double h, std::vector<glm::dvec3>& to);

// Takes the nodes there, with the velocities of having gone there in h seconds; not those of node 0, which has none.
void arrive(Strand& strand, double h, const std::vector<glm::dvec3>& to);

// Out of the scene's sphere along its radius (thesis 5.1.2); upwards from its centre.
void push_out(const Strand& strand, std::vector<glm::dvec3>& nodes);

// Adds the torques E I / l times the angle between links that meet, twice that at the clamp: hinges (Rosenblum et al.
// 1991) as forces across the links' ends.
void add_hinges(const Strand& strand, const std::vector<glm::dvec3>& nodes, std::vector<glm::dvec3>& force);

// The force that stretches a spring by kGive where it carries the whole strand: as stiff as the spring models are.
constexpr double kGive = 0.01;
double spring_stiffness(const Strand& strand); // 1/s^2 for masses of 1

// Plays the scene in frames of `substeps` substeps: step(t, h) takes `strand` from t - h to t.
template <typename Step> Result play(Strand& strand, double fps, double seconds, int substeps, Step step)
{
    Result result;
    const int frames = int(std::lround(seconds * fps));
    const double h = 1.0 / (fps * substeps);
    std::vector<double> ns;
    result.frames.push_back(strand.x);
    for (int frame = 0; frame < frames && result.finite; ++frame)
    {
        const auto start = std::chrono::steady_clock::now();
        for (int s = 1; s <= substeps; ++s)
            step((frame + double(s) / substeps) / fps, h);
        ns.push_back(std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
        for (int i = 1; i <= strand.links; ++i)
        {
            const double length = glm::distance(strand.x[i], strand.x[i - 1]);
            result.finite = result.finite && std::isfinite(length);
            result.stretch = std::max(result.stretch, std::abs(length / strand.rest - 1.0));
        }
        if (result.finite)
            result.frames.push_back(strand.x);
    }
    result.ns = median(ns);
    return result;
}

} // namespace coif::study

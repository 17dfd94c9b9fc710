// How else a strand of hair can be simulated: the models that the literature offers, one after another on the same
// strand, so that coif's own solver can be judged by what it gives for its time. Plain C++ in double precision, written
// to be read and compared; nothing of coif's own simulation knows of them.
#pragma once
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coif::study
{

// One strand: node 0 follows `root`, nodes 1 to `links` are free and start at rest.
struct Scene
{
    int links = 15;
    double length = 0.30;  // of all links together, m
    double drag = 0.0;     // 1/s: the still air takes drag times a node's velocity off it each second
    double gravity = 9.81; // m/s^2, along -y
    double tip_mass = 1.0; // of the last node, against 1 of the others; 0.5 where nodes stand for the links about them
    double gamma = 0.0;    // rho g S L^3 / (E I), weight against bending stiffness; 0: none, the strand is a chain.
                           // With it the strand is clamped: a fixed node lies one link behind node 0
    double bending = 0.5;  // instead of gamma where a model knows no material: strength, 0 to 1 (thesis eq. 5.6)
    glm::dvec3 direction{0.0, -1.0, 0.0}; // of the straight strand at the start, and of the clamp
    std::vector<glm::dvec3> start;        // nodes 0 to links at the start, if they are not straight along `direction`
    // Node 0 at a time (s). Models that need its velocity ask for it shortly before 0 and between substeps, too.
    std::function<glm::dvec3(double)> root = [](double) { return glm::dvec3(0.0); };
    std::optional<glm::dvec3> tip;    // where the last node is held
    std::optional<glm::dvec3> wind;   // m/s^2 on hair across it, less by the sine of the angle to it (thesis eq. 5.2)
    std::optional<glm::dvec4> sphere; // that nodes stay out of: centre and radius, m
};

struct Result
{
    std::vector<std::vector<glm::dvec3>> frames; // all nodes, frame after frame from time 0; ends where not finite
    double stretch = 0.0;                        // the worst of any link in any frame, shortening too; 0.01 is 1 %
    double ns = 0.0;                             // of one thread for a frame, the median
    bool finite = true;                          // links that have flown apart may be finite still: see stretch
};

enum class Bending
{
    none,     // gamma is ignored
    strength, // Scene::bending, so that what it does depends on the knob and on the time step
    material  // gamma
};

struct Model
{
    const char* name;
    const char* source;     // the paper
    const char* knob;       // what is traded: "iterations" a frame or "substeps" a frame
    std::vector<int> knobs; // worth comparing, from the cheapest
    Bending bending;
    bool holds_tip; // heeds Scene::tip
    bool collides;  // heeds Scene::sphere
    Result (*run)(const Scene& scene, double fps, double seconds, int knob);
};

// The model of a name, and all of them in the order of their papers.
const Model& model(const std::string& name); // throws Error naming the models there are
const std::vector<Model>& models();

} // namespace coif::study

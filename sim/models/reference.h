// Scenes whose answer is known, and how far a model's answer is from it. The files they name are described in
// tests/reference/README.md.
#pragma once
#include "sim/models/model.h"

#include <filesystem>
#include <string>
#include <vector>

namespace coif::study
{

using Frames = std::vector<std::vector<glm::dvec3>>; // nodes, frame after frame

struct Reference
{
    std::string name; // of the file: chain15_<name>.csv
    Scene scene;
    double fps;
    double seconds; // as long as two trustworthy integrators agree: after that weakly damped hair is chaotic
};

// A chain of 15 links: shaken by 5 cm at 1.5 Hz, carried around a quarter of a circle in 0.3 s, let go at 30 and at 90
// degrees.
const std::vector<Reference>& references();
const Reference& reference(const std::string& name); // throws Error naming the references there are

// Columns: time, then x, y, z of each node; one line of headings. Throws Error for a file that is otherwise.
Frames read_frames(const std::filesystem::path& csv);

struct Difference
{
    double rms, worst; // over nodes 1 and up and all frames but the first, in lengths of the strand
};

// Of as many nodes. Infinite where `frames` ends first.
Difference compare(const Frames& frames, const Frames& reference, double length);

// A strand clamped horizontally, with half a tip mass and enough drag to come to rest within some seconds (Romero et
// al. Physical validation of simulators in computer graphics. 2021: the cantilever test).
Scene cantilever(int links, double gamma);
// The tip's drop against its reach, from node 0, in the last frame.
double droop(const Frames& frames);

} // namespace coif::study

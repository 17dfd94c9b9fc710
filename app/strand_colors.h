#pragma once
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace coif
{

// Colours that tell something of the drawn strands: one value a node, and what the ends of the scale stand for. Another
// thing to tell is a label more in render.colors and a case in strand_colors().
struct StrandColors
{
    std::vector<float> value;          // [strand][node], 0 to 1 on the ramp; empty: the hair has its own colours
    std::string title;                 // of the legend
    std::vector<std::string> readings; // along the scale, from 0 to 1, evenly
};

// What render.colors asks for, of the last finished picture: views of the drawn nodes and of the guides.
StrandColors strand_colors(const Simulation& simulation, const Mapped& drawn, const Mapped& guides);

// The ramp from 0 to 1, linear: dark blue, teal, yellow, red. Equally far apart to the eye, and to most of those that
// do not tell red from green.
glm::vec3 ramp_color(float value);

// Where the two kinds of drawn strands stand on the ramp.
constexpr float kMixedPlace = 0.3f, kCopyPlace = 0.8f;

// How far each segment that ends in a guide's node is stretched or squeezed, as a fraction: [guide][node].
std::vector<float> guide_stretch(const Simulation& simulation, const float* guides);

} // namespace coif

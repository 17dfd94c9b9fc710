#pragma once
#include "app/shading.h"
#include "app/skin.h"
#include "sim/simulation.h"

#include <cmath>

namespace coif
{

// A level above LOOK_KAJIYA_KAY and what it is expected to leave out, as a share of the hair's light.
struct LevelError
{
    int level;
    double left_out;
};

// The simulation's hair as it was drawn last, under the style's lights. `waves`: wave_table() of its parameters;
// `skin`: skin_places() of its head.
LitScene lit_scene(const Simulation& simulation, std::vector<float> waves, const std::vector<SkinPlace>& skin);
LitScene lit_scene(const Simulation& simulation);

// Of the scene that `shading` has followed the light of, from the cheapest to the dearest.
std::vector<LevelError> level_errors(Shading& shading);

// look.level, or where that is left to a rule the cheapest level that leaves out no more than look.tolerance.
int chosen_level(const HairParams& params, const std::vector<LevelError>& errors);

const char* level_name(int level);

// Follows a scene's light anew and colours its strands at a level above LOOK_KAJIYA_KAY. Gives the passes of light, and
// before them "frame", which is all of it, and "look_shade", the colours.
PassTimes time_level(Shading& shading, const LitScene& scene, glm::vec3 eye, int level);

// ms on the device, medians. Not a number for LOOK_KAJIYA_KAY, whose light is part of the simulation and of drawing.
struct LevelCost
{
    double light_ms = NAN, shade_ms = NAN;
    double ms() const { return light_ms + shade_ms; }
};
LevelCost cost_of_level(Shading& shading, const LitScene& scene, glm::vec3 eye, int level);

} // namespace coif

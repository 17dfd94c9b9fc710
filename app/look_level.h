#pragma once
#include "app/shading.h"
#include "sim/simulation.h"

namespace coif
{

// A level above LOOK_KAJIYA_KAY and what it is expected to leave out, as a share of the hair's light.
struct LevelError
{
    int level;
    double left_out;
};

// The simulation's hair as it was drawn last, under the style's lights.
LitScene lit_scene(const Simulation& simulation);

// Of the scene that `shading` has followed the light of, from the cheapest to the dearest.
std::vector<LevelError> level_errors(Shading& shading);

// look.level, or where that is left to a rule the cheapest level that leaves out no more than look.tolerance.
int chosen_level(const HairParams& params, const std::vector<LevelError>& errors);

const char* level_name(int level);

} // namespace coif

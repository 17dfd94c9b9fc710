// What `coif report` says of the look: the level, what each level costs, and how far it is from traced light.
#pragma once
#include "app/look_error.h"
#include "app/look_level.h"
#include "app/progress.h"

#include <string>
#include <vector>

namespace coif
{

struct LevelReport
{
    int level = LOOK_KAJIYA_KAY;
    LevelCost cost = {};
    double left_out = NAN; // as expected; not told of Kajiya-Kay
    Likeness like = {};    // where light was traced
};

// The levels of the look for hair as it lies.
struct LookReport
{
    int chosen = LOOK_KAJIYA_KAY;
    std::vector<LevelReport> levels;
    LookTruth truth; // no samples: none was asked for
};

// Traces so many samples a pixel, or none, in the style's own light and camera. Throws Error.
LookReport report_look(Simulation& simulation, int samples, const Progress& progress);

std::string text_of(const LookReport& look); // a line a level
std::string json_of(const LookReport& look); // an object

// Of the chosen level, as the end of a row of CSV; fields are empty for what was not measured.
constexpr const char* kLookColumns = "look,look_ms,look_radiance_red,look_radiance_green,look_radiance_blue,look_off";
std::string row_of(const LookReport& look, bool untimed);

} // namespace coif

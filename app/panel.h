#pragma once
#include "sim/hairstyle.h"

#include <map>
#include <string>

namespace coif
{

// Where the panel drew each parameter's widget, in the window's pixels: left, top, right, bottom.
struct WidgetPlace
{
    float left, top, right, bottom;
};

struct PanelState
{
    std::map<std::string, WidgetPlace> places; // of the last frame, by path
    char filter[64] = {};                      // shows only what contains it
};

// One widget for each parameter, grouped as in kernels/params.def, and the colliders' list. What differs from the
// default is marked and has a button that takes it back; what the chosen solver does not read is greyed and says so.
// True when something changed; the values lie in their ranges.
bool draw_params_panel(Hairstyle& style, PanelState& state);

} // namespace coif

#pragma once
#include "sim/hairstyle.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace coif
{

// Where the panel drew each parameter's widget, in the window's pixels: left, top, right, bottom.
struct WidgetPlace
{
    float left, top, right, bottom;
};

// Of the widget that was just drawn, greyed or not: where it lies, and what is told of it to a mouse that rests there.
WidgetPlace last_widget();
void explain(const std::string& text);
void keep_in_view(float width, float height); // moves the window that is being drawn so that all of it is seen

struct PanelState
{
    std::map<std::string, WidgetPlace> places; // of the last frame, by path
    char filter[64] = {};                      // shows only what has it in its name or its help
    std::set<std::string> folded;              // groups
    std::set<std::string> locked;              // parameters that chance leaves alone, by path
    int seed = 1;                              // of the next throw
    float amount = 0.3f;                       // how far it goes: a share of the sliders
    std::string done;                          // what the last change was, where it has a name of its own
    size_t light = 0;                          // the chosen one
    std::vector<std::string> light_names;      // of files, while they are offered
    enum
    {
        NOTHING,
        EDIT_LIGHTS,
        SAVE_LIGHTS,
        MEASURE_LOOK
    } asked = NOTHING;                 // of the lights and the look, by a button
    std::string look_cost, look_error; // of the level that is shown: told under look.level; empty: nothing is known
    bool look_measured = false;        // just now
};

// One widget for each parameter, grouped as in kernels/params.def, and the colliders' list. What differs from the
// default is marked and has a button that takes it back; what the chosen solver does not read is greyed and says so.
// Above them the search and the throw of the dice. True when something changed; the values lie in their ranges.
bool draw_params_panel(Hairstyle& style, PanelState& state);

} // namespace coif

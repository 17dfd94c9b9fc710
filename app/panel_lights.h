#pragma once
#include "app/panel.h"

namespace coif
{

// Which file of lights the style shares: a choice of those that are beside it and of those that coif ships. True when
// it was changed.
bool draw_light_chooser(Hairstyle& style, PanelState& state, const char* id);

// Buttons that ask for its lights to become the style's own, and for those on screen to be saved as a file.
void draw_light_buttons(const Hairstyle& style, PanelState& state);

// Under look.level: what the level that is shown costs, and a button that measures its error.
void draw_look_cost(PanelState& state);

} // namespace coif

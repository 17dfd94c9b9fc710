#pragma once
#include "app/panel.h"
#include "sim/hairstyle.h"

namespace coif
{

// Widgets for one list of a style, entry by entry, by the fields that sim/lists.h declares. True when something
// changed; what is left is as a file may say it. Of lights one is chosen.
bool draw_list(HostParams& host, const ParamInfo& info, PanelState& state);

// "region 1", or with the first number that none has yet.
std::string unused_region(const std::vector<Region>& regions);

} // namespace coif

#pragma once
#include "sim/hairstyle.h"

#include <set>
#include <string>

namespace coif
{

// Is it part of what chance may change: what shapes and colours the hair, as the chosen solver reads it?
bool is_left_to_chance(const ParamInfo& info, const HairParams& params);

// The style with those of its values drawn anew that are not locked: within `amount` (0 to 1) of their sliders about
// where they were. Equal seeds give equal styles, and what one value becomes does not hang on which others are locked.
Hairstyle randomised(const Hairstyle& style, int seed, double amount, const std::set<std::string>& locked);

// Where a value stands on a slider from 0 to 1, and back. Ranges over several powers of ten are logarithmic about the
// usual value.
double slider_place(const ParamInfo& info, double value);
double slider_value(const ParamInfo& info, double place);

} // namespace coif

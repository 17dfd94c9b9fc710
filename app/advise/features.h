#pragma once
#include "sim/hairstyle.h"

#include <string>
#include <vector>

namespace coif
{

// One thing that a style does and could do without or with less of; or does not do, and might want. What it is, is an
// edit of the style; nothing about it has been measured.
struct Feature
{
    std::string name;    // "repulsion"
    Hairstyle style;     // the style without it; one that is lacked: with it
    bool lacked = false; // does the style lack it?
};

// What the style uses of what costs coif work, each left out or one step cheaper: forces, bodies and passes that a
// style can switch off, and counts that it can lower. Only what this style really does: no gusts without wind, no grid
// unless something reads it. `windy`: the motion brings wind. Parameters as authored.
std::vector<Feature> used_features(const Hairstyle& style, bool windy);

// What it does without though coif's defaults have it, and counts that it could raise, each by one step.
std::vector<Feature> lacked_features(const Hairstyle& style, bool windy);

// The feature with one step less of it still; its style is the same as before if there is none.
Feature further(const Feature& feature);

// `style` with all that sets `changed` apart from `from`.
Hairstyle with_changes(Hairstyle style, const Hairstyle& from, const Hairstyle& changed);

// What sets two styles apart, as TOML says it: "forces.repulsion = 0.0, grid.blur = 0.0".
std::string changes_text(const Hairstyle& from, const Hairstyle& changed);

} // namespace coif

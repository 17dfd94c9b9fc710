// Lights that styles share: a TOML file of [[light]] tables and a [sky], which look.lights names.
#pragma once
#include "sim/hairstyle.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coif
{

// What is not said is not there: without [sky] all light comes from the suns, without [[light]] from the sky.
struct LightRig
{
    std::vector<Light> lights;
    Sky sky;
    bool operator==(const LightRig&) const = default;
};

// Throws Error as load_hairstyle(), also for a file that holds neither.
LightRig load_lights(const std::filesystem::path& file);

// Of the file that look.lights names; none if it names none. Throws Error with the place in the style.
std::optional<LightRig> named_lights(const Hairstyle& style);

// Saves beside the target and renames over it, as save_hairstyle(); of lights that are there, comments stay.
void save_lights(const LightRig& rig, const std::filesystem::path& target);

// What look.lights may say for a style in that folder: the lights beside it and in its folder `lights`, and those that
// coif ships.
std::vector<std::string> light_names(const std::filesystem::path& folder);

// The one light that look.light_* says, bright or not.
Light only_light(const HairParams& params);

// The lights that the style says itself, look.lights apart.
LightRig own_lights(const Hairstyle& style);

// Makes these the style's own in place of what it had, so that it names no file.
void set_own_lights(Hairstyle& style, const LightRig& rig);

} // namespace coif

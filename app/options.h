#pragma once
#include "sim/hairstyle.h"
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace coif
{

// What the commands share.
struct Options
{
    std::string style;             // file, or the name of a preset; empty: the default preset
    std::vector<std::string> sets; // group.key=value
    std::string variant;           // [variant.NAME] to be on
    std::string tolerance;         // "1%": quality.tolerance
    int random = -1;               // the style that chance makes of it by this number; -1: itself
    std::string device;            // cpu, gpu or a part of a name
    std::string output;
    std::string motion = "still";
    double seconds = 2.0;
};

// The file of a style given by path, or by the name of a preset that coif ships. Throws Error naming the presets.
std::filesystem::path find_style(const std::string& name_or_path);
std::vector<std::filesystem::path> preset_files(); // that coif ships, in alphabetical order

// Loads the style, lets chance have its way and applies --set, which has the last word.
Hairstyle load_style(const Options& options);

Device open_device(const Options& options);

// What --only asks for, as indices of `names` in rising order; all if it asks for nothing. Throws Error naming them all
// where it asks for another; `what` says what they are, such as "scene".
std::vector<size_t> selected(const std::vector<std::string>& only, const std::vector<std::string>& names,
                             const char* what);

} // namespace coif

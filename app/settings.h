#pragma once
#include <filesystem>
#include <set>
#include <string>

namespace coif
{

// How the editor was arranged, kept between runs: coif's own lines, and where Dear ImGui's windows lay.
struct Settings
{
    int width = 0, height = 0; // of the window; 0: never said
    bool panel = true, history = false, browser = false;
    bool give_way = true;                 // app/leeway.h
    std::set<std::string> folded, locked; // groups of the panel; parameters that chance leaves alone
    std::string windows;                  // Dear ImGui's own text, windows only
    bool operator==(const Settings&) const = default;
};

// Whatever the text holds: what is not understood is left out.
Settings parse_settings(const std::string& text);
std::string settings_text(const Settings& settings);

// A file that is not there or cannot be read is as an empty one.
Settings load_settings(const std::filesystem::path& file);

// Makes the folder too. Throws Error when it cannot be written.
void save_settings(const std::filesystem::path& file, const Settings& settings);

} // namespace coif

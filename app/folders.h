#pragma once
#include <filesystem>

namespace coif
{

// Where coif keeps what is nobody's file, after the XDG Base Directory Specification; empty if the system names no
// place. sim/distance_grid.h has the one for what can be made again.
std::filesystem::path
state_folder(); // what a crash must not take along: $XDG_STATE_HOME/coif, else ~/.local/state/coif
std::filesystem::path recovery_folder(); // in it
std::filesystem::path config_folder();   // how the window was arranged: $XDG_CONFIG_HOME/coif, else ~/.config/coif

} // namespace coif

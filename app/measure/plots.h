#pragma once
#include "app/measure/rows.h"

#include <filesystem>
#include <string>
#include <vector>

namespace coif
{

// A figure as a gnuplot script: its data and how to draw them, for any terminal.
struct Plot
{
    std::string name;  // of its files, without an ending
    int width, height; // pixels
    std::string data;  // named blocks: $name << END
    std::string body;  // commands
};

// The figures that these rows give; those without data are left out.
//   error_cost      error against cost, a panel a scene, one line a solver, the Pareto front drawn
//   order           error against step, with slopes of order 1 and 2
//   cantilever      the master curve of the cantilever with our points on it (scene A8, measured H/W over Gamma)
//   picture         SSIM over hair against milliseconds
//   knobs           small multiples: the error over each knob's value
std::vector<Plot> plots_of(const std::vector<Row>& rows);

// Writes plots/<name>.gp into `folder`, and .svg and .png if gnuplot is there. Returns what to tell the user if it is
// not, or could not draw; empty if all is well.
std::string write_plots(const std::filesystem::path& folder, const std::vector<Plot>& plots);

} // namespace coif

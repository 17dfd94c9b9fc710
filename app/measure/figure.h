#pragma once
#include "app/measure/plots.h"

#include <string>
#include <vector>

namespace coif
{

// A figure before it is a script: panels of series, laid out and dressed all alike.
struct Series
{
    enum Kind
    {
        LINE_AND_POINTS,
        LINE,   // a reference or a theory
        POINTS, // measurements beside a theory
        STAIR,  // a Pareto front: what is reached at a cost, until it is bettered
        GUIDE,  // a slope to compare with
        STAR    // one point that stands for itself
    };
    std::string title;
    Kind kind = LINE_AND_POINTS;
    int color = 0; // which of the palette's
    std::vector<double> x, y;
    std::vector<std::string> labels; // beside the points; or none
};

struct Panel
{
    std::string title, x_label, y_label;
    bool log_x = false, log_y = false;
    std::vector<Series> series;
};

// The script's parts.
Plot figure(const std::string& name, const std::vector<Panel>& panels);

} // namespace coif

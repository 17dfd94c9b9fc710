#pragma once
#include "app/options.h"
#include "sim/lab.h"

namespace coif
{

struct LabOptions
{
    LabStrand strand; // angle in degrees here
    double drag = 0.0;
    double gamma = 0.0; // 0: no bending
    std::string solver; // empty: the product's own
    std::string root;   // CSV; empty: the root stays
    double fps = 60.0;
};

// Writes the nodes over time as CSV. Returns the exit status.
int lab(const Options& options, const LabOptions& wanted, bool seconds_given);

} // namespace coif

#pragma once
#include "app/options.h"

namespace coif
{

struct StressOptions
{
    bool quick = false;
    std::vector<std::string> only; // names of cases; none: all
    long styles = -1;              // random ones; -1: as many as usual
    int seed = 1;
    double soak = -1.0; // s simulated; -1: as long as usual
};

// Plays the solvers' extremes with guards about every buffer, prints a table and writes stress.csv, stress.json, what
// failed and a heat map into the folder options.output. Returns the exit status: 1 if any case failed.
int run_stress(const Options& options, const StressOptions& wanted);

} // namespace coif

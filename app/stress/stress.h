#pragma once
#include "app/options.h"

namespace coif
{

struct StressOptions
{
    bool quick = false;
    std::vector<std::string> only; // names of cases; none: all
    long from = 0;                 // number of the first random style
    long styles = -1;              // random ones; -1: as many as usual
    bool untimed = false;          // no times in the tables
    int jobs = 1;                  // processes for the random styles
    int seed = 1;
    double soak = -1.0; // s simulated; -1: as long as usual
};

// Plays the solvers' extremes with guards about every buffer, prints a table and writes stress.csv, stress.json, what
// failed and a heat map into the folder options.output. Returns the exit status: 1 if any case failed. Into a .csv: the
// rows of the cases alone, or of the random styles if those are all, and 0 whatever they say, which is a task of a
// batch.
int run_stress(const Options& options, const StressOptions& wanted);

} // namespace coif

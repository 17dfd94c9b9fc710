#pragma once
#include "app/bench/machine.h"

#include <cmath>
#include <string>
#include <vector>

namespace coif
{

// One pass, or a whole frame, that was timed.
struct BenchRow
{
    std::string scene; // its id
    std::string what;  // a pass, or "frame": on the clock, with what the host does in between
    std::string note;  // of what kind the frame is: "wind, repulsion"
    int strands = 0;
    int cores = 0;                // compute units of the device
    double ms = NAN;              // of a frame, median
    double low = NAN, high = NAN; // its quartiles
    double bytes = NAN;           // that the pass has to read and write at least, of a frame
    double operations = NAN;      // on floating-point numbers, of a frame
    double baseline_ms = NAN;     // of the same by the thesis' way, in the same run
    double most_ms = NAN;         // what it shall reach
    double least_ratio = NAN;     // what baseline_ms / ms shall reach

    double ratio() const { return baseline_ms / ms; }
    double of_bandwidth(const Machine& machine) const { return bytes / (ms * 1e-3) / machine.bandwidth; }
    double of_peak(const Machine& machine) const { return operations / (ms * 1e-3) / machine.operations; }
    bool judged() const { return !std::isnan(most_ms) || !std::isnan(least_ratio); }
    bool reached() const { return !(ms > most_ms) && !(ratio() < least_ratio); }
};

std::string bench_table(const std::vector<BenchRow>& rows, const Machine& machine);
std::string bench_csv(const std::vector<BenchRow>& rows, const Machine& machine);
std::string bench_json(const std::vector<BenchRow>& rows, const Machine& machine);

} // namespace coif

// `coif bench`: what takes how long, against the machine's limits and against the thesis' own way.
#pragma once
#include "app/bench/rows.h"
#include "app/options.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace coif
{

struct BenchOptions
{
    bool quick = false;             // fewer repeats and sizes
    bool json = false, csv = false; // to standard output, instead of the table
    std::vector<std::string> only;  // ids of scenes; empty: all
};

// What a scene is given to work with.
struct Benching
{
    const Device& device;
    const Machine& machine;
    bool quick = false;
    std::function<void(const std::string&)> progress;
    std::filesystem::path folder; // of its results
};

// One scene of the bench. To add one, write its function and its line in bench.cpp.
struct BenchScene
{
    const char* id; // as --only takes it
    const char* title;
    std::vector<BenchRow> (*run)(const Benching&);
};

std::vector<BenchRow> bench_whole_head(const Benching& with); // 102,400 strands, all simulated
std::vector<BenchRow> bench_guides(const Benching& with);     // 4096 strands; 256 of which 4096 are drawn
std::vector<BenchRow> bench_thesis(const Benching& with);     // its kernel and its grid against ours
std::vector<BenchRow> bench_picture(const Benching& with);    // strands drawn either way
std::vector<BenchRow> bench_look(const Benching& with);       // light in hair, at each level
std::vector<BenchRow> bench_growth(const Benching& with);     // over the number of strands and of cores

std::vector<BenchRow> bench_start(const Benching& with); // from nothing to a picture

// Runs the scenes, writes bench.csv, bench.json and plots/ into options.output, and prints a table. Returns the exit
// status: 0, for no machine's speed is a fault.
int bench(const Options& options, const BenchOptions& wanted);

} // namespace coif

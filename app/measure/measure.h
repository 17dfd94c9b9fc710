#pragma once
#include "app/measure/rows.h"
#include "app/options.h"

#include <functional>

namespace coif
{

// What `coif measure` is asked for.
struct MeasureOptions
{
    bool quick = false;            // fewer points and shorter runs: under a minute
    std::vector<std::string> only; // ids of scenes; empty: all
    bool untimed = false;          // no prices
    int jobs = 1;                  // processes for the scenes; more than one only without prices
};

// What a scene is given to work with.
struct Measuring
{
    const Device& device;
    bool quick = false;
    std::function<void(const std::string&)> progress = [](const std::string&) {}; // what is being done now
    std::filesystem::path folder = {}; // for pictures of what is compared; empty: none are wanted
};

// One scene of the suite: what it measures and how. To add one, write its function and its line in scenes.cpp.
struct Scene
{
    const char* id;    // "A12", as --only takes it
    const char* title; // for the plots and the table
    std::vector<Row> (*run)(const Measuring&);
};
const std::vector<Scene>& scenes();

// What moves the guides under these parameters, as it stands in rows.
std::string solver_name(const HairParams& params);

// Runs the scenes and writes measure.csv, measure.json and plots/ into options.output; the table goes to standard
// output. Returns the exit status: 1 if a row misses its bound. Into a .csv: the rows alone, and 0 whatever they say,
// which is a task of a batch.
int measure(const Options& options, const MeasureOptions& wanted);

// The scenes, in files of their own.
std::vector<Row> measure_fall(const Measuring&);        // A1: closed_forms.cpp
std::vector<Row> measure_pendulum(const Measuring&);    // A2: closed_forms.cpp
std::vector<Row> measure_modes(const Measuring&);       // A3: closed_forms.cpp
std::vector<Row> measure_decay(const Measuring&);       // A4: closed_forms.cpp
std::vector<Row> measure_motion(const Measuring&);      // A5: trajectories.cpp
std::vector<Row> measure_small_swing(const Measuring&); // A5m: trajectories.cpp
std::vector<Row> measure_hang(const Measuring&);        // A6: rest.cpp
std::vector<Row> measure_wind(const Measuring&);        // A7: rest.cpp
std::vector<Row> measure_cantilever(const Measuring&);  // A8: rest.cpp
std::vector<Row> measure_catenary(const Measuring&);    // A9: rest.cpp
std::vector<Row> measure_order(const Measuring&);       // A10: trajectories.cpp
std::vector<Row> measure_energy(const Measuring&);      // A11: closed_forms.cpp
std::vector<Row> measure_twin(const Measuring&);        // A14: trajectories.cpp
std::vector<Row> measure_sag(const Measuring&);         // presets.cpp
std::vector<Row> measure_solvers(const Measuring&);     // one against another: sweeps.cpp, as all knobs of a strand
std::vector<Row> measure_iterations(const Measuring&);
std::vector<Row> measure_substeps(const Measuring&);
std::vector<Row> measure_courant(const Measuring&);
std::vector<Row> measure_rate(const Measuring&);
std::vector<Row> measure_nodes(const Measuring&);
std::vector<Row> measure_interpolation(const Measuring&); // A12: interpolation.cpp
std::vector<Row> measure_ratio(const Measuring&);         // copies against mixes: interpolation.cpp
std::vector<Row> measure_voxels(const Measuring&);        // A13: voxels.cpp
std::vector<Row> measure_grid(const Measuring&);          // grid resolution: voxels.cpp
std::vector<Row> measure_picture(const Measuring&);       // picture error: picture.cpp
std::vector<Row> measure_look(const Measuring&);          // levels of the look: look.cpp

} // namespace coif

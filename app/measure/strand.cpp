#include "app/measure/strand.h"

#include "sim/error.h"
#include "sim/material.h"
#include "sim/source.h"

#include <cmath>
#include <fstream>
#include <sstream>

namespace coif
{

namespace fs = std::filesystem;

std::vector<HairParams> product_solvers()
{
    std::vector<HairParams> all(2);
    all[0].solver_kind = 0;
    all[1].solver_kind = 1;
    return all;
}

bool is_default_solver(const HairParams& params) { return params.solver_kind == HairParams().solver_kind; }

LabStrand strand_of(const study::Scene& scene)
{
    LabStrand strand;
    strand.nodes = scene.links + 1;
    strand.length = scene.length;
    strand.tip_mass = scene.tip_mass;
    strand.angle = std::atan2(scene.direction.x, -scene.direction.y);
    if (scene.gamma > 0.0)
        strand.gamma = scene.gamma;
    strand.start = scene.start;
    strand.tip_held = scene.tip.has_value();
    return strand;
}

HairParams params_of(HairParams solver, const study::Scene& scene)
{
    solver.forces_drag = float(scene.drag);
    solver.forces_gravity = float(scene.gravity / kGravity);
    solver.forces_turbulence = 0.0f;
    if (scene.wind)
        solver.forces_wind = F4(float(scene.wind->x), float(scene.wind->y), float(scene.wind->z), 0.0f);
    return solver;
}

LabRun play(const Measuring& with, const HairParams& solver, const study::Scene& scene, double fps, double seconds)
{
    return run_lab(with.device, params_of(solver, scene), strand_of(scene), scene.root, seconds, fps);
}

fs::path reference_file(const std::string& name)
{
    const fs::path file = data_folder() / "tests" / "reference" / name;
    if (!fs::exists(file))
        throw fail("{}: this reference is missing; it comes with coif's sources. --only takes the scenes that need "
                   "none: A1, A2, A3, A4, A6, A11, A12, A13, A14, ratio, grid, picture",
                   file.string());
    return file;
}

std::vector<std::vector<double>> reference_table(const std::string& name)
{
    std::ifstream file(reference_file(name));
    std::string line, cell;
    std::getline(file, line);
    std::vector<std::vector<double>> rows;
    while (std::getline(file, line))
    {
        rows.emplace_back();
        std::istringstream cells(line);
        while (std::getline(cells, cell, ','))
            rows.back().push_back(std::strtod(cell.c_str(), nullptr));
    }
    return rows;
}

study::Frames reference_frames(const std::string& name, double fps, double seconds)
{
    study::Frames frames = study::read_frames(reference_file("chain15_" + name + ".csv"));
    frames.resize(std::min(frames.size(), size_t(std::lround(seconds * fps)) + 1));
    return frames;
}

Row strand_row(const char* scene, const std::string& setting, const char* metric, const HairParams& solver,
               double error, const char* unit, const std::string& reference, Bounds bounds)
{
    Row row;
    row.scene = scene;
    row.setting = setting;
    row.metric = metric;
    row.solver = solver_name(solver);
    row.error = error;
    row.unit = unit;
    row.reference = reference;
    if (is_default_solver(solver))
    {
        row.pass = bounds.pass;
        row.state_of_the_art = bounds.state_of_the_art;
    }
    return row;
}

study::Frames common_frames(const study::Frames& played, double fps, double other)
{
    const size_t every = size_t(std::max(1L, std::lround(fps / other)));
    study::Frames frames;
    for (size_t f = 0; f < played.size(); f += every)
        frames.push_back(played[f]);
    return frames;
}

} // namespace coif

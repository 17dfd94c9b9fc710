#include "app/bench/hair.h"

#include "app/statistics.h"
#include "sim/simulation.h"

#include <chrono>
#include <cmath>

namespace coif
{

BenchHair::BenchHair(const Device& device, const std::string& preset, const std::vector<std::string>& sets,
                     bool with_bodies)
    : motion_(find_motion("shake"))
{
    Options options;
    options.style = preset;
    options.sets = sets;
    const Hairstyle style = load_style(options);
    assets_ = load_assets(style);
    solver_ = std::make_unique<Solver>(device, style.params, grown(style, assets_), Pose{});
    if (!with_bodies)
        return;
    const PlacedGrid grid = head_grid(style, assets_);
    solver_->set_body(grid);
    solver_->set_colliders(all_colliders(style, assets_, grid.grid != nullptr));
}

void BenchHair::go_far()
{
    solver_->let_blocks_sleep(true); // it is kept awake
    solver_->set_view(View{{0.0, 0.0, 1e6}, {0.0, 0.0, -1.0}, 1.0});
    solver_->set_thin_error(0.0);
}

static PassTimes per_frame(PassTimes times, std::chrono::steady_clock::time_point begin, int count)
{
    const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - begin;
    for (auto& [pass, ms] : times)
        ms /= count;
    times.insert(times.begin(), {"frame", passed.count() / count});
    return times;
}

PassTimes BenchHair::frames(int count, bool drawn)
{
    solver_->take_times();
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i)
    {
        constexpr double kFrame = 1.0 / 60.0;
        const auto at = [&](double time) { return pose_at(motion_, std::fmod(time, motion_.seconds)); };
        const auto way = [&, from = time_](double share) { return at(from + share * kFrame); };
        solver_->keep_awake();
        solver_->step({{at(time_ + kFrame), time_ + kFrame, float(kFrame), way}});
        time_ += kFrame;
        if (drawn)
            solver_->draw();
    }
    return per_frame(solver_->take_times(), begin, count); // waits
}

PassTimes BenchHair::rest(double seconds)
{
    solver_->take_times();
    const auto begin = std::chrono::steady_clock::now();
    const int count = int(std::lround(60.0 * seconds));
    solver_->let_blocks_sleep(true);
    for (int i = 0; i < count; ++i)
    {
        time_ += 1.0 / 60.0;
        solver_->step({{solver_->head(), time_, 1.0f / 60.0f}});
    }
    return per_frame(solver_->take_times(), begin, count);
}

// How much of the grid its passes see to: kernels/grid_room.cl.
static double share_of_grid(const Solver& solver)
{
    const std::vector<int> room = read<int>(solver.device(), solver.buffers().at("room"), 6);
    double voxels = 1.0;
    for (size_t axis = 0; axis < 3; ++axis)
        voxels *= std::max(0, room[axis + 3] - room[axis]);
    return voxels / double(solver.buffers().at("density").getInfo<CL_MEM_SIZE>() / sizeof(int));
}

static bool keeps_to_room(const std::string& pass)
{
    return pass == "clear_density" || pass == "blur_density" || pass == "density_gradient";
}

std::map<std::string, double> traffic_of(const Solver& solver)
{
    std::map<std::string, double> bytes;
    const double share = share_of_grid(solver);
    for (const auto& [key, kernel] : solver.kernels())
        for (size_t i = 0; i < kernel.arguments.size(); ++i)
        {
            const std::string thin = "thin_" + kernel.arguments[i];
            const bool has_own = key.find("-D THIN=1") != key.npos && solver.buffers().contains(thin);
            bytes[kernel.name] +=
                (keeps_to_room(kernel.name) ? share : 1.0) * (kernel.writes[i] ? 2.0 : 1.0) *
                double(solver.buffers().at(has_own ? thin : kernel.arguments[i]).getInfo<CL_MEM_SIZE>());
        }
    return bytes;
}

// Additions, subtractions, multiplications, divisions, roots and comparisons, one each, of a lane that touches nothing
// and whose lengths are found at once.
static double of_direct(const Solver& solver, const std::string& options)
{
    const auto has = [&](const char* feature) { return options.find(feature) != options.npos; };
    double node_substep = 26.0 + 54.0 + 15.0 + 11.0; // prediction, lengths, residual, segments and moves
    double node_step = 50.0;                         // turned, checked, stored
    if (has("-D BENDING"))
    {
        node_substep += 22.0 + 27.0; // forces, solve
        node_step += 20.0;           // factors
    }
    if (has("-D CURLED"))
        node_substep += 110.0;
    if (has("-D BODY_GRID"))
    {
        node_substep += 28.0; // height over the plane
        node_step += 135.0;   // the plane; at its length, and clear of the head
    }
    if (has("-D WIND"))
    {
        node_substep += 30.0;
        node_step += 3.0 * 8.0 * 26.0; // components and corners of the noise
    }
    if (has("-D REPULSION"))
        node_step += 60.0;
    const Groom& groom = solver.groom();
    double substeps = 0.0;
    for (const int pace : read<int>(solver.device(), solver.buffers().at("pace"), size_t(groom.blocks)))
        substeps += double(substeps_of(pace - 1)) / groom.blocks;
    const int links = (groom.nodes - 2) / (has("-D THIN=1") ? 2 : 1);
    return double(groom.guides) * links * (substeps * node_substep + node_step);
}

std::map<std::string, double> operations_of(const Solver& solver)
{
    const double side = std::cbrt(double(solver.buffers().at("density").getInfo<CL_MEM_SIZE>() / sizeof(int)));
    const double voxels = side * side * side, in_room = share_of_grid(solver) * voxels;
    std::map<std::string, double> operations;
    for (const auto& [key, kernel] : solver.kernels())
        if (kernel.name == "simulate_direct")
            operations[kernel.name] += of_direct(solver, key);
        else if (kernel.name == "blur_density")
            operations[kernel.name] += in_room * (2.0 * (double(solver.info().light_box.x) + 1.0) + 5.0);
        else if (kernel.name == "density_gradient")
            operations[kernel.name] += in_room * 6.0;
        else if (kernel.name == "transmittance")
            operations[kernel.name] += voxels * 14.0;
    return operations;
}

std::vector<std::vector<BenchRow>> timed(const std::vector<std::function<PassTimes()>>& runs, int repeats)
{
    // By run, pass and repeat, in the order in which passes first come.
    std::vector<std::vector<std::pair<std::string, std::vector<double>>>> said(runs.size());
    for (int r = 0; r <= repeats; ++r)
        for (size_t i = 0; i < runs.size(); ++i)
            for (const auto& [pass, ms] : runs[i]())
            {
                if (r == 0) // kernels are built, caches filled
                    continue;
                auto found = std::find_if(said[i].begin(), said[i].end(), [&](auto& p) { return p.first == pass; });
                if (found == said[i].end())
                    found = said[i].insert(said[i].end(), {pass, {}});
                found->second.push_back(ms);
            }
    std::vector<std::vector<BenchRow>> rows(runs.size());
    for (size_t i = 0; i < runs.size(); ++i)
        for (const auto& [pass, ms] : said[i])
        {
            BenchRow row;
            row.what = pass;
            row.ms = percentile(ms, 0.5);
            row.low = percentile(ms, 0.25);
            row.high = percentile(ms, 0.75);
            rows[i].push_back(row);
        }
    return rows;
}

} // namespace coif

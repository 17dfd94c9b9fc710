#include "app/bench/hair.h"

#include "app/statistics.h"
#include "sim/simulation.h"

#include <chrono>

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
    PassTimes times = solver_->take_times(); // waits
    const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - begin;
    for (auto& [pass, ms] : times)
        ms /= count;
    times.insert(times.begin(), {"frame", passed.count() / count});
    return times;
}

std::map<std::string, double> traffic_of(const Solver& solver)
{
    std::map<std::string, double> bytes;
    for (const auto& [key, kernel] : solver.kernels())
        for (size_t i = 0; i < kernel.arguments.size(); ++i)
            bytes[kernel.name] += (kernel.writes[i] ? 2.0 : 1.0) *
                                  double(solver.buffers().at(kernel.arguments[i]).getInfo<CL_MEM_SIZE>());
    return bytes;
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

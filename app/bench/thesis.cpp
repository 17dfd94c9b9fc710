// The thesis' own kernels beside ours: the same strands, iterations and voxels, in turns.
#include "app/bench/hair.h"
#include "sim/models/baseline.h"

#include <fmt/format.h>

#include <algorithm>

namespace coif
{

static double ms_of(const PassTimes& times, const std::string& pass)
{
    double ms = 0.0;
    for (const auto& [name, spent] : times)
        ms += name == pass ? spent : 0.0;
    return ms;
}

// Its kernel on strands as long as these, about one sphere.
static study::BaselineSetup thesis_strands(const Groom& groom, int iterations)
{
    study::BaselineSetup setup;
    setup.nodes = groom.nodes;
    setup.iterations = iterations;
    setup.drag = 3.0f;
    setup.bending = 0.15f;
    const float radius = 0.5f * groom.extent;
    setup.spheres = {F4(0.0f, 0.0f, 0.0f, radius)};
    for (int s = 0; s < groom.guides; ++s)
    {
        const glm::vec3 root = glm::vec3(vector_at(groom.root_position.data(), s, 0, 1)) - groom.center;
        setup.roots.push_back(F4(root.x, root.y, root.z, groom.segment_length[size_t(s)]));
    }
    return setup;
}

namespace
{
// Its passes of the grid.
struct ThesisGrid
{
    ThesisGrid(const Device& device, int resolution) : device_(device), resolution_(size_t(resolution))
    {
        const size_t voxels = resolution_ * resolution_ * resolution_;
        for (const char* name : {"density", "blurred"})
            buffers_[name] = allocate(device, voxels * sizeof(int), "the thesis' grid");
        buffers_["gradient"] = allocate(device, voxels * sizeof(float4), "the thesis' grid");
        for (const char* name : {"clear_density", "blur_density", "density_gradient"})
            kernels_.push_back(
                load_kernel(device, std::string("baseline/") + name, fmt::format("-D RESOLUTION={}", resolution)));
    }

    PassTimes frames(int count)
    {
        PassTimes times;
        for (Kernel& kernel : kernels_)
        {
            std::vector<cl::Event> events;
            for (int i = 0; i < count; ++i)
                events.push_back(run(device_, kernel, buffers_, cl::NDRange(resolution_, resolution_, resolution_)));
            double ms = 0.0;
            for (const cl::Event& event : events)
            {
                event.wait();
                ms += double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                             event.getProfilingInfo<CL_PROFILING_COMMAND_START>()) *
                      1e-6 / count;
            }
            times.emplace_back(kernel.name, ms);
        }
        return times;
    }

  private:
    const Device& device_;
    size_t resolution_;
    Buffers buffers_;
    std::vector<Kernel> kernels_;
};
} // namespace

// Ours and theirs of one thing, as a row of ours.
static BenchRow compared(const std::vector<BenchRow>& ours, const std::vector<BenchRow>& theirs, const Benching& with,
                         std::vector<std::string> passes, double least_ratio)
{
    const auto sum = [&](const std::vector<BenchRow>& rows, double BenchRow::*value)
    {
        double all = 0.0;
        for (const BenchRow& row : rows)
            all += std::find(passes.begin(), passes.end(), row.what) != passes.end() ? row.*value : 0.0;
        return all;
    };
    BenchRow row;
    row.cores = with.machine.compute_units;
    row.ms = sum(ours, &BenchRow::ms);
    row.low = sum(ours, &BenchRow::low);
    row.high = sum(ours, &BenchRow::high);
    row.baseline_ms = sum(theirs, &BenchRow::ms);
    row.least_ratio = least_ratio;
    return row;
}

static std::vector<BenchRow> compare_strands(const Benching& with)
{
    const int iterations = 8;
    constexpr int kOurs = 24, kTheirs = 8; // frames in a row: of a few, half are over before the second core wakes
    const std::vector<std::string> sets = {
        "interpolation.guides=all", "interpolation.strands=4096", "look.self_shadow=0", "forces.repulsion=0",
        "solver.iterations=8",      "head.contact=spheres",       "head.spheres=\"\"",  "solver.kind=pbd"};
    std::vector<std::string> direct = sets;
    direct.back() = "solver.kind=direct";
    BenchHair ours(with.device, "bob", sets), better(with.device, "bob", direct);
    study::Baseline theirs(with.device, thesis_strands(ours.solver().groom(), iterations), glm::vec3(0.0f));
    const double strands = ours.strands();
    const auto step = [&, frame = 0]() mutable
    {
        double ms = 0.0;
        for (int i = 0; i < kTheirs; ++i)
            ms += theirs.step({0.05f * std::sin(0.16f * float(++frame)), 0.0f, 0.0f}) * strands * 1e-6 / kTheirs;
        return PassTimes{{"simulate", ms}};
    };
    const auto renamed = [](PassTimes times, const std::string& pass) {
        return PassTimes{{"simulate", ms_of(times, pass)}};
    };
    const auto times = timed({[&] { return renamed(ours.frames(kOurs, false), "simulate_pbd"); },
                              [&] { return renamed(better.frames(kOurs, false), "simulate_direct"); }, step},
                             with.quick ? 5 : 21);
    std::vector<BenchRow> rows = {compared(times[0], times[2], with, {"simulate"}, 6.0),
                                  compared(times[1], times[2], with, {"simulate"}, NAN)};
    rows[0].note = "8 iterations about a sphere";
    rows[0].what = "simulate_pbd";
    rows[1].note = "direct instead of 8 iterations";
    rows[1].what = "simulate_direct";
    for (BenchRow& row : rows)
        row.strands = ours.strands();
    return rows;
}

static std::vector<BenchRow> compare_grid(const Benching& with, int resolution)
{
    BenchHair ours(with.device, "bob", {"forces.repulsion=1", fmt::format("grid.resolution={}", resolution)});
    ThesisGrid theirs(with.device, resolution);
    const auto times =
        timed({[&] { return ours.frames(8, false); }, [&] { return theirs.frames(4); }}, with.quick ? 5 : 21);
    BenchRow row = compared(times[0], times[1], with, {"clear_density", "blur_density", "density_gradient"}, 10.0);
    row.note = fmt::format("{0} x {0} x {0} voxels", resolution);
    row.what = "passes of the grid";
    return {row};
}

std::vector<BenchRow> bench_thesis(const Benching& with)
{
    with.progress("strands");
    std::vector<BenchRow> rows = compare_strands(with);
    for (const int resolution : {64, 128})
    {
        with.progress("voxels");
        const std::vector<BenchRow> more = compare_grid(with, resolution);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    return rows;
}

} // namespace coif

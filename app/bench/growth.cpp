// Time over the number of strands, all simulated, on one core and on more.
#include "app/bench/hair.h"

#include <fmt/format.h>

namespace coif
{

std::vector<BenchRow> bench_growth(const Benching& with)
{
    std::vector<Device> devices;
    for (int cores = 1; cores < with.machine.compute_units; cores *= 2)
        devices.push_back(part_of(with.device, cores));
    devices.push_back(with.device);
    std::vector<int> sizes = {256, 1024, 4096, 16384, 102400};
    if (!with.quick)
        sizes = {256, 512, 1024, 2048, 4096, 8192, 16384, 32768, 65536, 102400};
    std::vector<BenchRow> rows;
    std::vector<std::vector<BenchRow>> of_device(devices.size());
    for (const int size : sizes)
    {
        with.progress(fmt::format("{} strands", size));
        std::vector<std::unique_ptr<BenchHair>> hair;
        std::vector<std::function<PassTimes()>> runs;
        const int frames = std::clamp(20000 / size, 4, 32);
        for (const Device& device : devices)
        {
            hair.push_back(std::make_unique<BenchHair>(
                device, "bob",
                std::vector<std::string>{"interpolation.guides=all", fmt::format("interpolation.strands={}", size),
                                         "look.self_shadow=0", "forces.repulsion=0", "wave.normal_amplitude=0",
                                         "wave.binormal_amplitude=0"}));
            runs.push_back([h = hair.back().get(), frames] { return h->frames(frames, false); });
        }
        const std::vector<std::vector<BenchRow>> times = timed(runs, with.quick ? 3 : 7);
        for (size_t d = 0; d < devices.size(); ++d)
        {
            BenchRow row = times[d].front(); // the whole frame
            row.strands = size;
            row.cores = int(devices[d].device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
            row.note = fmt::format("{} core{}", row.cores, row.cores == 1 ? "" : "s");
            of_device[d].push_back(row);
        }
    }
    for (const std::vector<BenchRow>& more : of_device)
        rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

} // namespace coif

#include "app/bench/machine.h"

#include "app/statistics.h"
#include "sim/error.h"
#include "sim/median.h"

#include <sys/utsname.h>

#include <fstream>

namespace coif
{

static double seconds_of(const cl::Event& event)
{
    event.wait();
    return double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                  event.getProfilingInfo<CL_PROFILING_COMMAND_START>()) *
           1e-9;
}

// The shortest of some runs: a limit is what the machine does when nothing disturbs it.
static double best_seconds(const Device& device, Kernel& kernel, const Buffers& buffers, size_t items)
{
    double best = INFINITY;
    for (int i = 0; i < 9; ++i)
        best = std::min(best, seconds_of(run(device, kernel, buffers, cl::NDRange(items))));
    return best;
}

static std::string processor_name()
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos)
            return line.substr(line.find(": ") + 2);
    return "";
}

Machine measure_machine(const Device& device)
{
    Machine machine;
    machine.device = device.name;
    machine.processor = processor_name();
    utsname system = {};
    if (uname(&system) == 0)
        machine.system = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
    machine.compute_units = int(device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    machine.width = device.width;

    const size_t width = size_t(device.width), floats = size_t(32) << 20, chains = 8, links = 4096, sums = 16384;
    Buffers buffers;
    for (const char* name : {"from", "to"})
    {
        buffers[name] = allocate(device, floats * sizeof(float), "measuring the memory");
        device.queue.enqueueFillBuffer(buffers[name], 1.0f, 0, floats * sizeof(float));
    }
    Kernel copy = load_kernel(device, "limits/copy", fmt::format("-D WIDTH={}", width));
    machine.bandwidth = 2.0 * double(floats * sizeof(float)) / best_seconds(device, copy, buffers, floats / width);

    buffers["sums"] = allocate(device, sums * sizeof(float), "measuring arithmetic");
    device.queue.enqueueFillBuffer(buffers["sums"], 0.5f, 0, sums * sizeof(float));
    Kernel adds = load_kernel(device, "limits/multiply_add",
                              fmt::format("-D WIDTH={} -D CHAINS={} -D LINKS={}", width, chains, links));
    machine.operations = 2.0 * double(chains * links * sums) / best_seconds(device, adds, buffers, sums / width);
    return machine;
}

Device part_of(const Device& device, int compute_units)
try
{
    const cl_device_partition_property wish[] = {CL_DEVICE_PARTITION_BY_COUNTS, compute_units,
                                                 CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    cl::Device whole = device.device;
    whole.createSubDevices(wish, &parts);
    Device part = device;
    part.device = parts.at(0);
    part.context = cl::Context(part.device);
    part.queue = cl::CommandQueue(part.context, part.device, CL_QUEUE_PROFILING_ENABLE);
    return part;
}
catch (const cl::Error& e)
{
    throw fail("{} cannot be divided: OpenCL error {} from {}", device.name, e.err(), e.what());
}

} // namespace coif

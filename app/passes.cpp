#include "app/passes.h"

#include <algorithm>

namespace coif
{

Passes::Passes(const Device& device_, std::string options, std::string purpose)
    : device(device_), options_(std::move(options)), purpose_(std::move(purpose))
{
}

cl::Buffer& Passes::room_for(const std::string& name, size_t bytes)
{
    size_t& held = bytes_[name];
    if (!buffers.contains(name) || held < bytes)
    {
        buffers.erase(name); // before the new one is asked for
        buffers[name] = allocate(device, std::max<size_t>(bytes, 1), purpose_);
        held = bytes;
    }
    return buffers[name];
}

void Passes::launch(const std::string& pass, const std::string& extra, size_t items)
{
    const size_t group = device.is_gpu && items > 1 ? 64 : 1;
    launch(pass, extra, cl::NDRange((items + group - 1) / group * group), cl::NDRange(group));
}

void Passes::launch(const std::string& pass, const std::string& extra, const cl::NDRange& items,
                    const cl::NDRange& group)
{
    const std::string key = pass + extra;
    if (!kernels_.contains(key))
        kernels_[key] = load_kernel(device, pass, options_ + " " + extra);
    launches_.emplace_back(pass, run(device, kernels_[key], buffers, items, group));
}

PassTimes Passes::take_times()
{
    device.queue.finish();
    PassTimes times;
    for (const auto& [pass, event] : launches_)
    {
        const double ms = 1e-6 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                        event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
        const auto known = std::ranges::find(times, pass, &PassTimes::value_type::first);
        if (known == times.end())
            times.emplace_back(pass, ms);
        else
            known->second += ms;
    }
    launches_.clear();
    return times;
}

} // namespace coif

#pragma once
#include "sim/solver.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace coif
{

// Passes that draw, on the device that simulates: their buffers by the name of the kernels' arguments, grown as they
// are asked for, their kernels, built when they are first launched, and what each has cost. Throws cl::Error and Error.
class Passes
{
  public:
    // `options` are those of all kernels; `purpose` is what an error says that memory was needed for.
    Passes(const Device& device, std::string options, std::string purpose);

    // At least so many bytes; what was in it is lost where it grows.
    cl::Buffer& room_for(const std::string& name, size_t bytes);
    template <typename T> void fill(const std::string& name, const std::vector<T>& values)
    {
        room_for(name, values.size() * sizeof(T));
        write(device, buffers[name], values);
    }
    // Work-items in groups of 64 on GPUs; on CPUs each is a group of its own, or PoCL would give few groups to one
    // core.
    void launch(const std::string& pass, const std::string& extra, size_t items);
    void launch(const std::string& pass, const std::string& extra, const cl::NDRange& items, const cl::NDRange& group);
    // Of all passes since the last call, ms; waits for the device.
    PassTimes take_times();
    void forget_times() { launches_.clear(); }

    Device device; // its handles: a device that is gone and another in its place are not taken for one
    Buffers buffers;

  private:
    std::string options_, purpose_;
    std::map<std::string, size_t> bytes_; // of the buffers that are our own
    std::map<std::string, Kernel> kernels_;
    std::vector<std::pair<std::string, cl::Event>> launches_;
};

} // namespace coif

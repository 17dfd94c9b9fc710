#pragma once
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace coif
{

// Buffers by the name that kernels' arguments give them.
using Buffers = std::map<std::string, cl::Buffer>;

// One kernel and the names of its arguments, which are the only statement of what it reads and writes.
struct Kernel
{
    std::string name;
    cl::Kernel handle;
    std::vector<std::string> arguments;
    std::vector<bool> writes; // to which of them it may write
};

// Bands before and behind every buffer that nothing may write to: what a kernel does outside of a buffer is seen.
struct Guards
{
    struct Band
    {
        cl::Buffer whole; // band, buffer, band
        size_t before, bytes, after;
        std::string purpose;
    };
    std::vector<Band> bands;
};

// One OpenCL device with an in-order queue.
struct Device
{
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue; // with profiling on
    std::filesystem::path kernel_folder;
    std::string name;
    bool is_gpu = false;
    // Strands a work-item moves at once. A rule, not a measurement, so that the same device gives the same bytes: 16 on
    // CPUs whose native float vector is 16 wide, 8 on other CPUs, 1 on GPUs (a work-item a strand, coalesced).
    int width = 1;
    std::shared_ptr<Guards> guards; // of the buffers allocated from now on; none: they have no bands
    // Kernels that were built, by file and options, for those who make many solvers of few kinds; none: each its own.
    std::shared_ptr<std::map<std::string, Kernel>> built;
};

// The device that `wish` names: "cpu", "gpu", a part of a device's name, or "" for the first GPU and else the first
// device of any kind. Throws Error naming the devices there are.
Device open_device(const std::string& wish, const std::filesystem::path& kernel_folder);

// The device, with nothing built or allocated on it yet, in another context, which has such properties beside its
// platform: names and their values. Throws cl::Error.
Device in_context(Device device, std::vector<cl_context_properties> properties);

// kernels/<file>.cl must define the kernel of its name: `kernel void <file>(...)`, without its folder. Throws Error
// with the compiler's words.
Kernel load_kernel(const Device& device, const std::string& file, const std::string& options);

// Sets the arguments by their names. Throws Error when a kernel asks for what is no buffer. Returns the launch's event.
cl::Event run(const Device& device, Kernel& kernel, const Buffers& buffers, cl::NDRange items, cl::NDRange group = {});

// Throws Error when the device does not take buffers of that size.
cl::Buffer allocate(const Device& device, size_t bytes, const std::string& purpose);

// What has been written outside of the guarded buffers since last asked, a sentence each. Waits for the device, mends
// the bands, and lets go of those whose buffer is gone.
std::vector<std::string> find_trespasses(const Device& device);

template <typename T> void write(const Device& device, const cl::Buffer& to, const std::vector<T>& from)
{
    if (!from.empty())
        device.queue.enqueueWriteBuffer(to, CL_TRUE, 0, from.size() * sizeof(T), from.data());
}

template <typename T> std::vector<T> read(const Device& device, const cl::Buffer& from, size_t count)
{
    std::vector<T> out(count);
    if (count)
        device.queue.enqueueReadBuffer(from, CL_TRUE, 0, count * sizeof(T), out.data());
    return out;
}

// A view of a buffer for the host, valid while it lives; no copy where device and host share memory.
class Mapped
{
  public:
    Mapped() = default;
    Mapped(const Device& device, const cl::Buffer& buffer, size_t bytes);
    ~Mapped();
    Mapped(Mapped&& other) noexcept { *this = std::move(other); }
    Mapped& operator=(Mapped&& other) noexcept;

    template <typename T> const T* as() const { return static_cast<const T*>(pointer_); }
    size_t bytes() const { return bytes_; }

  private:
    cl::CommandQueue queue_;
    cl::Buffer buffer_;
    void* pointer_ = nullptr;
    size_t bytes_ = 0;
};

} // namespace coif

#include "sim/device.h"

#include "sim/error.h"
#include "sim/program_cache.h"
#include "sim/source.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace coif
{

static bool matches(const cl::Device& device, const std::string& wish)
{
    const bool gpu = device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU;
    return wish.empty() || wish == (gpu ? "gpu" : "cpu") ||
           device.getInfo<CL_DEVICE_NAME>().find(wish) != std::string::npos;
}

static cl::Device pick_device(const std::string& wish)
{
    std::vector<cl::Platform> platforms;
    try
    {
        cl::Platform::get(&platforms);
    }
    catch (const cl::Error&)
    {
        // The loader reports an error when no platform is installed; told below.
    }
    std::vector<cl::Device> fitting;
    std::string names;
    for (const cl::Platform& platform : platforms)
    {
        std::vector<cl::Device> devices;
        try
        {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        }
        catch (const cl::Error&)
        {
            continue; // a platform without a device
        }
        for (const cl::Device& device : devices)
        {
            names += (names.empty() ? "" : ", ") + device.getInfo<CL_DEVICE_NAME>();
            if (device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() && matches(device, wish))
                fitting.push_back(device);
        }
    }
    if (names.empty())
        throw fail("no OpenCL device answers; on Debian: apt-get install pocl-opencl-icd, and where that is there, see "
                   "that PoCL may write its kernels: into ~/.cache/pocl, or where POCL_CACHE_DIR says");
    if (fitting.empty())
        throw fail("no OpenCL device matches '{}'; there are: {}", wish, names);
    for (const cl::Device& device : fitting)
        if (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU)
            return device;
    return fitting.front();
}

Device in_context(Device device, std::vector<cl_context_properties> properties)
{
    const cl_platform_id platform = device.device.getInfo<CL_DEVICE_PLATFORM>();
    properties.insert(properties.end(), {CL_CONTEXT_PLATFORM, cl_context_properties(platform), 0});
    device.context = cl::Context(device.device, properties.data());
    device.queue = cl::CommandQueue(device.context, device.device, CL_QUEUE_PROFILING_ENABLE);
    return device;
}

Device open_device(const std::string& wish, const std::filesystem::path& kernel_folder)
try
{
    Device result;
    result.device = pick_device(wish);
    result = in_context(result, {});
    result.kernel_folder = kernel_folder;
    result.name = result.device.getInfo<CL_DEVICE_NAME>();
    result.is_gpu = result.device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU;
    if (!result.is_gpu)
        result.width = result.device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>() >= 16 ? 16 : 8;
    return result;
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {}", e.err(), e.what());
}

static cl::Program compiled(const Device& device, const ProgramSource& source, const std::filesystem::path& path)
try
{
    return compiled_program(device, source);
}
catch (const Error& e)
{
    throw fail("{} does not compile:\n{}", path.string(), e.what());
}

static Kernel kernel_of(const cl::Program& program, const std::string& name)
{
    Kernel kernel;
    kernel.name = name;
    kernel.handle = cl::Kernel(program, name.c_str());
    const cl_uint count = kernel.handle.getInfo<CL_KERNEL_NUM_ARGS>();
    for (cl_uint i = 0; i < count; ++i)
    {
        std::string argument = kernel.handle.getArgInfo<CL_KERNEL_ARG_NAME>(i);
        kernel.arguments.push_back(argument.c_str()); // some drivers count the final zero
        kernel.writes.push_back(
            kernel.handle.getArgInfo<CL_KERNEL_ARG_ADDRESS_QUALIFIER>(i) == CL_KERNEL_ARG_ADDRESS_GLOBAL &&
            !(kernel.handle.getArgInfo<CL_KERNEL_ARG_TYPE_QUALIFIER>(i) & CL_KERNEL_ARG_TYPE_CONST));
    }
    return kernel;
}

Kernel load_kernel(const Device& device, const std::string& file, const std::string& options)
{
    const std::string known = file + " " + options;
    if (device.built && device.built->contains(known))
        return device.built->at(known);
    const std::filesystem::path path = device.kernel_folder / (file + ".cl");
    // Denormals run 34 times slower on PoCL; -cl-fast-relaxed-math would fold away isfinite.
    const ProgramSource source = {load_source(path), "-cl-std=CL1.2 -cl-kernel-arg-info -cl-denorms-are-zero "
                                                     "-cl-mad-enable -cl-no-signed-zeros " +
                                                         options};
    std::optional<Kernel> kernel;
    if (const std::optional<cl::Program> stored = stored_program(device, source))
        try
        {
            kernel = kernel_of(*stored, path.stem().string());
        }
        catch (const cl::Error&)
        {
            // Some drivers leave the arguments' names out of what they store.
        }
    if (!kernel)
        try
        {
            kernel = kernel_of(compiled(device, source, path), path.stem().string());
        }
        catch (const cl::Error& e)
        {
            throw fail("{} must define: kernel void {}(...); OpenCL error {} from {}", path.string(),
                       path.stem().string(), e.err(), e.what());
        }
    if (device.built)
        device.built->emplace(known, *kernel);
    return *kernel;
}

cl::Event run(const Device& device, Kernel& kernel, const Buffers& buffers, cl::NDRange items, cl::NDRange group)
try
{
    for (cl_uint i = 0; i < kernel.arguments.size(); ++i)
    {
        const auto found = buffers.find(kernel.arguments[i]);
        if (found == buffers.end())
            throw fail("kernel {} asks for '{}', which is no buffer of the solver", kernel.name, kernel.arguments[i]);
        kernel.handle.setArg(i, found->second);
    }
    cl::Event event;
    device.queue.enqueueNDRangeKernel(kernel.handle, cl::NullRange, items, group, nullptr, &event);
    return event;
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} in kernel {}", e.err(), e.what(), kernel.name);
}

// Bytes of a guard's band, and what they hold: no number that a kernel would write.
static constexpr size_t kBand = 4096;
static constexpr uint8_t kUntouched = 0xa7;

cl::Buffer allocate(const Device& device, size_t bytes, const std::string& purpose)
try
{
    const cl_ulong limit = device.device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    if (bytes > limit)
        throw fail("{} takes {} MB, more than the {} MB that {} gives one buffer; draw fewer strands or nodes", purpose,
                   bytes >> 20, limit >> 20, device.name);
    // An empty buffer is no buffer for OpenCL; one that can be mapped costs no copy on devices in host memory.
    const bool shared = device.device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>();
    const cl_mem_flags flags = CL_MEM_READ_WRITE | (shared ? CL_MEM_ALLOC_HOST_PTR : 0);
    if (!device.guards)
        return cl::Buffer(device.context, flags, std::max<size_t>(bytes, 16));
    const size_t taken = std::max<size_t>(bytes, 1);
    const size_t align = device.device.getInfo<CL_DEVICE_MEM_BASE_ADDR_ALIGN>() / 8; // of a buffer within a buffer
    const size_t before = (kBand + align - 1) / align * align;
    const size_t after = before;
    cl::Buffer whole(device.context, flags, before + taken + after);
    device.queue.enqueueFillBuffer(whole, kUntouched, 0, before);
    device.queue.enqueueFillBuffer(whole, kUntouched, before + taken, after);
    device.guards->bands.push_back({whole, before, taken, after, purpose});
    const cl_buffer_region region = {before, taken};
    return whole.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region);
}
catch (const cl::Error& e)
{
    throw fail("{} takes {} MB, which {} cannot give (OpenCL error {}); draw fewer strands or nodes", purpose,
               bytes >> 20, device.name, e.err());
}

std::vector<std::string> find_trespasses(const Device& device)
{
    std::vector<std::string> found;
    if (!device.guards)
        return found;
    std::vector<uint8_t> band;
    for (const Guards::Band& b : device.guards->bands)
        for (const bool behind : {false, true})
        {
            const size_t begin = behind ? b.before + b.bytes : 0, size = behind ? b.after : b.before;
            band.resize(size);
            device.queue.enqueueReadBuffer(b.whole, CL_TRUE, begin, size, band.data());
            const auto touched = [](uint8_t byte) { return byte != kUntouched; };
            const auto first = std::find_if(band.begin(), band.end(), touched);
            if (first == band.end())
                continue;
            const auto last = std::find_if(band.rbegin(), band.rend(), touched).base();
            found.push_back(fmt::format("{} bytes {} the {} bytes of {} were written to",
                                        behind ? last - band.begin() : band.end() - first, behind ? "behind" : "before",
                                        b.bytes, b.purpose));
            device.queue.enqueueFillBuffer(b.whole, kUntouched, begin, size);
        }
    device.queue.finish();
    // A buffer within it would hold the whole one too.
    std::erase_if(device.guards->bands,
                  [](const Guards::Band& b) { return b.whole.getInfo<CL_MEM_REFERENCE_COUNT>() <= 1; });
    return found;
}

Mapped::Mapped(const Device& device, const cl::Buffer& buffer, size_t bytes)
    : queue_(device.queue), buffer_(buffer), bytes_(bytes)
{
    if (bytes_)
        pointer_ = queue_.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ, 0, bytes_);
}

Mapped::~Mapped()
{
    if (!pointer_)
        return;
    try
    {
        queue_.enqueueUnmapMemObject(buffer_, pointer_);
    }
    catch (const cl::Error&)
    {
        // A device that is lost has nothing mapped.
    }
}

Mapped& Mapped::operator=(Mapped&& other) noexcept
{
    std::swap(queue_, other.queue_);
    std::swap(buffer_, other.buffer_);
    std::swap(pointer_, other.pointer_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

} // namespace coif

#include "sim/program_cache.h"

#include "sim/cache_file.h"
#include "sim/distance_grid.h"
#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/hash.h"

#include <sys/resource.h>

#include <chrono>
#include <deque>
#include <mutex>

namespace coif
{

namespace fs = std::filesystem;

static constexpr size_t kMostFiles = 256;     // kept: seven styles whose kernels have nothing in common
static constexpr size_t kMostBytes = 1 << 26; // of one

static std::string hex(const Hash& hash) { return fmt::format("{:016x}{:016x}", hash.word[0], hash.word[1]); }

static fs::path file_of(const Device& device, const ProgramSource& source)
{
    Hash hash;
    for (const std::string& part :
         {source.text, source.options, device.name, device.device.getInfo<CL_DEVICE_VERSION>(),
          device.device.getInfo<CL_DRIVER_VERSION>(),
          cl::Platform(device.device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_VERSION>()})
        hash.add(part.c_str(), part.size() + 1);
    const fs::path folder = cache_folder();
    return folder.empty() ? folder : folder / "programs" / (hex(hash) + ".program");
}

static std::string digest_of(const std::string& binary)
{
    Hash hash;
    hash.add(binary.data(), binary.size());
    return hex(hash);
}

std::optional<cl::Program> stored_program(const Device& device, const ProgramSource& source)
try
{
    const fs::path file = file_of(device, source);
    std::error_code error;
    if (file.empty() || !fs::is_regular_file(file, error))
        return {};
    // The digest of what follows: a driver need not survive what is not its own.
    const std::string bytes = read_file(file, kMostBytes);
    const size_t digest = digest_of({}).size();
    if (bytes.size() <= digest || digest_of(bytes.substr(digest)) != bytes.substr(0, digest))
        return {};
    cl::Program program(device.context, {device.device},
                        cl::Program::Binaries{std::vector<unsigned char>(bytes.begin() + long(digest), bytes.end())});
    program.build(device.device, source.options.c_str());
    return program;
}
catch (const std::exception&)
{
    return {};
}

void store_program(const Device& device, const ProgramSource& source, const cl::Program& program)
try
{
    const fs::path file = file_of(device, source);
    const std::vector<std::vector<unsigned char>> binaries = program.getInfo<CL_PROGRAM_BINARIES>();
    if (file.empty() || binaries.size() != 1 || binaries[0].empty() || binaries[0].size() >= kMostBytes)
        return;
    const std::string binary(binaries[0].begin(), binaries[0].end());
    write_cache_file(file, digest_of(binary) + binary, kMostFiles);
}
catch (const std::exception&)
{
    // The next run compiles again.
}

namespace
{
struct Compiled
{
    Device device;
    ProgramSource source;
    cl::Program program;
};
struct Remembered
{
    std::mutex mutex;
    bool wanted = false;
    std::deque<Compiled> programs; // not stored yet
};
} // namespace

static Remembered& remembered()
{
    static Remembered all;
    return all;
}

cl::Program compiled_program(const Device& device, const ProgramSource& source)
{
    cl::Program program(device.context, source.text);
    try
    {
        program.build(device.device, source.options.c_str());
    }
    catch (const cl::Error&)
    {
        throw fail("{}", program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.device));
    }
    const std::lock_guard lock(remembered().mutex);
    if (remembered().wanted)
        remembered().programs.push_back({device, source, program});
    return program;
}

ProgramKeeper::ProgramKeeper()
{
    const std::lock_guard lock(remembered().mutex);
    remembered().wanted = true;
}

ProgramKeeper::~ProgramKeeper()
{
    stop_ = true;
    if (thread_.joinable())
        thread_.join();
    const std::lock_guard lock(remembered().mutex);
    remembered().wanted = false;
    remembered().programs.clear();
}

// The program that was compiled first of those that are not stored.
static bool store_next()
{
    std::optional<Compiled> next;
    {
        const std::lock_guard lock(remembered().mutex);
        if (remembered().programs.empty())
            return false;
        next = std::move(remembered().programs.front());
        remembered().programs.pop_front();
    }
    store_program(next->device, next->source, next->program);
    return true;
}

void ProgramKeeper::begin()
{
    if (thread_.joinable())
        return;
    thread_ = std::thread(
        [this]
        {
            setpriority(PRIO_PROCESS, 0, 19); // of this thread, on Linux
            while (!stop_)
                if (!store_next())
                    std::this_thread::sleep_for(std::chrono::milliseconds(200));
        });
}

void ProgramKeeper::finish()
{
    while (store_next())
        ;
}

} // namespace coif

// What several host tests share: a folder of their own, whole files, and the words of an error.
#pragma once
#include "sim/error.h"
#include "sim/mesh.h"
#include "sim/params.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <unistd.h>

namespace coif
{
namespace fs = std::filesystem;
}

namespace coif::test
{

// A folder that goes when the test does.
class Scratch
{
  public:
    Scratch()
    {
        std::string name = (fs::temp_directory_path() / "coif_test_XXXXXX").string();
        if (!mkdtemp(name.data()))
            throw std::runtime_error("no temporary folder");
        folder_ = fs::canonical(name);
    }
    ~Scratch()
    {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    const fs::path& folder() const { return folder_; }
    fs::path operator/(const fs::path& name) const { return folder_ / name; }

    // Writes a file, making the folders above it.
    fs::path write(const fs::path& name, const std::string& bytes) const
    {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }

  private:
    fs::path folder_;
};

inline std::string bytes_of(const fs::path& file)
{
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return std::move(text).str();
}

// What coif::Error says, or "no error". Any other exception goes on and fails the test.
template <typename F> std::string error_of(F&& f)
{
    try
    {
        f();
    }
    catch (const Error& e)
    {
        return e.what();
    }
    return "no error";
}

// Ends the program with SIGALRM if what may hang does.
struct TimeLimit
{
    explicit TimeLimit(unsigned seconds) { alarm(seconds); }
    ~TimeLimit() { alarm(0); }
};

inline fs::path shipped(const char* name) { return fs::path(COIF_SOURCE_FOLDER) / "assets" / name; }

// A number in [low, high] that is the same everywhere, unlike what std::uniform_real_distribution gives.
inline double between(std::mt19937& random, double low, double high)
{
    return low + (high - low) * (double(random()) / 4294967295.0);
}

} // namespace coif::test

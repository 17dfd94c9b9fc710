// The program as a person or a script calls it, in a folder of its own that goes when the test does.
#pragma once
#include "app/image.h"
#include "sim/hairstyle.h"

#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

namespace coif::test
{
namespace fs = std::filesystem;

struct Result
{
    int status = -1;
    std::string out, err;
};

class Commands : public testing::Test
{
  protected:
    void SetUp() override
    {
        folder = fs::temp_directory_path() / ("coif_commands_" + std::to_string(getpid()));
        fs::create_directories(folder);
        write("small.toml", "[interpolation]\nstrands = 200\n[grid]\nresolution = 16\n");
    }
    void TearDown() override { fs::remove_all(folder); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
    std::string contents(const std::string& name) const
    {
        std::ifstream in(folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    // Runs coif in the folder, without a display; `setting` is as `env` takes it, "PATH=/nowhere".
    Result coif(const std::string& arguments, const std::string& setting = {}) const
    {
        const std::string command = "cd '" + folder.string() + "' && env -u DISPLAY -u WAYLAND_DISPLAY " + setting +
                                    " '" COIF_BUILD_FOLDER "/coif' " + arguments + " > out.txt 2> err.txt < /dev/null";
        Result result;
        const int status = std::system(command.c_str());
        result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        result.out = contents("out.txt");
        result.err = contents("err.txt");
        return result;
    }
    static double number(const std::string& json, const std::string& key)
    {
        const size_t at = json.find("\"" + key + "\": ");
        return at == json.npos ? NAN : std::atof(json.c_str() + at + key.size() + 4);
    }

    fs::path folder;
};
} // namespace coif::test

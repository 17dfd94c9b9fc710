// Compiled programs on disk: what comes back is what was stored, and whatever else lies there is not taken.
#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/program_cache.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>

namespace coif
{
namespace
{

namespace fs = std::filesystem;

class ProgramCache : public testing::Test
{
  protected:
    void SetUp() override
    {
        test_device(); // opened where its own cache was
        if (const char* cache = std::getenv("XDG_CACHE_HOME"))
            before_ = cache;
        folder_ = fs::temp_directory_path() / fmt::format("coif_programs_{}", getpid());
        fs::create_directories(folder_);
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    void TearDown() override
    {
        before_ ? setenv("XDG_CACHE_HOME", before_->c_str(), 1) : unsetenv("XDG_CACHE_HOME");
        fs::remove_all(folder_);
    }

    std::vector<fs::path> files() const
    {
        std::vector<fs::path> all;
        const fs::path programs = folder_ / "coif" / "programs";
        if (fs::exists(programs))
            for (const fs::directory_entry& entry : fs::directory_iterator(programs))
                all.push_back(entry.path());
        return all;
    }

    // What the kernel makes of some numbers, denormal ones among them.
    static std::vector<float> results(const cl::Program& program)
    {
        cl::Kernel kernel(program, "cube");
        EXPECT_EQ(std::string(kernel.getArgInfo<CL_KERNEL_ARG_NAME>(0).c_str()), "values");
        const std::vector<float> values = {1.0f, -2.5f, 1e-14f, 1e10f};
        const cl::Buffer buffer = filled(test_device(), values);
        kernel.setArg(0, buffer);
        test_device().queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values.size()));
        return read<float>(test_device(), buffer, values.size());
    }

    const ProgramSource source_ = {
        "kernel void cube(global float* values) { int i = get_global_id(0); float v = values[i]; "
        "values[i] = v * v * v + ADDED; }\n",
        "-cl-std=CL1.2 -cl-kernel-arg-info -cl-denorms-are-zero -D ADDED=0.0f"};

  private:
    fs::path folder_;
    std::optional<std::string> before_;
};

TEST_F(ProgramCache, WhatComesBackIsWhatWasCompiled)
{
    EXPECT_FALSE(stored_program(test_device(), source_));
    const cl::Program compiled = compiled_program(test_device(), source_);
    EXPECT_FALSE(stored_program(test_device(), source_)) << "nobody asked for it to be kept";
    store_program(test_device(), source_, compiled);
    const std::optional<cl::Program> stored = stored_program(test_device(), source_);
    ASSERT_TRUE(stored);
    const std::vector<float> expected = results(compiled);
    EXPECT_EQ(expected[2], 0.0f) << "a denormal";
    EXPECT_EQ(results(*stored), expected);
}

TEST_F(ProgramCache, OtherSourcesAndOptionsAreOtherPrograms)
{
    store_program(test_device(), source_, compiled_program(test_device(), source_));
    EXPECT_FALSE(stored_program(test_device(), {source_.text + " ", source_.options}));
    EXPECT_FALSE(stored_program(test_device(), {source_.text, source_.options + "1"}));
}

TEST_F(ProgramCache, WhatIsNotAsItWasWrittenIsCompiledAnew)
{
    store_program(test_device(), source_, compiled_program(test_device(), source_));
    ASSERT_EQ(files().size(), 1u);
    const fs::path file = files()[0];
    const std::string whole = read_file(file, 1 << 26);
    for (const std::string& spoilt :
         {std::string(), whole.substr(0, 20), whole.substr(0, whole.size() - 1), "x" + whole.substr(1),
          whole.substr(0, whole.size() / 2) + char(whole[whole.size() / 2] ^ 1) + whole.substr(whole.size() / 2 + 1)})
    {
        write_file(file, spoilt);
        EXPECT_FALSE(stored_program(test_device(), source_)) << spoilt.size() << " bytes";
    }
    fs::remove(file);
    fs::create_directories(file);
    EXPECT_FALSE(stored_program(test_device(), source_)) << "a folder";
}

TEST_F(ProgramCache, AKeeperStoresWhatIsCompiledWhileItLives)
{
    {
        ProgramKeeper keeper;
        compiled_program(test_device(), source_);
        EXPECT_EQ(files().size(), 0u);
        keeper.finish();
    }
    EXPECT_EQ(files().size(), 1u);
    ProgramSource other = source_;
    other.text += "// other\n";
    compiled_program(test_device(), other); // while there is none
    ProgramKeeper keeper;
    keeper.finish();
    EXPECT_EQ(files().size(), 1u);
}

TEST_F(ProgramCache, ACompilersWordsComeThrough)
{
    try
    {
        compiled_program(test_device(), {"kernel void wrong(global float* x) { x[0] = nonsense; }\n", "-cl-std=CL1.2"});
        FAIL();
    }
    catch (const Error& e)
    {
        EXPECT_NE(std::string(e.what()).find("nonsense"), std::string::npos) << e.what();
    }
}

} // namespace
} // namespace coif

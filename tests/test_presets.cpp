// Each shipped hairstyle against a small picture of it, tests/golden/NAME.png. COIF_WRITE_GOLDENS=1 writes those that
// are missing or differ; look at them before they are kept.
#include "app/shot.h"
#include "sim/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace coif
{
namespace
{

namespace fs = std::filesystem;

class Preset : public testing::TestWithParam<fs::path>
{
};

struct Difference
{
    double mean = 0.0;       // of all channels, of 255
    double far_pixels = 0.0; // share of pixels that some channel is more than 24 off in
};

Difference difference(const Image& a, const Image& b)
{
    Difference d;
    for (size_t i = 0; i < a.pixels.size(); i += 4)
    {
        int most = 0;
        for (size_t c = 0; c < 3; ++c)
        {
            const int off = std::abs(int(a.pixels[i + c]) - int(b.pixels[i + c]));
            d.mean += off / (0.75 * double(a.pixels.size()));
            most = std::max(most, off);
        }
        d.far_pixels += (most > 24) / (0.25 * double(a.pixels.size()));
    }
    return d;
}

TEST_P(Preset, LooksAsItDid)
{
    const std::string name = GetParam().stem().string();
    Options options;
    options.style = GetParam().string();
    // What they were drawn by: test_rasteriser.cpp compares the methods, test_look_pictures.cpp the levels.
    options.sets = {"render.method=geometry", "look.level=kajiya_kay"};
    if (const char* wish = std::getenv("COIF_TEST_DEVICE"))
        options.device = wish;
    ShotOptions shot;
    shot.width = 640;
    shot.height = 360;
    shot.samples = 4;
    const Image picture = shrunk(take_shot(options, shot), 8);

    // Not as close as bytes: drivers round and rasterise in their own ways, and hair is chaotic. A strand's place may
    // differ; where hair lies, how bright and of which colour it is may not.
    const fs::path golden = fs::path(COIF_SOURCE_FOLDER) / "tests" / "golden" / (name + ".png");
    const auto passes = [](const Difference& d) { return d.mean <= 3.0 && d.far_pixels <= 0.02; };
    const bool known = fs::exists(golden);
    Difference d;
    if (known)
    {
        const Image expected = load_png(golden);
        ASSERT_EQ(expected.width, picture.width) << golden;
        ASSERT_EQ(expected.height, picture.height) << golden;
        d = difference(picture, expected);
    }
    if (known && passes(d))
        return;
    if (std::getenv("COIF_WRITE_GOLDENS"))
    {
        fs::create_directories(golden.parent_path());
        save_png(golden, picture);
        return;
    }
    const fs::path kept = fs::path(COIF_BUILD_FOLDER) / "failed" / (name + ".png");
    fs::create_directories(kept.parent_path());
    save_png(kept, picture);
    if (!known)
        FAIL() << golden.string() << " is missing. " << kept.string()
               << " is what it would be; if that is as it should "
               << "be, COIF_WRITE_GOLDENS=1 writes it.";
    FAIL() << name << " looks different: " << d.mean << " of 255 on average (3 allowed), " << 100.0 * d.far_pixels
           << " % of pixels more than 24 off (2 allowed). See " << kept.string() << " and " << golden.string();
}

std::vector<fs::path> presets_or_none()
{
    try
    {
        return preset_files();
    }
    catch (const Error&) // told by every other test
    {
        return {};
    }
}

INSTANTIATE_TEST_SUITE_P(All, Preset, testing::ValuesIn(presets_or_none()),
                         [](const auto& test)
                         {
                             std::string name = test.param.stem().string();
                             for (char& c : name)
                                 c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                             return name;
                         });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Preset);

} // namespace
} // namespace coif

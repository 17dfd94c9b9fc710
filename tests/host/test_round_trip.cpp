// What coif writes for another tool, coif reads again: every format that there is a reader of, for every tool.
#include "sim/exchange/place.h"
#include "sim/exchange/targets.h"
#include "tests/host/nine_strands.h"
#include "tests/host/scratch.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace coif::test
{
namespace
{

const char* const kRead[] = {".usda", ".abc", ".hair", ".tfx", ".data"};

// Back into metres with y up.
glm::vec3 upright(glm::vec3 p, Axes axes)
{
    return axes == Axes::Y_UP ? p : axes == Axes::Z_UP ? glm::vec3(p.x, p.z, -p.y) : glm::vec3(p.x, p.z, p.y);
}

TEST(RoundTrip, every_tools_file_comes_back_where_it_was_and_says_so_where_it_can)
{
    const Scratch scratch;
    std::vector<std::string> tools = {""};
    for (const Target& target : targets())
        tools.emplace_back(target.name);
    for (const std::string& tool : tools)
        for (const std::string suffix : kRead)
        {
            const std::filesystem::path path = scratch / ("hair" + suffix);
            const FormatInfo& format = format_of(path);
            const Placement placement = placement_of(format, find_target(tool));
            Curves before = nine_strands();
            before.guide.clear(); // which would lie apart, and so in another order
            Curves placed = before;
            place(placed, placement);
            NewFile file(path);
            write_curves(file, format, placed, words_of(placement, format.through));
            file.finish();
            const HairFile read = read_hair_file(path);
            const std::string which = suffix + " for " + (tool.empty() ? "nobody" : tool);
            ASSERT_EQ(read.curves.strands(), before.strands()) << which;
            const bool says = suffix == ".usda" || suffix == ".hair";
            EXPECT_EQ(read.unit, says ? 1.0f / placement.per_metre : 0.0f) << which;
            EXPECT_EQ(read.up, !says                          ? HAIR_UP_AUTO
                               : placement.axes == Axes::Y_UP ? HAIR_UP_Y
                               : placement.axes == Axes::Z_UP ? HAIR_UP_Z
                                                              : HAIR_UP_UNREAL)
                << which;
            // .tfx has other points on the same strands: their ends are the same.
            size_t first = 0, first_read = 0;
            for (size_t s = 0; s < before.strands(); ++s)
            {
                const size_t last = first + before.count[s] - 1, last_read = first_read + read.curves.count[s] - 1;
                for (const auto& [a, b] : {std::pair(first, first_read), {last, last_read}})
                    EXPECT_LT(glm::distance(before.position[a],
                                            upright(read.curves.position[b], placement.axes) / placement.per_metre),
                              1e-6f)
                        << which << " strand " << s;
                first = last + 1;
                first_read = last_read + 1;
            }
            EXPECT_EQ(first_read, read.curves.points()) << which;
        }
}

} // namespace
} // namespace coif::test

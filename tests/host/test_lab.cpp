// The lab's root paths: what is between rows, and files that are not what they should be.
#include "sim/lab.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;

TEST(Lab, a_path_meets_parabolas_at_unequal_times)
{
    const auto parabola = [](double t) { return glm::dvec3(1.0 - 2.0 * t + 3.0 * t * t, 0.5 * t * t, -4.0 + t); };
    for (const std::vector<double>& times :
         {std::vector<double>{0.0, 0.1, 0.25, 0.7, 0.8, 2.0}, std::vector<double>{-1.0, 0.0, 5.0},
          std::vector<double>{0.0, 1.0, 2.0, 3.0}})
    {
        RootRows rows{times, {}};
        for (const double t : times)
            rows.points.push_back(parabola(t));
        for (int i = 0; i <= 1000; ++i)
        {
            const double t = times.front() + (times.back() - times.front()) * i / 1000.0;
            EXPECT_LT(glm::distance(root_at(rows, t), parabola(t)), 1e-12 * (1.0 + glm::length(parabola(t)))) << t;
        }
    }
}

TEST(Lab, a_path_meets_its_rows_and_stands_before_and_after)
{
    const RootRows rows{{0.0, 0.5, 0.6, 2.0}, {{0, 0, 0}, {1, 2, 3}, {-1, 0, 5}, {4, 4, 4}}};
    for (size_t i = 0; i < rows.times.size(); ++i)
        EXPECT_LT(glm::distance(root_at(rows, rows.times[i]), rows.points[i]), 1e-14);
    EXPECT_EQ(root_at(rows, -1e9), rows.points.front());
    EXPECT_EQ(root_at(rows, 1e9), rows.points.back());
    const RootRows two{{1.0, 2.0}, {{0, 0, 0}, {2, 4, 6}}};
    EXPECT_LT(glm::distance(root_at(two, 1.25), glm::dvec3(0.5, 1, 1.5)), 1e-14) << "two rows: straight";
    // No jump of speed at a row.
    const double h = 1e-6;
    for (const double t : {0.5, 0.6})
    {
        const glm::dvec3 before = (root_at(rows, t) - root_at(rows, t - h)) / h,
                         after = (root_at(rows, t + h) - root_at(rows, t)) / h;
        EXPECT_LT(glm::distance(before, after), 1e-3 * glm::length(before)) << t;
    }
}

TEST(Lab, a_file_may_have_headings_spaces_blank_lines_and_further_columns)
{
    const Scratch scratch;
    const RootRows rows =
        load_root(scratch.write("root.csv", "t,x0,y0,z0,x1\r\n0, 1,2 ,3\r\n\r\n 0.5,1e-3,-2.5,3,99,words\n1.5,0,0,0"));
    ASSERT_EQ(rows.times, (std::vector<double>{0.0, 0.5, 1.5}));
    EXPECT_EQ(rows.points[1], glm::dvec3(1e-3, -2.5, 3));
    EXPECT_EQ(load_root(scratch.write("bare.csv", "0,0,0,0\n1,1,1,1\n")).times.size(), 2u) << "without headings";
    EXPECT_EQ(load_root(scratch.write("bom.csv", "\xef\xbb\xbf 0,0,0,0\n1,1,1,1\n")).times.size(), 2u)
        << "a spreadsheet's mark of UTF-8 is no heading";
}

TEST(Lab, files_that_are_no_paths_are_told_with_their_line)
{
    const Scratch scratch;
    const auto told = [&](const std::string& text)
    {
        const fs::path file = scratch.write("bad.csv", text);
        const std::string error = error_of([&] { load_root(file); });
        return error.substr(std::min(error.size(), file.string().size()));
    };
    const std::string numbers = ": expected four finite numbers, t,x,y,z", rows = ": expected two rows t,x,y,z or more";
    EXPECT_EQ(told(""), rows);
    EXPECT_EQ(told("\n\n\n"), rows);
    EXPECT_EQ(told("t,x,y,z\n"), rows);
    EXPECT_EQ(told("t,x,y,z\n0,0,0,0\n"), rows);
    EXPECT_EQ(told("0,0,0,0\nnan,0,0,0\n"), ":2" + numbers);
    EXPECT_EQ(told("0,0,0,0\n1,0,inf,0\n"), ":2" + numbers);
    EXPECT_EQ(told("0,0,0,0\n1,0,1e999,0\n"), ":2" + numbers);
    EXPECT_EQ(told("t,x,y,z\n0,0,0,0\n1,0,0\n"), ":3" + numbers);
    EXPECT_EQ(told("0,0,0,0\n1,,0,0\n"), ":2" + numbers);
    EXPECT_EQ(told("0,0,0,0\n1,0,0,0x\n"), ":2" + numbers);
    EXPECT_EQ(told("0,0,0,0\n1;0;0;0\n"), ":2" + numbers);
    EXPECT_EQ(told("0,0,0,0\nt,x,y,z\n"), ":2" + numbers) << "headings come first or not at all";
    EXPECT_EQ(told("0,nan,0,0\n1,0,0,0\n2,0,0,0\n"), ":1" + numbers) << "a row that begins with a number is no heading";
    EXPECT_EQ(told("0;0;0;0\n1,0,0,0\n2,0,0,0\n"), ":1" + numbers);
    EXPECT_EQ(told("0,0,0,0\n1,0,-1e300,0\n"), ":2: a root further than 1000000 m from the origin");
    EXPECT_EQ(told("0,0,0,0\n1e-300,0,0,0\n"), ":2: time 1e-300 comes less than a microsecond after 0");
    EXPECT_EQ(told("0,0,0,0\n1,0,0,0\n1,0,0,0\n"), ":3: time 1 does not come after 1");
    EXPECT_EQ(told("0,0,0,0\n1,0,0,0\n0.5,0,0,0\n"), ":3: time 0.5 does not come after 1");
    EXPECT_EQ(told(std::string("0,0,0,0\n1,0,\0,0\n", 17)), ":2" + numbers);
    EXPECT_NE(error_of([&] { load_root(scratch / "none.csv"); }), "no error");
}

} // namespace
} // namespace coif

// What coif bench makes of its times; the times themselves judge nothing here.
#include "app/bench/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace coif
{
namespace
{

TEST(BenchRows, are_reached_by_time_and_by_ratio_and_judged_only_where_something_is_wanted)
{
    BenchRow row;
    row.ms = 2.0;
    EXPECT_FALSE(row.judged());
    EXPECT_TRUE(row.reached());
    row.most_ms = 1.9;
    EXPECT_TRUE(row.judged());
    EXPECT_FALSE(row.reached());
    row.most_ms = 2.1;
    row.baseline_ms = 9.0;
    row.least_ratio = 5.0;
    EXPECT_FALSE(row.reached()) << "4.5 times";
    row.baseline_ms = 11.0;
    EXPECT_TRUE(row.reached());
}

TEST(BenchRows, say_what_share_of_the_machine_they_take)
{
    Machine machine;
    machine.bandwidth = 20e9;
    machine.operations = 100e9;
    BenchRow row;
    row.ms = 2.0;
    row.bytes = 10e6;
    row.operations = 50e6;
    EXPECT_NEAR(row.of_bandwidth(machine), 0.25, 1e-12);
    EXPECT_NEAR(row.of_peak(machine), 0.25, 1e-12);
    EXPECT_NE(bench_table({row}, machine).find("25 %"), std::string::npos) << bench_table({row}, machine);
}

TEST(BenchRows, fill_every_column_whatever_they_know)
{
    Machine machine;
    machine.device = "a \"device\", quoted";
    BenchRow bare, full;
    bare.scene = full.scene = "head";
    full.note = "wind, \"gusts\"";
    full.what = "frame";
    full.strands = 102400;
    full.ms = full.low = full.high = full.bytes = full.baseline_ms = full.most_ms = full.least_ratio = 1.0;
    std::istringstream lines(bench_csv({bare, full}, machine));
    std::string head, first, second;
    std::getline(lines, head);
    std::getline(lines, first);
    std::getline(lines, second);
    const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    EXPECT_EQ(commas(first), commas(head));
    EXPECT_EQ(commas(second), commas(head) + 1) << "the note's own, in quotes";
    EXPECT_NE(second.find("\"wind, \"\"gusts\"\"\""), std::string::npos) << second;
    const std::string json = bench_json({bare, full}, machine);
    EXPECT_EQ(std::count(json.begin(), json.end(), '{'), 3);
    EXPECT_EQ(std::count(json.begin(), json.end(), '{'), std::count(json.begin(), json.end(), '}'));
    EXPECT_NE(json.find("\"ms\": null"), std::string::npos) << "what is not known";
    EXPECT_NE(json.find("a \\\"device\\\", quoted"), std::string::npos);
}

} // namespace
} // namespace coif

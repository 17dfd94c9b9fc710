// coif bench on a device: that it measures what is there, and that part of a device moves hair as all of it does.
#include "app/bench/hair.h"
#include "sim/error.h"
#include "tests/commands.h"
#include "tests/on_device.h"

#include <cstring>

using namespace coif;
using namespace coif::test;

namespace
{

TEST(Bench, PartOfADeviceMovesHairToTheSameBytes)
{
    if (test_device().device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>() < 2)
        GTEST_SKIP() << "there is no part of it";
    const Device part = part_of(test_device(), 1);
    EXPECT_EQ(part.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>(), 1u);
    const std::vector<std::string> sets = {"interpolation.guides=all", "interpolation.strands=300",
                                           "grid.resolution=16"};
    BenchHair whole(test_device(), "bob", sets), less(part, "bob", sets);
    const PassTimes times = whole.frames(5, true);
    less.frames(5, true);
    EXPECT_EQ(times.front().first, "frame");
    EXPECT_EQ(whole.strands(), 300);
    const Mapped a = whole.solver().drawn_positions(), b = less.solver().drawn_positions();
    ASSERT_EQ(a.bytes(), b.bytes());
    EXPECT_EQ(memcmp(a.as<char>(), b.as<char>(), a.bytes()), 0);
    EXPECT_THROW(part_of(test_device(), 1 << 20), Error);
}

TEST(Bench, TrafficIsThatOfTheBuffersThatKernelsName)
{
    BenchHair hair(test_device(), "bob", {"grid.resolution=16", "look.self_shadow=0", "forces.repulsion=1"});
    hair.frames(1, false);
    const std::map<std::string, double> traffic = traffic_of(hair.solver());
    const std::vector<int> room = read<int>(test_device(), hair.solver().buffers().at("room"), 6);
    const double voxels = (room[3] - room[0]) * (room[4] - room[1]) * double(room[5] - room[2]);
    ASSERT_GT(voxels, 0.0);
    ASSERT_LT(voxels, 16.0 * 16.0 * 16.0);
    const double for_room = voxels / (16.0 * 16.0 * 16.0) * 6.0 * sizeof(int); // where the voxels are said
    EXPECT_DOUBLE_EQ(traffic.at("clear_density"), 2.0 * voxels * sizeof(int) + for_room)
        << "may be read as well as written";
    EXPECT_DOUBLE_EQ(traffic.at("density_gradient"),
                     voxels * sizeof(int) + 2.0 * 3.0 * voxels * sizeof(float) + for_room);
    const std::map<std::string, double> operations = operations_of(hair.solver());
    EXPECT_DOUBLE_EQ(operations.at("density_gradient"), 6.0 * voxels);
    EXPECT_GT(operations.at("simulate_direct"), 252.0 * 14 * 100) << "one substep of lengths alone";
    EXPECT_EQ(operations.count("clear_density"), 0u);
    EXPECT_GT(traffic.at("simulate_direct"), 252.0 * 16 * 3 * sizeof(float) * 4) << "positions, velocities, twice";
}

TEST_F(Commands, bench_writes_its_tables_and_says_what_the_machine_can_do)
{
    const Result json = coif("bench --quick --only guides --json -o out");
    ASSERT_EQ(json.status, 0) << json.err;
    EXPECT_EQ(json.out.front(), '{');
    EXPECT_GT(number(json.out, "bytes_per_second"), 1e8);
    EXPECT_GT(number(json.out, "operations_per_second"), 1e8);
    EXPECT_GT(number(json.out, "ms"), 0.0);
    EXPECT_EQ(contents("out/bench.json"), json.out);
    EXPECT_EQ(contents("out/bench.csv").rfind("scene,", 0), 0u);
    EXPECT_EQ(coif("bench --only nothing").status, 1);
    EXPECT_EQ(coif("bench --json --csv").status, 2);
}

} // namespace

// The passes over the grid against their double-precision twins: density and light.
#include "sim/error.h"
#include "tests/on_device.h"
#include "tests/oracle.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{
namespace
{

// Device width and voxels a side: whole chunks of 16 and of 8, and one voxel at a time where neither divides or the
// device is a GPU.
struct Size
{
    int width, resolution;
};
void PrintTo(const Size& size, std::ostream* out) { *out << size.width << " wide, " << size.resolution << "^3"; }

class GridPasses : public testing::TestWithParam<Size>
{
  protected:
    const int resolution = GetParam().resolution;
    const size_t voxels = size_t(resolution) * size_t(resolution) * size_t(resolution);
    const Device device = with_width(GetParam().width);
    const size_t chunk = size_t(resolution % device.width == 0 ? device.width : 1);
    Random random{unsigned(100 * GetParam().width + resolution)};

    std::vector<int> random_density(int most)
    {
        std::vector<int> density;
        for (size_t i = 0; i < voxels; ++i)
            density.push_back(random.below(3) ? random.below(most) : 0);
        return density;
    }

    void launch(const std::string& pass, const Buffers& buffers, cl::NDRange items, const std::string& extra = {})
    {
        Kernel kernel = load_kernel(device, pass, pass_options(device, 16, resolution, extra));
        run(device, kernel, buffers, items);
    }
    void launch_grid(const std::string& pass, const Buffers& buffers, const std::string& extra = {})
    {
        launch(pass, buffers, cl::NDRange(size_t(resolution) / chunk, size_t(resolution), size_t(resolution)), extra);
    }

    // All of the grid; and a box of it, whose chunks are whole.
    std::vector<std::vector<int>> rooms() const
    {
        const int r = resolution;
        return {{0, 0, 0, r, r, r}, {r / 3, r / 4, 1, r / 2, r - 1, r / 2}};
    }
    bool in_room(const std::vector<int>& room, size_t voxel) const
    {
        const int x = int(voxel) % resolution / int(chunk) * int(chunk), y = int(voxel) / resolution % resolution;
        const int z = int(voxel) / resolution / resolution;
        return x + int(chunk) > room[0] && x < room[3] && y >= room[1] && y < room[4] && z >= room[2] && z < room[5];
    }
};

TEST_P(GridPasses, ClearLeavesNothingInItsRoomAndAllElse)
{
    for (const std::vector<int>& room : rooms())
    {
        std::vector<int> expected = random_density(1000);
        const Buffers buffers = {{"density", filled(device, expected)}, {"room", filled(device, room)}};
        launch_grid("clear_density", buffers);
        for (size_t i = 0; i < voxels; ++i)
            expected[i] = in_room(room, i) ? 0 : expected[i];
        EXPECT_EQ(read<int>(device, buffers.at("density"), voxels), expected);
    }
}

TEST_P(GridPasses, RoomIsWhatWasTouchedInTwoStepsAndAsMuchMoreAsIsBlurred)
{
    struct RoomCase
    {
        std::vector<int> touched, before; // least x, y, z, and least of their negatives
        float light, push;                // whole voxels of the boxes; negative: none
        std::vector<int> room;
    };
    const int r = resolution, n = r; // none
    for (const RoomCase& c : {RoomCase{{3, 4, 5, -3, -4, -5}, {n, n, n, n, n, n}, -1, -1, {2, 3, 4, 5, 6, 7}},
                              RoomCase{{3, 4, 5, -3, -4, -5}, {4, 2, 6, -4, -2, -6}, -1, -1, {2, 1, 4, 6, 6, 8}},
                              RoomCase{{3, 4, 5, -3, -4, -5}, {n, n, n, n, n, n}, 0, -1, {1, 2, 3, 6, 7, 8}},
                              RoomCase{{4, 4, 4, -4, -4, -4},
                                       {n, n, n, n, n, n},
                                       0,
                                       1,
                                       {0, 0, 0, std::min(9, r), std::min(9, r), std::min(9, r)}},
                              RoomCase{{0, 4, 4, 1 - r, -4, -4}, {n, n, n, n, n, n}, 1, -1, {0, 1, 1, r, 8, 8}}})
    {
        StepInfo info = {};
        info.light_box = F4(c.light, 0.0f, 0.0f, c.light < 0.0f ? 0.0f : 1.0f);
        info.push_box = F4(c.push, 0.0f, 0.0f, c.push < 0.0f ? 0.0f : 1.0f);
        const Buffers buffers = {{"touched", filled(device, c.touched)},
                                 {"touched_before", filled(device, c.before)},
                                 {"room", filled(device, std::vector<int>(6, -1))},
                                 {"info", filled(device, info)}};
        launch("grid_room", buffers, cl::NDRange(1));
        EXPECT_EQ(read<int>(device, buffers.at("room"), 6), c.room);
        EXPECT_EQ(read<int>(device, buffers.at("touched_before"), 6), c.touched);
        EXPECT_EQ(read<int>(device, buffers.at("touched"), 6), std::vector<int>(6, n));
    }
}

TEST_P(GridPasses, BlurIsTheTwinsToTheLastUnitHoweverWide)
{
    const std::vector<int> density = random_density(1 << 20); // the density of 250 nodes in one voxel, at most
    for (const float4& box : {F4(0, 1, 0, 0), F4(0, 0.5f, 0.25f, 0), F4(1, 1.0f / 3.0f, 0, 0), F4(2, 0.18f, 0.05f, 0),
                              F4(17, 0.028f, 0.01f, 0), F4(200, 0.002f, 0.001f, 0)})
        for (int axis = 0; axis < 3; ++axis)
            for (const std::vector<int>& room : rooms())
            {
                StepInfo info = {};
                info.push_box = box;
                const Buffers buffers = {{"density", filled(device, density)},
                                         {"blurred", filled(device, std::vector<int>(voxels, -1))},
                                         {"room", filled(device, room)},
                                         {"info", filled(device, info)}};
                launch_grid("blur_density", buffers, fmt::format("-D AXIS={} -D BOX=push_box", axis));
                const std::vector<int> blurred = read<int>(device, buffers.at("blurred"), voxels);
                const std::vector<double> expected = oracle::blur_density(density, axis, resolution, box);
                // A half for rounding to whole units, and four roundings to 24 bits of what is summed.
                double worst = 0.0;
                int trespasses = 0;
                for (size_t i = 0; i < voxels; ++i)
                    if (in_room(room, i))
                        worst = std::max(worst, std::abs(blurred[i] - expected[i]) - 2.5e-7 * expected[i]);
                    else
                        trespasses += blurred[i] != -1;
                EXPECT_LE(worst, 0.5) << box.x << " voxels along axis " << axis;
                EXPECT_EQ(trespasses, 0) << box.x << " voxels along axis " << axis;
            }
}

TEST_P(GridPasses, GradientIsTheTwinsExactly)
{
    // Differences below 2^24 are whole numbers that a float holds, and halving is exact.
    const std::vector<int> density = random_density(1 << 24);
    for (const std::vector<int>& room : rooms())
    {
        const Buffers buffers = {{"density", filled(device, density)},
                                 {"gradient", filled(device, std::vector<float>(voxels * 3, -0.25f))},
                                 {"room", filled(device, room)}};
        launch_grid("density_gradient", buffers);
        const std::vector<float> gradient = read<float>(device, buffers.at("gradient"), voxels * 3);
        const std::vector<oracle::Vec> expected = oracle::density_gradient(density, resolution);
        int wrong = 0;
        for (size_t i = 0; i < voxels; ++i)
            for (int axis = 0; axis < 3; ++axis)
                wrong +=
                    !(double(gradient[i + size_t(axis) * voxels]) == (in_room(room, i) ? expected[i][axis] : -0.25));
        EXPECT_EQ(wrong, 0);
    }
}

// Light, as make_step_info() sets up its sweep, from the given direction.
StepInfo lit_info(Random& random, int resolution, glm::dvec3 light, HairParams& params)
{
    params.grid_resolution = resolution;
    params.look_light_direction = F4(float(light.x), float(light.y), float(light.z), 0.0f);
    params = device_params(params);
    const Groom groom = random_groom(random, 20, 16, 100);
    return make_step_info(params, groom, {}, glm::dvec3(0.0), Substep{}, 0, true);
}

TEST_P(GridPasses, BodiesFillTheVoxelsWhoseCentresLieInsideWithSoftEdges)
{
    HairParams params;
    const StepInfo info = lit_info(random, resolution, {0.0, 1.0, 0.0}, params);
    std::vector<Capsule> colliders;
    for (int i = 0; i < 12; ++i) // some reach over the grid's border; one is smaller than a voxel, one larger
    {
        const glm::dvec3 at = random.vector(0.3);
        colliders.push_back(capsule(at,
                                    i == 0   ? 1e-4
                                    : i == 1 ? 3.0 * double(info.grid_corner.w)
                                             : random.in(0.01, 0.15),
                                    i % 3 ? glm::dvec3(0.0) : random.vector(0.3)));
    }
    const std::vector<int> density = random_density(100);
    const Buffers buffers = {{"occupied", filled(device, density)},
                             {"colliders", filled(device, colliders)},
                             {"info", filled(device, info)}};
    launch("add_bodies", buffers, cl::NDRange(size_t(resolution), size_t(resolution), colliders.size()));
    const std::vector<int> occupied = read<int>(device, buffers.at("occupied"), voxels);
    const std::vector<double> depth = oracle::depth_in_bodies(colliders, resolution, info);
    int inside = 0, edge = 0;
    double worst = 0.0;
    for (size_t i = 0; i < voxels; ++i)
    {
        const double share = std::clamp(depth[i] + 0.5, 0.0, 1.0);
        const double expected = std::max(double(density[i]), std::floor(share * info.body_density));
        worst = std::max(worst, std::abs(occupied[i] - expected));
        inside += share == 1.0;
        edge += share > 0.0 && share < 1.0;
    }
    // Coordinates of up to 64 voxels carry 4e-6 of rounding, the distance a few of those; and one for the fraction.
    EXPECT_LE(worst, 1.0 + 3e-5 * info.body_density);
    EXPECT_GT(inside, 0);
    EXPECT_GT(edge, 0);
}

TEST_P(GridPasses, TheHeadFillsTheVoxelsWhoseCentresLieInsideWithSoftEdges)
{
    HairParams params;
    StepInfo info = lit_info(random, resolution, {0.0, 1.0, 0.0}, params);
    const Groom groom = random_groom(random, 20, 16, 100);
    Substep now;
    now.head.turn = glm::angleAxis(1.0, random.direction());
    const PlacedGrid placed = {lumpy_body(), 1.5f, {0.0f, 0.03f, 0.0f}};
    info = make_step_info(params, groom, now.head, glm::dvec3(0.0), now, 0, true, placed);
    const oracle::Body body = oracle::body_of(*placed.grid);
    std::vector<int> all_twice = rooms()[0];
    all_twice.insert(all_twice.end(), all_twice.begin(), all_twice.end());
    const std::vector<int> density = random_density(100);
    const Buffers buffers = {{"density", filled(device, density)},
                             {"in_head", filled(device, std::vector<int>(voxels, -1))},
                             {"occupied", filled(device, std::vector<int>(voxels, -1))},
                             {"body_distance", filled(device, body.distance)},
                             {"head_touched", filled(device, std::vector<int>(6, resolution))},
                             {"light_room", filled(device, all_twice)},
                             {"info", filled(device, info)}};
    const size_t bricks = (size_t(resolution) + 3) / 4, width = size_t(device.width);
    launch("stand_head", buffers, cl::NDRange((bricks + width - 1) / width, bricks, bricks));
    launch_grid("add_head", buffers);
    const std::vector<int> occupied = read<int>(device, buffers.at("occupied"), voxels);
    const std::vector<double> depth = oracle::depth_in_head(body, resolution, info);
    int inside = 0;
    double worst = 0.0;
    for (size_t i = 0; i < voxels; ++i)
    {
        const double share = std::clamp(depth[i] + 0.5, 0.0, 1.0);
        worst = std::max(worst,
                         std::abs(occupied[i] - std::max(double(density[i]), std::floor(share * info.body_density))));
        inside += share == 1.0;
    }
    EXPECT_LE(worst, 1.0 + 3e-5 * info.body_density);
    EXPECT_EQ(inside > 0, resolution > 8); // voxels of 10 cm are too large for it
    // In the box that it is said to lie in, give or take a brick.
    const std::vector<int> touched = read<int>(device, buffers.at("head_touched"), 6);
    const auto [low, high] = oracle::box_of(read<int>(device, buffers.at("in_head"), voxels), resolution);
    for (int axis = 0; axis < 3 && inside > 0; ++axis)
    {
        EXPECT_LE(touched[size_t(axis)], low[axis]);
        EXPECT_GE(touched[size_t(axis)], low[axis] - 8);
        EXPECT_GE(-touched[size_t(axis + 3)], high[axis]);
        EXPECT_LE(-touched[size_t(axis + 3)], high[axis] + 8);
    }
}

TEST_P(GridPasses, LightMayBeStoppedWhereHairOrHeadAreAndEverywhereByOtherBodies)
{
    StepInfo info = {};
    const int n = resolution, r = resolution;
    struct LightCase
    {
        std::vector<int> head, before;
        int colliders;
        std::vector<int> light_room;
    };
    for (const LightCase& c :
         {LightCase{{n, n, n, n, n, n}, {0, 0, 0, 0, 0, 0}, 0, {2, 3, 4, 5, 6, 7, 0, 0, 0, 5, 6, 7}},
          LightCase{{1, 4, 4, -4, -4, 1 - r}, {3, 3, 3, 4, 8, 4}, 0, {1, 3, 4, 5, 6, r, 1, 3, 3, 5, 8, r}},
          LightCase{{n, n, n, n, n, n}, {3, 3, 3, 4, 4, 4}, 2, {0, 0, 0, r, r, r, 0, 0, 0, r, r, r}}})
    {
        info.colliders = c.colliders;
        std::vector<int> light_room = c.before;
        light_room.resize(12, -1);
        const Buffers buffers = {{"room", filled(device, std::vector<int>{2, 3, 4, 5, 6, 7})},
                                 {"head_touched", filled(device, c.head)},
                                 {"light_room", filled(device, light_room)},
                                 {"info", filled(device, info)}};
        launch("light_room", buffers, cl::NDRange(1), "-D BODY_GRID");
        EXPECT_EQ(read<int>(device, buffers.at("light_room"), 12), c.light_room);
    }
}

TEST_P(GridPasses, TransmittanceIsTheTwinsFromEverySide)
{
    std::vector<glm::dvec3> lights = {{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}, {1, 1, 1}, {-1, 1, -1}, {0.45, 0.75, 0.6}};
    for (int i = 0; i < 6; ++i)
        lights.push_back(random.direction());
    Kernel kernel = load_kernel(device, "transmittance", pass_options(device, 16, resolution));
    const std::vector<int> everywhere = random_density(20 * 4096);
    std::vector<int> boxed = everywhere;
    const std::vector<int> box = {resolution / 4, resolution / 2, 1, resolution / 2, resolution - 2, resolution / 3};
    for (int i = 0; i < int(voxels); ++i)
    {
        const int at[] = {i % resolution, i / resolution % resolution, i / resolution / resolution};
        for (int axis = 0; axis < 3; ++axis)
            if (at[axis] < box[size_t(axis)] || at[axis] >= box[size_t(axis + 3)])
                boxed[size_t(i)] = 0;
    }
    for (size_t l = 0; l < 2 * lights.size(); ++l) // through a full grid, and through one that says where it is empty
    {
        const glm::dvec3 light = lights[l / 2];
        const std::vector<int>& occupied = l % 2 ? boxed : everywhere;
        HairParams params;
        const StepInfo info = lit_info(random, resolution, light, params);
        const Buffers buffers = {{"occupied", filled(device, occupied)},
                                 {"depth", filled(device, std::vector<float>(voxels, NAN))},
                                 {"light_room", filled(device, l % 2 ? box : rooms()[0])},
                                 {"info", filled(device, info)}};
        run(device, kernel, buffers, cl::NDRange(voxels / size_t(resolution) / chunk));
        const std::vector<float> depth = read<float>(device, buffers.at("depth"), voxels);
        const std::vector<double> expected = oracle::transmittance(occupied, resolution, info);
        double most = 0.0, worst = 0.0;
        for (size_t i = 0; i < voxels; ++i)
        {
            most = std::max(most, expected[i]);
            worst = std::max(worst, std::isfinite(depth[i]) ? std::abs(depth[i] - expected[i]) : INFINITY);
        }
        // The slant's rounding moves a ray by 64 * 6e-8 voxels, which changes each of up to 64 sums by as much of a
        // voxel's density; the sums themselves round 64 times. Both come to 1e-5 of the depth at most.
        EXPECT_LE(worst, 1e-5 * most) << "light from " << light.x << " " << light.y << " " << light.z;
        EXPECT_GT(most, 0.0);
    }
}

INSTANTIATE_TEST_SUITE_P(All, GridPasses,
                         testing::Values(Size{16, 64}, Size{16, 20}, Size{8, 8}, Size{16, 8}, Size{1, 20}));

} // namespace
} // namespace coif

// The walk that lays strands around bodies, alone: one segment from beside two spheres into the crease between them.
#include "sim/source.h"
#include "tests/on_device.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace fs = std::filesystem;

namespace coif
{
namespace
{

using Vec = glm::dvec3;

// Its kernel is the test's own: coif never walks a segment alone.
class Crease : public testing::Test
{
  protected:
    void SetUp() override
    {
        folder = fs::temp_directory_path() / ("coif_crease_" + std::to_string(getpid()));
        fs::create_directories(folder);
        std::ofstream(folder / "walk_probe.cl")
            << "#include \"" << (data_folder() / "kernels/bodies_contact.h").string() << R"("
kernel void walk_probe(global const float* parent, global float* child, constant Capsule* bodies)
{
    const int at = strand_value(get_global_id(0) * WIDTH, 0, 0, 1);
    const float4 x = (float4)(1.0f, 0.0f, 0.0f, 0.0f);
    const HeadPose head = {x.xyzw, x.yxzw, x.yzxw};
    Bodies near;
    near.all = bodies;
    near.near_head = 0;
    near.near_count = 2;
    near.near[0] = 0;
    near.near[1] = 1;
    Points nodes[NODES];
    nodes[0] = nodes[1] = load_lanes(parent + at);
    nodes[2] = load_lanes(child + at);
    const real inside[NODES] = {(real)(0.0f), (real)(0.0f), (real)(0.0f)};
    walk_out(&near, head, nodes, (real)(REST), 2, inside, 1);
    store_lanes(nodes[2], child + at);
}
)";
    }
    void TearDown() override { fs::remove_all(folder); }
    fs::path folder;
};

TEST_F(Crease, a_segment_from_outside_of_two_bodies_ends_outside_of_both_at_its_length)
{
    constexpr int kStrands = 4096;
    constexpr double kRest = 0.14;
    Device device = test_device();
    device.kernel_folder = folder;
    Kernel walk = load_kernel(device, "walk_probe", pass_options(device, 3, 8, "-D REST=0.14f"));
    Random random(5);
    int stuck = 0;
    double worst = 0.0;
    for (int scene = 0; scene < 24; ++scene)
    {
        // They overlap, touch, or leave a gap that hair is drawn into.
        const double a = random.in(0.08, 0.25), b = random.in(0.08, 0.25), apart = a + b + random.in(-0.05, 0.01);
        const Vec centers[] = {{-apart * a / (a + b), 0, 0}, {apart * b / (a + b), 0, 0}};
        const double radii[] = {a, b};
        const auto depth = [&](Vec p)
        { return std::max(radii[0] - glm::distance(p, centers[0]), radii[1] - glm::distance(p, centers[1])); };
        std::vector<Vec> parents, children;
        while (parents.size() < kStrands)
        {
            const Vec p = {random.in(-0.03, 0.03), random.in(0.0, 0.2), random.in(-0.02, 0.02)};
            if (depth(p) > -1e-3 || depth(p) < -0.02)
                continue;
            parents.push_back(p);
            children.push_back(p + kRest * glm::normalize(Vec(0, -1, 0) + random.vector(0.7)));
        }
        Buffers buffers;
        buffers["parent"] = filled(device, to_blocks(parents, kStrands, 1));
        buffers["child"] = filled(device, to_blocks(children, kStrands, 1));
        std::vector<Capsule> bodies;
        for (int i = 0; i < 2; ++i)
            bodies.push_back({F4(float(centers[i].x), 0.0f, 0.0f, float(radii[i])), F4(0.0f, 0.0f, 0.0f, 0.0f)});
        buffers["bodies"] = filled(device, bodies);
        run(device, walk, buffers, cl::NDRange(kStrands / device.width), cl::NullRange);
        const std::vector<Vec> walked =
            from_blocks(read<float>(device, buffers["child"], size_t(kStrands) * 3), kStrands, 1);
        for (size_t i = 0; i < kStrands; ++i)
        {
            EXPECT_NEAR(glm::distance(walked[i], parents[i]), kRest, 1e-4 * kRest);
            stuck += depth(walked[i]) > 1e-3;
            worst = std::max(worst, depth(walked[i]));
        }
    }
    // Where the spheres face each other and the way out is along neither of their planes.
    EXPECT_LT(stuck, 24 * kStrands / 100) << worst;
}

} // namespace
} // namespace coif

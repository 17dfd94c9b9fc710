#include "tests/on_device.h"

#include "sim/error.h"
#include "sim/source.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace coif
{

// What tests keep for the next run is not the user's.
static const int kOwnCache = setenv("XDG_CACHE_HOME", COIF_BUILD_FOLDER "/test_cache", 1);

const Device& test_device()
{
    static const Device device = []
    {
        const char* wish = std::getenv("COIF_TEST_DEVICE");
        return open_device(wish ? wish : "", data_folder() / "kernels");
    }();
    return device;
}

Device with_width(int width)
{
    Device device = test_device();
    device.width = width;
    return device;
}

std::string pass_options(const Device& device, int nodes, int resolution, const std::string& extra)
{
    const int chunk = resolution % device.width == 0 ? device.width : 1;
    return fmt::format("-D NODES={} -D RESOLUTION={} -D WIDTH={} -D CHUNK={} {}", nodes, resolution, device.width,
                       chunk, extra);
}

glm::dvec3 Random::direction()
{
    for (;;)
    {
        const glm::dvec3 v = vector(1.0);
        const double length = glm::length(v);
        if (length > 0.1 && length < 1.0)
            return v / length;
    }
}

// Where a value lies, written out once more rather than taken from kernels/shared.h.
static size_t place(int strand, int node, int axis, int nodes)
{
    const int block = strand / 16, lane = strand % 16;
    return ((size_t(block) * size_t(nodes) + size_t(node)) * 3 + size_t(axis)) * 16 + size_t(lane);
}

std::vector<float> to_blocks(const std::vector<glm::dvec3>& values, int strands, int nodes)
{
    const int filled_up = (strands + 15) / 16 * 16;
    std::vector<float> blocks(size_t(filled_up) * size_t(nodes) * 3);
    for (int s = 0; s < filled_up; ++s)
        for (int k = 0; k < nodes; ++k)
            for (int axis = 0; axis < 3; ++axis)
                blocks[place(s, k, axis, nodes)] = float(values[size_t((s < strands ? s : 0) * nodes + k)][axis]);
    return blocks;
}

std::vector<glm::dvec3> from_blocks(const std::vector<float>& blocks, int strands, int nodes)
{
    std::vector<glm::dvec3> values;
    for (int s = 0; s < strands; ++s)
        for (int k = 0; k < nodes; ++k)
            values.emplace_back(blocks[place(s, k, 0, nodes)], blocks[place(s, k, 1, nodes)],
                                blocks[place(s, k, 2, nodes)]);
    return values;
}

static void set_guides(Groom& groom, const std::vector<glm::dvec3>& roots, const std::vector<glm::dvec3>& directions,
                       const std::vector<float>& segments)
{
    groom.guides = int(roots.size());
    groom.blocks = (groom.guides + 15) / 16;
    groom.root_position = to_blocks(roots, groom.guides, 1);
    groom.root_direction = to_blocks(directions, groom.guides, 1);
    for (int s = 0; s < groom.blocks * 16; ++s)
        groom.segment_length.push_back(segments[size_t(s < groom.guides ? s : 0)]);
    groom.middle = groom.center;
    for (const glm::dvec3& root : roots)
        groom.farthest = std::max(groom.farthest, glm::distance(glm::vec3(root), groom.middle));
}

Groom random_groom(Random& random, int guides, int nodes, int drawn)
{
    Groom groom;
    groom.nodes = nodes;
    groom.center = {0.01f, 0.02f, -0.01f};
    groom.extent = 0.2f;
    groom.longest = 0.2f;
    std::vector<glm::dvec3> roots, directions;
    std::vector<float> segments;
    for (int g = 0; g < guides; ++g)
    {
        const glm::dvec3 out = random.direction();
        roots.push_back(glm::dvec3(groom.center) + 0.1 * out);
        directions.push_back(glm::normalize(out + 0.6 * random.direction()));
        segments.push_back(float(random.in(0.5, 1.0)) * groom.longest / float(nodes - 2));
    }
    set_guides(groom, roots, directions, segments);
    groom.drawn_multi = drawn - drawn / 4;
    for (int i = 0; i < drawn; ++i)
    {
        DrawnStrand strand = {};
        const glm::vec3 root = groom.center + 0.1f * glm::vec3(random.direction());
        strand.root = F4(root.x, root.y, root.z, float(random.in(0.4, 1.0)));
        const float b = float(random.in(0.0, 0.5)), c = float(random.in(0.0, 0.5));
        strand.guide0 = random.below(guides);
        strand.guide1 = random.below(guides);
        strand.guide2 = random.below(guides);
        strand.weights = F4(1.0f - b - c, b, c, 0.0f);
        if (i >= groom.drawn_multi)
            strand.weights = F4(float(random.in(-0.3, 0.3)), float(random.in(-0.3, 0.3)), 0.0f, 0.0f);
        strand.seed = random.below(1 << 24);
        groom.drawn.push_back(strand);
    }
    return groom;
}

std::vector<glm::dvec3> nodes_in(const Device& device, const cl::Buffer& buffer, const Groom& groom)
{
    const size_t values = size_t(groom.blocks) * 16 * size_t(groom.nodes) * 3;
    return from_blocks(read<float>(device, buffer, values), groom.guides, groom.nodes);
}

Groom one_strand(int nodes, float length, glm::vec3 root, glm::vec3 direction)
{
    Groom groom;
    groom.nodes = nodes;
    groom.longest = length;
    groom.extent = 0.2f;
    set_guides(groom, {glm::dvec3(root)}, {glm::dvec3(direction)}, {length / float(nodes - 2)});
    return groom;
}

std::shared_ptr<const DistanceGrid> lumpy_body()
{
    DistanceGrid grid;
    grid.size = {30, 31, 29};
    grid.corner = {-0.14f, -0.15f, -0.14f};
    grid.voxel = 0.01f;
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x)
            {
                const glm::vec3 p = grid.corner + grid.voxel * glm::vec3(x, y, z) - glm::vec3(0.01f, 0.0f, 0.0f);
                grid.distance.push_back(glm::length(p) - 0.09f -
                                        0.004f * std::sin(60.0f * p.x) * std::cos(50.0f * p.y));
            }
    for (int z = 0; z <= grid.size.z / 2; ++z)
        for (int y = 0; y <= grid.size.y / 2; ++y)
            for (int x = 0; x <= grid.size.x / 2; ++x)
                grid.way.push_back(glm::normalize(grid.corner + 2.0f * grid.voxel * glm::vec3(x, y, z) +
                                                  glm::vec3(0.003f, 0.02f, 0.003f)));
    return std::make_shared<const DistanceGrid>(grid);
}

Capsule capsule(glm::dvec3 center, double radius, glm::dvec3 axis)
{
    const double squared = glm::dot(axis, axis);
    return {F4(float(center.x), float(center.y), float(center.z), float(radius)),
            F4(float(axis.x), float(axis.y), float(axis.z), squared > 0.0 ? float(1.0 / squared) : 0.0f)};
}

const std::set<std::string>& read_by_shaders_only()
{
    static const std::set<std::string> paths = {"wave.normal_frequency",
                                                "wave.normal_randomness",
                                                "wave.binormal_frequency",
                                                "wave.binormal_randomness",
                                                "curl.pitch",
                                                "curl.hand",
                                                "curl.phase",
                                                "curl.variation",
                                                "frizz.frequency"};
    return paths;
}

std::vector<uint8_t> bytes_of(const Device& device, const cl::Buffer& buffer)
{
    return read<uint8_t>(device, buffer, buffer.getInfo<CL_MEM_SIZE>());
}

} // namespace coif

// What the device tests share: one device, seeded randomness, and small made-up grooms, so that a test needs no assets
// unless it is about them.
#pragma once
#include "sim/device.h"
#include "sim/groom.h"
#include "sim/solver.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace coif
{

// Opened once; COIF_TEST_DEVICE may name another than the default.
const Device& test_device();

// The same device, told to move `width` strands at once: what GPUs (1), older CPUs (8) and newer ones (16) would run.
Device with_width(int width);

// The build options that Solver gives every kernel.
std::string pass_options(const Device& device, int nodes, int resolution, const std::string& extra = {});

// Uniform numbers that depend on the seed alone.
class Random
{
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double in(double low, double high) { return low + (high - low) * (double(engine_()) / 4294967296.0); }
    int below(int end) { return int(in(0.0, end)); }
    glm::dvec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
    glm::dvec3 direction();

  private:
    std::mt19937 engine_;
};

template <typename T> cl::Buffer filled(const Device& device, const std::vector<T>& values)
{
    const cl::Buffer buffer = allocate(device, values.size() * sizeof(T), "a test");
    write(device, buffer, values);
    return buffer;
}

template <typename T> cl::Buffer filled(const Device& device, const T& value)
{
    return filled(device, std::vector<T>(1, value));
}

// Vectors per strand and node <-> the blocks of 16 lanes that kernels read. Lanes that fill the last block copy the
// first strand.
std::vector<float> to_blocks(const std::vector<glm::dvec3>& values, int strands, int nodes);
std::vector<glm::dvec3> from_blocks(const std::vector<float>& blocks, int strands, int nodes);

// The vectors of every node that such a buffer of a groom holds: [strand][node].
std::vector<glm::dvec3> nodes_in(const Device& device, const cl::Buffer& buffer, const Groom& groom);

// Roots all over a sphere of 10 cm, leaning this way and that, of unequal segments; `drawn` strands, a quarter of them
// copies.
Groom random_groom(Random& random, int guides, int nodes, int drawn);

// One guide whose root is at `root` and points along `direction` (unit length).
Groom one_strand(int nodes, float length, glm::vec3 root, glm::vec3 direction);

// A lumpy ball of about 9 cm about the head's centre as a distance grid, with ways out that differ from the slope a
// little.
std::shared_ptr<const DistanceGrid> lumpy_body();

// A sphere, or with an axis a capsule, as the kernels read it.
Capsule capsule(glm::dvec3 center, double radius, glm::dvec3 axis = glm::dvec3(0.0));

// Parameters that change the picture of waves, curls and frizz but no node of a strand.
const std::set<std::string>& read_by_shaders_only();

// Every byte of a buffer.
std::vector<uint8_t> bytes_of(const Device& device, const cl::Buffer& buffer);

} // namespace coif

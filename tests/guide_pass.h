// What the tests of the passes that move guides share: the forces and the head that act on hair of a case, and how far
// apart device and twin are.
#pragma once
#include "tests/on_device.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace coif
{

// As a float holds it.
inline glm::dvec3 rounded(glm::dvec3 v) { return glm::dvec3(glm::vec3(v)); }

// As the device reads them.
inline HairParams pass_params(int nodes, int resolution, bool wind, bool repulsion, void (*change)(HairParams&))
{
    HairParams params;
    params.strand_nodes = nodes;
    params.grid_resolution = resolution;
    params.forces_wind = wind ? F4(9.0f, -2.0f, 4.0f, 0.0f) : F4(0.0f, 0.0f, 0.0f, 0.0f);
    params.forces_repulsion = repulsion ? 2.0f : 0.0f;
    if (change)
        change(params);
    return device_params(params);
}

// The head anywhere, and on its way by up to `way` (m) along each axis and by `angle` (rad) in a step, or by a leap.
inline void move_head(Random& random, bool leap, double way, double angle, Pose& before, Substep& now)
{
    before.origin = random.vector(2.0);
    before.turn = glm::angleAxis(random.in(-3.0, 3.0), random.direction());
    now.head.origin = before.origin + random.vector(leap ? 5.0 : way);
    now.head.turn = glm::angleAxis(leap ? 2.0 : angle, random.direction()) * before.turn;
    now.time = 3.7;
}

inline PlacedGrid lumpy_head() { return {lumpy_body(), 1.1f, {0.005f, -0.01f, 0.0f}}; }

// Vectors per voxel as kernels read them: x of them all, then y, then z. At least one value, for a buffer to hold.
inline std::vector<float> axis_by_axis(const std::vector<glm::dvec3>& vectors)
{
    std::vector<float> values;
    for (int axis = 0; axis < 3; ++axis)
        for (const glm::dvec3& v : vectors)
            values.push_back(float(v[axis]));
    values.resize(std::max<size_t>(values.size(), 1));
    return values;
}

// The largest difference of numbers or vectors along each strand; infinite where something is not a number.
template <typename T> std::vector<double> apart(const std::vector<T>& a, const std::vector<T>& b, int strands)
{
    std::vector<double> most(size_t(strands), 0.0);
    for (size_t i = 0; i < a.size(); ++i)
    {
        double d;
        if constexpr (std::is_same_v<T, glm::dvec3>)
            d = glm::distance(a[i], b[i]);
        else
            d = std::abs(a[i] - b[i]);
        double& m = most[i / (a.size() / most.size())];
        m = std::max(m, std::isfinite(d) ? d : INFINITY);
    }
    return most;
}

} // namespace coif

#include "app/mesh_order.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace coif
{

// Every third bit of what is below 1024.
static uint32_t spread(uint32_t bits)
{
    uint32_t wide = 0;
    for (int i = 0; i < 10; ++i)
        wide |= (bits >> i & 1u) << (3 * i);
    return wide;
}

std::vector<glm::uvec3> along_curve(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles)
{
    if (positions.empty())
        return triangles;
    glm::vec3 low = positions.front(), high = low;
    for (const glm::vec3& p : positions)
        for (int axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    const glm::vec3 size = high - low;
    const float longest = std::max({size.x, size.y, size.z});
    std::vector<std::pair<uint32_t, uint32_t>> order; // place on the curve, triangle
    for (uint32_t t = 0; t < triangles.size(); ++t)
    {
        const glm::uvec3& of = triangles[t];
        const glm::vec3 middle = (positions[of.x] + positions[of.y] + positions[of.z]) / 3.0f - low;
        uint32_t place = 0;
        for (int axis = 0; axis < 3; ++axis)
        {
            const float cell = 1024.0f * middle[axis] / longest; // no number where the mesh is a point
            place |= spread(cell > 0.0f ? uint32_t(std::min(cell, 1023.0f)) : 0u) << axis;
        }
        order.emplace_back(place, t);
    }
    std::sort(order.begin(), order.end());
    std::vector<glm::uvec3> sorted;
    for (const auto& [place, t] : order)
        sorted.push_back(triangles[t]);
    return sorted;
}

int facing(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles)
{
    std::vector<std::pair<unsigned, unsigned>> edges, back;
    double volume = 0.0; // six times what is within, by tetrahedra over each triangle
    for (const glm::uvec3& t : triangles)
    {
        for (int i = 0; i < 3; ++i)
        {
            edges.emplace_back(t[i], t[(i + 1) % 3]);
            back.emplace_back(t[(i + 1) % 3], t[i]);
        }
        volume +=
            glm::dot(glm::dvec3(positions[t.x]), glm::cross(glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z])));
    }
    std::sort(edges.begin(), edges.end());
    std::sort(back.begin(), back.end());
    const bool closed = edges == back && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
    return !closed ? 0 : volume > 0.0 ? 1 : volume < 0.0 ? -1 : 0;
}

} // namespace coif

#include "sim/winding.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <tuple>

namespace coif
{

// For each position the first one that lies in the same place.
static std::vector<unsigned> welded(const std::vector<glm::vec3>& positions)
{
    std::vector<unsigned> order(positions.size()), same(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](unsigned i) { return std::tuple(positions[i].x, positions[i].y, positions[i].z); };
    std::sort(order.begin(), order.end(),
              [&](unsigned a, unsigned b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    for (size_t i = 0; i < order.size(); ++i)
        same[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? same[order[i - 1]] : order[i];
    return same;
}

namespace
{
struct Edge
{
    uint64_t ends; // the lesser corner in the high half
    int triangle;
    bool forwards; // from the lesser to the greater
};
} // namespace

static glm::dvec3 area_of(const Mesh& mesh, glm::uvec3 t)
{
    const glm::dvec3 a(mesh.positions[t.x]);
    return 0.5 * glm::cross(glm::dvec3(mesh.positions[t.y]) - a, glm::dvec3(mesh.positions[t.z]) - a);
}

static glm::dvec3 center_of(const Mesh& mesh, glm::uvec3 t)
{
    return (glm::dvec3(mesh.positions[t.x]) + glm::dvec3(mesh.positions[t.y]) + glm::dvec3(mesh.positions[t.z])) / 3.0;
}

// Should the piece be turned over? By what most of its area says about the first triangle, unless it encloses, as seen
// from its own middle, clearly more from the wrong side.
static bool turned_over(const Mesh& mesh, const std::vector<glm::uvec3>& triangles, const std::vector<int>& piece,
                        const std::vector<int8_t>& flip)
{
    glm::dvec3 middle(0.0);
    double all = 0.0, flipped = 0.0;
    for (const int t : piece)
    {
        const double area = glm::length(area_of(mesh, triangles[size_t(t)]));
        middle += area * center_of(mesh, triangles[size_t(t)]);
        all += area;
        flipped += flip[size_t(t)] ? area : 0.0;
    }
    middle /= all;
    double volume = 0.0, most = 0.0;
    for (const int t : piece)
    {
        const glm::dvec3 out = center_of(mesh, triangles[size_t(t)]) - middle;
        const glm::dvec3 area = area_of(mesh, triangles[size_t(t)]) * (flip[size_t(t)] ? -1.0 : 1.0);
        volume += glm::dot(out, area);
        most += glm::length(out) * glm::length(area);
    }
    return std::abs(volume) > 0.1 * most ? volume < 0.0 : flipped > 0.5 * all;
}

std::vector<glm::uvec3> oriented_triangles(const Mesh& mesh)
{
    const std::vector<unsigned> same = welded(mesh.positions);
    // Each shape once: a surface that was exported from both sides would wind about nothing.
    std::vector<std::tuple<unsigned, unsigned, unsigned, int>> shapes;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
    {
        const glm::uvec3 t = mesh.triangles[i];
        unsigned c[3] = {same[t.x], same[t.y], same[t.z]};
        const glm::dvec3 area = area_of(mesh, t);
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0] || !(glm::dot(area, area) > 0.0))
            continue;
        std::sort(c, c + 3);
        shapes.emplace_back(c[0], c[1], c[2], int(i));
    }
    if (shapes.empty())
        return mesh.triangles;
    std::sort(shapes.begin(), shapes.end());
    std::vector<int> kept;
    for (size_t i = 0; i < shapes.size(); ++i)
    {
        const auto& [a, b, c, t] = shapes[i];
        if (i == 0 || std::tie(a, b, c) !=
                          std::tie(std::get<0>(shapes[i - 1]), std::get<1>(shapes[i - 1]), std::get<2>(shapes[i - 1])))
            kept.push_back(t);
    }
    std::sort(kept.begin(), kept.end());
    std::vector<glm::uvec3> triangles;
    std::vector<Edge> edges;
    for (const int t : kept)
    {
        const glm::uvec3 corners = mesh.triangles[size_t(t)];
        for (int k = 0; k < 3; ++k)
        {
            const unsigned from = same[corners[k]], to = same[corners[(k + 1) % 3]];
            edges.push_back(
                {uint64_t(std::min(from, to)) << 32 | std::max(from, to), int(triangles.size()), from < to});
        }
        triangles.push_back(corners);
    }
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return std::tie(a.ends, a.triangle) < std::tie(b.ends, b.triangle); });

    // Across an edge that just two triangles share, their directions along it must differ.
    std::vector<int> neighbour(triangles.size() * 3, -1);
    std::vector<int8_t> unlike(triangles.size() * 3, 0), neighbours(triangles.size(), 0);
    for (size_t i = 0, end; i < edges.size(); i = end)
    {
        for (end = i + 1; end < edges.size() && edges[end].ends == edges[i].ends;)
            ++end;
        if (end - i != 2)
            continue;
        for (int k = 0; k < 2; ++k)
        {
            const int own = edges[i + size_t(k)].triangle, other = edges[i + size_t(1 - k)].triangle;
            const size_t slot = size_t(own) * 3 + size_t(neighbours[size_t(own)]++);
            neighbour[slot] = other;
            unlike[slot] = edges[i].forwards == edges[i + 1].forwards;
        }
    }
    std::vector<int8_t> flip(triangles.size(), -1);
    std::vector<int> piece;
    for (size_t seed = 0; seed < triangles.size(); ++seed)
    {
        if (flip[seed] >= 0)
            continue;
        piece.assign(1, int(seed));
        flip[seed] = 0;
        for (size_t i = 0; i < piece.size(); ++i)
            for (size_t k = 0; k < size_t(neighbours[size_t(piece[i])]); ++k)
            {
                const size_t slot = size_t(piece[i]) * 3 + k, other = size_t(neighbour[slot]);
                if (flip[other] >= 0)
                    continue;
                flip[other] = flip[size_t(piece[i])] ^ unlike[slot];
                piece.push_back(int(other));
            }
        if (turned_over(mesh, triangles, piece, flip))
            for (const int t : piece)
                flip[size_t(t)] ^= 1;
    }
    for (size_t i = 0; i < triangles.size(); ++i)
        if (flip[i])
            std::swap(triangles[i].y, triangles[i].z);
    return triangles;
}

WindingTree::WindingTree(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles)
    : positions_(positions), triangles_(triangles)
{
    assert(!triangles.empty());
    for (const glm::uvec3& t : triangles)
        centers_.push_back((positions[t.x] + positions[t.y] + positions[t.z]) / 3.0f);
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.emplace_back();
    build(0, 0, int(order_.size()));
}

void WindingTree::build(int node, int first, int count)
{
    glm::vec3 low(INFINITY), high(-INFINITY), area(0.0f), middle(0.0f);
    float all = 0.0f;
    for (int i = first; i < first + count; ++i)
    {
        const glm::uvec3 t = triangles_[size_t(order_[size_t(i)])];
        const glm::vec3 a = positions_[t.x], center = centers_[size_t(order_[size_t(i)])];
        const glm::vec3 own = 0.5f * glm::cross(positions_[t.y] - a, positions_[t.z] - a);
        const float size = glm::length(own);
        area += own;
        middle += size * center;
        all += size;
        low = glm::min(low, center);
        high = glm::max(high, center);
    }
    middle = all > 0.0f ? middle / all : 0.5f * (low + high);
    float radius2 = 0.0f;
    for (int i = first; i < first + count; ++i)
        for (int k = 0; k < 3; ++k)
        {
            const glm::vec3 away = positions_[triangles_[size_t(order_[size_t(i)])][k]] - middle;
            radius2 = std::max(radius2, glm::dot(away, away));
        }
    nodes_[size_t(node)] = {middle, std::sqrt(radius2), area, first, count};
    if (count <= 8)
        return;
    const glm::vec3 side = high - low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const int half = count / 2;
    std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                     [&](int a, int b) { return centers_[size_t(a)][axis] < centers_[size_t(b)][axis]; });
    const int children = int(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[size_t(node)].first = children;
    nodes_[size_t(node)].count = 0;
    build(children, first, half);
    build(children + 1, first + half, count - half);
}

// Solid angle of a triangle seen from the origin (van Oosterom, Strackee. The solid angle of a plane triangle. 1983).
static float solid_angle(glm::vec3 a, glm::vec3 b, glm::vec3 c)
{
    const float la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return 2.0f * std::atan2(glm::dot(a, glm::cross(b, c)),
                             la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

float WindingTree::winding(glm::vec3 p) const
{
    float angle = 0.0f;
    int stack[64], depth = 0; // halves of at most 2^31 triangles, and one to go on with at each
    for (stack[depth++] = 0; depth > 0;)
    {
        const Node& node = nodes_[size_t(stack[--depth])];
        const glm::vec3 out = node.center - p;
        const float squared = glm::dot(out, out);
        if (squared > 4.0f * node.radius * node.radius)
            angle += glm::dot(out, node.area) / (squared * std::sqrt(squared));
        else if (node.count == 0)
        {
            stack[depth++] = node.first;
            stack[depth++] = node.first + 1;
        }
        else
            for (int i = node.first; i < node.first + node.count; ++i)
            {
                const glm::uvec3 t = triangles_[size_t(order_[size_t(i)])];
                angle += solid_angle(positions_[t.x] - p, positions_[t.y] - p, positions_[t.z] - p);
            }
    }
    return angle / (4.0f * std::numbers::pi_v<float>);
}

} // namespace coif

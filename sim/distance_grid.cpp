#include "sim/distance_grid.h"

#include "sim/winding.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace coif
{

// All of the work is done in voxels from the grid's corner, so that no scale of the mesh matters.
namespace
{
struct Work
{
    glm::ivec3 size;
    std::vector<glm::vec3> positions;
    const std::vector<glm::uvec3>& triangles;

    // Of each sample: the nearest point of the surface found so far, on which triangle, and how far it is, squared.
    std::vector<glm::vec3> nearest;
    std::vector<int> triangle; // kNone, kPoint for a point on none, else an index
    std::vector<float> squared;

    static constexpr int kNone = -1, kPoint = -2;
    size_t index(int x, int y, int z) const
    {
        return (size_t(z) * size_t(size.y) + size_t(y)) * size_t(size.x) + size_t(x);
    }
};
} // namespace

DistanceGrid distance_lattice(const Mesh& mesh, int resolution)
{
    DistanceGrid grid;
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::uvec3& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
        {
            const glm::dvec3 p(mesh.positions[t[k]]);
            if (!std::isfinite(p.x + p.y + p.z))
                return grid;
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    const glm::dvec3 extent = high - low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (!(longest > 1e-25 && longest < 1e25)) // what floats hold, squared
        return grid;
    const double margin = longest / 8.0;
    const glm::dvec3 sides = extent + 2.0 * margin;
    grid.voxel = float(std::cbrt(sides.x * sides.y * sides.z) / std::clamp(resolution, 4, 400));
    grid.corner = glm::vec3(low - margin);
    grid.size = glm::ivec3(glm::ceil(sides / double(grid.voxel) - 1e-3)) + 1; // whole numbers stay what they are
    return grid;
}

static void take_if_nearer(Work& work, size_t i, glm::vec3 at, int triangle)
{
    const glm::uvec3 t = work.triangles[size_t(triangle)];
    const glm::vec3 away = from_triangle(at, work.positions[t.x], work.positions[t.y], work.positions[t.z]);
    const float squared = glm::dot(away, away);
    if (!(squared < work.squared[i]))
        return;
    work.squared[i] = squared;
    work.nearest[i] = at - away;
    work.triangle[i] = triangle;
}

static void take_point_if_nearer(Work& work, size_t i, glm::vec3 at, glm::vec3 point, int triangle = Work::kPoint)
{
    const float squared = glm::dot(at - point, at - point);
    if (!(squared < work.squared[i]))
        return;
    work.squared[i] = squared;
    work.nearest[i] = point;
    work.triangle[i] = triangle;
}

// Exactly, at all samples within a voxel of the surface.
static void measure_near(Work& work)
{
    for (size_t n = 0; n < work.triangles.size(); ++n)
    {
        const glm::uvec3 t = work.triangles[n];
        const glm::vec3 a = work.positions[t.x], b = work.positions[t.y], c = work.positions[t.z];
        const glm::ivec3 first = glm::max(glm::ivec3(glm::floor(glm::min(a, glm::min(b, c)))), 0);
        const glm::ivec3 last = glm::min(glm::ivec3(glm::ceil(glm::max(a, glm::max(b, c)))), work.size - 1);
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x)
                    take_if_nearer(work, work.index(x, y, z), glm::vec3(x, y, z), int(n));
    }
}

// From sample to sample, in all eight directions in which x, y and z may run: each looks whether what is nearest to the
// three neighbours that it comes from is nearer than its own. Where what is nearest changes within a voxel, that
// is wrong by up to a fifth of one.
static void sweep(Work& work)
{
    const glm::ivec3 size = work.size;
    const ptrdiff_t strides[3] = {1, size.x, ptrdiff_t(size.x) * size.y};
    for (int direction = 0; direction < 8; ++direction)
    {
        const int back[3] = {direction & 1 ? 1 : -1, direction & 2 ? 1 : -1, direction & 4 ? 1 : -1};
        for (int k = 0; k < size.z; ++k)
            for (int j = 0; j < size.y; ++j)
                for (int i = 0; i < size.x; ++i)
                {
                    const glm::ivec3 at(direction & 1 ? size.x - 1 - i : i, direction & 2 ? size.y - 1 - j : j,
                                        direction & 4 ? size.z - 1 - k : k);
                    const size_t here = work.index(at.x, at.y, at.z);
                    for (int axis = 0; axis < 3; ++axis)
                    {
                        const int neighbour = at[axis] + back[axis];
                        if (neighbour < 0 || neighbour >= size[axis])
                            continue;
                        const size_t there = size_t(ptrdiff_t(here) + back[axis] * strides[axis]);
                        const int triangle = work.triangle[there];
                        if (triangle == Work::kNone)
                            continue;
                        const int before = work.triangle[here];
                        take_point_if_nearer(work, here, glm::vec3(at), work.nearest[there], triangle);
                        if (triangle >= 0 && triangle != before && work.triangle[here] == triangle)
                            take_if_nearer(work, here, glm::vec3(at), triangle);
                    }
                }
    }
}

// Is each sample inside? Winding numbers are harmonic away from the surface, so what one sample is, its neighbours are
// as well up to a share of the distance: widely spaced samples first, and only those asked that none has answered for.
// A harmonic function within m of its value there changes by less than 3 m / r a length in the middle of a ball of
// radius r; one that the surface's windings make differs by about one.
static std::vector<int8_t> inside_or_out(const Work& work)
{
    const glm::ivec3 size = work.size;
    const WindingTree tree(work.positions, work.triangles);
    std::vector<int8_t> sign(work.squared.size(), 0);
    for (int stride = 8; stride > 0; stride /= 2)
        for (int z = 0; z < size.z; z += stride)
            for (int y = 0; y < size.y; y += stride)
                for (int x = 0; x < size.x; x += stride)
                {
                    const size_t i = work.index(x, y, z);
                    if (sign[i])
                        continue;
                    const float above = tree.winding(glm::vec3(x, y, z)) - 0.5f;
                    sign[i] = above > 0.0f ? -1 : 1;
                    const float reach =
                        std::sqrt(work.squared[i]) * std::abs(above) / (3.0f * (0.5f + std::abs(above)));
                    const int r = int(reach);
                    if (r < 1)
                        continue;
                    const glm::ivec3 low = glm::max(glm::ivec3(x, y, z) - r, 0);
                    const glm::ivec3 high = glm::min(glm::ivec3(x, y, z) + r, size - 1);
                    for (int k = low.z; k <= high.z; ++k)
                        for (int j = low.y; j <= high.y; ++j)
                            for (int l = low.x; l <= high.x; ++l)
                            {
                                int8_t& other = sign[work.index(l, j, k)];
                                const int dx = l - x, dy = j - y, dz = k - z;
                                if (!other && float(dx * dx + dy * dy + dz * dz) <= reach * reach)
                                    other = sign[i];
                            }
                }
    return sign;
}

// Where inside turns into outside with no surface between, as in the opening of a neck, a lid belongs: else distances
// would leap there. Its points lie half-way between the samples. Returns whether there are any.
static bool close_openings(Work& work, const std::vector<int8_t>& sign)
{
    std::vector<std::tuple<size_t, glm::vec3, glm::vec3>> lids; // sample, where it is, point
    const ptrdiff_t strides[3] = {1, work.size.x, ptrdiff_t(work.size.x) * work.size.y};
    for (int z = 0; z < work.size.z; ++z)
        for (int y = 0; y < work.size.y; ++y)
            for (int x = 0; x < work.size.x; ++x)
            {
                const glm::ivec3 at(x, y, z);
                const size_t i = work.index(x, y, z);
                for (int axis = 0; axis < 3; ++axis)
                {
                    if (at[axis] + 1 == work.size[axis])
                        continue;
                    const size_t next = i + size_t(strides[axis]);
                    // Further from the surface than from each other: it does not pass between them.
                    if (sign[i] == sign[next] || std::max(work.squared[i], work.squared[next]) <= 1.0f)
                        continue;
                    glm::vec3 middle(at);
                    middle[axis] += 0.5f;
                    lids.emplace_back(i, glm::vec3(at), middle);
                    lids.emplace_back(next, 2.0f * middle - glm::vec3(at), middle);
                }
            }
    for (const auto& [i, at, point] : lids)
        take_point_if_nearer(work, i, at, point);
    return !lids.empty();
}

DistanceGrid compute_distance_grid(const Mesh& mesh, int resolution)
{
    DistanceGrid grid = distance_lattice(mesh, resolution);
    if (grid.size.x == 0)
        return grid;
    const std::vector<glm::uvec3> triangles = oriented_triangles(mesh);
    const size_t samples = size_t(grid.size.x) * size_t(grid.size.y) * size_t(grid.size.z);
    Work work{grid.size,
              {},
              triangles,
              std::vector<glm::vec3>(samples, glm::vec3(0.0f)),
              std::vector<int>(samples, Work::kNone),
              std::vector<float>(samples, INFINITY)};
    for (const glm::vec3& p : mesh.positions)
        work.positions.push_back(glm::vec3((glm::dvec3(p) - glm::dvec3(grid.corner)) / double(grid.voxel)));
    measure_near(work);
    sweep(work);
    const std::vector<int8_t> sign = inside_or_out(work);
    if (close_openings(work, sign))
        sweep(work);
    grid.distance.reserve(samples);
    for (size_t i = 0; i < samples; ++i)
        grid.distance.push_back(float(sign[i]) * std::sqrt(work.squared[i]) * grid.voxel);
    return grid;
}

// Difference of the neighbours' values along each axis; at the border, the sample's own for the one that is not there.
static glm::vec3 slope_at(const std::vector<float>& values, glm::ivec3 size, glm::ivec3 at, size_t sample)
{
    const size_t strides[3] = {1, size_t(size.x), size_t(size.x) * size_t(size.y)};
    glm::vec3 slope;
    for (int axis = 0; axis < 3; ++axis)
        slope[axis] = values[at[axis] + 1 < size[axis] ? sample + strides[axis] : sample] -
                      values[at[axis] > 0 ? sample - strides[axis] : sample];
    return slope;
}

// Closing by a ball: the body is as far from a sample as that is from where the ball's centre may be, less its radius.
// What is not in the grid cannot hold it: the ball shrinks to fit between the body and the border.
static void fill_hollows(DistanceGrid& grid, float radius)
{
    size_t sample = 0;
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x, ++sample)
                if (x == 0 || y == 0 || z == 0 || x + 1 == grid.size.x || y + 1 == grid.size.y || z + 1 == grid.size.z)
                    radius = std::min(radius, 0.99f * grid.distance[sample]);
    if (!(radius > grid.voxel))
        return;
    const size_t samples = grid.distance.size();
    const std::vector<glm::uvec3> none;
    Work work{grid.size,
              {},
              none,
              std::vector<glm::vec3>(samples, glm::vec3(0.0f)),
              std::vector<int>(samples, Work::kNone),
              std::vector<float>(samples, INFINITY)};
    // Where the ball's centre may be: beyond a radius from the body. From a sample there, what it is too far goes to a
    // point of the border or, in a crease, short of it, which the samples beside it that are not there hear of.
    sample = 0;
    for (int z = 0; z < grid.size.z; ++z)
        for (int y = 0; y < grid.size.y; ++y)
            for (int x = 0; x < grid.size.x; ++x, ++sample)
            {
                const glm::ivec3 at(x, y, z);
                const float beyond = (grid.distance[sample] - radius) / grid.voxel;
                if (beyond < 0.0f)
                    continue;
                take_point_if_nearer(work, sample, glm::vec3(at), glm::vec3(at));
                if (beyond > 2.0f)
                    continue;
                const glm::vec3 slope = slope_at(grid.distance, grid.size, at, sample);
                const float steep = glm::length(slope);
                const glm::vec3 border =
                    glm::vec3(at) - (steep > 0.5f * grid.voxel ? slope * (beyond / steep) : glm::vec3(0.0f));
                const glm::ivec3 first = glm::max(at - 1, 0), last = glm::min(at + 1, grid.size - 1);
                for (int k = first.z; k <= last.z; ++k)
                    for (int j = first.y; j <= last.y; ++j)
                        for (int i = first.x; i <= last.x; ++i)
                            if (grid.distance[work.index(i, j, k)] < radius)
                                take_point_if_nearer(work, work.index(i, j, k), glm::vec3(i, j, k), border);
            }
    sweep(work);
    // The border is known in points up to a voxel apart, which makes ways to it longer: beside it by half a voxel, at
    // the surface by a tenth, and further in, where the nearest is not found so well, by some of the way. With that
    // much to spare nothing changes where the ball touches the surface.
    for (size_t i = 0; i < samples; ++i)
    {
        if (!(grid.distance[i] < radius) || work.triangle[i] == Work::kNone)
            continue;
        const float away = std::sqrt(work.squared[i]) * grid.voxel;
        const float spare = 0.1f * grid.voxel + 0.4f * grid.voxel * std::max(0.0f, 1.0f - away / radius) +
                            0.15f * std::max(0.0f, away - radius);
        grid.distance[i] = std::min(grid.distance[i], radius - away + spare);
    }
}

// One pass of a running mean over 2 reach + 1 samples along an axis; beyond the grid its border goes on.
static void blur_along(std::vector<float>& values, glm::ivec3 size, int axis, int reach)
{
    const size_t strides[3] = {1, size_t(size.x), size_t(size.x) * size_t(size.y)};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3, n = size[axis];
    std::vector<float> line(static_cast<size_t>(n));
    for (int j = 0; j < size[v]; ++j)
        for (int i = 0; i < size[u]; ++i)
        {
            float* first = values.data() + size_t(i) * strides[u] + size_t(j) * strides[v];
            const auto at = [&](int k) { return line[size_t(std::clamp(k, 0, n - 1))]; };
            for (int k = 0; k < n; ++k)
                line[size_t(k)] = first[size_t(k) * strides[axis]];
            double sum = 0.0;
            for (int k = -reach; k <= reach; ++k)
                sum += at(k);
            for (int k = 0; k < n; ++k)
            {
                first[size_t(k) * strides[axis]] = float(sum / (2 * reach + 1));
                sum += double(at(k + reach + 1)) - double(at(k - reach));
            }
        }
}

static std::vector<glm::vec3> ways_out(const DistanceGrid& grid, float radius)
{
    std::vector<float> blurred = grid.distance;
    // Three means of this reach blur about as far as a Gaussian of half the radius.
    const int reach = std::clamp(int(std::lround(0.5f * radius / grid.voxel)), 1, 32);
    for (int pass = 0; pass < 3; ++pass)
        for (int axis = 0; axis < 3; ++axis)
            blur_along(blurred, grid.size, axis, reach);
    std::vector<glm::vec3> ways;
    for (int z = 0; z <= grid.size.z / 2; ++z)
        for (int y = 0; y <= grid.size.y / 2; ++y)
            for (int x = 0; x <= grid.size.x / 2; ++x)
            {
                const glm::ivec3 at = glm::min(glm::ivec3(x, y, z) * 2, grid.size - 1);
                const size_t i =
                    (size_t(at.z) * size_t(grid.size.y) + size_t(at.y)) * size_t(grid.size.x) + size_t(at.x);
                const glm::vec3 slope = slope_at(blurred, grid.size, at, i);
                const float length = glm::length(slope);
                ways.push_back(length > 1e-4f * grid.voxel ? slope / length : glm::vec3(0.0f, 1.0f, 0.0f));
            }
    return ways;
}

DistanceGrid body_grid(const DistanceGrid& grid, float radius)
{
    DistanceGrid body = grid;
    if (body.empty())
        return body;
    fill_hollows(body, radius);
    body.way = ways_out(body, radius);
    return body;
}

DistanceAt distance_at(const DistanceGrid& grid, glm::vec3 p)
{
    if (grid.empty() || !std::isfinite(p.x + p.y + p.z))
        return {kFarOutside, glm::vec3(0.0f)};
    const glm::vec3 g = (p - grid.corner) / grid.voxel;
    const glm::vec3 within = glm::clamp(g, glm::vec3(0.0f), glm::vec3(grid.size - 1));
    const glm::ivec3 cell = glm::min(glm::ivec3(within), grid.size - 2);
    const glm::vec3 f = within - glm::vec3(cell);
    const size_t row = size_t(grid.size.x), plane = row * size_t(grid.size.y);
    const float* v = grid.distance.data() + size_t(cell.z) * plane + size_t(cell.y) * row + size_t(cell.x);
    DistanceAt at = {glm::distance(g, within) * grid.voxel, glm::vec3(0.0f)};
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::ivec3 c(corner & 1, corner >> 1 & 1, corner >> 2);
        const float value = v[size_t(c.z) * plane + size_t(c.y) * row + size_t(c.x)];
        const glm::vec3 weight = glm::mix(1.0f - f, f, glm::vec3(c)), slope = glm::vec3(c) * 2.0f - 1.0f;
        at.distance += value * weight.x * weight.y * weight.z;
        at.gradient +=
            value / grid.voxel *
            glm::vec3(slope.x * weight.y * weight.z, weight.x * slope.y * weight.z, weight.x * weight.y * slope.z);
    }
    return at;
}

float distance_to(const PlacedGrid& body, glm::vec3 p)
{
    return body.grid ? distance_at(*body.grid, (p - body.offset) / body.scale).distance * body.scale : kFarOutside;
}

} // namespace coif

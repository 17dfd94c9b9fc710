#include "tests/oracle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace coif::oracle
{

static Vec turned(float4 row0, float4 row1, float4 row2, Vec v)
{
    return {glm::dot(xyz(row0), v), glm::dot(xyz(row1), v), glm::dot(xyz(row2), v)};
}

// ---- wind: eq. 5.2 with gradient noise (Perlin 1985, 2002) -------------------------------------------------------

static uint32_t lattice_hash(int x, int y, int z, uint32_t component)
{
    const auto cell = [](int i) { return uint32_t((i % 256 + 256) % 256); };
    uint32_t h = cell(x) * 0x8da6b343u ^ cell(y) * 0xd8163841u ^ cell(z) * 0xcb1ab31fu ^ component * 0x9e3779b9u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

static double noise(Vec at, uint32_t component)
{
    const int cell[3] = {int(std::floor(at.x)), int(std::floor(at.y)), int(std::floor(at.z))};
    double sum = 0.0;
    for (int dz = 0; dz <= 1; ++dz)
        for (int dy = 0; dy <= 1; ++dy)
            for (int dx = 0; dx <= 1; ++dx)
            {
                const int corner[3] = {cell[0] + dx, cell[1] + dy, cell[2] + dz};
                const uint32_t h = lattice_hash(corner[0], corner[1], corner[2], component);
                double slope = 0.0, weight = 1.0;
                for (int axis = 0; axis < 3; ++axis)
                {
                    const double away = at[axis] - corner[axis];
                    slope += ((h >> (10 * axis)) % 1024 / 1023.0 * 2.0 - 1.0) * away;
                    const double t = 1.0 - std::abs(away);
                    weight *= 6.0 * std::pow(t, 5) - 15.0 * std::pow(t, 4) + 10.0 * std::pow(t, 3);
                }
                sum += weight * slope;
            }
    return sum;
}

Vec wind_at(Vec at, const StepInfo& info)
{
    const Vec p = at / 0.15 + xyz(info.gust_origin);
    const Vec gusts(noise(p, 0), noise(p, 1), noise(p, 2));
    return xyz(info.wind) + double(info.wind.w) * info.gust_origin.w * gusts;
}

Vec across_wind(Vec w, Vec tangent)
{
    const double size = glm::length(w) * glm::length(tangent);
    if (size < 1e-12)
        return Vec(0.0);
    return glm::length(glm::cross(w, tangent)) / size * w;
}

// ---- the grid ----------------------------------------------------------------------------------------------------

static size_t voxel_at(int x, int y, int z, int resolution)
{
    return size_t(x) + size_t(resolution) * (size_t(y) + size_t(resolution) * size_t(z));
}

static Vec grid_coordinates(Vec p, const StepInfo& info)
{
    return (p - xyz(info.grid_corner)) / double(info.grid_corner.w) - 0.5;
}

// Calls visit(voxel, weight) for the eight voxels about a point, if it lies among the voxels' centres.
template <typename Visit> static void trilinear(Vec p, int resolution, const StepInfo& info, Visit visit)
{
    const Vec g = grid_coordinates(p, info);
    for (int axis = 0; axis < 3; ++axis)
        if (!(g[axis] >= 0.0 && g[axis] < resolution - 1))
            return;
    const int x = int(g.x), y = int(g.y), z = int(g.z);
    for (int k = 0; k <= 1; ++k)
        for (int j = 0; j <= 1; ++j)
            for (int i = 0; i <= 1; ++i)
                visit(voxel_at(x + i, y + j, z + k, resolution), (1.0 - std::abs(g.x - (x + i))) *
                                                                     (1.0 - std::abs(g.y - (y + j))) *
                                                                     (1.0 - std::abs(g.z - (z + k))));
}

Vec repulsion_force(Vec at, const std::vector<Vec>& gradient, int resolution, const StepInfo& info)
{
    Vec slope(0.0);
    trilinear(at, resolution, info, [&](size_t voxel, double weight) { slope += weight * gradient[voxel]; });
    const Vec push = -double(info.repulsion) * slope;
    const double size = glm::length(push);
    return size > 50.0 ? push * (50.0 / size) : push;
}

Density add_density(const Strands& strands, int resolution, const StepInfo& info)
{
    const size_t voxels = size_t(resolution) * size_t(resolution) * size_t(resolution);
    Density density{std::vector<double>(voxels), std::vector<int>(voxels)};
    for (int s = 0; s < strands.count(); ++s)
        // Node 1 and every stride-th after it, moved outwards by the golden section of the stride from strand to
        // strand.
        for (int k = 1 + int(std::fmod(s * 0.6180339887498949, 1.0) * info.density_stride); k < strands.nodes;
             k += info.density_stride)
            trilinear(strands.position[size_t(s * strands.nodes + k)], resolution, info,
                      [&](size_t voxel, double weight)
                      {
                          density.sum[voxel] += info.density_unit * weight;
                          ++density.shares[voxel];
                      });
    return density;
}

std::pair<glm::ivec3, glm::ivec3> box_of(const std::vector<int>& grid, int resolution)
{
    glm::ivec3 low(resolution), high(-1);
    for (int i = 0; i < int(grid.size()); ++i)
        if (grid[size_t(i)] != 0)
        {
            const glm::ivec3 at(i % resolution, i / resolution % resolution, i / resolution / resolution);
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
    return {low, high};
}

template <typename T> static T value_or_zero(const std::vector<T>& values, int x, int y, int z, int resolution)
{
    const auto inside = [&](int i) { return i >= 0 && i < resolution; };
    return inside(x) && inside(y) && inside(z) ? values[voxel_at(x, y, z, resolution)] : T(0);
}

std::vector<double> blur_density(const std::vector<int>& density, int axis, int resolution, const float4& box)
{
    std::vector<double> blurred;
    const int end = int(box.x) + 1;
    for (int z = 0; z < resolution; ++z)
        for (int y = 0; y < resolution; ++y)
            for (int x = 0; x < resolution; ++x)
            {
                double sum = 0.0;
                for (int d = -end; d <= end; ++d)
                    sum += double(std::abs(d) == end ? box.z : box.y) *
                           value_or_zero(density, x + (axis == 0 ? d : 0), y + (axis == 1 ? d : 0),
                                         z + (axis == 2 ? d : 0), resolution);
                blurred.push_back(sum);
            }
    return blurred;
}

std::vector<Vec> density_gradient(const std::vector<int>& density, int resolution)
{
    std::vector<Vec> gradient;
    const auto at = [&](int x, int y, int z) { return double(value_or_zero(density, x, y, z, resolution)); };
    for (int z = 0; z < resolution; ++z)
        for (int y = 0; y < resolution; ++y)
            for (int x = 0; x < resolution; ++x)
                gradient.push_back(0.5 * Vec(at(x + 1, y, z) - at(x - 1, y, z), at(x, y + 1, z) - at(x, y - 1, z),
                                             at(x, y, z + 1) - at(x, y, z - 1)));
    return gradient;
}

// ---- constraints
// -----------------------------------------------------------------------------------------------------

Vec nearest_on_axis(const Capsule& collider, Vec p)
{
    const Vec center = xyz(collider.center), axis = xyz(collider.axis);
    const double squared = glm::dot(axis, axis);
    return squared > 0.0 ? center + axis * std::clamp(glm::dot(p - center, axis) / squared, 0.0, 1.0) : center;
}

BodyCorners body_corners(Vec p, const StepInfo& info, int stride)
{
    const int all[3] = {info.body_x, info.body_y, info.body_z};
    const int size[3] = {stride > 1 ? all[0] / stride + 1 : all[0], stride > 1 ? all[1] / stride + 1 : all[1],
                         stride > 1 ? all[2] / stride + 1 : all[2]};
    const Vec local = xyz(info.head_row0) * p.x + xyz(info.head_row1) * p.y + xyz(info.head_row2) * p.z;
    const Vec g = (local - xyz(info.body_corner)) / (stride * double(info.body_corner.w));
    Vec within = g;
    int cell[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        within[axis] = std::clamp(g[axis], 0.0, size[axis] - 1.0);
        cell[axis] = std::min(int(within[axis]), size[axis] - 2);
    }
    BodyCorners corners = {{}, glm::length(g - within)};
    for (int corner = 0; corner < 8; ++corner)
    {
        double weight[3], change[3];
        size_t sample = 0;
        for (int axis = 2; axis >= 0; --axis)
        {
            const int c = corner >> axis & 1;
            weight[axis] = 1.0 - std::abs(within[axis] - cell[axis] - c);
            change[axis] = 2.0 * c - 1.0;
            sample = sample * size_t(size[axis]) + size_t(cell[axis] + c);
        }
        corners.at[corner] = {sample, weight[0] * weight[1] * weight[2],
                              Vec(change[0] * weight[1] * weight[2], weight[0] * change[1] * weight[2],
                                  weight[0] * weight[1] * change[2])};
    }
    return corners;
}

Body body_of(const DistanceGrid& grid)
{
    Body body = {{}, grid.way};
    for (const float distance : grid.distance)
        body.distance.push_back(distance / grid.voxel);
    return body;
}

Plane plane_at(const Body& body, Vec p, const StepInfo& info)
{
    if (!std::isfinite(p.x + p.y + p.z))
        return {1e6, Vec(0, 1, 0)};
    const BodyCorners corners = body_corners(p, info);
    double distance = corners.away;
    Vec slope(0.0);
    for (const auto& corner : corners.at)
    {
        distance += corner.weight * body.distance[corner.sample];
        slope += corner.slope * double(body.distance[corner.sample]);
    }
    const Vec normal =
        glm::length(slope) > 1e-4 ? turned(info.head_row0, info.head_row1, info.head_row2, slope) : Vec(0, 1, 0);
    return {distance * info.body_corner.w, glm::normalize(normal)};
}

static void collide(Vec* x, int begin, int end, const std::vector<Capsule>& colliders)
{
    for (const Capsule& collider : colliders)
        for (int i = begin; i < end; ++i)
        {
            const Vec center = nearest_on_axis(collider, x[i]), out = x[i] - center;
            const double distance = glm::length(out), radius = collider.center.w;
            if (distance < radius)
                x[i] = center + (distance > 1e-6 * radius ? out / distance : Vec(0, 1, 0)) * radius;
        }
}

// The head's surface near a node, held as a plane while the node moves about.
struct HeldPlane
{
    Vec normal{0.0};
    double level = -1e9; // along the normal

    HeldPlane() = default;
    HeldPlane(const Body& body, Vec p, const StepInfo& info)
    {
        const Plane plane = plane_at(body, p, info);
        normal = plane.normal;
        level = glm::dot(p, normal) - plane.distance;
    }
    void push_out(Vec& p) const { p += normal * std::max(0.0, level - glm::dot(p, normal)); }
};

static double inverse_mass(int node, int held) { return node < held ? 0.0 : 1.0; }

// Distance constraint of Mueller et al. 2007, eq. 10 and 11, times a strength.
static void keep_distance(Vec& a, Vec& b, double mass_a, double mass_b, double rest, double strength,
                          const std::function<Vec()>& rounding)
{
    const double distance = glm::length(b - a);
    if (distance < 1e-12 || mass_a + mass_b == 0.0)
        return;
    const Vec correction = strength * (distance - rest) / distance / (mass_a + mass_b) * (b - a);
    if (mass_a > 0.0) // zero times NaN is NaN
        a += mass_a * correction + (rounding ? rounding() : Vec(0.0));
    if (mass_b > 0.0)
        b -= mass_b * correction + (rounding ? rounding() : Vec(0.0));
}

// The first `held` nodes are prescribed.
static void sweep(Vec* x, int nodes, int held, double rest, double strength, const std::vector<Capsule>& colliders,
                  const std::vector<HeldPlane>& head, const HairParams& params, const StepInfo& info,
                  const std::function<Vec()>& rounding)
{
    for (int i = held; i < nodes; ++i)
        head[size_t(i)].push_out(x[i]);
    collide(x, held, nodes, colliders);
    for (const int first : {2, 1})
        for (int i = first; i + 1 < nodes; i += 2)
            keep_distance(x[i], x[i + 1], inverse_mass(i, held), inverse_mass(i + 1, held), rest, strength, rounding);
    // Thesis' angular constraint: node i as far from node 0, or the last held one but one, as on a straight strand; eq.
    // 5.6 for its attenuation.
    for (int i = held; i < nodes; ++i)
    {
        const double bend =
            std::clamp(double(info.bend) / std::pow(i - 1.0, double(params.solver_bending_attenuation)), 0.0, 1.0);
        keep_distance(x[held - 2], x[i], 0.0, 1.0, rest * (i - (held - 2)) * params.solver_bending_scale, bend,
                      rounding);
    }
}

void simulate_pbd(Strands& strands, Forces forces, const std::vector<Vec>& gradient, int resolution,
                  const std::vector<Capsule>& colliders, const HairParams& params, const StepInfo& info,
                  const std::function<Vec()>& rounding, const Body& body)
{
    const int n = strands.nodes;
    const double h = info.substep;
    const Vec move = xyz(info.origin_move), head_velocity = xyz(info.head_velocity);
    const auto carried = [&](Vec v) { return turned(info.turn_row0, info.turn_row1, info.turn_row2, v); };
    const auto to_world = [&](Vec v) { return turned(info.head_row0, info.head_row1, info.head_row2, v); };
    for (int s = 0; s < strands.count(); ++s)
    {
        const double rest = strands.segment_length[size_t(s)] * params.strand_spacing;
        std::vector<Vec> before, x(size_t(n), Vec(0.0));
        for (int i = 0; i < n; ++i)
            before.push_back(carried(strands.position[size_t(s * n + i)]));

        const Vec along = to_world(strands.root_direction[size_t(s)]);
        x[1] = to_world(strands.root_position[size_t(s)]);
        x[0] = x[1] - rest * along;
        for (int i = 2; i < n; ++i)
        {
            Vec velocity = carried(strands.velocity[size_t(s * n + i)] - head_velocity) + head_velocity;
            Vec force(0.0, info.gravity, 0.0);
            if (forces.wind)
                force += across_wind(wind_at(before[size_t(i)], info),
                                     before[size_t(std::min(i + 1, n - 1))] - before[size_t(i - 1)]);
            if (forces.repulsion)
                force += repulsion_force(before[size_t(i)], gradient, resolution, info);
            // Exact for a force that does not change: dv/dt = a - b v.
            velocity = velocity * double(info.drag_keep) + force * double(info.drag_gain);
            x[size_t(i)] = before[size_t(i)] + h * velocity - move;
        }

        const int held = strands.held.empty() ? 2 : strands.held[size_t(s)];
        for (int i = 2; i < held; ++i)
            x[size_t(i)] = to_world(strands.rest_position[size_t(s * n + i)]);

        std::vector<HeldPlane> head(static_cast<size_t>(n));
        for (int i = held; i < n && !body.distance.empty(); ++i)
            head[size_t(i)] = HeldPlane(body, x[size_t(i)], info);
        for (int k = 1; k <= params.solver_iterations; ++k)
            sweep(x.data(), n, held, rest,
                  double(info.stretch) * (k < params.solver_iterations ? double(info.relax) : 1.0), colliders, head,
                  params, info, rounding);
        for (int i = held; i < n; ++i) // the closing walk
            for (int turns = 0; turns < 8; ++turns)
            {
                const Vec segment = x[size_t(i)] - x[size_t(i - 1)];
                const double most = (params.solver_stretching >= 1.0f ? 1.005 : 4.0) * rest, is = glm::length(segment);
                if (turns < 4 && is > most)
                    x[size_t(i)] = x[size_t(i - 1)] + segment * (most / is);
                if (turns % 3 == 0 && !body.distance.empty())
                    head[size_t(i)] = HeldPlane(body, x[size_t(i)], info);
                head[size_t(i)].push_out(x[size_t(i)]);
                collide(x.data(), i, i + 1, colliders);
            }

        bool finite = true; // as it came, and now
        for (const Vec& p : before)
            finite = finite && std::isfinite(p.x + p.y + p.z);
        for (int i = 2; i < n; ++i)
            finite = finite && std::abs(x[size_t(i)].x) + std::abs(x[size_t(i)].y) + std::abs(x[size_t(i)].z) < 1e6;
        if (!finite)
        {
            for (int i = 2; i < n; ++i)
                x[size_t(i)] =
                    held > 2 ? to_world(strands.rest_position[size_t(s * n + i)]) : x[1] + rest * (i - 1) * along;
            ++strands.resets[size_t(s)];
        }
        for (int i = 0; i < n; ++i)
        {
            strands.position[size_t(s * n + i)] = x[size_t(i)];
            strands.velocity[size_t(s * n + i)] =
                finite ? (x[size_t(i)] - before[size_t(i)] + move) / h : head_velocity;
        }
    }
}

} // namespace coif::oracle

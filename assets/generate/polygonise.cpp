// From a field to triangles: small where the skin bends, large where it does not, and all of them about equilateral.
#include "polygonise.h"

#include <cstdint>
#include <iterator>
#include <tuple>
#include <unordered_map>
#include <utility>

using Triangle = std::array<int, 3>;

namespace
{

constexpr double kCoarsest = 0.0085; // m

// Surface nets (Gibson 1998): a point for each cell that the surface crosses, a quad, cut in two, for each edge of the
// grid that it crosses.
Mesh surface_net(const Field& field, Vec low, Vec high, double step)
{
    const auto count = [&](double from, double to) { return static_cast<int>(std::ceil((to - from) / step)) + 1; };
    const int nx = count(low.x, high.x), ny = count(low.y, high.y), nz = count(low.z, high.z);
    const std::array<int, 3> stride{1, nx, nx * ny};
    const auto place = [&](int index) {
        return low + Vec{index % nx * step, index / nx % ny * step, index / (nx * ny) * step};
    };
    std::vector<double> value(static_cast<size_t>(nx) * ny * nz);
    for (size_t i = 0; i < value.size(); ++i)
        value[i] = field(place(static_cast<int>(i)));

    Mesh mesh;
    std::vector<int> cell(value.size(), -1); // its point
    const int cells = static_cast<int>(value.size()) - stride[0] - stride[1] - stride[2];
    for (int i = 0; i < cells; ++i)
    {
        Vec sum;
        int crossings = 0;
        for (int corner = 0; corner < 8; ++corner)
            for (int axis = 0; axis < 3; ++axis)
            {
                if (corner >> axis & 1)
                    continue;
                const int a = i + (corner & 1) + (corner >> 1 & 1) * stride[1] + (corner >> 2) * stride[2];
                const int b = a + stride[axis];
                if ((value[a] < 0) == (value[b] < 0))
                    continue;
                sum = sum + place(a) + (place(b) - place(a)) * (value[a] / (value[a] - value[b]));
                ++crossings;
            }
        if (crossings == 0)
            continue;
        cell[i] = static_cast<int>(mesh.points.size());
        mesh.points.push_back(step_to_zero(field, sum * (1.0 / crossings), step / 2));
    }
    for (int i = stride[2]; i < cells; ++i)
        for (int axis = 0; axis < 3; ++axis)
        {
            const bool within = value[i] < 0;
            if (within == (value[i + stride[axis]] < 0))
                continue;
            const int u = stride[(axis + 1) % 3], v = stride[(axis + 2) % 3];
            std::array<int, 4> quad{cell[i], cell[i - u], cell[i - u - v], cell[i - v]};
            if (!within)
                std::swap(quad[1], quad[3]);
            mesh.triangles.push_back({quad[0], quad[1], quad[2]});
            mesh.triangles.push_back({quad[0], quad[2], quad[3]});
        }
    return mesh;
}

// The triangle to the left of each directed edge.
struct Edges
{
    explicit Edges(const Mesh& mesh)
    {
        left_.reserve(mesh.triangles.size() * 3);
        for (size_t i = 0; i < mesh.triangles.size(); ++i)
            for (int k = 0; k < 3; ++k)
                left_[key(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3])] = static_cast<int>(i);
    }
    int left_of(int a, int b) const // -1: there is no such edge
    {
        const auto found = left_.find(key(a, b));
        return found == left_.end() ? -1 : found->second;
    }

  private:
    static uint64_t key(int a, int b) { return static_cast<uint64_t>(a) << 32 | static_cast<uint32_t>(b); }
    std::unordered_map<uint64_t, int> left_;
};

Vec normal_of(const Mesh& mesh, const Triangle& t)
{
    const Vec a = mesh.points[t[0]];
    return cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a);
}

double edge_length(const Mesh& mesh, int a, int b) { return length(mesh.points[a] - mesh.points[b]); }

struct Candidate
{
    double rank;
    int a, b;
    bool operator<(const Candidate& other) const
    {
        return std::tie(rank, a, b) < std::tie(other.rank, other.a, other.b);
    }
};

// How long edges should be at each point, for the sag: s = length^2 curvature / 8. Sizes of neighbours differ by less
// than half their distance.
std::vector<double> sizes(const Mesh& mesh, const Field& field, const Field& sag, double finest)
{
    std::vector<double> size;
    const double reach = 0.7 * finest;
    for (const Vec p : mesh.points)
    {
        const Vec n = normalize(gradient(field, p));
        const Vec u = normalize(cross(n, std::abs(n.x) < 0.7 ? Vec{1, 0, 0} : Vec{0, 1, 0})), v = cross(n, u);
        double bent = 0; // 1/m, along one of two directions
        for (const Vec along : {u, v})
            bent = std::max(bent, length(normalize(gradient(field, p + along * reach)) -
                                         normalize(gradient(field, p - along * reach))) /
                                      (2 * reach));
        size.push_back(std::clamp(std::sqrt(8 * sag(p) / std::max(bent, 1e-3)), finest, kCoarsest));
    }
    for (int round = 0; round < 6; ++round)
        for (const Triangle& t : mesh.triangles)
            for (int k = 0; k < 3; ++k)
            {
                const int a = t[k], b = t[(k + 1) % 3];
                const double most = std::min(size[a], size[b]) + 0.5 * edge_length(mesh, a, b);
                size[a] = std::min(size[a], most);
                size[b] = std::min(size[b], most);
            }
    return size;
}

// Each of these four does one round over edges that do not touch each other and returns how many it changed (Botsch,
// Kobbelt. A remeshing approach to multiresolution modeling. 2004; with sizes: Dunyach et al. Adaptive remeshing.
// 2013).

size_t split(Mesh& mesh, const Field& field, std::vector<double>& size)
{
    const Edges edges(mesh);
    std::vector<Candidate> wanted;
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
        {
            const int a = t[k], b = t[(k + 1) % 3];
            const double long_ = edge_length(mesh, a, b);
            if (a < b && long_ > 4.0 / 3 * (size[a] + size[b]) / 2)
                wanted.push_back({-long_, a, b});
        }
    std::sort(wanted.begin(), wanted.end());
    std::vector<bool> touched(mesh.triangles.size());
    size_t changed = 0;
    for (const auto& [rank, a, b] : wanted)
    {
        const int left = edges.left_of(a, b), right = edges.left_of(b, a);
        if (touched[left] || touched[right])
            continue;
        touched[left] = touched[right] = true;
        const int middle = static_cast<int>(mesh.points.size());
        mesh.points.push_back(step_to_zero(field, (mesh.points[a] + mesh.points[b]) * 0.5, -rank / 2));
        size.push_back((size[a] + size[b]) / 2);
        for (const int i : {left, right})
        {
            Triangle other_half = mesh.triangles[i];
            std::replace(mesh.triangles[i].begin(), mesh.triangles[i].end(), a, middle);
            std::replace(other_half.begin(), other_half.end(), b, middle);
            mesh.triangles.push_back(other_half);
        }
        ++changed;
    }
    return changed;
}

size_t collapse(Mesh& mesh, const Field& field, std::vector<double>& size)
{
    std::vector<std::vector<int>> around(mesh.points.size()); // triangles
    std::vector<Candidate> wanted;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
        {
            const int a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
            around[a].push_back(static_cast<int>(i));
            const double long_ = edge_length(mesh, a, b);
            if (a < b && long_ < 4.0 / 5 * (size[a] + size[b]) / 2)
                wanted.push_back({long_, a, b});
        }
    std::sort(wanted.begin(), wanted.end());
    std::vector<bool> touched(mesh.points.size()), gone(mesh.triangles.size());
    size_t changed = 0;
    for (const auto& [rank, a, b] : wanted)
    {
        std::vector<int> ring; // of both, each point as often as it has triangles there
        bool free = true;
        for (const int end : {a, b})
            for (const int i : around[end])
                for (const int point : mesh.triangles[i])
                {
                    free &= !touched[point];
                    ring.push_back(point);
                }
        if (!free)
            continue;
        // Neighbours of both must be the two across the edge, or the surface would be pinched.
        const auto neighbours = [&](int end)
        {
            std::vector<int> all;
            for (const int i : around[end])
                for (const int point : mesh.triangles[i])
                    if (point != a && point != b)
                        all.push_back(point);
            std::sort(all.begin(), all.end());
            all.erase(std::unique(all.begin(), all.end()), all.end());
            return all;
        };
        const std::vector<int> of_a = neighbours(a), of_b = neighbours(b);
        std::vector<int> both;
        std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(both));
        if (both.size() != 2 || around[a].size() + around[b].size() < 8)
            continue;
        const Vec middle = step_to_zero(field, (mesh.points[a] + mesh.points[b]) * 0.5, rank / 2);
        bool fits = true;
        for (const int end : {a, b})
            for (const int i : around[end])
            {
                Triangle t = mesh.triangles[i];
                if (std::count(t.begin(), t.end(), a) && std::count(t.begin(), t.end(), b))
                    continue;
                const Vec before = normal_of(mesh, t);
                const Vec kept = std::exchange(mesh.points[end], middle);
                const Vec after = normal_of(mesh, t);
                mesh.points[end] = kept;
                fits &= dot(before, after) > 0.7 * length(before) * length(after);
                for (const int point : t)
                    fits &= length(mesh.points[point] - middle) < 4.0 / 3 * size[point];
            }
        if (!fits)
            continue;
        mesh.points[a] = middle;
        size[a] = (size[a] + size[b]) / 2;
        for (const int i : around[b])
        {
            Triangle& t = mesh.triangles[i];
            gone[i] = gone[i] || std::count(t.begin(), t.end(), a);
            std::replace(t.begin(), t.end(), b, a);
        }
        for (const int point : ring)
            touched[point] = true;
        ++changed;
    }
    std::vector<Triangle> kept;
    for (size_t i = 0; i < gone.size(); ++i)
        if (!gone[i])
            kept.push_back(mesh.triangles[i]);
    mesh.triangles = std::move(kept);
    return changed;
}

// Turns edges whose opposite angles are more than half a circle together: towards Delaunay's triangulation.
size_t flip(Mesh& mesh)
{
    const Edges edges(mesh);
    std::vector<bool> touched(mesh.triangles.size());
    size_t changed = 0;
    for (size_t left = 0; left < mesh.triangles.size(); ++left)
        for (int k = 0; k < 3 && !touched[left]; ++k)
        {
            const Triangle t = mesh.triangles[left];
            const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3], right = edges.left_of(b, a);
            const Triangle s = mesh.triangles[right];
            if (a > b || touched[right])
                continue;
            const int d = s[0] + s[1] + s[2] - a - b;
            const auto angle = [&](int at)
            {
                const Vec u = mesh.points[a] - mesh.points[at], v = mesh.points[b] - mesh.points[at];
                return std::atan2(length(cross(u, v)), dot(u, v));
            };
            if (angle(c) + angle(d) < std::numbers::pi + 0.01 || edges.left_of(c, d) >= 0 || edges.left_of(d, c) >= 0)
                continue;
            const Triangle one{a, d, c}, two{d, b, c};
            const Vec n = normalize(normal_of(mesh, t)) + normalize(normal_of(mesh, s));
            if (dot(normalize(normal_of(mesh, one)), n) < 1 || dot(normalize(normal_of(mesh, two)), n) < 1)
                continue;
            // Edges next to these have changed their triangles, so these wait for the next round.
            for (const Triangle& u : {t, s})
                for (int e = 0; e < 3; ++e)
                    touched[edges.left_of(u[(e + 1) % 3], u[e])] = true;
            touched[left] = touched[right] = true;
            mesh.triangles[left] = one;
            mesh.triangles[right] = two;
            ++changed;
        }
    return changed;
}

// Moves points towards the middle of their neighbours along the skin; inwards, a thin rim would close up.
void smooth(Mesh& mesh, const Field& field, const std::vector<double>& size)
{
    std::vector<Vec> sum(mesh.points.size());
    std::vector<double> weight(mesh.points.size());
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) // of the triangle's area in units of the size wanted there
        {
            const Vec middle = (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) * (1.0 / 3);
            const double wanted = (size[t[0]] + size[t[1]] + size[t[2]]) / 3;
            const double area = length(normal_of(mesh, t)) / (wanted * wanted);
            sum[t[k]] = sum[t[k]] + middle * area;
            weight[t[k]] += area;
        }
    for (size_t i = 0; i < mesh.points.size(); ++i)
    {
        if (weight[i] == 0)
            continue;
        Vec& p = mesh.points[i];
        const Vec shift = sum[i] * (1 / weight[i]) - p, out = normalize(gradient(field, p));
        p = step_to_zero(field, p + (shift - out * dot(shift, out)) * 0.6, size[i] / 2);
    }
}

} // namespace

Mesh without_loose_points(const Mesh& mesh)
{
    std::vector<int> place(mesh.points.size(), -1);
    for (const Triangle& t : mesh.triangles)
        for (int i : t)
            place[i] = 0;
    Mesh kept;
    for (size_t i = 0; i < place.size(); ++i)
        if (place[i] == 0)
        {
            place[i] = static_cast<int>(kept.points.size());
            kept.points.push_back(mesh.points[i]);
        }
    for (const Triangle& t : mesh.triangles)
        kept.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
    return kept;
}

Mesh polygonise(const Field& field, Vec low, Vec high, double step, const Field& sag, double finest)
{
    Mesh mesh = surface_net(field, low, high, step);
    for (int round = 0; round < 5; ++round)
    {
        std::vector<double> size = sizes(mesh, field, sag, finest);
        for (int i = 0; i < 3 && split(mesh, field, size) > 0; ++i)
            ;
        for (int i = 0; i < 10 && collapse(mesh, field, size) > 0; ++i)
            ;
        for (int i = 0; i < 3 && flip(mesh) > 0; ++i)
            ;
        smooth(mesh, field, size);
        smooth(mesh, field, size);
        mesh = without_loose_points(mesh);
    }
    for (int i = 0; i < 10 && flip(mesh) > 0; ++i)
        ;
    for (Vec& p : mesh.points)
        p = step_to_zero(field, p, finest);
    return mesh;
}

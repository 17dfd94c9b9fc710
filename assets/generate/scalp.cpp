#include "scalp.h"

#include "polygonise.h"

#include <map>
#include <tuple>
#include <utility>

using Triangle = std::array<int, 3>;

namespace
{

using Edges = std::map<std::pair<int, int>, size_t>; // the triangle to the left of each directed edge

Edges edges_of(const Mesh& mesh)
{
    Edges edges;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            edges[{mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]}] = i;
    return edges;
}

// The icosahedron with each edge cut into `frequency`, blown up to 1 m: 10 frequency^2 + 2 points. In this orientation
// it is its own mirror image in x.
Mesh geodesic_sphere(int frequency)
{
    const double phi = std::numbers::phi;
    std::vector<Vec> corners;
    for (const double one : {-1.0, 1.0})
        for (const double golden : {-phi, phi})
            corners.insert(corners.end(), {{0, one, golden}, {one, golden, 0}, {golden, 0, one}});
    const auto adjacent = [&](Vec a, Vec b) { return length(a - b) < 2.1; };

    Mesh sphere;
    std::map<std::array<long, 3>, int> known; // points on the edges of faces are met more than once
    const auto point = [&](Vec p)
    {
        p = normalize(p);
        const auto [place, fresh] =
            known.try_emplace({std::lround(p.x * 1e6), std::lround(p.y * 1e6), std::lround(p.z * 1e6)},
                              static_cast<int>(sphere.points.size()));
        if (fresh)
            sphere.points.push_back(p);
        return place->second;
    };
    const auto face = [&](Vec a, Vec b, Vec c)
    {
        const Vec u = (b - a) * (1.0 / frequency), v = (c - a) * (1.0 / frequency);
        const auto at = [&](int i, int j) { return point(a + u * i + v * j); };
        for (int i = 0; i < frequency; ++i)
            for (int j = 0; i + j < frequency; ++j)
            {
                sphere.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
                if (i + j + 1 < frequency)
                    sphere.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    };
    for (const Vec a : corners)
        for (const Vec b : corners)
            for (const Vec c : corners)
            {
                const bool counterclockwise = dot(a, cross(b, c)) > 0;
                const bool first = std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z) &&
                                   std::tie(a.x, a.y, a.z) < std::tie(c.x, c.y, c.z);
                if (first && counterclockwise && adjacent(a, b) && adjacent(b, c) && adjacent(c, a))
                    face(a, b, c);
            }
    return sphere;
}

// Where a ray from the origin leaves the skin.
Vec cast(const Field& skin, Vec direction)
{
    double near = 0.03, far = 0.25; // m
    for (int i = 0; i < 40; ++i)
        (skin(direction * ((near + far) / 2)) < 0 ? near : far) = (near + far) / 2;
    return direction * near;
}

} // namespace

// A bare cut has teeth as large as a triangle, so the rim is moved onto inside = 0 and the points are evened out.
Mesh scalp(int frequency, const Field& skin, const Field& inside)
{
    Mesh mesh = geodesic_sphere(frequency);
    for (Vec& p : mesh.points)
        p = cast(skin, p);
    const auto outside = [&](const Triangle& t)
    { return inside((mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) * (1.0 / 3)) < 0.002; };
    std::erase_if(mesh.triangles, outside);

    for (bool changed = true; changed;) // a triangle that hangs by one edge would be squashed onto the rim
    {
        const Edges edges = edges_of(mesh);
        const auto hangs = [&](const Triangle& t) {
            return edges.count({t[1], t[0]}) + edges.count({t[2], t[1]}) + edges.count({t[0], t[2]}) < 2;
        };
        changed = std::erase_if(mesh.triangles, hangs) > 0;
    }
    mesh = without_loose_points(mesh);

    std::vector<std::vector<int>> near(mesh.points.size()), along_rim(mesh.points.size());
    const Edges edges = edges_of(mesh);
    for (const auto& [edge, triangle] : edges)
    {
        const auto [a, b] = edge;
        near[a].push_back(b);
        if (edges.count({b, a}))
            continue;
        along_rim[a].push_back(b);
        along_rim[b].push_back(a);
    }
    for (int round = 0; round < 100; ++round)
    {
        std::vector<Vec> moved = mesh.points;
        for (size_t i = 0; i < moved.size(); ++i)
        {
            const bool rim = !along_rim[i].empty();
            const std::vector<int>& others = rim ? along_rim[i] : near[i];
            Vec sum;
            double weight = 0; // long edges pull harder, so that all become alike
            for (int k : others)
            {
                const double pull = length(mesh.points[k] - mesh.points[i]);
                sum = sum + mesh.points[k] * pull;
                weight += pull;
            }
            Vec& p = moved[i];
            p = p + (sum * (1 / weight) - p) * 0.5;
            for (int step = 0; step < 3; ++step)
            {
                if (rim)
                    p = step_to_zero(inside, p, 0.003);
                p = step_to_zero(skin, p, 0.003);
            }
        }
        mesh.points = moved;
    }
    return mesh;
}

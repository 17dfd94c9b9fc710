#include "spheres.h"

namespace
{

// The largest ball that touches the skin at p from within and holds no point of the mesh (Ma, Bae, Choi. 3D medial axis
// point approximation using nearest neighbors and the normal field. 2012).
Sphere inscribed(const Mesh& mesh, Vec p, Vec out)
{
    double radius = 0.12; // m
    for (int round = 0; round < 30; ++round)
    {
        const Vec centre = p - out * radius;
        double nearest = radius * 0.999;
        const Vec* touched = nullptr;
        for (const Vec& q : mesh.points)
            if (const double away = length(q - centre); away < nearest)
            {
                nearest = away;
                touched = &q;
            }
        if (!touched)
            break;
        const Vec to = p - *touched; // through p, tangent there, and through what it touched
        radius = dot(to, to) / (2 * std::max(dot(out, to), 1e-6));
    }
    return {p - out * radius, radius};
}

} // namespace

std::vector<Sphere> fill_with_spheres(const Mesh& mesh, const Field& body, const Field& weight, size_t count)
{
    std::vector<Sphere> candidates;
    for (size_t i = 0; i < mesh.points.size(); i += 11)
    {
        Sphere ball = inscribed(mesh, mesh.points[i], normalize(gradient(body, mesh.points[i])));
        if (std::abs(ball.centre.x) < 0.25 * ball.radius) // near the middle, and then one is enough
            ball.centre.x = 0;
        // The mesh has gaps between its points.
        ball.radius = std::min(ball.radius, -body(ball.centre));
        ball.centre.x = std::abs(ball.centre.x);
        if (ball.radius > 0.004)
            candidates.push_back(ball);
    }
    std::vector<Vec> skin;
    std::vector<double> cost;
    for (size_t i = 0; i < mesh.triangles.size(); i += 5)
    {
        const auto& t = mesh.triangles[i];
        const Vec a = mesh.points[t[0]], n = cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a);
        if (a.x < 0)
            continue;
        skin.push_back(a);
        cost.push_back(length(n) * weight(a));
    }
    const auto away = [](Vec p, const Sphere& s) { return std::max(length(p - s.centre) - s.radius, 0.0); };
    std::vector<double> depth(skin.size(), 0.1);
    std::vector<Sphere> chosen;
    for (size_t taken = 0; taken < count;)
    {
        const Sphere* best = nullptr;
        double least = 1e9;
        for (const Sphere& s : candidates)
        {
            double sum = 0;
            for (size_t i = 0; i < skin.size() && sum < least; ++i)
            {
                const double d = std::min(depth[i], away(skin[i], s));
                sum += cost[i] * d * d;
            }
            if (sum < least)
            {
                least = sum;
                best = &s;
            }
        }
        for (size_t i = 0; i < skin.size(); ++i)
            depth[i] = std::min(depth[i], away(skin[i], *best));
        chosen.push_back(*best);
        taken += best->centre.x == 0 ? 1 : 2;
    }
    return chosen;
}

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

// What lies between the skin at p and the ball, m; negative in it.
double gap(Vec p, const Sphere& s) { return length(p - s.centre) - s.radius; }

// Moves and sizes the balls, one number at a time, as long as that lowers what the gaps cost.
void improve(std::vector<Sphere>& balls, const std::vector<Vec>& skin, const std::vector<double>& weight,
             const std::function<double(size_t, double)>& cost)
{
    std::vector<double> others(skin.size());
    for (double step = 0.004; step > 0.0002; step *= 0.85)
        for (Sphere& ball : balls)
        {
            for (size_t i = 0; i < skin.size(); ++i)
            {
                others[i] = 1;
                for (const Sphere& other : balls)
                    if (&other != &ball)
                        others[i] = std::min(others[i], gap(skin[i], other));
            }
            const auto total = [&](const Sphere& as)
            {
                double sum = 0;
                for (size_t i = 0; i < skin.size(); ++i)
                    sum += weight[i] * cost(i, std::min(others[i], gap(skin[i], as)));
                return sum;
            };
            double least = total(ball);
            for (double* number : {&ball.centre.x, &ball.centre.y, &ball.centre.z, &ball.radius})
                for (const double change : {step, -step})
                {
                    if (number == &ball.centre.x && (ball.centre.x == 0 || ball.centre.x + change <= 0))
                        continue; // in the middle, and to stay there
                    *number += change;
                    const double now = total(ball);
                    if (now < least && ball.radius > 0.003)
                        least = now;
                    else
                        *number -= change;
                }
        }
}

} // namespace

std::vector<Sphere> fill_with_spheres(const Mesh& mesh, const Field& body, const Field& roots, size_t count)
{
    std::vector<Sphere> candidates;
    for (size_t i = 0; i < mesh.points.size(); i += 11)
    {
        Sphere ball = inscribed(mesh, mesh.points[i], normalize(gradient(body, mesh.points[i])));
        ball.centre.x = std::abs(ball.centre.x) < 0.25 * ball.radius ? 0 : std::abs(ball.centre.x);
        ball.radius = 1;
        for (const Vec& q : mesh.points)
            ball.radius = std::min(ball.radius, length(q - ball.centre));
        if (ball.radius > 0.004)
            candidates.push_back(ball);
    }
    std::vector<Vec> skin; // of the left half
    std::vector<double> weight;
    std::vector<bool> hairy;
    for (size_t i = 0; i < mesh.triangles.size(); i += 5)
    {
        const auto& t = mesh.triangles[i];
        const Vec a = mesh.points[t[0]], n = cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a);
        if (a.x < 0)
            continue;
        skin.push_back(a);
        hairy.push_back(roots(a) > 0);
        weight.push_back(length(n) * (hairy.back() ? 10 : a.z < 0.03 ? 3 : 1));
    }
    // Out of the scalp they must not stand, elsewhere a little does not matter.
    const auto cost = [&](size_t i, double d) { return d * d * (d > 0 ? 1 : hairy[i] ? 60 : 0.5); };

    std::vector<double> depth(skin.size(), 0.1);
    std::vector<Sphere> chosen;
    for (size_t taken = 0; taken < count;)
    {
        const Sphere* best = nullptr;
        double least = 1e9;
        for (const Sphere& s : candidates)
        {
            if (taken + 1 == count && s.centre.x != 0)
                continue;
            double sum = 0;
            for (size_t i = 0; i < skin.size() && sum < least; ++i)
                sum += weight[i] * cost(i, std::min(depth[i], gap(skin[i], s)));
            if (sum < least)
            {
                least = sum;
                best = &s;
            }
        }
        for (size_t i = 0; i < skin.size(); ++i)
            depth[i] = std::min(depth[i], gap(skin[i], *best));
        chosen.push_back(*best);
        taken += best->centre.x == 0 ? 1 : 2;
    }
    improve(chosen, skin, weight, cost);
    return chosen;
}

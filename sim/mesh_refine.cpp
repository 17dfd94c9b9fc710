// A scalp's triangles cut in four or strewn with vertices, as round as they stand for.
#include "sim/error.h"
#include "sim/mesh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace coif
{

using Side = std::pair<unsigned, unsigned>; // of a triangle
static Side side_of(unsigned a, unsigned b) { return std::minmax(a, b); }

int most_refinements(const Scalp& scalp)
{
    // Each adds a vertex an edge; of edges there are twice as many then, and three in each triangle.
    std::set<Side> sides;
    for (const glm::uvec3& t : scalp.triangles)
        sides.insert({side_of(t.x, t.y), side_of(t.y, t.z), side_of(t.z, t.x)});
    size_t vertices = scalp.positions.size(), edges = sides.size(), triangles = scalp.triangles.size();
    int times = 0;
    while (times < 5 && vertices + edges <= kMostVertices)
    {
        vertices += edges;
        edges = 2 * edges + 3 * triangles;
        triangles *= 4;
        ++times;
    }
    return times;
}

// Normals that are a sphere's own if the vertices lie on one, however unevenly: Max, Weights for Computing Vertex
// Normals from Facet Normals, 1999. Where triangles lie to one side only, at borders, they would lean: there they are
// the mirror images of the inner neighbours'.
static std::vector<glm::vec3> round_normals(const Scalp& scalp)
{
    const std::vector<glm::vec3>& p = scalp.positions;
    std::vector<glm::vec3> normals(p.size(), glm::vec3(0.0f)), mirrored = normals;
    std::map<Side, int> triangles;
    for (const glm::uvec3& t : scalp.triangles)
        for (int k = 0; k < 3; ++k)
        {
            const unsigned a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
            const glm::vec3 to_b = p[b] - p[a], to_c = p[c] - p[a];
            const float squares = glm::dot(to_b, to_b) * glm::dot(to_c, to_c);
            if (squares > 0.0f)
                normals[a] += glm::cross(to_b, to_c) / squares;
            ++triangles[side_of(a, b)];
        }
    std::vector<char> border(p.size(), 0);
    for (const auto& [side, count] : triangles)
        if (count == 1)
            border[side.first] = border[side.second] = 1;
    for (size_t i = 0; i < p.size(); ++i)
        normals[i] = unit_or(normals[i], scalp.normals[i], 0.0f);
    for (const auto& [side, count] : triangles)
    {
        const auto [inner, outer] = border[side.first] ? std::pair(side.second, side.first) : side;
        if (border[inner] || !border[outer])
            continue;
        const glm::vec3 along = unit_or(p[outer] - p[inner], glm::vec3(0.0f), 0.0f);
        mirrored[outer] += normals[inner] - 2.0f * glm::dot(normals[inner], along) * along;
    }
    for (size_t i = 0; i < p.size(); ++i)
        normals[i] = unit_or(mirrored[i], normals[i], 0.0f);
    return normals;
}

// On the curve that leaves a and b at right angles to their normals, not on the chord, which would set roots inside the
// head. Of a sphere's radius the chord's middle is t^2 / 2 within it where the side spans the angle 2 t, this 3/8 t^4.
// Vlachos, Peters, Boyd, Mitchell, Curved PN Triangles, 2001.
static glm::vec3 curved_middle(const Mesh& mesh, const std::vector<glm::vec3>& normals, unsigned a, unsigned b)
{
    const glm::vec3 middle = 0.5f * (mesh.positions[a] + mesh.positions[b]);
    const auto to_plane = [&](unsigned v) { return glm::dot(mesh.positions[v] - middle, normals[v]) * normals[v]; };
    return middle + 0.25f * (to_plane(a) + to_plane(b));
}

Scalp refined(const Scalp& scalp, int times)
{
    if (times == 0) // as every slider's regrowth asks for
        return scalp;
    if (times > most_refinements(scalp))
        throw fail(
            "interpolation.refine: {} would give more than the {} guides that coif takes; this scalp can take {}",
            times, kMostVertices, most_refinements(scalp));
    Scalp fine = scalp;
    for (int i = 0; i < times; ++i)
    {
        const std::vector<glm::vec3> round = round_normals(fine);
        std::map<Side, unsigned> middles;
        const auto middle = [&](unsigned a, unsigned b)
        {
            const auto [found, fresh] = middles.try_emplace(side_of(a, b), unsigned(fine.positions.size()));
            if (fresh)
            {
                fine.positions.push_back(curved_middle(fine, round, a, b));
                fine.between.push_back({{a, b, b}, {0.5f, 0.5f, 0.0f}});
            }
            return found->second;
        };
        std::vector<glm::uvec3> triangles;
        for (const glm::uvec3& t : fine.triangles)
        {
            const unsigned xy = middle(t.x, t.y), yz = middle(t.y, t.z), zx = middle(t.z, t.x);
            triangles.insert(triangles.end(), {{t.x, xy, zx}, {xy, t.y, yz}, {zx, yz, t.z}, {xy, yz, zx}});
        }
        fine.triangles = std::move(triangles);
        const std::vector<glm::vec3> normals = vertex_normals(fine, fine.center);
        fine.normals.insert(fine.normals.end(), normals.begin() + long(fine.normals.size()), normals.end());
    }
    return fine;
}

// What curved_middle() does at a side's middle, anywhere on a triangle. Boubekeur, Alexa, Phong Tessellation, 2008.
Scalp strewn(const Scalp& scalp, const std::vector<Between>& places)
{
    Scalp more = scalp;
    const std::vector<glm::vec3> round = round_normals(scalp);
    for (const Between& place : places)
    {
        glm::vec3 flat(0.0f), normal(0.0f), lift(0.0f);
        for (int k = 0; k < 3; ++k)
        {
            flat += place.shares[k] * scalp.positions[place.of[k]];
            normal += place.shares[k] * scalp.normals[place.of[k]];
        }
        for (int k = 0; k < 3; ++k)
        {
            const glm::vec3 own = round[place.of[k]];
            lift += place.shares[k] * glm::dot(scalp.positions[place.of[k]] - flat, own) * own;
        }
        more.positions.push_back(flat + 0.5f * lift);
        more.normals.push_back(unit_or(normal, scalp.normals[place.of[0]]));
        more.between.push_back(place);
    }
    return more;
}

} // namespace coif

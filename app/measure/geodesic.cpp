#include "app/measure/geodesic.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace coif
{

std::vector<glm::vec3> even_roots(const Ball& ball, int count, float from, float to)
{
    // Heights and longitudes by the R2 sequence (Roberts 2018): even, and no spiral that could follow the guides' rows.
    std::vector<glm::vec3> roots;
    const double high = std::cos(double(from)), low = std::cos(double(to));
    for (int i = 0; i < count; ++i)
    {
        const double a = std::fmod(0.5 + 0.7548776662466927 * i, 1.0), b = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
        const double y = high + (low - high) * a, ring = std::sqrt(std::max(0.0, 1.0 - y * y));
        const double turn = 2.0 * std::numbers::pi * b;
        roots.push_back(ball.center +
                        ball.radius * glm::vec3(glm::dvec3(ring * std::sin(turn), y, ring * std::cos(turn))));
    }
    return roots;
}

namespace
{
struct Icosahedron
{
    std::array<glm::dvec3, 12> corner;
    std::vector<std::array<int, 3>> faces;
};
} // namespace

static Icosahedron icosahedron()
{
    Icosahedron solid;
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    int count = 0;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-golden, golden})
        {
            solid.corner[size_t(count++)] = {0, a, b};
            solid.corner[size_t(count++)] = {a, b, 0};
            solid.corner[size_t(count++)] = {b, 0, a};
        }
    // A turn about no particular axis, so that no root lies on an edge by symmetry.
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.5, 0.8));
    for (glm::dvec3& c : solid.corner)
        c = glm::normalize(c * std::cos(0.4) + glm::cross(axis, c) * std::sin(0.4) +
                           axis * (glm::dot(axis, c) * (1.0 - std::cos(0.4))));
    const double edge = 2.0 / std::sqrt(golden * golden + 1.0); // of the solid within the unit sphere
    const auto joined = [&](int i, int j)
    { return glm::distance(solid.corner[size_t(i)], solid.corner[size_t(j)]) < 1.01 * edge; };
    for (int i = 0; i < 12; ++i)
        for (int j = i + 1; j < 12; ++j)
            for (int k = j + 1; k < 12; ++k)
                if (joined(i, j) && joined(j, k) && joined(i, k))
                    solid.faces.push_back({i, j, k});
    return solid;
}

// Shares of three directions in a fourth, which lies in their cone where none is negative; their sum is 1.
static glm::dvec3 shares(const glm::dvec3& d, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    const glm::dvec3 w(glm::dot(d, glm::cross(b, c)), glm::dot(d, glm::cross(c, a)), glm::dot(d, glm::cross(a, b)));
    return w / (w.x + w.y + w.z);
}

static double least(const glm::dvec3& v) { return std::min({v.x, v.y, v.z}); }

// Which three of its face's grid points a direction lies among, by their distances from the face's corners: they sum up
// to `frequency`.
static std::array<std::array<int, 3>, 3> cell_about(const glm::dvec3& share, int frequency)
{
    std::array<int, 3> whole;
    for (int k = 0; k < 3; ++k)
        whole[size_t(k)] = std::clamp(int(share[k] * frequency), 0, frequency - 1);
    int sum = whole[0] + whole[1] + whole[2];
    for (size_t k = 0; k < 3 && sum > frequency - 1; ++k) // a direction on a grid point or line
        if (whole[k] > 0)
        {
            --whole[k];
            --sum;
        }
    std::array<std::array<int, 3>, 3> cell = {whole, whole, whole};
    const bool upright = sum == frequency - 1; // one more step leads to a point, or two do
    for (size_t k = 0; k < 3; ++k)
        for (size_t j = 0; j < 3; ++j)
            cell[k][j] += upright == (j == k);
    return cell;
}

static Scalp bare_scalp(const Ball& ball)
{
    Scalp scalp;
    scalp.center = ball.center;
    scalp.radius = ball.radius;
    scalp.extent = 2.0f * ball.radius;
    return scalp;
}

static void add_vertex(Scalp& scalp, const Ball& ball, const glm::vec3& outwards)
{
    scalp.positions.push_back(ball.center + ball.radius * outwards);
    scalp.normals.push_back(outwards);
}

// Guides on the scalp. The grid's place and the reach of the hair are the ball's, so that they are the same whichever
// vertices there are.
static Groom guides_on(HairParams params, const Ball& ball, const Scalp& scalp)
{
    params.interpolation_strands = 0;
    Groom groom = grow(params, scalp);
    groom.middle = ball.center * params.head_scale;
    groom.farthest = ball.radius * params.head_scale;
    return groom;
}

static void finish(DrawnStrand& strand, const glm::vec3& root, int index, const HairParams& params)
{
    const glm::vec3 at = root * params.head_scale;
    // As grow() would cut and seed it, from streams of its own.
    strand.root =
        F4(at.x, at.y, at.z, 1.0f - params.strand_length_variation * random01(params.interpolation_seed, index, 1000));
    strand.seed = int(random01(params.interpolation_seed, index, 1001) * 0x1p24f);
}

static std::vector<glm::vec3> root_directions(const Groom& groom)
{
    std::vector<glm::vec3> directions;
    for (int g = 0; g < groom.guides; ++g)
        directions.emplace_back(groom.root_direction[size_t(strand_value(g, 0, 0, 1))],
                                groom.root_direction[size_t(strand_value(g, 0, 1, 1))],
                                groom.root_direction[size_t(strand_value(g, 0, 2, 1))]);
    return directions;
}

GeodesicGroom geodesic_groom(const HairParams& params, const Ball& ball, const std::vector<glm::vec3>& roots,
                             int frequency)
{
    static const Icosahedron solid = icosahedron();
    GeodesicGroom made;
    made.scalp = bare_scalp(ball);
    // A grid point by its distances from the icosahedron's corners; points of an edge belong to both faces.
    std::map<std::array<int, 12>, unsigned> vertex_of;
    std::map<std::array<unsigned, 3>, bool> known;
    std::vector<glm::uvec3> about;
    std::vector<glm::vec3> weights;
    double edges = 0.0;
    for (const glm::vec3& root : roots)
    {
        const glm::dvec3 outwards = glm::normalize(glm::dvec3(root - ball.center));
        const auto share_in = [&](const std::array<int, 3>& f)
        {
            // Behind the ball's centre the shares have the wrong sign, which three positive ones would hide.
            const glm::dvec3 a = solid.corner[size_t(f[0])];
            return glm::dot(outwards, a) > 0.0
                       ? shares(outwards, a, solid.corner[size_t(f[1])], solid.corner[size_t(f[2])])
                       : glm::dvec3(-1.0);
        };
        const std::array<int, 3>& face =
            *std::max_element(solid.faces.begin(), solid.faces.end(),
                              [&](const auto& f, const auto& g) { return least(share_in(f)) < least(share_in(g)); });
        const auto cell = cell_about(share_in(face), frequency);
        std::array<unsigned, 3> corner;
        glm::dvec3 at[3];
        for (size_t k = 0; k < 3; ++k)
        {
            std::array<int, 12> key = {};
            at[k] = glm::dvec3(0.0);
            for (size_t j = 0; j < 3; ++j)
            {
                key[size_t(face[j])] = cell[k][j];
                at[k] += double(cell[k][j]) * solid.corner[size_t(face[j])];
            }
            at[k] = glm::normalize(at[k]);
            const auto [found, fresh] = vertex_of.try_emplace(key, unsigned(made.scalp.positions.size()));
            if (fresh)
                add_vertex(made.scalp, ball, glm::vec3(at[k]));
            corner[k] = found->second;
        }
        about.emplace_back(corner[0], corner[1], corner[2]);
        const glm::dvec3 w = glm::max(shares(outwards, at[0], at[1], at[2]), glm::dvec3(0.0));
        weights.emplace_back(w / (w.x + w.y + w.z));
        std::sort(corner.begin(), corner.end());
        if (known.try_emplace(corner, true).second)
        {
            made.scalp.triangles.push_back(about.back());
            edges += glm::distance(at[0], at[1]) + glm::distance(at[1], at[2]) + glm::distance(at[2], at[0]);
        }
    }
    made.spacing = ball.radius * edges / double(3 * std::max<size_t>(made.scalp.triangles.size(), 1));
    made.groom = guides_on(params, ball, made.scalp);
    const std::vector<glm::vec3> directions = root_directions(made.groom);
    for (size_t i = 0; i < roots.size(); ++i)
    {
        DrawnStrand strand = mixed_of(directions, about[i], weights[i]);
        finish(strand, roots[i], int(i), params);
        made.groom.drawn.push_back(strand);
    }
    made.groom.drawn_multi = int(roots.size());
    return made;
}

Groom all_simulated(const HairParams& params, const Ball& ball, const std::vector<glm::vec3>& roots)
{
    Scalp scalp = bare_scalp(ball);
    for (const glm::vec3& root : roots)
        add_vertex(scalp, ball, glm::normalize(root - ball.center));
    Groom groom = guides_on(params, ball, scalp);
    for (size_t i = 0; i < roots.size(); ++i)
    {
        DrawnStrand strand = {};
        strand.guide0 = strand.guide1 = strand.guide2 = int(i);
        strand.weights = F4(1.0f, 0.0f, 0.0f, 0.0f);
        finish(strand, roots[i], int(i), params);
        groom.drawn.push_back(strand);
    }
    groom.drawn_multi = int(roots.size());
    return groom;
}

} // namespace coif

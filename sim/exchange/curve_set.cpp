#include "sim/exchange/curve_set.h"

#include "sim/error.h"

#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

// How many points of a curve with `n` control points are kept: all, or all but the first and the last, which only lead
// the curve in and out.
static uint32_t kept_points(const CurveSet& set, uint32_t n)
{
    const bool led = !set.pinned && (set.basis == CurveBasis::BSPLINE || set.basis == CurveBasis::CATMULL_ROM);
    return !led ? n : n > 2 ? n - 2 : 0;
}

static glm::dvec3 bezier(const glm::vec3* p, double t)
{
    const double u = 1.0 - t;
    return u * u * u * glm::dvec3(p[0]) + 3.0 * u * u * t * glm::dvec3(p[1]) + 3.0 * u * t * t * glm::dvec3(p[2]) +
           t * t * t * glm::dvec3(p[3]);
}

// The point of the curve that control point k stands for.
static glm::dvec3 point_of(const CurveSet& set, const glm::vec3* p, uint32_t n, uint32_t k)
{
    if (set.basis == CurveBasis::BEZIER)
    {
        const uint32_t piece = std::min(k / 3, (n - 1) / 3 > 0 ? (n - 1) / 3 - 1 : 0);
        return 3 * piece + 3 < n ? bezier(p + 3 * piece, std::min((k - 3.0 * piece) / 3.0, 1.0)) : glm::dvec3(p[k]);
    }
    // Uniform B-splines at their knots. A pinned one ends in its first and last control points, as if those next to
    // them were mirrored there.
    if (set.basis == CurveBasis::BSPLINE && k > 0 && k + 1 < n)
        return (glm::dvec3(p[k - 1]) + 4.0 * glm::dvec3(p[k]) + glm::dvec3(p[k + 1])) / 6.0;
    return p[k];
}

// Values one a kept point, from as many as there are.
template <typename T>
static void add_values(std::vector<T>& to, const CurveSet& set, const std::vector<T>& from, uint64_t kept)
{
    const size_t curves = set.count.size(), points = set.position.size();
    if (from.empty() || (from.size() != 1 && from.size() != curves && from.size() != points && from.size() != kept))
        return;
    size_t first = 0, first_kept = 0;
    for (size_t s = 0; s < curves; ++s)
    {
        const uint32_t n = set.count[s], keeps = kept_points(set, n), skip = keeps == n ? 0 : 1;
        for (uint32_t k = 0; k < keeps; ++k)
            to.push_back(from[from.size() == 1        ? 0
                              : from.size() == curves ? s
                              : from.size() == points ? first + skip + k
                                                      : first_kept + k]);
        first += n;
        first_kept += keeps;
    }
}

// Values one a curve: of values at its points, the first.
template <typename T> static void add_of_curve(std::vector<T>& to, const CurveSet& set, const std::vector<T>& from)
{
    const size_t curves = set.count.size(), points = set.position.size();
    if (from.empty() || (from.size() != 1 && from.size() != curves && from.size() != points))
        return;
    size_t first = 0;
    for (size_t s = 0; s < curves; ++s)
    {
        const size_t at = from.size() == 1 ? 0 : from.size() == curves ? s : std::min(first, points - 1);
        to.push_back(from[at]);
        first += set.count[s];
    }
}

void add_curve_set(HairFile& file, const CurveSet& set)
{
    Curves& c = file.curves;
    const size_t strands_before = c.strands();
    const glm::dmat3 turn(set.place);
    const double size = std::cbrt(std::abs(glm::determinant(turn)));
    size_t first = 0;
    uint64_t kept = 0;
    for (const uint32_t n : set.count)
    {
        const uint32_t keeps = kept_points(set, n), skip = keeps == n ? 0 : 1;
        for (uint32_t k = 0; k < keeps; ++k)
        {
            const glm::dvec3 p = point_of(set, set.position.data() + first, n, k + skip);
            c.position.emplace_back(glm::dvec3(set.place * glm::dvec4(p, 1.0)));
        }
        c.count.push_back(keeps);
        first += n;
        kept += keeps;
    }
    const size_t widths = c.width.size();
    add_values(c.width, set, set.width, kept);
    for (size_t i = widths; i < c.width.size(); ++i)
        c.width[i] = float(double(c.width[i]) * size);
    add_values(c.color, set, set.color, kept);
    add_of_curve(c.root_uv, set, set.root_uv);
    add_of_curve(c.id, set, set.id);
    std::vector<int32_t> guide;
    add_of_curve(guide, set, set.guide);
    if (!guide.empty() || !c.guide.empty())
    {
        c.guide.resize(strands_before, 0);
        for (const int32_t is : guide)
            c.guide.push_back(is != 0);
        c.guide.resize(c.strands(), 0);
    }
    const auto named = std::ranges::find(c.group_name, set.name);
    c.group.resize(c.strands(), int32_t(named - c.group_name.begin()));
    if (named == c.group_name.end())
        c.group_name.push_back(set.name);
}

void finish_curve_sets(HairFile& file)
{
    Curves& c = file.curves;
    const auto finish = [&](auto& values, size_t wanted, const char* what)
    {
        if (!values.empty() && values.size() != wanted)
        {
            values.clear();
            file.remark.push_back(fmt::format("only some of its curves have {}, which are not read", what));
        }
    };
    finish(c.width, c.points(), "widths");
    finish(c.color, c.points(), "colours");
    finish(c.root_uv, c.strands(), "root UVs");
    finish(c.id, c.strands(), "numbers");
}

} // namespace coif

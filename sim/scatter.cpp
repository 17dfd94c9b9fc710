#include "sim/scatter.h"

#include "sim/exchange/place.h"
#include "sim/groom.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace coif
{

// Streams of random numbers, among those of sim/groom.cpp.
enum
{
    kTriangle = 2,
    kWeightA,
    kWeightB
};

glm::vec3 shares_over_triangle(float b, float c)
{
    if (b + c > 1.0f)
    {
        b = 1.0f - b;
        c = 1.0f - c;
    }
    return {1.0f - b - c, b, c};
}

std::vector<Between> spread_places(const Mesh& mesh, int count, int seed)
{
    std::vector<double> area_up_to;
    double area = 0.0;
    for (const glm::uvec3& t : mesh.triangles)
    {
        const glm::vec3 a = mesh.positions[t.x];
        area += glm::length(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
        area_up_to.push_back(area);
    }
    std::vector<Between> places;
    for (int i = 0; i < count; ++i)
    {
        // Stratified over the area, so that triangles of equal size get equal numbers.
        const double at = (i + double(random01(seed, i, kTriangle))) / count * area;
        const size_t found = size_t(std::upper_bound(area_up_to.begin(), area_up_to.end(), at) - area_up_to.begin());
        const glm::uvec3 t = mesh.triangles[std::min(found, mesh.triangles.size() - 1)];
        places.push_back({t, shares_over_triangle(random01(seed, i, kWeightA), random01(seed, i, kWeightB))});
    }
    return places;
}

Scalp guide_scalp(const Scalp& authored, const HairParams& params)
{
    if (authored.hair)
    {
        std::vector<Between> places;
        for (const unsigned strand : simulated_strands(*authored.hair, params))
            places.push_back(authored.hair->place[strand]);
        return strewn(authored, places);
    }
    if (params.interpolation_guides != GUIDES_ALL)
        return refined(authored, params.interpolation_refine);
    const int more = params.interpolation_strands - int(authored.positions.size());
    return strewn(authored, spread_places(authored, std::max(more, 0), params.interpolation_seed));
}

} // namespace coif

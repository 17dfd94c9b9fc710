// Placed hair cut into nodes, as a groom's rest shape.
#include "sim/exchange/place.h"
#include "sim/groom.h"
#include "sim/scatter.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

float PlacedHair::length(size_t strand) const
{
    float sum = 0.0f;
    for (size_t k = first[strand] + 1; k < first[strand + 1]; ++k)
        sum += glm::distance(position[k], position[k - 1]);
    return sum;
}

std::vector<unsigned> simulated_strands(const PlacedHair& hair, const HairParams& params)
{
    if (params.interpolation_guides != GUIDES_ALL)
        return hair.guides;
    std::vector<unsigned> all(hair.strands());
    for (unsigned i = 0; i < all.size(); ++i)
        all[i] = i;
    return all;
}

// Walks along the curve in steps that are straight and `step` long, as far as `links` of them. False where the curve
// ends before.
static bool walk(const glm::vec3* curve, size_t points, int links, float step, std::vector<glm::vec3>& corners)
{
    corners.assign(1, curve[0]);
    size_t piece = 1; // that the last corner lies on ends here
    glm::vec3 from = curve[0];
    float at = 0.0f; // share of the piece
    while (corners.size() <= size_t(links))
    {
        while (piece < points && glm::distance(curve[piece], from) < step)
        {
            ++piece;
            at = 0.0f;
        }
        if (piece == points)
            return false;
        // Where the piece leaves the ball of that radius about the corner.
        const glm::vec3 a = curve[piece - 1], along = curve[piece] - a, off = a - from;
        const double aa = double(glm::dot(along, along)), b = double(glm::dot(along, off)),
                     c = double(glm::dot(off, off)) - double(step) * double(step);
        const double t = aa > 0.0 ? (-b + std::sqrt(std::max(0.0, b * b - aa * c))) / aa : 1.0;
        at = std::max(at, float(std::min(t, 1.0)));
        from = a + along * at;
        corners.push_back(from);
    }
    return true;
}

float resampled(const glm::vec3* curve, size_t points, int links, std::vector<glm::vec3>& corners)
{
    float length = 0.0f;
    for (size_t k = 1; k < points; ++k)
        length += glm::distance(curve[k], curve[k - 1]);
    // The longest step that the curve is long enough for ends at its tip.
    float low = 0.0f, high = length / float(links) * 1.0001f;
    for (int i = 0; i < 30; ++i)
    {
        const float step = 0.5f * (low + high);
        (walk(curve, points, links, step, corners) ? low : high) = step;
    }
    walk(curve, points, links, low, corners);
    corners.resize(size_t(links) + 1, corners.back());
    return low;
}

void take_hair(Groom& groom, const Scalp& scalp, const HairParams& params, const std::vector<float>& length_factor)
{
    const PlacedHair& hair = *scalp.hair;
    const std::vector<unsigned> strands = simulated_strands(hair, params);
    const size_t authored = scalp.positions.size() - strands.size();
    const int links = groom.nodes - 2;
    const float scale = params.head_scale;
    groom.hold = 1.0f;
    groom.natural_position.clear();
    groom.rest_multiplier.clear();
    groom.rest_position.assign(size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3, 0.0f);
    groom.longest = 0.0f;
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        const size_t g = size_t(s < groom.guides ? s : 0);
        size_t own = g - authored; // of `strands`
        if (g < authored)
        {
            own = 0;
            for (size_t i = 0; i < strands.size(); ++i)
                if (glm::distance(scalp.positions[authored + i], scalp.positions[g]) <
                    glm::distance(scalp.positions[authored + own], scalp.positions[g]))
                    own = i;
        }
        const unsigned strand = strands[own];
        const glm::vec3* curve = hair.position.data() + hair.first[strand];
        std::vector<glm::vec3> corners;
        const float segment = resampled(curve, hair.first[strand + 1] - hair.first[strand], links, corners) * scale;
        // The first segment tells the way out of the scalp.
        const glm::vec3 direction = unit_or(corners[1], glm::vec3(0.0f, 1.0f, 0.0f), 1e-9f);
        const glm::dvec3 root = vector_at(groom.root_position.data(), s, 0, 1);
        put_vector(groom.root_direction, s, 0, 1, direction);
        put_vector(groom.rest_position, s, 0, groom.nodes, root - glm::dvec3(direction) * double(segment));
        // Cut, or let grow straight on, by as much as the style says of this place.
        for (int k = 0; k <= links; ++k)
        {
            const float at = float(k) * length_factor[g];
            const size_t piece = size_t(std::min(int(at), links - 1));
            const glm::vec3 corner = corners[piece] + (corners[piece + 1] - corners[piece]) * (at - float(piece));
            put_vector(groom.rest_position, s, k + 1, groom.nodes, root + glm::dvec3(corner) * double(scale));
        }
        float& length = groom.segment_length[size_t(s)];
        length = segment * length_factor[g];
        groom.longest = std::max(groom.longest, length * float(links));
    }
}

std::string import_report(const PlacedHair& hair, const HairParams& params)
{
    double whole = 0.0, kept = 0.0, worst = 1.0;
    const std::vector<unsigned> strands = simulated_strands(hair, params);
    const int links = params.strand_nodes - 2;
    for (const unsigned s : strands)
    {
        const glm::vec3* curve = hair.position.data() + hair.first[s];
        const size_t points = hair.first[s + 1] - hair.first[s];
        const double length = double(hair.length(s));
        std::vector<glm::vec3> corners;
        const double own = double(resampled(curve, points, links, corners)) * links;
        whole += length;
        kept += own;
        worst = std::min(worst, own / std::max(length, 1e-9));
    }
    std::string text =
        fmt::format("{}\n{} strands of {} points in all, {:.1f} to {:.1f} cm long, {:.1f} cm in the mean\n"
                    "the farthest root was {:.1f} mm from the scalp, on which all stand now\n"
                    "{} strands are simulated, {}\n"
                    "{} nodes keep {:.1f} % of their length, {:.1f} % of the one that loses most{}\n",
                    hair.said, hair.strands(), hair.position.size(), 100.0f * hair.shortest, 100.0f * hair.longest,
                    100.0f * hair.mean, 1000.0f * hair.farthest, strands.size(),
                    params.interpolation_guides == GUIDES_ALL ? "and drawn as they are"
                    : hair.drawn ? "and each strand of the file is drawn along with the nearest of them"
                                 : "and drawn strands are mixed of them",
                    params.strand_nodes, 100.0 * kept / std::max(whole, 1e-9), 100.0 * worst,
                    worst < 0.9 ? ": strand.nodes says how many there are" : "");
    for (const std::string& remark : hair.remark)
        text += remark + "\n";
    return text;
}

} // namespace coif

#include "sim/exchange/place.h"

#include "sim/error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

static glm::vec3 upright(glm::vec3 p, HairUp up)
{
    return up == HAIR_UP_Z ? glm::vec3(p.x, p.z, -p.y) : up == HAIR_UP_UNREAL ? glm::vec3(p.x, p.z, p.y) : p;
}

static glm::vec3 in_frame(glm::vec3 p, const HairFrame& frame)
{
    return upright(p, frame.up) * frame.scale + frame.offset;
}

namespace
{
// Triangles with balls about them, so that few need be looked at.
struct Nearest
{
    const Scalp& scalp;
    std::vector<glm::vec4> ball;
    size_t last = 0; // that was nearest: where the next strand may stand too

    explicit Nearest(const Scalp& on) : scalp(on)
    {
        for (const glm::uvec3& t : scalp.triangles)
        {
            const glm::vec3 middle = (scalp.positions[t.x] + scalp.positions[t.y] + scalp.positions[t.z]) / 3.0f;
            float radius = 0.0f;
            for (int k = 0; k < 3; ++k)
                radius = std::max(radius, glm::distance(middle, scalp.positions[t[k]]));
            ball.emplace_back(middle, radius);
        }
    }

    glm::vec3 away(size_t triangle, glm::vec3 p) const
    {
        const glm::uvec3 t = scalp.triangles[triangle];
        return from_triangle(p, scalp.positions[t.x], scalp.positions[t.y], scalp.positions[t.z]);
    }

    // The place nearest to p, and how far p is from it, m.
    Between operator()(glm::vec3 p, float& distance)
    {
        distance = glm::length(away(last, p));
        for (size_t i = 0; i < ball.size(); ++i)
            if (glm::distance(glm::vec3(ball[i]), p) - ball[i].w < distance)
                if (const float d = glm::length(away(i, p)); d < distance)
                {
                    distance = d;
                    last = i;
                }
        const glm::uvec3 t = scalp.triangles[last];
        const glm::vec3 a = scalp.positions[t.x], b = scalp.positions[t.y], c = scalp.positions[t.z];
        const glm::vec3 on = p - away(last, p), normal = glm::cross(b - a, c - a);
        const float twice = std::max(glm::dot(normal, normal), 1e-30f);
        const float u = glm::clamp(glm::dot(glm::cross(c - b, on - b), normal) / twice, 0.0f, 1.0f);
        const float v = glm::clamp(glm::dot(glm::cross(a - c, on - c), normal) / twice, 0.0f, 1.0f - u);
        return {t, {u, v, 1.0f - u - v}};
    }
};
} // namespace

static glm::vec3 point_of(const Scalp& scalp, const Between& place)
{
    return scalp.positions[place.of.x] * place.shares.x + scalp.positions[place.of.y] * place.shares.y +
           scalp.positions[place.of.z] * place.shares.z;
}

// Where files are damaged or made for another head, roots are this far off at most, m.
static float reach(const Scalp& scalp) { return 0.25f * scalp.extent; }

namespace
{
struct Box
{
    glm::vec3 low{INFINITY}, high{-INFINITY};
    void add(glm::vec3 p)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    glm::vec3 middle() const { return 0.5f * (low + high); }
};
} // namespace

// Some of the roots, evenly over the file, in a frame.
static std::vector<glm::vec3> some_roots(const HairFile& file, const HairFrame& frame)
{
    const Curves& c = file.curves;
    std::vector<glm::vec3> roots;
    for (size_t s = 0, at = 0; s < c.strands(); at += c.count[s++])
        if (s % (c.strands() / 500 + 1) == 0)
            roots.push_back(in_frame(c.position[at], frame));
    return roots;
}

// To bring the middle of the roots to the scalp's, m.
static glm::vec3 to_middle(const std::vector<glm::vec3>& roots, const Scalp& scalp)
{
    Box of_roots, of_scalp;
    for (const glm::vec3& root : roots)
        of_roots.add(root);
    for (const glm::vec3& p : scalp.positions)
        of_scalp.add(p);
    return of_scalp.middle() - of_roots.middle();
}

// How far they are from the scalp in the mean, m.
static float mean_distance(const std::vector<glm::vec3>& roots, glm::vec3 moved, Nearest& nearest)
{
    float sum = 0.0f;
    for (const glm::vec3& root : roots)
    {
        float distance = 0.0f;
        nearest(root + moved, distance);
        sum += distance;
    }
    return sum / float(roots.size());
}

// The axis by which the roots lie closest to the scalp: as they are, or moved there if they are far from it by any. The
// less likely ones must do clearly better.
static HairUp guessed_up(const HairFile& file, HairFrame frame, const Scalp& scalp)
{
    constexpr float kClearly = 0.7f;
    constexpr HairUp kUps[] = {HAIR_UP_Y, HAIR_UP_Z, HAIR_UP_UNREAL};
    Nearest nearest(scalp);
    for (const bool moved : {false, true})
    {
        HairUp best = HAIR_UP_Y;
        float least = INFINITY;
        for (const HairUp up : kUps)
        {
            frame.up = up;
            const std::vector<glm::vec3> roots = some_roots(file, frame);
            const float own = mean_distance(roots, moved ? to_middle(roots, scalp) : glm::vec3(0.0f), nearest);
            if (own < kClearly * least)
            {
                best = up;
                least = own;
            }
        }
        if (moved || least < 0.25f * reach(scalp))
            return best;
    }
    return HAIR_UP_Y; // not reached
}

HairFrame hair_frame(const HairFile& file, const Scalp& scalp, const HairParams& params, std::string& said)
{
    Box box;
    for (const glm::vec3& p : file.curves.position)
        box.add(p);
    const glm::vec3 size = box.high - box.low;
    const float extent = std::max({size.x, size.y, size.z});
    HairFrame frame;
    frame.offset = {params.groom_import_offset.x, params.groom_import_offset.y, params.groom_import_offset.z};
    const bool scale_told = params.groom_import_scale > 0.0f, up_told = params.groom_import_up != HAIR_UP_AUTO;
    frame.scale = scale_told         ? params.groom_import_scale
                  : file.unit > 0.0f ? file.unit
                  : extent > 200.0f  ? 0.001f
                  : extent > 10.0f   ? 0.01f
                                     : 1.0f;
    const float height = 0.5f / frame.scale; // hair on a standing figure is far above its feet
    frame.up = up_told                                           ? HairUp(params.groom_import_up)
               : file.up != HAIR_UP_AUTO                         ? file.up
               : box.low.z > height && box.low.y < 0.5f * height ? HAIR_UP_Z
               : box.low.y > height && box.low.z < 0.5f * height ? HAIR_UP_Y
                                                                 : guessed_up(file, frame, scalp);
    const auto why = [](bool told, bool by_file) { return told ? "as told" : by_file ? "as it says" : "a guess"; };
    said = fmt::format("{}, {:.4g} across; its unit is {:g} m ({}), its {} ({})", file.format, extent, frame.scale,
                       why(scale_told, file.unit > 0.0f),
                       frame.up == HAIR_UP_Y   ? "y axis points up"
                       : frame.up == HAIR_UP_Z ? "z axis points up"
                                               : "z axis points up, left-handed",
                       why(up_told, file.up != HAIR_UP_AUTO));
    return frame;
}

glm::vec3 fitting_offset(const HairFile& file, const HairFrame& frame, const Scalp& scalp)
{
    const std::vector<glm::vec3> roots = some_roots(file, frame);
    Nearest nearest(scalp);
    if (mean_distance(roots, glm::vec3(0.0f), nearest) < 0.25f * reach(scalp))
        return glm::vec3(0.0f);
    return glm::round(to_middle(roots, scalp) * 1000.0f) / 1000.0f; // to the millimetre: it is written into a style
}

// The first `most` strands in such an order that each root is as far from all before it as can be (Gonzalez, Clustering
// to minimize the maximum intercluster distance, 1985): they stand for the others at any number of them.
static std::vector<unsigned> farthest_roots(const std::vector<glm::vec3>& roots, std::vector<unsigned> among,
                                            size_t most)
{
    std::vector<unsigned> chosen;
    std::vector<float> distance(among.size(), INFINITY);
    size_t next = 0;
    while (chosen.size() < std::min(most, among.size()))
    {
        chosen.push_back(among[next]);
        distance[next] = -1.0f;
        const glm::vec3 from = roots[among[next]];
        for (size_t i = 0; i < among.size(); ++i)
        {
            const glm::vec3 d = roots[among[i]] - from;
            distance[i] = std::min(distance[i], glm::dot(d, d));
        }
        next = size_t(std::max_element(distance.begin(), distance.end()) - distance.begin());
    }
    return chosen;
}

static constexpr size_t kMostStrands = 200000; // as many as interpolation.strands may ask for

PlacedHair place_hair(const HairFile& file, const Scalp& scalp, const HairParams& params)
{
    const Curves& c = file.curves;
    PlacedHair hair;
    const HairFrame frame = hair_frame(file, scalp, params, hair.said);
    hair.remark = file.remark;
    Nearest nearest(scalp);
    std::vector<size_t> begin;
    for (size_t s = 0, at = 0; s < c.strands(); at += c.count[s++])
        begin.push_back(at);
    // Some write strands from the tip on.
    double roots_off = 0.0, tips_off = 0.0;
    for (size_t s = 0; s < c.strands(); s += c.strands() / 200 + 1)
    {
        float distance = 0.0f;
        nearest(in_frame(c.position[begin[s]], frame), distance);
        roots_off += double(distance);
        nearest(in_frame(c.position[begin[s] + c.count[s] - 1], frame), distance);
        tips_off += double(distance);
    }
    const bool backwards = tips_off < roots_off;
    if (backwards)
        hair.remark.emplace_back("its strands begin at their tips, and are turned round");

    std::vector<unsigned> from; // [strand] its number in the file
    std::vector<glm::vec3> roots;
    const size_t all = c.strands(), most = std::min(all, kMostStrands);
    if (all > most)
        hair.remark.push_back(fmt::format("of its {} strands {} are taken, evenly", all, most));
    size_t dropped = 0;
    float farthest_dropped = 0.0f;
    hair.shortest = INFINITY;
    hair.first.push_back(0);
    double sum = 0.0;
    for (size_t s = 0; s < c.strands(); ++s)
    {
        if (s * most / all == (s + 1) * most / all) // as many in every stretch of the file
            continue;
        const size_t count = c.count[s];
        const auto point = [&](size_t k)
        { return in_frame(c.position[begin[s] + (backwards ? count - 1 - k : k)], frame); };
        float distance = 0.0f;
        const glm::vec3 root = point(0);
        const Between place = nearest(root, distance);
        if (!(distance <= reach(scalp)))
        {
            ++dropped;
            farthest_dropped = std::max(farthest_dropped, distance);
            continue;
        }
        float length = 0.0f;
        for (size_t k = 0; k < count; ++k)
        {
            hair.position.push_back(point(k) - root);
            length += k > 0 ? glm::distance(point(k), point(k - 1)) : 0.0f;
        }
        if (!(length > 1e-4f && length < 10.0f))
        {
            hair.position.resize(hair.first.back());
            ++dropped;
            continue;
        }
        hair.first.push_back(hair.position.size());
        hair.place.push_back(place);
        roots.push_back(point_of(scalp, place));
        from.push_back(unsigned(s));
        hair.farthest = std::max(hair.farthest, distance);
        hair.shortest = std::min(hair.shortest, length);
        hair.longest = std::max(hair.longest, length);
        sum += double(length);
    }
    if (2 * dropped > most)
    {
        const glm::vec3 by = frame.offset + fitting_offset(file, frame, scalp);
        throw fail("{} of the {} strands do not stand on this scalp, the farthest root is {:.3g} m off it, or are no "
                   "hair of 0.1 mm to 10 m: {}. groom.import_scale and groom.import_up say what its numbers are, "
                   "groom.import_offset = [{:.3f}, {:.3f}, {:.3f}] would bring their middle to the scalp's",
                   dropped, most, farthest_dropped, hair.said, by.x, by.y, by.z);
    }
    if (dropped > 0)
        hair.remark.push_back(fmt::format("{} of its strands have roots more than {:.0f} mm from the scalp, or are no "
                                          "hair of 0.1 mm to 10 m, and are dropped",
                                          dropped, 1000.0f * reach(scalp)));
    hair.mean = float(sum / double(hair.strands()));

    std::vector<unsigned> among;
    for (unsigned i = 0; i < hair.strands(); ++i)
        if (!c.guide.empty() && c.guide[from[i]])
            among.push_back(i);
    const bool told = !among.empty();
    if (!told)
        for (unsigned i = 0; i < hair.strands(); ++i)
            among.push_back(i);
    hair.guides = farthest_roots(roots, among, size_t(params.groom_import_guides));
    hair.drawn = hair.guides.size() < hair.strands();
    return hair;
}

} // namespace coif

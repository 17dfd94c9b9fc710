#include "sim/drawn_strands.h"

#include "sim/exchange/place.h"
#include "sim/hair_color.h"
#include "sim/scatter.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace coif
{

// Streams of random numbers, among those of sim/groom.cpp.
enum
{
    kCut = 5,
    kStrandSeed,
    kTurn, // and upwards: one pair of channels for each of eight tries
    kKeep = kTurn + 16
};

// A mix across a parting would lie flat over it: guides that leave the head the other way than the nearest one get no
// weight, and the drawn strand, which starts at its own root, follows the others.
static glm::vec3 without_opposed(glm::vec3 weights, const glm::vec3 directions[3])
{
    int nearest = 0;
    for (int k = 1; k < 3; ++k)
        if (weights[k] > weights[nearest])
            nearest = k;
    for (int k = 0; k < 3; ++k)
        if (glm::dot(directions[k], directions[nearest]) < kSameWay)
            weights[k] = 0.0f;
    return weights / (weights.x + weights.y + weights.z);
}

DrawnStrand mixed_of(const std::vector<glm::vec3>& directions, const glm::uvec3& guides, glm::vec3 weights)
{
    const glm::vec3 of[3] = {directions[guides.x], directions[guides.y], directions[guides.z]};
    const glm::vec3 w = without_opposed(weights, of);
    // The heaviest guide first: the others may lose their weight to it (kernels/interpolate_multi.cl).
    int order[3] = {0, 1, 2};
    std::stable_sort(order, order + 3, [&](int i, int j) { return w[i] > w[j]; });
    DrawnStrand strand = {};
    strand.weights = F4(w[order[0]], w[order[1]], w[order[2]], 0.0f);
    strand.guide0 = int(guides[order[0]]);
    strand.guide1 = int(guides[order[1]]);
    strand.guide2 = int(guides[order[2]]);
    return strand;
}

// Guides on the other side of an edge or a parting get no weight. Where that leaves none, the nearest on this side has
// it all.
static void keep_to_own_side(const Scalp& scalp, const std::vector<Sides>& sides, const Sides& own, glm::vec3 root,
                             glm::uvec3& guides, glm::vec3& weights)
{
    for (int k = 0; k < 3; ++k)
        if (!may_mix(sides[guides[k]], own))
            weights[k] = 0.0f;
    if (weights.x + weights.y + weights.z > 0.01f)
        return;
    float nearest = INFINITY;
    unsigned best = guides.x;
    for (unsigned g = 0; g < sides.size(); ++g)
        if (const float distance = glm::distance(scalp.positions[g], root);
            distance < nearest && may_mix(sides[g], own))
        {
            nearest = distance;
            best = g;
        }
    guides = glm::uvec3(best);
    weights = {1.0f, 0.0f, 0.0f};
}

// Cuts the strand with this number to its length and adds it, unless it is one of those that thin hair lacks.
static void add_drawn(Groom& groom, StrandGround& ground, DrawnStrand strand, const ScalpPlace& place, int index)
{
    const HairParams p = ground.varied ? params_at(ground.shaping, place) : ground.shaping.params;
    const int seed = p.interpolation_seed;
    if (p.interpolation_density < 1.0f && random01(seed, index, kKeep) >= p.interpolation_density)
        return;
    const float scale = p.head_scale;
    strand.root = F4(place.point.x * scale, place.point.y * scale, place.point.z * scale,
                     1.0f - p.strand_length_variation * random01(seed, index, kCut));
    strand.seed = int(random01(seed, index, kStrandSeed) * 0x1p24f);
    if (ground.varied)
    {
        ground.drawn_sides.push_back(sides_at(ground.shaping, place));
        const bool copy = strand.guide0 == strand.guide1 && strand.guide0 == strand.guide2;
        const float4 w = copy ? F4(1.0f, 0.0f, 0.0f, 0.0f) : strand.weights;
        const float length = w.x * ground.lengths[size_t(strand.guide0)] + w.y * ground.lengths[size_t(strand.guide1)] +
                             w.z * ground.lengths[size_t(strand.guide2)];
        strand.root.w = std::min(1.0f, strand.root.w * p.strand_length / std::max(length, 1e-6f));
        const auto linear = [](const float4& c)
        { return F4(linear_of_srgb(c.x), linear_of_srgb(c.y), linear_of_srgb(c.z), 1.0f); };
        const auto with = [](const float4& color, float more) { return F4(color.x, color.y, color.z, more); };
        HairParams dyed = p;
        dyed.look_root_color = linear(p.look_root_color);
        dyed.look_tip_color = linear(p.look_tip_color);
        take_pigment(dyed);
        const float waves = waves_are_shape(ground.shaping.params) ? 0.0f : 1.0f; // nothing is left to lay on
        groom.looks.push_back({with(dyed.look_root_color, p.look_width), with(dyed.look_tip_color, p.look_opacity),
                               F4(waves * p.wave_normal_amplitude, p.wave_normal_frequency,
                                  waves * p.wave_binormal_amplitude, p.wave_binormal_frequency),
                               F4(float(strand.seed), curls_are_shape(ground.shaping.params) ? 0.0f : p.curl_radius,
                                  p.frizz_amount, 0.0f)});
    }
    groom.drawn.push_back(strand);
}

static void grow_multi(Groom& groom, StrandGround& ground, int count)
{
    const HairParams& p = ground.shaping.params;
    const Scalp& scalp = ground.shaping.scalp;
    const std::vector<Between> places = spread_places(scalp, count, p.interpolation_seed);
    for (int i = 0; i < count; ++i)
    {
        glm::uvec3 guides = places[size_t(i)].of;
        glm::vec3 shares = places[size_t(i)].shares;
        const glm::vec3 root = scalp.positions[guides.x] * shares.x + scalp.positions[guides.y] * shares.y +
                               scalp.positions[guides.z] * shares.z;
        const ScalpPlace place = {root, guides, shares};
        if (ground.varied)
            keep_to_own_side(scalp, ground.sides, sides_at(ground.shaping, place), root, guides, shares);
        add_drawn(groom, ground, mixed_of(ground.directions, guides, shares), place, i);
    }
}

// The place on the scalp that is nearest to a point beside it, if one is near.
static std::optional<ScalpPlace> place_near(const Scalp& scalp, const std::vector<unsigned>& triangles, glm::vec3 point)
{
    float nearest = 0.02f * scalp.extent;
    std::optional<ScalpPlace> place;
    for (const unsigned index : triangles)
    {
        const glm::uvec3 t = scalp.triangles[index];
        const glm::vec3 a = scalp.positions[t.x], b = scalp.positions[t.y], c = scalp.positions[t.z];
        const glm::vec3 away = from_triangle(point, a, b, c);
        if (!(glm::length(away) < nearest))
            continue;
        nearest = glm::length(away);
        const glm::vec3 normal = glm::cross(b - a, c - a), on = point - away;
        const float twice = std::max(glm::dot(normal, normal), 1e-30f);
        const float u = glm::clamp(glm::dot(glm::cross(c - b, on - b), normal) / twice, 0.0f, 1.0f);
        const float v = glm::clamp(glm::dot(glm::cross(a - c, on - c), normal) / twice, 0.0f, 1.0f - u);
        place = {on, t, {u, v, 1.0f - u - v}};
    }
    return place;
}

static glm::vec3 turned(glm::vec3 v, glm::vec3 center, float yaw, float pitch)
{
    const glm::quat turn = glm::angleAxis(yaw, glm::vec3(0, 1, 0)) * glm::angleAxis(pitch, glm::vec3(1, 0, 0));
    return center + turn * (v - center);
}

static void grow_single(Groom& groom, StrandGround& ground, int count, int first)
{
    const HairParams& p = ground.shaping.params;
    const Scalp& scalp = ground.shaping.scalp;
    // The triangles about each vertex and about its neighbours: where a turned copy may stand.
    std::vector<std::vector<unsigned>> own(scalp.positions.size()), near(scalp.positions.size());
    for (unsigned i = 0; i < scalp.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            own[scalp.triangles[i][k]].push_back(i);
    for (unsigned v = 0; v < own.size(); ++v)
    {
        for (const unsigned i : own[v])
            for (int k = 0; k < 3; ++k)
                near[v].insert(near[v].end(), own[scalp.triangles[i][k]].begin(), own[scalp.triangles[i][k]].end());
        std::sort(near[v].begin(), near[v].end());
        near[v].erase(std::unique(near[v].begin(), near[v].end()), near[v].end());
    }
    const float spread = p.interpolation_spread * std::numbers::pi_v<float> / 180.0f;
    for (int i = 0; i < count; ++i)
    {
        const int index = first + i;
        const int guide = i % groom.guides;
        float yaw = 0.0f, pitch = 0.0f;
        ScalpPlace place = at_vertex(scalp, size_t(guide));
        // Copies that would leave the scalp or their side are drawn again, ever closer; the last resort is the guide
        // itself.
        for (int attempt = 0; attempt < 8; ++attempt)
        {
            const float within = spread * (1.0f - float(attempt) / 8.0f);
            yaw = within * random_sign(p.interpolation_seed, index, kTurn + 2 * attempt);
            pitch = within * random_sign(p.interpolation_seed, index, kTurn + 2 * attempt + 1);
            const glm::vec3 root = turned(scalp.positions[size_t(guide)], scalp.center, yaw, pitch);
            const std::optional<ScalpPlace> found = place_near(scalp, near[size_t(guide)], root);
            if (own[size_t(guide)].empty())
            {
                place.point = root;
                break;
            }
            if (found && (!ground.varied || may_mix(ground.sides[size_t(guide)], sides_at(ground.shaping, *found))))
            {
                place = *found;
                break;
            }
            yaw = pitch = 0.0f;
        }
        DrawnStrand strand = {};
        strand.weights = F4(yaw, pitch, 0.0f, 0.0f);
        strand.guide0 = strand.guide1 = strand.guide2 = guide;
        add_drawn(groom, ground, strand, place, index);
    }
}

// Each drawn strand is a guide of its own, unturned.
static void grow_all(Groom& groom, StrandGround& ground, int count)
{
    for (int i = 0; i < count; ++i)
    {
        DrawnStrand strand = {};
        strand.guide0 = strand.guide1 = strand.guide2 = int(long(i) * groom.guides / count);
        add_drawn(groom, ground, strand, at_vertex(ground.shaping.scalp, size_t(strand.guide0)), i);
    }
}

namespace
{
// The simulated strands nearest to a place, and their shares of it.
struct Neighbours
{
    glm::uvec3 guides{0};
    glm::vec3 shares{0.0f};
    float nearest = 0.0f; // m
};
} // namespace

// `first` is the first of the scalp's vertices that are asked.
static Neighbours neighbours(const Scalp& scalp, size_t first, glm::vec3 point)
{
    float square[3] = {INFINITY, INFINITY, INFINITY};
    unsigned guide[3] = {unsigned(first), unsigned(first), unsigned(first)};
    for (size_t g = first; g < scalp.positions.size(); ++g)
    {
        const glm::vec3 d = scalp.positions[g] - point;
        const float own = glm::dot(d, d);
        if (own >= square[2])
            continue;
        int at = 2;
        for (; at > 0 && square[at - 1] > own; --at)
        {
            square[at] = square[at - 1];
            guide[at] = guide[at - 1];
        }
        square[at] = own;
        guide[at] = unsigned(g);
    }
    // By the inverse square (Shepard 1968), within a tenth of a millimetre all to one.
    const auto share = [&](int k) { return square[k] < INFINITY ? 1.0f / (square[k] + 1e-8f) : 0.0f; };
    const glm::vec3 shares(share(0), share(1), share(2));
    return {{guide[0], guide[1], guide[2]}, shares / (shares.x + shares.y + shares.z), std::sqrt(square[0])};
}

// How far from simulated strands there is still hair: twice as far as most of them are from one another, m.
static float reach_of_hair(const Scalp& scalp, size_t first)
{
    std::vector<float> apart;
    const size_t stride = (scalp.positions.size() - first) / 500 + 1;
    for (size_t g = first; g < scalp.positions.size(); g += stride)
    {
        float nearest = INFINITY;
        for (size_t other = first; other < scalp.positions.size(); ++other)
            if (other != g)
                nearest = std::min(nearest, glm::distance(scalp.positions[g], scalp.positions[other]));
        apart.push_back(nearest);
    }
    const auto most = apart.begin() + long(apart.size() * 9 / 10);
    std::nth_element(apart.begin(), most, apart.end());
    return 2.0f * *most;
}

// Strands of a file's hair: itself, where all of it is simulated; else each of its strands along with the simulated
// ones nearest to it, or, where those are all that it has, as many as the style says wherever there is hair.
static void grow_placed(Groom& groom, StrandGround& ground)
{
    const HairParams& p = ground.shaping.params;
    const Scalp& scalp = ground.shaping.scalp;
    const PlacedHair& hair = *scalp.hair;
    const std::vector<unsigned> simulated = simulated_strands(hair, p);
    const size_t first = scalp.positions.size() - simulated.size();
    if (p.interpolation_guides == GUIDES_ALL)
    {
        for (size_t i = 0; i < simulated.size(); ++i)
        {
            DrawnStrand strand = {};
            strand.guide0 = strand.guide1 = strand.guide2 = int(first + i);
            add_drawn(groom, ground, strand, at_vertex(scalp, first + i), int(i));
        }
        return;
    }
    std::vector<int> guide_of(hair.strands(), -1);
    for (size_t i = 0; i < simulated.size(); ++i)
        guide_of[simulated[i]] = int(first + i);
    const std::vector<Between> places =
        hair.drawn ? hair.place : spread_places(scalp, p.interpolation_strands, p.interpolation_seed);
    const float reach = hair.drawn ? INFINITY : reach_of_hair(scalp, first);
    for (size_t i = 0; i < places.size(); ++i)
    {
        const Between& on = places[i];
        const glm::vec3 root = scalp.positions[on.of.x] * on.shares.x + scalp.positions[on.of.y] * on.shares.y +
                               scalp.positions[on.of.z] * on.shares.z;
        const ScalpPlace place = {root, on.of, on.shares};
        Neighbours near = neighbours(scalp, first, root);
        if (near.nearest > reach)
            continue;
        if (hair.drawn && guide_of[i] >= 0)
            near = {glm::uvec3(unsigned(guide_of[i])), {1.0f, 0.0f, 0.0f}, 0.0f};
        if (ground.varied)
            keep_to_own_side(scalp, ground.sides, sides_at(ground.shaping, place), root, near.guides, near.shares);
        const DrawnStrand strand = mixed_of(ground.directions, near.guides, near.shares);
        const size_t before = groom.drawn.size();
        add_drawn(groom, ground, strand, place, int(i));
        if (!hair.drawn || groom.drawn.size() == before)
            continue;
        // As long as in the file, as far as those that it goes along with reach.
        const float4 w = strand.weights;
        const float mixed = w.x * groom.segment_length[size_t(strand.guide0)] +
                            w.y * groom.segment_length[size_t(strand.guide1)] +
                            w.z * groom.segment_length[size_t(strand.guide2)];
        const float own = hair.length(i) * p.head_scale / float(groom.nodes - 2);
        float& cut = groom.drawn.back().root.w;
        cut = std::min(1.0f, cut * own / std::max(mixed, 1e-9f));
    }
}

void grow_drawn(Groom& groom, StrandGround& ground)
{
    const HairParams& p = ground.shaping.params;
    const bool placed = ground.shaping.scalp.hair != nullptr, all = p.interpolation_guides == GUIDES_ALL;
    const int single = int(std::lround(double(p.interpolation_strands) * double(p.interpolation_ratio)));
    const int multi = all ? 0 : p.interpolation_strands - single;
    groom.drawn.reserve(size_t(p.interpolation_strands));
    if (placed)
        grow_placed(groom, ground);
    else
        grow_multi(groom, ground, multi);
    groom.drawn_multi = placed && all ? 0 : int(groom.drawn.size());
    if (!placed && all)
        grow_all(groom, ground, p.interpolation_strands);
    else if (!placed)
        grow_single(groom, ground, single, multi);
}

} // namespace coif

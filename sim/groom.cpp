#include "sim/groom.h"

#include "sim/clumps.h"
#include "sim/exchange/place.h"
#include "sim/material.h"
#include "sim/scatter.h"
#include "sim/shaping.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

namespace coif
{

// What a random number is for; each purpose draws from its own stream.
enum Channel
{
    kLift,
    kSweep,
    kCut = 5, // from 2 on: spread_places()
    kStrandSeed,
    kTurn, // and upwards: one pair of channels for each of eight tries
    kKeep = kTurn + 16,
    kCurlPhase = 100,
    kCurlVariation,
    kCurlHand
};

static uint32_t pcg(uint32_t state)
{
    const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

float random01(int seed, int index, int channel)
{
    uint32_t state = pcg(uint32_t(seed) * 747796405u + 2891336453u);
    state = pcg((state ^ uint32_t(index)) * 747796405u + 2891336453u);
    state = pcg((state ^ uint32_t(channel)) * 747796405u + 2891336453u);
    return float(state >> 8) * 0x1p-24f;
}

static float random_sign(int seed, int index, int channel) { return 2.0f * random01(seed, index, channel) - 1.0f; }

// The direction along the scalp, at a root with normal n, that leads away from the crown or its parting. The parting is
// an arc about the head's side-to-side axis, from the crown towards the face.
static glm::vec3 flow(glm::vec3 n, glm::vec3 crown, float part)
{
    const glm::vec3 side(1.0f, 0.0f, 0.0f);
    const glm::vec3 pole = unit_or(crown, {0.0f, 1.0f, 0.0f});
    const glm::vec3 axis = unit_or(side - pole * glm::dot(side, pole), {0.0f, 0.0f, 1.0f});
    const glm::vec3 ahead = glm::cross(axis, pole); // where the arc leads from the crown
    // The arc's point nearest to n, by its angle from the crown.
    const float angle = std::clamp(std::atan2(glm::dot(n, ahead), glm::dot(n, pole)), 0.0f, part);
    const glm::vec3 nearest = pole * std::cos(angle) + ahead * std::sin(angle);
    const glm::vec3 away = glm::cross(n, glm::cross(n, nearest)); // across n to the last bit, even close to the crown
    const glm::vec3 back = -ahead - n * glm::dot(-ahead, n);      // on the parting itself: backwards
    return unit_or(away, unit_or(back, unit_or(glm::cross(n, glm::vec3(0.3f, 0.5f, 0.8f)), {1.0f, 0.0f, 0.0f})));
}

static glm::vec3 root_direction(const Shaping& shaping, const HairParams& p, int guide)
{
    const glm::vec3 n = shaping.scalp.normals[size_t(guide)];
    const float degree = std::numbers::pi_v<float> / 180.0f;
    const int seed = p.interpolation_seed;
    const float lift = (p.root_lift + p.root_lift_variation * random_sign(seed, guide, kLift)) * degree;
    const float sweep = (p.root_sweep + p.root_sweep_variation * random_sign(seed, guide, kSweep)) * degree;
    const glm::vec3 crown(p.root_crown.x, p.root_crown.y, p.root_crown.z);
    const glm::vec3 down =
        parted_flow(shaping, shaping.scalp.positions[size_t(guide)], n, flow(n, crown, p.root_part * degree));
    const glm::vec3 along = glm::angleAxis(sweep, n) * down;
    return unit_or(n * std::cos(lift) + along * std::sin(lift), n);
}

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

namespace
{
// What drawn strands are grown of.
struct Ground
{
    const Shaping& shaping;
    bool varied;                       // from place to place
    std::vector<glm::vec3> directions; // of the guides' roots
    std::vector<float> lengths;        // of the guides, m
    std::vector<Sides> sides;          // of the guides
    std::vector<Sides> drawn_sides;    // of the drawn strands so far; empty where nothing varies
};
} // namespace

// Cuts the strand with this number to its length and adds it, unless it is one of those that thin hair lacks.
static void add_drawn(Groom& groom, Ground& ground, DrawnStrand strand, const ScalpPlace& place, int index)
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
        const auto linear = [](const float4& c, float with)
        { return F4(linear_of_srgb(c.x), linear_of_srgb(c.y), linear_of_srgb(c.z), with); };
        const float waves = waves_are_shape(ground.shaping.params) ? 0.0f : 1.0f; // nothing is left to lay on
        groom.looks.push_back({linear(p.look_root_color, p.look_width), linear(p.look_tip_color, p.look_opacity),
                               F4(waves * p.wave_normal_amplitude, p.wave_normal_frequency,
                                  waves * p.wave_binormal_amplitude, p.wave_binormal_frequency),
                               F4(float(strand.seed), curls_are_shape(ground.shaping.params) ? 0.0f : p.curl_radius,
                                  p.frizz_amount, 0.0f)});
    }
    groom.drawn.push_back(strand);
}

static void grow_multi(Groom& groom, Ground& ground, int count)
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

static void grow_single(Groom& groom, Ground& ground, int count, int first)
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
static void grow_all(Groom& groom, Ground& ground, int count)
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
static void grow_placed(Groom& groom, Ground& ground)
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

// A guide's curl, if it is one of the strand's own shape.
struct Curl
{
    double radius = 0.0, turns = 0.0; // m; turns a metre, left-handed ones below zero
    double phase = 0.0;               // turns
};

static Curl curl_of(const HairParams& p, int guide)
{
    const int seed = p.interpolation_seed;
    const double less = double(p.curl_variation) * double(random01(seed, guide, kCurlVariation));
    const bool left = p.curl_hand == 2 ? random01(seed, guide, kCurlHand) < 0.5f : p.curl_hand == 1;
    return {double(p.curl_radius) * (1.0 - less), (left ? -1.0 : 1.0) / (double(p.curl_pitch) * (1.0 - 0.5 * less)),
            double(p.curl_phase) * double(random01(seed, guide, kCurlPhase))};
}

// Nodes of a strand whose own shape is waves and a curl about a straight axis: equally far apart along the curve, which
// is longer than the axis. Returns the length of its segments, m.
static double shape_form(const HairParams& p, bool waved, const Curl& curl, glm::dvec3 root, glm::dvec3 along,
                         glm::dvec3 normal, std::vector<glm::dvec3>& nodes)
{
    const glm::dvec3 binormal = glm::cross(along, normal);
    const double waves = waved ? 1.0 : 0.0;
    const auto at = [&](double s) // s: along the axis, m
    {
        const double share = s / double(p.strand_length), turn = 2.0 * std::numbers::pi;
        // As kernels/strand_curve.h lets waves set in; said again, because that speaks float only, as GLSL does.
        const auto onset = [&](double begin)
        {
            const double u = std::clamp(4.0 * (share - begin), 0.0, 1.0);
            return u * u * (3.0 - 2.0 * u);
        };
        const double angle = turn * (curl.turns * s + curl.phase), radius = curl.radius * onset(p.curl_begin);
        const double n = waves * double(p.wave_normal_amplitude) * onset(p.wave_normal_begin) *
                         std::sin(turn * s * double(p.wave_normal_frequency));
        const double b = waves * double(p.wave_binormal_amplitude) * onset(p.wave_binormal_begin) *
                         std::cos(turn * s * double(p.wave_binormal_frequency));
        return root + along * s +
               profile_at(p.wave_along, share) *
                   (normal * (n + radius * std::cos(angle)) + binormal * (b + radius * std::sin(angle)));
    };
    const int links = p.strand_nodes - 2, fine = 64 * links;
    std::vector<glm::dvec3> curve;
    std::vector<double> length_at = {0.0};
    for (int i = 0; i <= fine; ++i)
    {
        curve.push_back(at(double(p.strand_length) * i / fine));
        if (i > 0)
            length_at.push_back(length_at.back() + glm::distance(curve[size_t(i)], curve[size_t(i - 1)]));
    }
    const double segment = length_at.back() / links;
    nodes = {root - along * segment, root};
    size_t piece = 0;
    for (int k = 1; k <= links; ++k)
    {
        const double wanted = segment * k;
        while (piece + 2 < length_at.size() && length_at[piece + 1] < wanted)
            ++piece;
        const double within = (wanted - length_at[piece]) / std::max(1e-12, length_at[piece + 1] - length_at[piece]);
        nodes.push_back(glm::mix(curve[piece], curve[piece + 1], std::clamp(within, 0.0, 1.0)));
    }
    return segment;
}

static bool curls_differ(const HairParams& p)
{
    return curls_are_shape(p) && (p.curl_phase > 0.0f || p.curl_variation > 0.0f || p.curl_hand == 2);
}

Groom grow(const HairParams& params, const Scalp& authored, const HostParams& host)
{
    const Scalp scalp = guide_scalp(authored, params);
    return grow(shape_over(params, host, authored, scalp));
}

Groom grow(const Shaping& shaping)
{
    const HairParams& p = shaping.params;
    const HostParams& host = shaping.host;
    const Scalp& scalp = shaping.scalp;
    Ground ground{shaping, varies(host), {}, {}, {}, {}};
    Groom groom;
    groom.nodes = p.strand_nodes;
    groom.guides = int(scalp.positions.size());
    groom.blocks = (groom.guides + LANES - 1) / LANES;
    groom.center = scalp.center * p.head_scale;
    groom.extent = scalp.extent * p.head_scale;

    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3& root : scalp.positions)
    {
        low = glm::min(low, root * p.head_scale);
        high = glm::max(high, root * p.head_scale);
    }
    groom.middle = 0.5f * (low + high);
    for (const glm::vec3& root : scalp.positions)
        groom.farthest = std::max(groom.farthest, glm::length(root * p.head_scale - groom.middle));

    groom.root_position.resize(size_t(groom.blocks) * 3 * LANES);
    groom.root_direction.resize(size_t(groom.blocks) * 3 * LANES);
    groom.segment_length.resize(size_t(groom.blocks) * LANES);
    groom.hold = p.bending_hold;
    const bool formed = waves_are_shape(p) || curls_are_shape(p);
    if (formed)
        groom.natural_position.resize(size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3);
    if (ground.varied)
        groom.bend_factor.resize(size_t(groom.blocks) * LANES);
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        const size_t g = size_t(s < groom.guides ? s : 0);
        const HairParams own = ground.varied ? params_at(shaping, at_vertex(scalp, g)) : p;
        const glm::vec3 direction = root_direction(shaping, own, int(g));
        put_vector(groom.root_position, s, 0, 1, scalp.positions[g] * p.head_scale);
        put_vector(groom.root_direction, s, 0, 1, direction);
        // All segments of a strand are equally long; the one under the scalp does not count towards its length.
        float& segment = groom.segment_length[size_t(s)];
        segment = own.strand_length / float(groom.nodes - 2);
        if (formed)
        {
            const glm::dvec3 root = glm::dvec3(scalp.positions[g]) * double(p.head_scale), along = direction;
            const glm::vec3 outward = scalp.normals[g] - direction * glm::dot(scalp.normals[g], direction);
            const glm::vec3 side = glm::cross(direction, glm::vec3(0.0f, 1.0f, 0.0f));
            const glm::dvec3 normal = unit_or(outward, unit_or(side, {1.0f, 0.0f, 0.0f}));
            std::vector<glm::dvec3> nodes;
            segment = float(shape_form(own, waves_are_shape(p), curls_are_shape(p) ? curl_of(own, int(g)) : Curl{},
                                       root, along, glm::normalize(normal - along * glm::dot(normal, along)), nodes));
            for (int k = 0; k < groom.nodes; ++k)
                put_vector(groom.natural_position, s, k, groom.nodes, nodes[size_t(k)]);
        }
        // The axis of waves counts for their length; the strand is longer.
        groom.longest = std::max({groom.longest, own.strand_length, segment * float(groom.nodes - 2)});
        if (ground.varied)
            groom.bend_factor[size_t(s)] =
                float(stiffness_over_mass(own, groom.nodes - 2, double(segment * p.strand_spacing)) /
                      stiffness_over_mass(p, groom.nodes - 2, double(segment * p.strand_spacing)));
        if (s >= groom.guides)
            continue;
        ground.directions.push_back(direction);
        ground.lengths.push_back(own.strand_length);
        ground.sides.push_back(ground.varied ? sides_at(shaping, at_vertex(scalp, g)) : Sides{});
    }

    if (scalp.hair)
    {
        std::vector<float> factor;
        for (const float length : ground.lengths)
            factor.push_back(length / p.strand_length);
        take_hair(groom, scalp, p, factor);
        for (size_t g = 0; g < ground.directions.size(); ++g)
            ground.directions[g] = glm::vec3(vector_at(groom.root_direction.data(), int(g), 0, 1));
    }
    else if (host.groom_rest.shapes)
        take_shapes(groom, *host.groom_rest.shapes, scalp, p.head_scale);

    const bool all = p.interpolation_guides == GUIDES_ALL;
    const int single = int(std::lround(double(p.interpolation_strands) * double(p.interpolation_ratio)));
    const int multi = all ? 0 : p.interpolation_strands - single;
    groom.drawn.reserve(size_t(p.interpolation_strands));
    if (scalp.hair)
        grow_placed(groom, ground);
    else
        grow_multi(groom, ground, multi);
    groom.drawn_multi = scalp.hair && all ? 0 : int(groom.drawn.size());
    if (!scalp.hair && all)
        grow_all(groom, ground, p.interpolation_strands);
    else if (!scalp.hair)
        grow_single(groom, ground, single, multi);
    for (size_t i = 0; i < groom.drawn.size(); ++i)
    {
        groom.drawn[i].leader = int(i);
        // The mean of two curls that turn in different places is none: each strand follows one guide.
        if (formed && int(i) < groom.drawn_multi && curls_differ(p))
            groom.drawn[i].weights = F4(1.0f, 0.0f, 0.0f, 0.0f);
    }
    if (has_clumps(p))
        gather_clumps(groom.drawn, p, ground.directions, ground.drawn_sides);
    return groom;
}

} // namespace coif

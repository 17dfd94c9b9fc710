#include "sim/tied_hair.h"

#include "sim/error.h"
#include "sim/scatter.h"
#include "sim/shaping.h"
#include "sim/shown.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

using glm::vec3;

static constexpr float kClearance = 0.0015f; // m that held hair keeps from the head at least
static constexpr int kPieces = 48;           // of a path from root to ring
static constexpr float kLeastTail = 2.0f;    // segments that must be left behind the ring

static vec3 some_normal(vec3 t)
{
    return glm::normalize(std::abs(t.x) > 0.6f ? vec3(-t.z, 0.0f, t.x) : vec3(0.0f, t.z, -t.y));
}

// The smallest rotation that takes the unit vector a to b.
static glm::quat turning(vec3 a, vec3 b)
{
    const float cosine = glm::dot(a, b);
    if (cosine < -0.9999f)
        return glm::angleAxis(std::numbers::pi_v<float>, some_normal(a));
    return glm::normalize(glm::quat(1.0f + cosine, glm::cross(a, b)));
}

// ---- the ground

static DistanceAt above(const TieGround& ground, vec3 p)
{
    if (ground.grid.grid)
    {
        DistanceAt at = distance_at(*ground.grid.grid, (p - ground.grid.offset) / ground.grid.scale);
        return {at.distance * ground.grid.scale, unit_or(at.gradient, {0.0f, 1.0f, 0.0f})};
    }
    DistanceAt nearest = {kFarOutside, {0.0f, 1.0f, 0.0f}};
    for (const Collider& body : ground.spheres)
    {
        const vec3 axis = body.to ? *body.to - body.center : vec3(0.0f);
        const float squared = glm::dot(axis, axis);
        const float share = squared > 0.0f ? std::clamp(glm::dot(p - body.center, axis) / squared, 0.0f, 1.0f) : 0.0f;
        const vec3 away = p - body.center - axis * share;
        const float distance = glm::length(away) - body.radius;
        if (distance < nearest.distance)
            nearest = {distance, unit_or(away, {0.0f, 1.0f, 0.0f})};
    }
    return nearest;
}

// Out along the slope until p is `height` above the ground.
static vec3 lifted(const TieGround& ground, vec3 p, float height)
{
    for (int i = 0; i < 6; ++i)
    {
        const DistanceAt at = above(ground, p);
        if (at.distance >= height - 1e-5f)
            break;
        p += (height - at.distance) * at.gradient;
    }
    return p;
}

RingPlace ring_place(const TieGround& ground, vec3 at, float height)
{
    for (int i = 0; i < 40; ++i) // in creases it takes some rounds
    {
        const DistanceAt here = above(ground, at);
        if (std::abs(here.distance - height) < 1e-5f)
            break;
        at += (height - here.distance) * here.gradient;
    }
    return {at, above(ground, at).gradient};
}

float height_above(const TieGround& ground, vec3 at) { return above(ground, at).distance; }

// ---- rings

namespace
{
struct Ring
{
    vec3 center, axis; // in the head's frame, m
    vec3 side, up;     // across the axis; side is level as far as may be
    vec3 pole;         // from the scalp's centre, unit length
    float radius;
    glm::quat from_pole; // turns the pole to the axis: what arrives from below leaves below
};
} // namespace

static Ring ring_of(const Tie& tie, const Groom& groom, const HairParams& params, const TieGround& ground)
{
    const auto number = [](vec3 v) { return std::isfinite(v.x + v.y + v.z); };
    if (!number(tie.at) || !number(tie.axis) || !(glm::length(tie.axis) > 1e-6f))
        throw fail("tie '{}' has no direction: its axis must not be zero", shown(tie.name));
    if (!(tie.radius >= 0.002f && tie.radius <= 0.2f))
        throw fail("tie '{}' has a ring of {} m radius, but it must lie in [0.002, 0.2] m", shown(tie.name),
                   tie.radius);
    Ring ring;
    ring.center = tie.at * params.head_scale;
    ring.axis = glm::normalize(tie.axis);
    ring.radius = tie.radius;
    const float height = above(ground, ring.center).distance;
    if (height < 0.0f)
    {
        const vec3 out = ring_place(ground, ring.center, ring.radius).at / params.head_scale;
        throw fail("tie '{}' has its ring {:.1f} mm inside the head: its place must be outside, as [{:.3f}, {:.3f}, "
                   "{:.3f}] is",
                   shown(tie.name), double(-height) * 1000.0, out.x, out.y, out.z);
    }
    ring.pole = unit_or(ring.center - groom.center, {0.0f, 1.0f, 0.0f});
    ring.from_pole = turning(ring.pole, ring.axis);
    const vec3 level = glm::cross(vec3(0.0f, 1.0f, 0.0f), ring.pole);
    vec3 side = glm::length(level) > 0.2f ? level : vec3(1.0f, 0.0f, 0.0f);
    side = glm::normalize(ring.from_pole * glm::normalize(side - ring.pole * glm::dot(side, ring.pole)));
    ring.side = side;
    ring.up = glm::cross(ring.axis, ring.side);
    return ring;
}

// Where in the ring the hair of a root runs: x along its side, y along its up, in shares of its radius.
static glm::vec2 azimuth(const Ring& ring, const Groom& groom, vec3 root)
{
    const vec3 u = unit_or(root - groom.center, ring.pole);
    const vec3 arrives = ring.from_pole * unit_or(u - ring.pole * glm::dot(u, ring.pole), ring.side);
    return {glm::dot(arrives, ring.side), glm::dot(arrives, ring.up)};
}

static float angle_from(const Ring& ring, const Groom& groom, vec3 root)
{
    return std::acos(std::clamp(glm::dot(unit_or(root - groom.center, ring.pole), ring.pole), -1.0f, 1.0f));
}

// ---- paths

// Over the ground at these heights along a great circle about the scalp's centre, and from nearby in a curve into the
// ring: points from the root to its place in the ring.
static std::vector<vec3> path_of(const Ring& ring, const Groom& groom, const TieGround& ground, vec3 root, vec3 place,
                                 float height)
{
    const vec3 from = unit_or(root - groom.center, ring.pole), to = unit_or(place - groom.center, ring.pole);
    const float angle = std::acos(std::clamp(glm::dot(from, to), -1.0f, 1.0f));
    const float far = 0.5f * (glm::length(root - groom.center) + glm::length(place - groom.center));
    const float rise = std::max(above(ground, place).distance, 0.0f);
    // The curve into the ring begins where it need not be steep.
    const float way = angle * far, curve = std::min(way, 2.0f * ring.radius + 1.5f * rise + 0.01f);
    const float begins = way > 1e-5f ? 1.0f - curve / way : 0.0f;
    const auto on_ground = [&](float t) // share of the great circle
    {
        const glm::quat turn = glm::slerp(glm::quat(1, 0, 0, 0), turning(from, to), t);
        const vec3 u = turn * from;
        const float share = glm::smoothstep(0.0f, 1.0f, std::min(t * way / 0.03f, 1.0f));
        const float wanted = std::max(kClearance, height * share * (1.0f - t));
        vec3 p = groom.center + u * glm::length(root - groom.center);
        for (int i = 0; i < 8; ++i)
        {
            const DistanceAt at = above(ground, p);
            p += (wanted - at.distance) / std::max(glm::dot(at.gradient, u), 0.5f) * u;
        }
        return glm::mix(root, p, glm::smoothstep(0.0f, 1.0f, std::min(t * way / 0.012f, 1.0f)));
    };
    std::vector<vec3> path;
    const vec3 start = begins > 0.0f ? on_ground(begins) : root;
    const vec3 along = begins > 0.0f
                           ? unit_or(start - on_ground(std::max(begins - 0.005f / way, 0.0f)), ring.axis)
                           : unit_or(unit_or(place - root, ring.axis) + above(ground, root).gradient, ring.axis);
    for (int i = 0; i < kPieces && begins > 0.0f; ++i)
        path.push_back(on_ground(begins * float(i) / kPieces));
    const float pull = 1.1f * glm::distance(start, place);
    for (int i = 0; i <= kPieces; ++i) // Hermite
    {
        const float t = float(i) / kPieces, t2 = t * t, t3 = t2 * t;
        path.push_back((2.0f * t3 - 3.0f * t2 + 1.0f) * start + (t3 - 2.0f * t2 + t) * pull * along +
                       (3.0f * t2 - 2.0f * t3) * place + (t3 - t2) * pull * ring.axis);
    }
    // Smooth and outside: what the curve cuts off the head is laid around it.
    for (int round = 0; round < 8; ++round)
    {
        for (size_t i = 1; i + 1 < path.size(); ++i)
        {
            const float from_root = float(i) * way / float(path.size());
            path[i] = lifted(ground, path[i], std::min(kClearance, 0.2f * from_root));
        }
        for (size_t i = 2; i + 2 < path.size(); ++i)
            path[i] = 0.5f * path[i] + 0.25f * (path[i - 1] + path[i + 1]);
    }
    return path;
}

namespace
{
struct HeldStrand
{
    std::vector<vec3> nodes; // from node 1 on, up to the first that is out of the ring
    float ring;              // where the ring is, in nodes
};
} // namespace

// Nodes `segment` apart (m, as the crow flies, as segments are) along a path and then along the axis, to the first that
// has left the ring.
static HeldStrand walked(const std::vector<vec3>& path, vec3 axis, float segment)
{
    HeldStrand strand;
    strand.nodes.push_back(path.front());
    size_t piece = 0;
    vec3 at = path.front();
    while (true)
    {
        // The first place ahead that far from the last node.
        size_t i = piece + 1;
        while (i < path.size() && glm::distance(path[i], strand.nodes.back()) < segment)
            ++i;
        if (i == path.size())
            break;
        const vec3 a = i == piece + 1 ? at : path[i - 1], d = path[i] - a, from = a - strand.nodes.back();
        const float aa = std::max(glm::dot(d, d), 1e-12f), b = glm::dot(d, from),
                    c = glm::dot(from, from) - segment * segment;
        at = a + d * std::clamp((-b + std::sqrt(std::max(b * b - aa * c, 0.0f))) / aa, 0.0f, 1.0f);
        strand.nodes.push_back(at);
        piece = i - 1;
    }
    const vec3 from = path.back() - strand.nodes.back();
    const float b = glm::dot(axis, from), c = glm::dot(from, from) - segment * segment;
    const float beyond = -b + std::sqrt(std::max(b * b - c, 0.0f)); // of the ring
    strand.ring = float(strand.nodes.size()) + glm::length(from) / std::max(glm::length(from) + beyond, 1e-6f);
    strand.nodes.push_back(path.back() + axis * beyond);
    return strand;
}

// ---- guides

static vec3 root_of(const Groom& groom, int guide) { return vec3(vector_at(groom.root_position.data(), guide, 0, 1)); }

// The rest of a strand behind the ring: as it was grown, turned so that it leaves the ring the way it left the root.
static void lay(Groom& groom, int guide, const HeldStrand& held, vec3 leaves, float segment)
{
    const vec3 grown = vec3(vector_at(groom.root_direction.data(), guide, 0, 1));
    const glm::quat turn = turning(grown, leaves);
    std::vector<vec3> nodes = held.nodes;
    const int first = int(nodes.size()); // of the nodes still to be laid, counted from node 1
    for (int k = first + 1; k < groom.nodes; ++k)
    {
        const vec3 a = vec3(vector_at(groom.natural_position.data(), guide, k, groom.nodes) -
                            vector_at(groom.natural_position.data(), guide, k - 1, groom.nodes));
        nodes.push_back(nodes.back() + turn * unit_or(a, grown) * segment);
    }
    const vec3 direction = unit_or(nodes[1] - nodes[0], grown);
    put_vector(groom.root_direction, guide, 0, 1, direction);
    put_vector(groom.natural_position, guide, 0, groom.nodes, nodes[0] - direction * segment);
    for (int k = 1; k < groom.nodes; ++k)
        put_vector(groom.natural_position, guide, k, groom.nodes, nodes[size_t(k - 1)]);
    groom.held[size_t(guide)] = first + 1;
}

// Straight strands said as a shape.
static void say_natural(Groom& groom)
{
    groom.natural_position.resize(size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3);
    for (int s = 0; s < groom.blocks * LANES; ++s)
        for (int k = 0; k < groom.nodes; ++k)
            put_vector(groom.natural_position, s, k, groom.nodes,
                       root_of(groom, s) + vec3(vector_at(groom.root_direction.data(), s, 0, 1)) *
                                               (float(k - 1) * groom.segment_length[size_t(s)]));
}

namespace
{
struct TiedGuide
{
    int tie = -1;
    float ring = 0.0f;     // in nodes
    glm::vec2 place{0.0f}; // in the ring, in its radii
};
} // namespace

// Gathers the guides of one tie; those too short keep -1.
static void gather(Groom& groom, const Tie& tie, int number, const Ring& ring, const std::vector<int>& guides,
                   const TieGround& ground, float spacing, std::vector<TiedGuide>& tied)
{
    // Hair from further away comes to lie further out in the ring, and higher above the head: so no two strands meet.
    std::vector<std::pair<float, int>> by_angle;
    for (const int g : guides)
        by_angle.emplace_back(angle_from(ring, groom, root_of(groom, g)), g);
    std::sort(by_angle.begin(), by_angle.end());
    const float farthest = std::max(by_angle.back().first, 1e-3f);
    for (size_t i = 0; i < by_angle.size(); ++i)
    {
        const auto [angle, g] = by_angle[i];
        const vec3 root = root_of(groom, g);
        const float out = std::sqrt((float(i) + 0.5f) / float(by_angle.size()));
        const glm::vec2 place = out * azimuth(ring, groom, root);
        const vec3 spot = (place.x * ring.side + place.y * ring.up);
        const float segment = groom.segment_length[size_t(g)] * spacing;
        const HeldStrand held = walked(path_of(ring, groom, ground, root, ring.center + spot * (0.9f * ring.radius),
                                               tie.puff * angle / farthest + kClearance),
                                       ring.axis, segment);
        if (held.ring + kLeastTail > float(groom.nodes - 1))
        {
            ++groom.short_of_ring[size_t(number)];
            continue;
        }
        const float flare = tie.flare * std::numbers::pi_v<float> / 180.0f;
        lay(groom, g, held, glm::normalize(ring.axis + std::tan(flare) * spot), segment);
        tied[size_t(g)] = {number, held.ring, place};
    }
}

// ---- tails

// A tail follows the guide that hangs furthest out of the ring, which is one from its middle.
static Tail tail_of(const Tie& tie, const Ring& ring, const Groom& groom, const std::vector<TiedGuide>& tied,
                    int number, float spacing)
{
    Tail tail = {};
    float longest = 0.0f;
    for (int g = 0; g < groom.guides; ++g)
    {
        if (tied[size_t(g)].tie != number)
            continue;
        const float segment = groom.segment_length[size_t(g)] * spacing;
        const float length = (float(groom.nodes - 1) - tied[size_t(g)].ring) * segment;
        if (length > longest)
        {
            longest = length;
            tail.guide = g;
            tail.ring = tied[size_t(g)].ring;
        }
    }
    tail.axis = F4(ring.axis.x, ring.axis.y, ring.axis.z, 0.0f);
    tail.side = F4(ring.side.x, ring.side.y, ring.side.z, 0.0f);
    tail.length = longest;
    tail.radius = 0.9f * ring.radius;
    tail.fullest = tie.fullness * ring.radius;
    tail.together = tie.cohesion;
    if (!tie.braid)
        return tail;
    // Half the width is a swing and a radius; the depth keeps plaits apart where they cross.
    const float half = 0.5f * tie.braid_width;
    tail.plait = 0.52f * half;
    tail.axis.w = tie.braid_pitch;
    tail.side.w = half - tail.plait;
    tail.depth = 0.7f * tail.plait;
    tail.bound = std::max(longest - std::clamp(0.2f * longest, 0.02f, 0.06f), 0.5f * longest);
    return tail;
}

// Which plait a place in the ring belongs to, and where in it.
static float4 place_in_plait(glm::vec2 place)
{
    // Thirds of a disc by area, across: |x| < 0.2649.
    const float third = 0.2649f, x = place.x, y = place.y;
    const int plait = x < -third ? 2 : x > third ? 1 : 0;
    const float middle = plait == 0 ? 0.0f : plait == 1 ? 0.633f : -0.633f;
    glm::vec2 in((x - middle) / (plait == 0 ? 0.2649f : 0.3675f), y / (plait == 0 ? 0.98f : 0.8f));
    const float size = std::max(std::abs(in.x), std::abs(in.y)), round = glm::length(in);
    if (round > 1e-6f) // the square to a disc
        in *= std::min(size, 1.0f) / round;
    const float third_turn = 2.0f * std::numbers::pi_v<float> / 3.0f;
    return F4(in.x, in.y, third_turn * float(plait), 0.0f);
}

// ---- drawn strands

// Drops the guides that do not go the strand's way. Returns whether any of them does.
static bool mix_within(DrawnStrand& strand, const std::vector<TiedGuide>& tied, int wanted)
{
    int guides[3] = {strand.guide0, strand.guide1, strand.guide2};
    float weights[3] = {strand.weights.x, strand.weights.y, strand.weights.z};
    float sum = 0.0f;
    int any = -1;
    for (int i = 0; i < 3; ++i)
    {
        const bool goes = tied[size_t(guides[i])].tie == wanted;
        any = goes ? i : any;
        weights[i] = goes ? weights[i] : 0.0f;
        sum += weights[i];
    }
    if (any < 0)
        return false;
    if (!(sum > 0.0f))
        sum = weights[any] = 1.0f;
    int order[3] = {0, 1, 2};
    std::stable_sort(order, order + 3, [&](int i, int j) { return weights[i] > weights[j]; });
    for (const int i : {1, 2}) // a guide without weight is the heaviest: its nodes must not come into it
        if (weights[order[i]] == 0.0f)
            guides[order[i]] = guides[order[0]];
    strand.guide0 = guides[order[0]];
    strand.guide1 = guides[order[1]];
    strand.guide2 = guides[order[2]];
    strand.weights = F4(weights[order[0]] / sum, weights[order[1]] / sum, weights[order[2]] / sum, strand.weights.w);
    return true;
}

// A copy of a tied guide would miss the ring: a mix of the guides about it instead, at a root nearby.
static DrawnStrand mixed_copy(const DrawnStrand& copy, const Scalp& scalp, const std::vector<unsigned>& triangles,
                              const std::vector<vec3>& directions, const HairParams& params, int index)
{
    const float chance = random01(params.interpolation_seed, index, 101);
    const glm::uvec3 t =
        scalp.triangles[triangles[std::min(size_t(chance * float(triangles.size())), triangles.size() - 1)]];
    const vec3 weights = shares_over_triangle(random01(params.interpolation_seed, index, 102),
                                              random01(params.interpolation_seed, index, 103));
    const vec3 root =
        (scalp.positions[t.x] * weights.x + scalp.positions[t.y] * weights.y + scalp.positions[t.z] * weights.z) *
        params.head_scale;
    DrawnStrand mixed = mixed_of(directions, t, weights);
    mixed.root = F4(root.x, root.y, root.z, copy.root.w);
    mixed.weights.w = copy.weights.w;
    mixed.seed = copy.seed;
    mixed.leader = copy.leader;
    return mixed;
}

static void tie_drawn(Groom& groom, const HairParams& params, const Scalp& scalp, const TieRoots& roots,
                      const std::vector<TiedGuide>& tied)
{
    std::vector<vec3> directions;
    for (int g = 0; g < groom.guides; ++g)
        directions.push_back(vec3(vector_at(groom.root_direction.data(), g, 0, 1)));
    std::vector<std::vector<unsigned>> triangles(scalp.positions.size());
    for (unsigned i = 0; i < scalp.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            triangles[scalp.triangles[i][k]].push_back(i);

    std::vector<DrawnStrand> mixed, copies;
    std::vector<StrandLook> mixed_looks, copied_looks;
    std::vector<int> mixed_from, copied_from; // their numbers before
    for (size_t i = 0; i < groom.drawn.size(); ++i)
    {
        DrawnStrand strand = groom.drawn[i];
        const bool copy = int(i) >= groom.drawn_multi;
        const int own = tied[size_t(strand.guide0)].tie;
        const bool all = params.interpolation_guides == GUIDES_ALL; // its own guide is all that it is made of
        if (copy && (own < 0 || (!all && triangles[size_t(strand.guide0)].empty())))
        {
            copies.push_back(strand);
            copied_from.push_back(int(i));
            if (!groom.looks.empty())
                copied_looks.push_back(groom.looks[i]);
            continue;
        }
        if (copy && all)
            strand.weights = F4(1.0f, 0.0f, 0.0f, strand.weights.w);
        else if (copy)
            strand = mixed_copy(strand, scalp, triangles[size_t(strand.guide0)], directions, params, int(i));
        const bool known = !roots.drawn.empty() && !copy;
        if (!known || !mix_within(strand, tied, roots.drawn[i]))
            mix_within(strand, tied, tied[size_t(strand.guide0)].tie);
        mixed.push_back(strand);
        mixed_from.push_back(int(i));
        if (!groom.looks.empty())
            mixed_looks.push_back(groom.looks[i]);
    }
    groom.looks = std::move(mixed_looks);
    groom.looks.insert(groom.looks.end(), copied_looks.begin(), copied_looks.end());
    groom.drawn_multi = int(mixed.size());
    groom.tied.clear();
    for (DrawnStrand& strand : mixed)
    {
        const TiedGuide* of[3] = {&tied[size_t(strand.guide0)], &tied[size_t(strand.guide1)],
                                  &tied[size_t(strand.guide2)]};
        TiedStrand held = {};
        if (of[0]->tie >= 0)
        {
            const float w[3] = {strand.weights.x, strand.weights.y, strand.weights.z};
            glm::vec2 place(0.0f);
            for (int i = 0; i < 3; ++i)
            {
                held.ring += w[i] * of[i]->ring;
                place += w[i] * of[i]->place;
            }
            held.tail = of[0]->tie;
            held.place =
                groom.tails[size_t(held.tail)].axis.w > 0.0f ? place_in_plait(place) : F4(place.x, place.y, 0.0f, 0.0f);
            // Only what hangs out of the ring is cut.
            const float links = float(groom.nodes - 2), tail = 1.0f - (held.ring - 1.0f) / links;
            strand.root.w = 1.0f - (1.0f - strand.root.w) * tail;
        }
        groom.tied.push_back(held);
    }
    groom.drawn = std::move(mixed);
    groom.drawn.insert(groom.drawn.end(), copies.begin(), copies.end());
    // Leaders of clumps have new numbers, and lead the strands of their own tie only.
    std::vector<int> number(groom.drawn.size());
    mixed_from.insert(mixed_from.end(), copied_from.begin(), copied_from.end());
    for (size_t i = 0; i < number.size(); ++i)
        number[size_t(mixed_from[i])] = int(i);
    const auto tail = [&](int i)
    { return i < groom.drawn_multi && groom.tied[size_t(i)].ring > 0.0f ? groom.tied[size_t(i)].tail : -1; };
    for (size_t i = 0; i < groom.drawn.size(); ++i)
    {
        const int leader = number[size_t(groom.drawn[i].leader)];
        groom.drawn[i].leader = tail(leader) == tail(int(i)) ? leader : int(i);
    }
}

// ---- all of it

TieRoots tie_roots(const Groom& groom, const Shaping& shaping)
{
    const HostParams& host = shaping.host;
    const std::vector<Tie>& ties = host.ties;
    const auto nearest = [&](vec3 root, auto&& takes)
    {
        int found = -1;
        float least = INFINITY;
        for (size_t i = 0; i < ties.size(); ++i)
            if (const float d = glm::distance(root, ties[i].at * shaping.params.head_scale); d < least && takes(i))
            {
                least = d;
                found = int(i);
            }
        return found;
    };
    const auto gathers = [&](size_t tie, const ScalpPlace& place)
    {
        bool in = ties[tie].regions.empty();
        for (const std::string& name : ties[tie].regions)
            for (size_t r = 0; r < host.regions.size(); ++r)
                in |= host.regions[r].name == name && region_weight(shaping, r, place) > 0.5f;
        return in;
    };
    TieRoots roots;
    for (int g = 0; g < groom.guides; ++g)
    {
        const ScalpPlace place = at_vertex(shaping.scalp, size_t(g));
        roots.guides.push_back(nearest(root_of(groom, g), [&](size_t tie) { return gathers(tie, place); }));
    }
    for (const DrawnStrand& strand : groom.drawn)
    {
        const int of[3] = {roots.guides[size_t(strand.guide0)], roots.guides[size_t(strand.guide1)],
                           roots.guides[size_t(strand.guide2)]};
        const int own = nearest(vec3(strand.root.x, strand.root.y, strand.root.z),
                                [&](size_t tie) { return std::find(of, of + 3, int(tie)) != of + 3; });
        roots.drawn.push_back(of[0] < 0 ? -1 : own); // beside loose hair the nearest guide has the say
    }
    return roots;
}

void check_tie(const Groom& groom, const Shaping& shaping, size_t tie, const TieRoots& roots, const TieGround& ground)
{
    const Tie& own = shaping.host.ties[tie];
    ring_of(own, groom, shaping.params, ground);
    if (std::find(roots.guides.begin(), roots.guides.end(), int(tie)) == roots.guides.end())
        throw fail("tie '{}' gathers no hair: no root belongs to it", shown(own.name));
}

void tie_hair(Groom& groom, const Shaping& shaping, const TieRoots& roots, const TieGround& ground)
{
    const HairParams& params = shaping.params;
    const std::vector<Tie>& ties = shaping.host.ties;
    if (ties.empty())
        return;
    if (groom.natural_position.empty())
        say_natural(groom);
    groom.held.assign(size_t(groom.blocks) * LANES, 2);
    groom.short_of_ring.assign(ties.size(), 0);
    groom.tails.clear();
    std::vector<TiedGuide> tied(size_t(groom.guides));
    for (size_t i = 0; i < ties.size(); ++i)
    {
        const Ring ring = ring_of(ties[i], groom, params, ground);
        std::vector<int> guides;
        for (int g = 0; g < groom.guides; ++g)
            if (roots.guides[size_t(g)] == int(i))
                guides.push_back(g);
        gather(groom, ties[i], int(i), ring, guides, ground, params.strand_spacing, tied);
        groom.tails.push_back(tail_of(ties[i], ring, groom, tied, int(i), params.strand_spacing));
    }
    // What fills the last block copies the first guide, in all.
    for (int s = groom.guides; s < groom.blocks * LANES; ++s)
    {
        groom.held[size_t(s)] = groom.held[0];
        put_vector(groom.root_direction, s, 0, 1, vec3(vector_at(groom.root_direction.data(), 0, 0, 1)));
        for (int k = 0; k < groom.nodes; ++k)
            put_vector(groom.natural_position, s, k, groom.nodes,
                       vec3(vector_at(groom.natural_position.data(), 0, k, groom.nodes)));
    }
    tie_drawn(groom, params, shaping.scalp, roots, tied);
    if (!groom.rest_position.empty()) // as it was once frozen: what is held goes where the rings are now
    {
        const std::vector<float> multiplier = groom.rest_multiplier;
        keep_rest(groom, Groom(groom));
        groom.rest_multiplier = multiplier;
    }
}

void keep_rest(Groom& groom, const Groom& old)
{
    groom.rest_multiplier = old.rest_multiplier;
    groom.rest_position = old.rest_position;
    if (groom.held.empty() != old.held.empty())
    {
        groom.rest_multiplier.clear();
        groom.rest_position.clear();
    }
    if (groom.rest_position.empty() || groom.held.empty())
        return;
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        const int held = held_nodes(groom, s);
        const std::vector<float>& shape = groom.natural_position;
        for (int k = 0; k < held && held > 2; ++k)
            put_vector(groom.rest_position, s, k, groom.nodes, vec3(vector_at(shape.data(), s, k, groom.nodes)));
        for (int k = held; k < groom.nodes && held > 2; ++k)
        {
            const glm::dvec3 a = vector_at(old.rest_position.data(), s, k, groom.nodes) -
                                 vector_at(old.rest_position.data(), s, k - 1, groom.nodes);
            put_vector(groom.rest_position, s, k, groom.nodes,
                       vec3(vector_at(groom.rest_position.data(), s, k - 1, groom.nodes) + a));
        }
    }
    if (groom.held != old.held)
        groom.rest_multiplier.clear();
}

std::vector<float4> braid_values(const Groom& groom)
{
    const bool any = std::any_of(groom.tails.begin(), groom.tails.end(), [](auto& t) { return t.axis.w > 0.0f; });
    std::vector<float4> values;
    for (size_t i = 0; any && i < groom.tied.size(); ++i)
    {
        const TiedStrand& strand = groom.tied[i];
        if (strand.ring == 0.0f || groom.tails[size_t(strand.tail)].axis.w == 0.0f)
        {
            values.insert(values.end(), 3, F4(0.0f, 0.0f, 0.0f, 0.0f)); // no pitch: no braid
            continue;
        }
        const Tail& braid = groom.tails[size_t(strand.tail)];
        const float per_node = braid.length / (float(groom.nodes - 1) - strand.ring);
        const float4 place = strand.place;
        values.push_back(F4(place.x, place.y, place.z, (1.0f - strand.ring) * per_node));
        values.push_back(
            F4(float(groom.nodes - 2) * groom.drawn[i].root.w * per_node, braid.axis.w, braid.side.w, braid.depth));
        values.push_back(F4(braid.plait, braid.bound, 0.0f, 0.0f));
    }
    return values;
}

} // namespace coif

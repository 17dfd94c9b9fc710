#include "sim/groom.h"

#include "sim/clumps.h"
#include "sim/drawn_strands.h"
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

namespace coif
{

// What a random number is for; each purpose draws from its own stream.
enum
{
    kLift,
    kSweep,
    kCurlPhase = 100, // from 2 on: spread_places() and sim/drawn_strands.cpp
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

float random_sign(int seed, int index, int channel) { return 2.0f * random01(seed, index, channel) - 1.0f; }

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
    StrandGround ground{shaping, varies(host), {}, {}, {}, {}};
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

    grow_drawn(groom, ground);
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

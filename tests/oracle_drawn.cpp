// The twins of the passes that light and make drawn strands.
#include "tests/oracle.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace coif::oracle
{

static Vec to_world(const StepInfo& info, Vec v)
{
    return {glm::dot(xyz(info.head_row0), v), glm::dot(xyz(info.head_row1), v), glm::dot(xyz(info.head_row2), v)};
}
static Vec to_head(const StepInfo& info, Vec v)
{
    return xyz(info.head_row0) * v.x + xyz(info.head_row1) * v.y + xyz(info.head_row2) * v.z;
}

// ---- light: Bertails et al. 2005 ---------------------------------------------------------------------------------

std::vector<double> depth_in_bodies(const std::vector<Capsule>& colliders, int resolution, const StepInfo& info)
{
    std::vector<double> depth;
    const double voxel = info.grid_corner.w;
    for (int z = 0; z < resolution; ++z)
        for (int y = 0; y < resolution; ++y)
            for (int x = 0; x < resolution; ++x)
            {
                const Vec center = xyz(info.grid_corner) + voxel * (Vec(x, y, z) + 0.5);
                double deepest = -1e9;
                for (const Capsule& c : colliders)
                    deepest = std::max(deepest,
                                       (c.center.w - glm::distance(center, nearest_on_axis(c, center))) / voxel - 0.7);
                depth.push_back(deepest);
            }
    return depth;
}

std::vector<double> depth_in_head(const Body& body, int resolution, const StepInfo& info)
{
    std::vector<double> depth;
    const double voxel = info.grid_corner.w;
    for (int z = 0; z < resolution; ++z)
        for (int y = 0; y < resolution; ++y)
            for (int x = 0; x < resolution; ++x)
                depth.push_back(
                    -plane_at(body, xyz(info.grid_corner) + voxel * (Vec(x, y, z) + 0.5), info).distance / voxel - 0.7);
    return depth;
}

// A slice's axes: the two others in the order x, y, z.
static void slice_axes(int axis, int& u, int& v)
{
    u = axis == 0 ? 1 : 0;
    v = axis == 2 ? 1 : 2;
}

std::vector<double> transmittance(const std::vector<int>& occupied, int resolution, const StepInfo& info)
{
    const int r = resolution;
    int u_axis, v_axis;
    slice_axes(info.sweep_axis, u_axis, v_axis);
    const auto density = [&](int slice, int u, int v) -> double
    {
        if (u < 0 || u >= r || v < 0 || v >= r)
            return 0.0;
        int at[3];
        at[info.sweep_axis] = slice;
        at[u_axis] = u;
        at[v_axis] = v;
        return occupied[size_t(at[0]) + size_t(r) * (size_t(at[1]) + size_t(r) * size_t(at[2]))];
    };
    std::vector<double> depth(size_t(r) * size_t(r) * size_t(r));
    for (int j = 0; j < r; ++j)
        for (int i = 0; i < r; ++i)
        {
            double tau = 0.0, before = 0.0;
            int round_u = 0, round_v = 0; // how often the ray has come around
            for (int passed = 0; passed < r; ++passed)
            {
                // The slant's product is rounded as a float's: where a ray just reaches the border (slants of 3/5 after
                // five slices), rounding decides in which round it is.
                const double u = i + double(info.sweep.x * float(passed)), v = j + double(info.sweep.y * float(passed));
                const int now_u = int(std::floor(std::floor(u) / r)), now_v = int(std::floor(std::floor(v) / r));
                if (now_u != round_u || now_v != round_v)
                    tau = before = 0.0;
                round_u = now_u;
                round_v = now_v;
                const double in_u = u - now_u * r, in_v = v - now_v * r;
                const int u0 = int(std::floor(in_u)), v0 = int(std::floor(in_v));
                const int slice = info.sweep_from + info.sweep_sign * passed;
                double here = 0.0;
                for (int b = 0; b <= 1; ++b)
                    for (int a = 0; a <= 1; ++a)
                        here += density(slice, u0 + a, v0 + b) * (1.0 - std::abs(in_u - (u0 + a))) *
                                (1.0 - std::abs(in_v - (v0 + b)));
                tau += 0.5 * (before + here) * info.sweep.z * info.sweep.w;
                before = here;
                depth[(size_t(passed) * size_t(r) + size_t(j)) * size_t(r) + size_t(i)] = tau;
            }
        }
    return depth;
}

double light_depth(const std::vector<float>& depth, Vec point, int resolution, const HairParams& params,
                   const StepInfo& info)
{
    const int r = resolution;
    const Vec g =
        (point - xyz(info.grid_corner)) / double(info.grid_corner.w) - 0.5 + 0.5 * xyz(params.look_light_direction);
    for (int axis = 0; axis < 3; ++axis)
        if (!(g[axis] >= 0.0 && g[axis] < r - 1))
            return 0.0;
    int u_axis, v_axis;
    slice_axes(info.sweep_axis, u_axis, v_axis);
    const double passed = std::abs(g[info.sweep_axis] - info.sweep_from);
    const int below = std::min(int(passed), r - 2);
    double tau = 0.0;
    for (int s = below; s <= below + 1; ++s)
    {
        const double ru = g[u_axis] - double(info.sweep.x) * s, rv = g[v_axis] - double(info.sweep.y) * s;
        const int u0 = int(std::floor(ru)), v0 = int(std::floor(rv));
        for (int b = 0; b <= 1; ++b)
            for (int a = 0; a <= 1; ++a)
            {
                const int u = ((u0 + a) % r + r) % r, v = ((v0 + b) % r + r) % r;
                tau += depth[(size_t(s) * size_t(r) + size_t(v)) * size_t(r) + size_t(u)] *
                       (1.0 - std::abs(ru - (u0 + a))) * (1.0 - std::abs(rv - (v0 + b))) * (1.0 - std::abs(passed - s));
            }
    }
    return tau;
}

// ---- drawn strands: thesis 5.1.4 -----------------------------------------------------------------------------------

double room_at(int node, int nodes, const DrawnStrand& strand, const HairParams& params, const StepInfo& info)
{
    const double along = (node - 1.0) / (nodes - 2.0);
    const double layer = params.interpolation_layer * strand_random(strand.seed, 4) * std::min(1.0, 4.0 * along);
    const double n = params.wave_normal_amplitude * wave_onset(along, params.wave_normal_begin);
    const double b = params.wave_binormal_amplitude * wave_onset(along, params.wave_binormal_begin);
    const double curl = params.curl_radius * wave_onset(along, params.curl_begin);
    const double frizz = params.frizz_amount * (2.0 * along - along * along);
    return info.clearance + layer + oracle::profile_at(params.wave_along, along) * (std::hypot(n, b) + curl + frizz);
}

// Along the mean of the ways out of the spheres that hold it, weighed by squared depth, until no sphere holds it.
Vec out_of_union(Vec p, const std::vector<Capsule>& colliders, double room)
{
    double weights = 0.0;
    Vec way(0.0);
    for (const Capsule& collider : colliders)
    {
        const Vec out = p - nearest_on_axis(collider, p);
        const double radius = collider.center.w + room, distance = glm::length(out);
        if (distance >= radius)
            continue;
        const double weight = (radius - distance) * (radius - distance);
        way += weight * (distance > 1e-6 * radius ? out / distance : Vec(0, 1, 0));
        weights += weight;
    }
    if (weights == 0.0)
        return p;
    const Vec direction = glm::length(way) > 1e-4 * weights ? glm::normalize(way) : Vec(0, 1, 0);
    double t = 0.0;
    for (bool moved = true; moved;)
    {
        moved = false;
        for (const Capsule& collider : colliders)
        {
            const Vec at = p + t * direction, out = at - nearest_on_axis(collider, at);
            const double radius = collider.center.w + room;
            if (glm::length(out) > radius - 1e-9) // on the surface is outside
                continue;
            const double b = glm::dot(out, direction);
            t += -b + std::sqrt(b * b + radius * radius - glm::dot(out, out));
            moved = true;
        }
    }
    return p + t * direction;
}

static Vec way_out(const Body& body, Vec p, const StepInfo& info)
{
    Vec out(0.0);
    for (const auto& corner : body_corners(p, info, 2).at)
        out += corner.weight * Vec(body.way[corner.sample]);
    return glm::normalize(to_world(info, out));
}

// The way that the grid says, trilinear, as far as the surface there says; what that does not bring out goes along the
// normal.
Vec out_of_body(Vec p, const Body& body, double room, const StepInfo& info)
{
    const double voxel = info.body_corner.w;
    Vec way(0.0);
    for (int taken = 0; taken < 5; ++taken)
    {
        const Plane plane = plane_at(body, p, info);
        const double within = room - plane.distance;
        if (within <= 0.01 * voxel)
            break;
        if (taken == 0)
            way = way_out(body, p, info);
        if (taken >= 3)
            way = plane.normal;
        p += way * (within / std::max(0.5, glm::dot(way, plane.normal)));
        if (within <= 0.25 * voxel)
            break;
    }
    return p;
}

static Vec out_of_all(Vec p, const std::vector<Capsule>& colliders, const Body& body, double room, const StepInfo& info)
{
    if (body.distance.empty())
        return out_of_union(p, colliders, room);
    const Vec there = out_of_body(p, body, room, info);
    Vec out = out_of_union(there, colliders, room);
    if (out == there)
        return out;
    const Vec way = glm::normalize(way_out(body, out, info) + glm::normalize(out - there));
    for (int taken = 0; taken < 8; ++taken)
    {
        const Plane plane = plane_at(body, out, info);
        const double within = room - plane.distance;
        if (within <= 0.01 * info.body_corner.w)
            return out;
        double go = within / std::max(0.5, glm::dot(way, plane.normal));
        for (const Capsule& collider : colliders)
        {
            // Out of the sphere that the collider is to the point.
            const Vec from = out - nearest_on_axis(collider, out + go * way);
            const double radius = collider.center.w + room;
            if (glm::length(from + go * way) < radius)
                go = -glm::dot(from, way) +
                     std::sqrt(std::pow(glm::dot(from, way), 2.0) + radius * radius - glm::dot(from, from));
        }
        out += go * way;
    }
    return out_of_body(out, body, room, info);
}

static bool flies_away(const DrawnStrand& strand, int number, const HairParams& params)
{
    const bool leads = params.clump_strength > 0.0f && strand.leader == number;
    return params.flyaway_distance > 0.0f && strand_random(strand.seed, 12) < params.flyaway_share && !leads;
}

// Off its way by a smooth step from where it leaves it on, no faster than over half as long a way; segments keep their
// lengths, one after the other.
static std::vector<Vec> flown_away(const std::vector<Vec>& node, const DrawnStrand& strand, const HairParams& params,
                                   const StepInfo& info)
{
    const int n = int(node.size());
    const auto random = [&](int of) { return strand_random(strand.seed, 12 + of); };
    const double begin = random(2) / 2.0, over = 0.2 + 0.6 * random(3);
    const Vec own = to_world(info, 2.0 * Vec(random(4), random(5), random(6)) - 1.0);
    double length = 0.0;
    for (int k = 2; k < n; ++k)
        length += glm::distance(node[size_t(k)], node[size_t(k - 1)]);
    const double reach = std::min(params.flyaway_distance * (0.2 + 0.8 * random(1)), over * length / 2.0);
    std::vector<Vec> out = node;
    for (int k = 2; k < n; ++k)
    {
        const double along = (k - 1.0) / (n - 2.0), t = std::clamp((along - begin) / over, 0.0, 1.0);
        const Vec up = glm::normalize(node[size_t(k)] - to_world(info, xyz(info.head_center)));
        const double sway = 0.5 * std::sin(2.0 * std::numbers::pi * (random(3) + along));
        const Vec way = 0.7 * up + 0.5 * own + sway * glm::cross(up, own);
        const Vec to = node[size_t(k)] + reach * (3.0 * t * t - 2.0 * t * t * t) * way;
        out[size_t(k)] = out[size_t(k - 1)] +
                         glm::normalize(to - out[size_t(k - 1)]) * glm::distance(node[size_t(k)], node[size_t(k - 1)]);
    }
    return out;
}

static std::vector<Vec> finished(const std::vector<Vec>& node, const DrawnStrand& strand, int number,
                                 const HairParams& params, const std::vector<Capsule>& colliders, const StepInfo& info,
                                 const Body& body)
{
    const int n = int(node.size());
    std::vector<Vec> out = node;
    for (int k = 2; k < n; ++k)
    {
        const double at = 1.0 + (k - 1) * double(strand.root.w);
        const int i = std::min(int(at), n - 2);
        double w[4];
        curve_weights(3, at - i, w);
        const Vec cut = w[0] * node[size_t(i - 1)] + w[1] * node[size_t(i)] + w[2] * node[size_t(i + 1)] +
                        w[3] * node[size_t(std::min(i + 2, n - 1))];
        out[size_t(k)] = cut;
    }
    if (flies_away(strand, number, params))
        out = flown_away(out, strand, params, info);
    for (int k = 2; k < n; ++k)
        out[size_t(k)] = out_of_all(out[size_t(k)], colliders, body, room_at(k, n, strand, params, info), info);
    return out;
}

Clumped clump(const std::vector<Vec>& own, const std::vector<Vec>& leader, const DrawnStrand& strand, int number,
              double leaders_cut, const HairParams& params, const std::vector<Capsule>& colliders, const StepInfo& info,
              const Body& body)
{
    const int n = int(own.size());
    Clumped clumped = {own, std::vector<double>(size_t(n), 0.0)};
    if (strand.leader == number || flies_away(strand, number, params))
        return clumped;
    // Where the leader is as far from its root as node k of the strand is; straight on beyond its tip.
    const auto led = [&](int k)
    {
        const double ahead = strand.weights.w / glm::distance(leader[2], leader[1]);
        const double at = std::max(1.0, 1.0 + ahead + (k - 1.0) * strand.root.w / leaders_cut);
        if (at >= n - 1.0)
            return leader[size_t(n - 1)] + (at - (n - 1.0)) * (leader[size_t(n - 1)] - leader[size_t(n - 2)]);
        const int i = int(at);
        double w[4];
        curve_weights(3, at - i, w);
        return w[0] * leader[size_t(i - 1)] + w[1] * leader[size_t(i)] + w[2] * leader[size_t(i + 1)] +
               w[3] * leader[size_t(std::min(i + 2, n - 1))];
    };
    const auto apart = [&](int k) { return glm::distance(own[size_t(k)], led(k)); };
    const double parted = std::max(apart((n + 1) / 2), apart(n - 1)) - glm::distance(own[1], leader[1]);
    const double t = std::clamp((parted / double(info.parting) - 2.0) / 4.0, 0.0, 1.0);
    const double strength = params.clump_strength * (1.0 - params.clump_variation * strand_random(strand.seed, 11)) *
                            (1.0 - t * t * (3.0 - 2.0 * t));
    if (strength <= 0.0)
        return clumped;
    for (int k = 2; k < n; ++k)
    {
        clumped.share[size_t(k)] = strength * oracle::profile_at(params.clump_along, (k - 1.0) / (n - 2.0));
        const Vec to = glm::mix(own[size_t(k)], led(k), clumped.share[size_t(k)]) - clumped.node[size_t(k - 1)];
        const double rest = glm::distance(own[size_t(k)], own[size_t(k - 1)]);
        clumped.node[size_t(k)] =
            clumped.node[size_t(k - 1)] + glm::normalize(to) * std::clamp(glm::length(to), 0.8 * rest, rest);
    }
    for (int k = 2; k < n; ++k)
        clumped.node[size_t(k)] =
            out_of_all(clumped.node[size_t(k)], colliders, body, room_at(k, n, strand, params, info), info);
    return clumped;
}

std::vector<Vec> interpolate_multi(const Strands& guides, const DrawnStrand& strand, int number,
                                   const HairParams& params, const std::vector<Capsule>& colliders,
                                   const StepInfo& info, const Body& body)
{
    const int n = guides.nodes;
    const int of[3] = {strand.guide0, strand.guide1, strand.guide2};
    double weight[3] = {strand.weights.x, strand.weights.y, strand.weights.z};
    // A guide that parts from the heaviest one, which comes first, loses its weight to it.
    const auto apart = [&](int g, int k)
    { return glm::distance(guides.position[size_t(of[g] * n + k)], guides.position[size_t(of[0] * n + k)]); };
    for (int g = 1; g < 3; ++g)
    {
        const double parted = std::max(apart(g, (n + 1) / 2), apart(g, n - 1)) - apart(g, 1);
        const double t = std::clamp(parted / double(info.parting) - 1.0, 0.0, 1.0);
        weight[g] *= 1.0 - t * t * (3.0 - 2.0 * t);
    }
    const double sum = weight[0] + weight[1] + weight[2];
    for (double& w : weight)
        w /= sum;
    std::vector<Vec> node(size_t(n), to_world(info, xyz(strand.root)));
    for (int k = 0; k < n; ++k)
        for (int g = 0; g < 3; ++g)
            node[size_t(k)] +=
                weight[g] * (guides.position[size_t(of[g] * n + k)] - guides.position[size_t(of[g] * n + 1)]);
    return finished(node, strand, number, params, colliders, info, body);
}

std::vector<Vec> interpolate_single(const Strands& guides, const DrawnStrand& strand, int number,
                                    const HairParams& params, const std::vector<Capsule>& colliders,
                                    const StepInfo& info, const Body& body)
{
    const int n = guides.nodes;
    const glm::dquat turn =
        glm::angleAxis(double(strand.weights.x), Vec(0, 1, 0)) * glm::angleAxis(double(strand.weights.y), Vec(1, 0, 0));
    const Vec center = xyz(info.head_center);
    std::vector<Vec> node;
    for (int k = 0; k < n; ++k)
    {
        const Vec own = to_head(info, guides.position[size_t(strand.guide0 * n + k)]) - center;
        node.push_back(to_world(info, turn * own + center));
    }
    return finished(node, strand, number, params, colliders, info, body);
}

std::vector<FrameNode> transport_frames(const std::vector<Vec>& p, const StepInfo& info)
{
    const Vec outward = glm::normalize(p[1] - to_world(info, xyz(info.head_center)));
    Vec tangent = glm::normalize(p[1] - p[0]);
    Vec normal = outward - tangent * glm::dot(outward, tangent);
    if (glm::dot(normal, normal) <= 1e-4) // leaves along the normal: sideways, the same way for all strands
    {
        const Vec side = glm::cross(Vec(0, 1, 0), tangent);
        normal = side - tangent * glm::dot(side, tangent);
    }
    normal = glm::normalize(normal);
    std::vector<FrameNode> frames = {{normal, 0.0}};
    double length = 0.0;
    for (size_t k = 1; k < p.size(); ++k)
    {
        const Vec next = glm::normalize(p[k] - p[k - 1]), axis = glm::cross(tangent, next);
        const double sine = glm::length(axis), cosine = glm::dot(tangent, next);
        if (sine > 1e-12)
            normal = glm::angleAxis(std::atan2(sine, cosine), axis / sine) * normal;
        tangent = next;
        length += k > 1 ? glm::distance(p[k], p[k - 1]) : 0.0;
        frames.push_back({normal, length});
    }
    return frames;
}

// ---- curves and waves
// ------------------------------------------------------------------------------------------------

void curve_weights(int curve, double t, double weights[4])
{
    // Rows: the factors of 1, t, t^2, t^3 for each of the four nodes (Catmull and Rom 1974; Bourke 1999 for "cubic").
    static const double catmull_rom[4][4] = {
        {0, -0.5, 1, -0.5}, {1, 0, -2.5, 1.5}, {0, 0.5, 2, -1.5}, {0, 0, -0.5, 0.5}};
    static const double cubic[4][4] = {{0, -1, 2, -1}, {1, 0, -2, 1}, {0, 1, 1, -1}, {0, 0, -1, 1}};
    const double s = curve == 1 ? 0.5 * (1.0 - std::cos(std::numbers::pi * t)) : t;
    const double straight[4] = {0.0, 1.0 - s, s, 0.0};
    for (int i = 0; i < 4; ++i)
    {
        const double* c = curve == 2 ? cubic[i] : catmull_rom[i];
        weights[i] = curve < 2 ? straight[i] : c[0] + c[1] * t + c[2] * t * t + c[3] * t * t * t;
    }
}

double wave_onset(double along, double begin)
{
    const double t = std::clamp((along - begin) / 0.25, 0.0, 1.0);
    return 3.0 * t * t - 2.0 * t * t * t;
}

double strand_random(int seed, int purpose)
{
    // O'Neill 2014: a linear congruential state, and the RXS-M-XS output of 32 bits, of which 24 are used.
    const uint32_t state =
        uint32_t(uint64_t(uint32_t(seed)) * 747796405u + uint64_t(uint32_t(purpose)) * 2891336453u + 277803737u);
    const uint32_t word = (state ^ (state >> (4 + state / (1u << 28)))) * 277803737u;
    return double((word ^ (word >> 22)) >> 8) / 16777216.0;
}

double wave_place(int seed, double distance, double frequency, double randomness)
{
    const double shift = randomness * strand_random(seed, 2);
    const double table = randomness > 0.0 ? std::floor(32.0 * strand_random(seed, 3)) : 0.0;
    return (distance * frequency + shift + table) / 32.0;
}

double profile_at(const float4& profile, double along)
{
    const double of[4] = {profile.x, profile.y, profile.z, profile.w};
    const int piece = std::clamp(int(3.0 * along), 0, 2);
    const double t = 3.0 * along - piece;
    return of[piece] * (1.0 - t) + of[piece + 1] * t;
}

Across curl_at(int together, double begin, double distance, double pitch, double variation, int hand)
{
    const double less = variation * strand_random(together, 7);
    const bool left = hand == 2 ? strand_random(together, 8) < 0.5 : hand == 1;
    const double angle =
        2.0 * std::numbers::pi * (begin + (left ? -1.0 : 1.0) * distance / (pitch * (1.0 - less / 2.0)));
    return {(1.0 - less) * std::cos(angle), (1.0 - less) * std::sin(angle)};
}

Across frizz_at(int seed, double distance, double frequency)
{
    const double most = strand_random(seed, 9), place = distance * frequency + strand_random(seed, 10);
    const auto noise = [&](int side, double at)
    {
        const int cell = int(std::floor(at));
        const double t = at - cell, s = 3.0 * t * t - 2.0 * t * t * t;
        return 2.0 * ((1.0 - s) * strand_random(seed, 256 + 2 * cell + side) +
                      s * strand_random(seed, 258 + 2 * cell + side)) -
               1.0;
    };
    const double own = (0.2 + 0.8 * most * most) / std::sqrt(2.0);
    return {own * noise(0, place), own * noise(1, place + 0.5)};
}

} // namespace coif::oracle

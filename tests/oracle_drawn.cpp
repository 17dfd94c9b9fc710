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

Vec to_world(const StepInfo& info, Vec v)
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

double room_at(int node, int nodes, const DrawnStrand& strand, const HairParams& params, const StepInfo& info,
               const Besides& besides)
{
    const double along = (node - 1.0) / (nodes - 2.0);
    const double layer = params.interpolation_layer * strand_random(strand.seed, 4) * std::min(1.0, 4.0 * along);
    const StrandLook* own = besides.look;
    const double n = (own ? own->wave.x : params.wave_normal_amplitude) * wave_onset(along, params.wave_normal_begin);
    const double b =
        (own ? own->wave.z : params.wave_binormal_amplitude) * wave_onset(along, params.wave_binormal_begin);
    const double curl = (own ? own->own.y : params.curl_radius) * wave_onset(along, params.curl_begin);
    const double frizz = (own ? own->own.z : params.frizz_amount) * (2.0 * along - along * along);
    const double room =
        info.clearance + layer + oracle::profile_at(params.wave_along, along) * (std::hypot(n, b) + curl + frizz);
    if (!besides.tail || !(besides.tail->axis.w > 0.0f))
        return room;
    // Half as deep as plaits swing with their radii, pressed flat.
    const Tail& braid = *besides.tail;
    const double per_node = braid.length / (nodes - 1.0 - besides.tied->ring);
    const double behind = (1.0 + (node - 1.0) * strand.root.w - besides.tied->ring) * per_node;
    return glm::mix(room, info.clearance + braid.depth + 0.7 * braid.plait, braid_share(behind, braid.axis.w));
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
                                 const Body& body, const Besides& besides)
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
        out[size_t(k)] =
            out_of_all(out[size_t(k)], colliders, body, room_at(k, n, strand, params, info, besides), info);
    return out;
}

Clumped clump(const std::vector<Vec>& own, const std::vector<Vec>& leader, const DrawnStrand& strand, int number,
              double leaders_cut, const HairParams& params, const std::vector<Capsule>& colliders, const StepInfo& info,
              const Body& body, const StrandLook* look)
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
            out_of_all(clumped.node[size_t(k)], colliders, body, room_at(k, n, strand, params, info, {look}), info);
    return clumped;
}

std::vector<Vec> interpolate_multi(const Strands& guides, const DrawnStrand& strand, int number,
                                   const HairParams& params, const std::vector<Capsule>& colliders,
                                   const StepInfo& info, const Body& body, const Besides& besides)
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
    Vec shift = to_world(info, xyz(strand.root));
    for (int g = 0; g < 3; ++g)
        shift -= weight[g] * guides.position[size_t(of[g] * n + 1)];
    std::vector<Vec> node(size_t(n), shift);
    for (int k = 0; k < n; ++k)
        for (int g = 0; g < 3; ++g)
            node[size_t(k)] += weight[g] * guides.position[size_t(of[g] * n + k)];
    if (besides.tied)
        hang_in_tail(node, shift, guides, besides, info);
    return finished(node, strand, number, params, colliders, info, body, besides);
}

std::vector<Vec> interpolate_single(const Strands& guides, const DrawnStrand& strand, int number,
                                    const HairParams& params, const std::vector<Capsule>& colliders,
                                    const StepInfo& info, const Body& body, const Besides& besides)
{
    const int n = guides.nodes;
    const glm::dquat turn =
        glm::angleAxis(double(strand.weights.x), Vec(0, 1, 0)) * glm::angleAxis(double(strand.weights.y), Vec(1, 0, 0));
    const Vec root = to_head(info, guides.position[size_t(strand.guide0 * n + 1)]);
    std::vector<Vec> node;
    for (int k = 0; k < n; ++k) // about its root, which it has been given a place of its own for
    {
        const Vec own = to_head(info, guides.position[size_t(strand.guide0 * n + k)]) - root;
        node.push_back(to_world(info, turn * own + xyz(strand.root)));
    }
    return finished(node, strand, number, params, colliders, info, body, besides);
}

Vec carried_over(Vec v, Vec a, Vec b)
{
    const Vec axis = glm::cross(a, b);
    const double sine = glm::length(axis);
    return sine > 1e-12 ? glm::angleAxis(std::atan2(sine, glm::dot(a, b)), axis / sine) * v : v;
}

std::vector<FrameNode> transport_frames(const std::vector<Vec>& p, const StepInfo& info, const Besides& besides,
                                        double cut)
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
    // Where a braid's ring is on the strand as it is cut.
    const bool braided = besides.tail && besides.tail->axis.w > 0.0f;
    const double ring = braided ? 1.0 + (besides.tied->ring - 1.0) / cut : double(p.size());
    std::vector<FrameNode> frames = {{normal, 0.0, 2.0}};
    double length = 0.0, told = 2.0;
    for (size_t k = 1; k < p.size(); ++k)
    {
        const Vec next = glm::normalize(p[k] - p[k - 1]);
        if (double(k) > ring && double(k) - 1.0 <= ring)
        {
            normal = to_world(info, xyz(besides.tail->side));
            tangent = to_world(info, xyz(besides.tail->axis));
            told = 2.0;
        }
        told = std::min(told, 1.0 + glm::dot(tangent, next));
        normal = carried_over(normal, tangent, next);
        tangent = next;
        length += k > 1 ? glm::distance(p[k], p[k - 1]) : 0.0;
        frames.push_back({normal, length, told});
    }
    return frames;
}

} // namespace coif::oracle

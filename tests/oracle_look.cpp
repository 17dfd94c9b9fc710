#include "tests/oracle_look.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif::oracle
{

static constexpr double kPi = std::numbers::pi;

size_t voxels_of(const LookVolume& v) { return size_t(v.x) * size_t(v.y) * size_t(v.z); }

static size_t voxel_at(const LookVolume& v, int x, int y, int z)
{
    return size_t(x) + size_t(v.x) * (size_t(y) + size_t(v.y) * size_t(z));
}

Vec in_voxels(Vec p, const LookVolume& volume) { return (p - xyz(volume.corner)) / double(volume.corner.w) - 0.5; }

// Calls visit(voxel, weight) for those of the eight voxels about a point that there are.
template <typename Visit> static void about(const LookVolume& v, Vec at, Visit visit)
{
    const Vec below = glm::floor(at);
    for (int corner = 0; corner < 8; ++corner)
    {
        const Vec c = below + Vec(corner & 1, corner >> 1 & 1, corner >> 2);
        if (c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < v.x && c.y < v.y && c.z < v.z)
            visit(voxel_at(v, int(c.x), int(c.y), int(c.z)),
                  (1.0 - std::abs(at.x - c.x)) * (1.0 - std::abs(at.y - c.y)) * (1.0 - std::abs(at.z - c.z)));
    }
}

std::vector<Fibres> fibre_in_voxels(const std::vector<float4>& places, const LookVolume& volume)
{
    std::vector<Fibres> fibre(voxels_of(volume));
    for (int s = 0; s < volume.strands; ++s)
        for (int k = 0; k + 1 < volume.places; ++k)
        {
            const float4 &a = places[size_t(s * volume.places + k)], &b = places[size_t(s * volume.places + k + 1)];
            const Vec way = xyz(b) - xyz(a);
            const double length = glm::length(way);
            const int parts = std::max(int(length / double(volume.corner.w) + 0.5), 1);
            for (int i = 0; i < parts && length > 0.0; ++i)
            {
                const double on = (i + 0.5) / parts, area = length / parts * glm::mix(double(a.w), double(b.w), on);
                about(volume, in_voxels(xyz(a) + on * way, volume),
                      [&](size_t voxel, double weight)
                      {
                          for (int axis = 0; axis < 3; ++axis)
                              fibre[voxel][size_t(axis)] += weight * area * way[axis] / length;
                          fibre[voxel][3] += weight * area;
                      });
            }
        }
    return fibre;
}

std::vector<double> bodies_in_voxels(const std::vector<Capsule>& colliders, const Body& body, const LookVolume& volume,
                                     const StepInfo& info)
{
    constexpr double kDeep = 6.0; // optical depth of a voxel, of fibres that run any way
    std::vector<double> bodies;
    const double side = volume.corner.w;
    for (int z = 0; z < volume.z; ++z)
        for (int y = 0; y < volume.y; ++y)
            for (int x = 0; x < volume.x; ++x)
            {
                const Vec p = xyz(volume.corner) + side * (Vec(x, y, z) + 0.5);
                double under = 0.0; // m
                for (const Capsule& c : colliders)
                    under = std::max(under, c.center.w - glm::distance(p, nearest_on_axis(c, p)));
                if (!body.distance.empty())
                    under = std::max(under, -plane_at(body, p, info).distance);
                bodies.push_back(std::clamp(under / (2.0 * side) - 0.35, 0.0, 1.0) * kDeep / (0.25 * kPi * side));
            }
    return bodies;
}

double extinction(const Fibres& f, Vec direction, double self_shadow)
{
    const Vec way(f[0], f[1], f[2]);
    const double one_way = glm::length(way), any_way = std::max(0.0, f[3] - one_way);
    return self_shadow * (glm::length(glm::cross(way, direction)) + 0.25 * kPi * any_way);
}

std::vector<float> as_voxels_lie(const std::vector<float>& extinction, const LookVolume& volume,
                                 const std::vector<LookRay>& rays)
{
    std::vector<float> lies = extinction;
    const size_t all = voxels_of(volume), nx = size_t(volume.x), ny = size_t(volume.y), nz = size_t(volume.z);
    for (size_t ray = 0; ray < rays.size(); ++ray)
        for (size_t i = 0; i < all && rays[ray].axis == 0; ++i)
        {
            const size_t x = i % nx, y = i / nx % ny, z = i / (nx * ny);
            lies[ray * all + i] = extinction[ray * all + (x * nz + z) * ny + y];
        }
    return lies;
}

// The axes of a slice, and what a slice has.
struct Slice
{
    int u_axis, v_axis, u, v, count;
    Slice(const LookVolume& volume, const LookRay& ray) : u_axis(ray.axis == 0 ? 1 : 0), v_axis(ray.axis == 2 ? 1 : 2)
    {
        const int size[3] = {volume.x, volume.y, volume.z};
        u = size[u_axis];
        v = size[v_axis];
        count = size[ray.axis];
    }
};

// Calls `found` with each point of a ray in turn: where it is written, the depth there, that before it, and whether the
// ray starts afresh.
template <typename Found>
static void along_rays(const float* taken, const LookVolume& volume, const LookRay& ray, const Found& found)
{
    const Slice s(volume, ray);
    for (int j = 0; j < s.v; ++j)
        for (int i = 0; i < s.u; ++i)
        {
            double tau = 0.0, before = 0.0;
            int rounds_u = 0, rounds_v = 0; // how often the ray has come around
            for (int passed = 0; passed < s.count; ++passed)
            {
                // The slant's product is a float's, as in oracle::transmittance().
                const double u = i + double(ray.slant.x * float(passed)), v = j + double(ray.slant.y * float(passed));
                const int now_u = int(std::floor(std::floor(u) / s.u)), now_v = int(std::floor(std::floor(v) / s.v));
                const bool fresh = passed == 0 || now_u != rounds_u || now_v != rounds_v;
                if (fresh)
                    tau = before = 0.0;
                rounds_u = now_u;
                rounds_v = now_v;
                Vec at;
                at[ray.axis] = ray.from + ray.sign * passed;
                at[s.u_axis] = u - now_u * s.u;
                at[s.v_axis] = v - now_v * s.v;
                double here = 0.0;
                about(volume, at, [&](size_t voxel, double weight) { here += weight * double(taken[voxel]); });
                const double until = tau;
                tau += 0.5 * (before + here) * double(ray.slant.z);
                before = here;
                found((size_t(passed) * size_t(s.v) + size_t(j)) * size_t(s.u) + size_t(i), tau, until, fresh);
            }
        }
}

std::vector<double> sweep(const float* taken, const LookVolume& volume, const LookRay& ray)
{
    std::vector<double> depth(voxels_of(volume));
    along_rays(taken, volume, ray, [&](size_t at, double tau, double, bool) { depth[at] = tau; });
    return depth;
}

std::vector<double> front(const float* taken, const LookVolume& volume, const LookRay& ray)
{
    const double step = ray.slant.z;
    std::vector<double> behind(voxels_of(volume));
    double so_far = 0.0;
    along_rays(taken, volume, ray,
               [&](size_t at, double tau, double before, bool fresh)
               {
                   if (tau <= double(SEEN))
                       so_far = 0.0;
                   else if (fresh || before <= double(SEEN))
                       so_far = step * (tau - double(SEEN)) / (tau - before);
                   else
                       so_far += step;
                   behind[at] = so_far;
               });
    return behind;
}

// In one slice of a sweep: between the rays about a point, of which those that are on their way around count for
// nothing.
static double depth_in_slice(const float* depth, const Slice& s, const LookRay& ray, int slice, double u, double v)
{
    double sum = 0.0, whole = 0.0;
    const double ray_u = u - double(ray.slant.x * float(slice)), ray_v = v - double(ray.slant.y * float(slice));
    for (int b = 0; b <= 1; ++b)
        for (int a = 0; a <= 1; ++a)
        {
            const double iu = std::floor(ray_u) + a, iv = std::floor(ray_v) + b;
            const double is_u = u + iu - ray_u, is_v = v + iv - ray_v; // where that ray is
            const double weight = (1.0 - std::abs(ray_u - iu)) * (1.0 - std::abs(ray_v - iv));
            if (is_u < 0.0 || is_v < 0.0 || is_u > s.u - 1 || is_v > s.v - 1)
                continue;
            const size_t at_u = size_t(int(iu) - s.u * int(std::floor(iu / s.u)));
            const size_t at_v = size_t(int(iv) - s.v * int(std::floor(iv / s.v)));
            sum += weight * double(depth[(size_t(slice) * size_t(s.v) + at_v) * size_t(s.u) + at_u]);
            whole += weight;
        }
    return whole > 0.0 ? sum / whole : 0.0;
}

double depth_at(const float* depth, const LookVolume& volume, const LookRay& ray, Vec at)
{
    const Vec last = Vec(volume.x, volume.y, volume.z) - 1.001, l = xyz(ray.direction);
    double enters = 0.0, leaves = 1e6;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double by = std::abs(l[axis]) > 1e-6 ? l[axis] : 1e-6;
        const double a = -at[axis] / by, b = (last[axis] - at[axis]) / by;
        enters = std::max(enters, std::min(a, b));
        leaves = std::min(leaves, std::max(a, b));
    }
    if (!(enters <= leaves))
        return 0.0;
    const Vec p = glm::clamp(at + enters * l, Vec(0.0), last);
    const Slice s(volume, ray);
    const double passed = (p[ray.axis] - ray.from) * ray.sign;
    const int slice = std::clamp(int(passed), 0, s.count - 2);
    const double u = p[s.u_axis], v = p[s.v_axis];
    return std::max(0.0, glm::mix(depth_in_slice(depth, s, ray, slice, u, v),
                                  depth_in_slice(depth, s, ray, slice + 1, u, v), passed - slice));
}

double march(const float* taken, const LookVolume& volume, Vec at, Vec direction)
{
    const double most = 2.0 * std::max({volume.x, volume.y, volume.z}) + glm::length(at);
    double sum = 0.0;
    for (double far = 0.25; far < most; far += 0.5)
        about(volume, at + far * direction, [&](size_t voxel, double weight) { sum += weight * double(taken[voxel]); });
    return sum * 0.5 * volume.corner.w;
}

static std::array<double, 16> moments_at(const std::vector<float>& of, const LookVolume& coarse, Vec p)
{
    const Vec at = glm::clamp(in_voxels(p, coarse), Vec(0.0), Vec(coarse.x, coarse.y, coarse.z) - 1.001);
    std::array<double, 16> moments = {};
    about(coarse, at,
          [&](size_t voxel, double weight)
          {
              for (size_t i = 0; i < 16; ++i)
                  moments[i] += weight * double(of[16 * voxel + i]);
          });
    return moments;
}

TwoSides two_sides(const std::vector<float>& moments, const LookVolume& coarse, Vec p, Vec middle, Vec aside)
{
    const std::array<double, 16> found = moments_at(moments, coarse, p);
    TwoSides sides;
    for (size_t c = 0; c < 4; ++c)
    {
        const Vec lean(found[4 + c], found[8 + c], found[12 + c]);
        sides.front[c] = std::max(found[c] + glm::dot(lean, middle + aside), 0.0);
        sides.behind[c] = std::max(found[c] + glm::dot(lean, middle - aside), 0.0);
    }
    return sides;
}

std::vector<Step> steps_of(const std::vector<float>& fibre, const std::vector<int>& skin_in,
                           const std::vector<float4>& sent, const LookVolume& coarse, double self_shadow,
                           Vec from_all_sides)
{
    const size_t all = voxels_of(coarse);
    const double side = coarse.corner.w;
    std::vector<Step> steps(all);
    for (int z = 0; z < coarse.z; ++z)
        for (int y = 0; y < coarse.y; ++y)
            for (int x = 0; x < coarse.x; ++x)
            {
                const size_t at = voxel_at(coarse, x, y, z);
                Step& step = steps[at];
                const double body = fibre[4 * all + at], hair = std::max(0.0, fibre[3 * all + at] - body);
                step.depth = self_shadow * side * 0.25 * kPi * hair;
                step.left = glm::exp(-double(SKIN_TAKEN) * step.depth * (1.0 - from_all_sides));
                // Of a body's voxels a ray takes BODY_DEPTH, over COARSE of them.
                step.open = 1.0 - std::min(1.0, 0.25 * kPi * body * side / (BODY_DEPTH * COARSE));
                int nearest = 4, found = -1;
                for (int by = 0; by < 27 && !skin_in.empty(); ++by)
                {
                    const int i = by % 3 - 1, j = by / 3 % 3 - 1, k = by / 9 - 1, far = i * i + j * j + k * k;
                    if (x + i < 0 || y + j < 0 || z + k < 0 || x + i >= coarse.x || y + j >= coarse.y ||
                        z + k >= coarse.z)
                        continue;
                    const int there = skin_in[voxel_at(coarse, x + i, y + j, z + k)];
                    if (there >= 0 && far < nearest)
                        nearest = far, found = there;
                }
                if (found >= 0)
                    step.sent = (1.0 - step.open) * step.left * xyz(sent[size_t(found)]);
            }
    return steps;
}

Stepped step_along(const std::vector<Step>& steps, const LookVolume& coarse, glm::ivec3 from, const LookRay& ray)
{
    Stepped found;
    Vec left = steps[voxel_at(coarse, from.x, from.y, from.z)].left;
    for (int step = 1; step <= STEPS; ++step)
    {
        const glm::ivec3 at = from + glm::ivec3(glm::roundEven(glm::vec3(xyz(ray.direction)) * float(step)));
        if (at.x < 0 || at.y < 0 || at.z < 0 || at.x >= coarse.x || at.y >= coarse.y || at.z >= coarse.z)
            continue; // nothing lies there
        const Step& met = steps[voxel_at(coarse, at.x, at.y, at.z)];
        found.comes += left * met.sent;
        found.open *= met.open;
        left *= met.open * met.left;
    }
    return found;
}

// What a place's fibre does to light of one channel.
struct Shares
{
    Crossed rows[3]; // at the hair's root, in its middle, at its tip
    double tip;
    // A parabola through the three.
    double of(double Crossed::*value) const
    {
        const double a = rows[0].*value, b = rows[1].*value, c = rows[2].*value;
        const double between = a * (1 - tip) * (1 - 2 * tip) + 4 * b * tip * (1 - tip) - c * tip * (1 - 2 * tip);
        return std::clamp(between, 1e-5, 1.0);
    }
};

static in_doubles::Fibre fibre_of(const LookFrame& f)
{
    return {f.variance,   f.logistic,   f.ior,        f.tilts[0].x, f.tilts[0].y,
            f.tilts[0].z, f.tilts[0].w, f.tilts[1].x, f.tilts[1].y};
}

Vec shade(const Lit& lit, const float4* places, int k, const StrandLook& look, int level)
{
    const int count = lit.volume.places;
    const Vec p = xyz(places[k]), eye = glm::normalize(xyz(lit.frame.eye) - p);
    const Vec t = glm::normalize(xyz(places[std::min(k + 1, count - 1)]) - xyz(places[std::max(k - 1, 0)]));
    const double along = double(k) / (count - 1), tip = profile_at(lit.params.look_color_along, along);
    const double bright = std::exp(double(lit.params.look_variation) * 2.0 * (strand_random(int(look.own.x), 1) - 0.5));
    const auto absorb = [&](double color)
    { return std::pow(std::log(std::clamp(color, 1e-4, 0.9999)) / bright, 2) * double(lit.frame.per_log); };
    const Vec root = xyz(look.root_color), end = xyz(look.tip_color), color = glm::mix(root, end, tip);
    const auto shares = [&](int channel, double sine)
    {
        return Shares{{from_table(lit.table, absorb(root[channel]), sine),
                       from_table(lit.table, absorb(0.5 * (root + end)[channel]), sine),
                       from_table(lit.table, absorb(end[channel]), sine)},
                      tip};
    };
    const in_doubles::Rgb absorbs = {absorb(color.x), absorb(color.y), absorb(color.z)};
    const LookFrame& f = lit.frame;
    const in_doubles::Fibre fibre = fibre_of(f);
    const auto vec = [](const in_doubles::Rgb& c) { return Vec(c.r, c.g, c.b); };

    const Vec to_eye = xyz(lit.eye_ray.direction);
    const Vec seen = p + to_eye * depth_at(lit.eye_depth.data(), lit.volume, lit.eye_ray, in_voxels(p, lit.volume));

    Vec sum(0.0);
    for (int i = 0; i < f.suns; ++i)
    {
        const LookRay& ray = lit.rays[size_t(i)];
        const Vec l = xyz(ray.direction), e = xyz(ray.irradiance);
        const double disc = ray.direction.w;
        const in_doubles::FibreAngles a = in_doubles::fibre_angles(glm::dot(t, l), glm::dot(t, eye), glm::dot(eye, l));
        const double out = double(OUT_TO_SUN) / std::max(glm::length(eye - l), 1.0);
        const double tau = depth_at(lit.depth.data() + size_t(i) * voxels_of(lit.volume), lit.volume, ray,
                                    in_voxels(seen, lit.volume) + out * l);
        if (level == 1)
        {
            sum += e * std::exp(-tau) * vec(in_doubles::karis(fibre, a, absorbs, f.roughness));
            continue;
        }
        const Vec own =
            (1.0 - double(f.near)) *
            vec(in_doubles::far_field(fibre, a, in_doubles::lobe_heights(fibre, a, disc), absorbs, f.nodes, false));
        if (level == 2)
        {
            sum += e * std::exp(-tau) * own;
            continue;
        }
        // The spread is that of green.
        const Shares green = shares(1, a.si);
        const double forward_v = green.of(&Crossed::forward_variance);
        const double met = green.of(&Crossed::forward) * tau, crossings = met > 1e-9 ? met / -std::expm1(-met) : 1.0;
        const double further = forward_v * crossings + disc;
        const Vec around =
            vec(in_doubles::far_field(fibre, a, in_doubles::lobe_heights(fibre, a, further), absorbs, 2, true));
        const double thrown_v = green.of(&Crossed::behind_variance);
        const double facing = 0.5 * std::max(0.0, a.cos_phi);
        for (int c = 0; c < 3; ++c)
        {
            const Shares s = shares(c, a.si);
            const double forward = s.of(&Crossed::forward), behind = s.of(&Crossed::behind);
            const double handed = std::exp((forward - 1) * tau) - std::exp(-tau);
            sum[c] +=
                e[c] *
                (std::exp(-tau) *
                     (own[c] + behind * facing * in_doubles::longitudinal(a.si, a.ci, a.so, a.co, thrown_v + disc)) +
                 handed * (around[c] +
                           behind * facing * in_doubles::longitudinal(a.si, a.ci, a.so, a.co, thrown_v + further)));
        }
    }
    const double along_eye = glm::dot(t, eye);
    const double v = f.variance, cone = 1.0 / std::tanh(1.0 / v) - v;
    const TwoSides around =
        two_sides(lit.around, lit.coarse, seen + to_eye * double(SKY_TO_EYE) * double(lit.coarse.corner.w),
                  -cone * along_eye * t, cone * 2.0 / kPi * (eye - t * along_eye));
    for (int c = 0; c < 3; ++c)
    {
        const Shares s = shares(c, along_eye);
        const double forward = s.of(&Crossed::forward), backward = s.of(&Crossed::backward);
        const double dense = 1.0 - std::min(1.0, around.behind[3]);
        const double behind = level == 3 ? in_doubles::back_albedo(forward, backward) * dense : 0.0;
        sum[c] += (backward + behind) * around.front[size_t(c)] + forward * around.behind[size_t(c)];
    }
    return sum;
}

Vec near_light(const Lit& lit, Vec p, Vec tangent, Vec absorption, const std::vector<double>& straight, double from,
               double to)
{
    const Vec eye = glm::normalize(xyz(lit.frame.eye) - p);
    const LookFrame& f = lit.frame;
    const in_doubles::Fibre fibre = fibre_of(f);
    Vec sum(0.0);
    for (int cell = 0; cell < NEAR_CELLS; ++cell)
    {
        const double begin = -1.0 + 2.0 * cell / NEAR_CELLS, end = begin + 2.0 / NEAR_CELLS;
        const double seen = std::max(0.0, std::min(to, end) - std::max(from, begin)) / (to - from);
        for (size_t k = 0; k < lit.rays.size(); ++k)
        {
            const Vec l = xyz(lit.rays[k].direction), e = xyz(lit.rays[k].irradiance);
            in_doubles::FibreAngles a =
                in_doubles::fibre_angles(glm::dot(tangent, l), glm::dot(tangent, eye), glm::dot(l, eye));
            const Vec other = glm::normalize(glm::cross(eye, tangent));
            a.phi = std::copysign(a.phi, glm::dot(l, other));
            const double h = -0.5 * (begin + end); // to the right, as the tracer has it
            const in_doubles::NearLight light = in_doubles::near_light(fibre, a, lit.rays[k].direction.w);
            const double r = in_doubles::reflected_beyond(light, in_doubles::reflected_at(float(-begin))) -
                             in_doubles::reflected_beyond(light, in_doubles::reflected_at(float(-end)));
            const in_doubles::Rgb found =
                in_doubles::near_field(in_doubles::near_place(fibre, a, {absorption.x, absorption.y, absorption.z},
                                                              float(h), 2.0f / NEAR_CELLS),
                                       light, r * NEAR_CELLS);
            sum += seen * straight[k] * e * Vec(found.r, found.g, found.b);
        }
    }
    return double(f.near) * sum;
}

// The share of a sun's light at a point, by channel: the mean over four points a voxel off, across the light.
static Vec light_through(const Lit& lit, int sun, Vec at)
{
    const LookRay& ray = lit.rays[size_t(sun)];
    const Vec l = xyz(ray.direction);
    const Vec side = glm::normalize(glm::cross(l, std::abs(l.x) < 0.6 ? Vec(1, 0, 0) : Vec(0, 1, 0)));
    const Vec up = glm::cross(l, side);
    Vec mean(0.0);
    for (const Vec& by : {side, up, -side, -up})
    {
        const Vec p = at + double(lit.volume.corner.w) * by;
        const double tau =
            depth_at(lit.depth.data() + size_t(sun) * voxels_of(lit.volume), lit.volume, ray, in_voxels(p, lit.volume));
        const double kept = std::min(tau, depth_at(lit.body_depth.data() + size_t(sun) * voxels_of(lit.coarse),
                                                   lit.coarse, lit.body_rays[size_t(sun)], in_voxels(p, lit.coarse)));
        for (int c = 0; c < 3; ++c)
            mean[c] += 0.25 * std::exp((lit.forward[c] - 1) * (tau - kept) - kept);
    }
    return mean;
}

Vec lit_surface(const Lit& lit, const LookSurface& surface)
{
    const Vec n = xyz(surface.normal), p = xyz(surface.position), eye = glm::normalize(xyz(lit.frame.eye) - p);
    const Vec above = p + double(surface.position.w) * double(lit.volume.corner.w) * n;
    const double a2 = std::pow(0.45, 4), ne = std::max(1e-3, glm::dot(n, eye));
    const double reach[3] = {0.35, 0.18, 0.12}; // Lambert's cosine comes around so far
    Vec diffuse(0.0), shine(0.0);
    for (int i = 0; i < lit.frame.suns; ++i)
    {
        const LookRay& ray = lit.rays[size_t(i)];
        const Vec l = xyz(ray.direction), h = glm::normalize(l + eye);
        const Vec through = light_through(lit, i, above);
        const double nl = std::max(0.0, glm::dot(n, l)), nh = glm::dot(n, h);
        const double d = a2 / (kPi * std::pow(nh * nh * (a2 - 1) + 1, 2));
        const double v =
            0.5 / std::max(1e-4, nl * std::sqrt(ne * ne * (1 - a2) + a2) + ne * std::sqrt(nl * nl * (1 - a2) + a2));
        const double f = 0.028 + 0.972 * std::pow(1.0 - std::clamp(glm::dot(eye, h), 0.0, 1.0), 5);
        for (int c = 0; c < 3; ++c)
        {
            const double e = xyz(ray.irradiance)[c] * through[c];
            const double round = std::max(0.0, glm::dot(n, l) + reach[c]) / (1 + reach[c]);
            diffuse[c] += e * glm::mix(nl, round, double(surface.albedo.w)) / kPi;
            shine[c] += e * surface.normal.w * d * v * f * nl;
        }
    }
    const TwoSides sky = two_sides(lit.sky, lit.coarse, above, Vec(0.0), 2.0 / 3.0 * n);
    for (int c = 0; c < 3; ++c)
        diffuse[c] += xyz(lit.frame.sky)[c] * std::min(1.0, sky.front[size_t(c) + 1]);
    return xyz(surface.albedo) * diffuse + shine;
}

} // namespace coif::oracle

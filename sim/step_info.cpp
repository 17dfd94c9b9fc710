#include "sim/step_info.h"

#include "sim/material.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr double kTeleportDistance = 0.25;                // m in a substep
static constexpr double kTeleportAngle = std::numbers::pi / 2.0; // rad in a substep
static constexpr double kGustCell = 0.15, kGustPeriod = 256.0;   // m; cells: kernels/turbulence.h
static constexpr double kGustDrift = 0.3;                        // s: gusts travel as fast as wind drives in this time
static constexpr float kClearance = 0.001f;                      // m that hair keeps from colliders

static float4 row(const glm::dmat3& m, int i) { return F4(float(m[0][i]), float(m[1][i]), float(m[2][i]), 0.0f); }
static float4 vector4(glm::dvec3 v, double w) { return F4(float(v.x), float(v.y), float(v.z), float(w)); }
static double wrapped(double cells) { return cells - std::floor(cells / kGustPeriod) * kGustPeriod; }

// The sweep of light through the grid: kernels/light_grid.h.
static void set_sweep(StepInfo& info, const HairParams& params, const Groom& groom, double voxel)
{
    const double light[3] = {params.look_light_direction.x, params.look_light_direction.y,
                             params.look_light_direction.z};
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(light[i]) > std::abs(light[axis]))
            axis = i;
    const double lean = std::abs(light[axis]); // at least 1 / sqrt(3)
    info.sweep_axis = axis;
    info.sweep_from = light[axis] > 0.0 ? params.grid_resolution - 1 : 0;
    info.sweep_sign = light[axis] > 0.0 ? -1 : 1;
    // A guide's node stands for a segment of every drawn strand that follows it. Mean projected area of a fibre that
    // may lie any way: pi / 4 of its length times its width.
    const double segment = double(groom.longest) * params.strand_spacing / (groom.nodes - 2);
    const double area = std::numbers::pi / 4.0 * segment * params.look_width *
                        double(std::max<size_t>(groom.drawn.size(), 1)) / std::max(groom.guides, 1);
    const double extinction = params.look_self_shadow * area / (DENSITY_ONE * voxel * voxel * voxel);
    info.sweep =
        vector4({-light[axis == 0 ? 1 : 0] / lean, -light[axis == 2 ? 1 : 2] / lean, voxel / lean}, extinction);
    // Three units of optical depth a voxel stop all but 5 % of the light.
    info.body_density = extinction > 0.0 ? int(std::min(3.0 / (extinction * voxel), 1e8)) : 0;
}

// A box of the given variance, in voxels^2: kernels/blur_density.cl.
static float4 box_of(double variance)
{
    // r whole voxels to each side have the variance r (r + 1) / 3; the ends make up for the rest.
    const double r = std::floor(std::sqrt(0.25 + 3.0 * variance) - 0.5), voxels = 2.0 * r + 1.0;
    const double end = 0.5 * (variance * voxels - r * (r + 1.0) * voxels / 3.0) / ((r + 1.0) * (r + 1.0) - variance);
    const double all = voxels + 2.0 * end;
    return F4(float(r), float(1.0 / all), float(end / all), float(variance));
}

// A node is spread as wide as grid.blur says (a standard deviation), part of it by the grid itself: adding to it and
// reading from it trilinearly have a variance of 1/6 voxel^2 each, the central difference 1/3. Two boxes come near a
// Gaussian, so that the push does not hang on how the width is shared out; light stops at the first, which keeps the
// edges of shadows.
static void set_blur(StepInfo& info, const HairParams& params, double voxel)
{
    const double width = params.grid_blur / voxel, rest = std::max(0.0, width * width - 2.0 / 3.0);
    info.light_box = info.push_box = box_of(0.5 * rest);
}

// Which nodes feed the density, and with what weight: all of them alike, or of many an even part that weighs as much.
static void set_density(StepInfo& info, const Groom& groom)
{
    const long nodes = groom.nodes - 1, all = groom.guides * nodes;
    info.density_stride = int(std::max(1L, (all + DENSITY_NODES - 1) / DENSITY_NODES));
    info.density_unit = DENSITY_ONE;
    if (info.density_stride == 1)
        return;
    long part = 0;
    for (int s = 0; s < groom.guides; ++s)
        part += (nodes + info.density_stride - density_first(s, info.density_stride)) / info.density_stride;
    info.density_unit = int(std::lround(double(DENSITY_ONE) * double(all) / double(part)));
}

StepInfo make_step_info(const HairParams& params, const Groom& groom, const Pose& before, glm::dvec3 velocity_before,
                        const Substep& now, int colliders, bool last, const PlacedGrid& body)
{
    StepInfo info = {};
    const double h = now.seconds;
    const glm::dmat3 turn = glm::mat3_cast(now.head.turn), turn_before = glm::mat3_cast(before.turn);
    const double angle = 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(now.head.turn, before.turn))));
    const bool teleport = glm::length(now.head.origin - before.origin) > kTeleportDistance || angle > kTeleportAngle;
    const glm::dmat3 carried = teleport ? turn * glm::transpose(turn_before) : glm::dmat3(1.0);

    info.head_row0 = row(turn, 0);
    info.head_row1 = row(turn, 1);
    info.head_row2 = row(turn, 2);
    info.turn_row0 = row(carried, 0);
    info.turn_row1 = row(carried, 1);
    info.turn_row2 = row(carried, 2);
    info.origin_move = vector4(teleport ? glm::dvec3(0.0) : now.head.origin - before.origin, 0.0);
    info.head_velocity = vector4(velocity_before, 0.0);
    info.head_center = vector4(glm::dvec3(groom.center), 0.0);

    const glm::dvec3 wind =
        glm::dvec3(params.forces_wind.x, params.forces_wind.y, params.forces_wind.z) + now.head.wind;
    info.wind = vector4(wind, glm::length(wind));
    const glm::dvec3 gust = (now.head.origin - wind * (kGustDrift * now.time)) / kGustCell;
    info.gust_origin = vector4({wrapped(gust.x), wrapped(gust.y), wrapped(gust.z)}, params.forces_turbulence);

    // The grid holds all that hair can reach, whichever way the head turns. Values sit at the voxels' centres, so the
    // outermost half voxels hold none; a thousandth more keeps float arithmetic within.
    const double reach = double(groom.longest) * std::max(1.0f, params.strand_spacing) + double(groom.farthest);
    const double voxel = 1.001 * 2.0 * reach / (params.grid_resolution - 1);
    info.grid_corner = vector4(turn * glm::dvec3(groom.middle) - 0.5 * voxel * params.grid_resolution, voxel);
    set_sweep(info, params, groom, voxel);
    set_blur(info, params, voxel);
    set_density(info, groom);

    const double b = params.forces_drag;
    info.substep = float(h);
    info.drag_keep = float(std::exp(-b * h));
    info.drag_gain = float(b * h > 1e-6 ? -std::expm1(-b * h) / b : h);
    info.gravity = float(-kGravity * params.forces_gravity);
    // Strengths beyond what there is count as the nearest that there is: their power would be no number.
    const auto of_a_sweep = [sweeps = std::max(1, params.solver_iterations)](float strength) // eq. 5.5
    { return float(1.0 - std::pow(1.0 - std::clamp(double(strength), 0.0, 1.0), 1.0 / sweeps)); };
    info.stretch = of_a_sweep(params.solver_stretching);
    info.bend = of_a_sweep(params.solver_bending);
    const double links = groom.nodes - 2;
    info.relax =
        params.solver_sweeps == 0 ? float(2.0 / (1.0 + std::sin(std::numbers::pi / (2.0 * links + 1.0)))) : 1.0f;
    // Of segments of 1 m: kernels/direct.h takes it to each strand's own.
    const float stiffness = float(stiffness_over_mass(params, links, 1.0));
    info.bend_droop = params.bending_modulus > 0.0f ? 0.0f : stiffness;
    info.bend_modulus = params.bending_modulus > 0.0f ? stiffness : 0.0f;
    info.tip_mass = groom.tip_mass;
    info.push_out = kPushOut;
    info.clearance = kClearance;
    info.parting = 0.15f * groom.extent; // beyond some spacings of the guides, still small against the head
    // Repulsion is the relative change of the density over a tenth of the scalp's extent. The density it is relative to
    // is that of all nodes spread over the scalp's cube, so the number of guides does not change the force.
    const double spread =
        double(groom.extent) * groom.extent * groom.extent / (double(groom.guides) * (groom.nodes - 1));
    info.repulsion =
        float(params.forces_repulsion * spread * 0.1 * groom.extent / (DENSITY_ONE * voxel * voxel * voxel * voxel));

    info.guides = groom.guides;
    info.drawn_multi = groom.drawn_multi;
    info.drawn = int(groom.drawn.size());
    info.colliders = colliders;
    if (body.grid)
    {
        info.body_corner = vector4(glm::dvec3(body.grid->corner) * double(body.scale) + glm::dvec3(body.offset),
                                   double(body.grid->voxel) * body.scale);
        info.body_x = body.grid->size.x;
        info.body_y = body.grid->size.y;
        info.body_z = body.grid->size.z;
    }
    info.teleport = teleport;
    info.last_substep = last;
    return info;
}

// Mean velocity over a substep of z = b h under drag b and force f, against that of the substep before (z_before):
// V' = keep V + (1 - keep) f / b with keep = exp(-z_before) phi(z) / phi(z_before), phi(z) = (1 - exp(-z)) / z, from
// the exact motion v = f / b + c exp(-b t). Exact for constant f, at changes of h and from the start (z_before = 0)
// too.
static float4 drag_between(double b, double h_before, double h)
{
    const auto log_phi = [](double z) // of phi, without loss for small z
    { return z < 1e-3 ? -0.5 * z + z * z / 24.0 : std::log(-std::expm1(-z) / z); };
    const double before = b * h_before, now = b * h;
    const double keep_log = -before + log_phi(now) - log_phi(before);
    const double gain = b > 1e-9 ? -std::expm1(keep_log) / b : 0.5 * (h_before + h);
    return F4(float(std::exp(keep_log)), float(gain), 0.0f, 0.0f);
}

StepPath make_step_path(const HairParams& params, const Pose& before, const Substep& now, bool teleport,
                        double seconds_before)
{
    StepPath path = {};
    for (int i = 0; i <= STEP_PARTS; ++i)
    {
        if (i % 3 != 0 && i % 4 != 0) // of sixteen substeps, or of twelve
            continue;
        const double share = double(i) / STEP_PARTS;
        Pose pose = now.head;
        if (!teleport && i < STEP_PARTS)
            pose = now.way ? now.way(share)
                           : Pose{glm::mix(before.origin, now.head.origin, share),
                                  glm::slerp(before.turn, now.head.turn, share),
                                  {}};
        const glm::dmat3 turn = glm::mat3_cast(pose.turn);
        const glm::dvec3 origin = teleport ? glm::dvec3(0.0) : pose.origin - before.origin;
        for (int axis = 0; axis < 3; ++axis)
        {
            path.row[3 * i + axis] = row(turn, axis);
            path.row[3 * i + axis].w = float(origin[axis]);
        }
    }
    for (int from = 0; from <= DRAG_WITHIN; ++from)
        for (int to = 0; to < PACES; ++to)
        {
            const double h = double(now.seconds) / substeps_of(to);
            const double h_before = from == 0             ? 0.0
                                    : from == DRAG_WITHIN ? h // steps need not be equally long
                                                          : seconds_before / substeps_of(from - 1);
            path.drag[PACES * from + to] = drag_between(params.forces_drag, h_before, h);
        }
    return path;
}

// What a root may be accelerated by on this path, at most: second differences over quarters of the step, so that one
// grid of times serves all substeps. `reach` is the farthest root from the head's origin.
static double root_acceleration(const StepPath& path, double seconds, double reach)
{
    const double quarter = seconds / 4.0;
    double most = 0.0;
    constexpr int kQuarter = STEP_PARTS / 4;
    for (int i = kQuarter; i < STEP_PARTS; i += kQuarter)
    {
        double origin2 = 0.0, turn2 = 0.0;
        for (int axis = 0; axis < 3; ++axis)
        {
            const float4 &a = path.row[3 * (i - kQuarter) + axis], &b = path.row[3 * i + axis],
                         &c = path.row[3 * (i + kQuarter) + axis];
            const auto second = [](float l, float m, float r) { return double(l) - 2.0 * double(m) + double(r); };
            origin2 += std::pow(second(a.w, b.w, c.w), 2);
            turn2 += std::pow(second(a.x, b.x, c.x), 2) + std::pow(second(a.y, b.y, c.y), 2) +
                     std::pow(second(a.z, b.z, c.z), 2);
        }
        most = std::max(most, (std::sqrt(origin2) + reach * std::sqrt(turn2)) / (quarter * quarter));
    }
    return most;
}

void set_direct(StepInfo& info, const StepPath& path, const Groom& groom, const RestShape& rest, int head_colliders)
{
    info.head_colliders = head_colliders;
    info.bend_most = float(rest.bend_most);
    info.turning_rate = float(rest.turning_rate);
    const double reach = glm::length(glm::dvec3(groom.middle)) + double(groom.farthest);
    info.acceleration =
        float(std::abs(double(info.gravity)) + double(info.wind.w) * (1.0 + double(info.gust_origin.w)) +
              root_acceleration(path, info.substep, reach));
}

} // namespace coif

// Fills StepInfo: everything that the kernels need of one substep, in one place.
#include "sim/solver.h"

#include <glm/geometric.hpp>
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

    const double b = params.forces_drag;
    info.substep = float(h);
    info.drag_keep = float(std::exp(-b * h));
    info.drag_gain = float(b * h > 1e-6 ? -std::expm1(-b * h) / b : h);
    info.gravity = -9.81f * params.forces_gravity;
    const double sweeps = params.solver_iterations;
    info.stretch = float(1.0 - std::pow(1.0 - double(params.solver_stretching), 1.0 / sweeps)); // eq. 5.5
    info.bend = float(1.0 - std::pow(1.0 - double(params.solver_bending), 1.0 / sweeps));
    const double links = groom.nodes - 2;
    info.relax =
        params.solver_sweeps == 0 ? float(2.0 / (1.0 + std::sin(std::numbers::pi / (2.0 * links + 1.0)))) : 1.0f;
    info.clearance = kClearance;
    info.parting = 0.15f * groom.extent; // beyond some spacings of the guides, still small against the head
    // Repulsion is the relative change of the density over a tenth of the scalp's extent. The density it is relative to
    // is that of all nodes spread over the scalp's cube, so neither grid nor number of guides changes the force.
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

} // namespace coif

// How much light reaches a drawn node: the swept grid (light_grid.h), read for a point of each lane.
#ifndef COIF_INTERPOLATE_LIGHT_H
#define COIF_INTERPOLATE_LIGHT_H
#include "drawn_lanes.h"

// light_ray() of light_grid.h, lane by lane.
static inline real light_rays(real at, float slant, real passed)
{
    const real moved = at - slant * passed;
    return moved - floor(moved * (1.0f / RESOLUTION)) * (float)RESOLUTION;
}

// Bilinear between the four rays about (u, v) in each lane's slice.
LAID_IN real slice_depth(global const float* depth, real u, real v, whole slice, constant StepInfo* info)
{
    const real passed = TO_REAL(slice);
    const real ru = light_rays(u, info->sweep.x, passed), rv = light_rays(v, info->sweep.y, passed);
    const whole u0 = min(TO_WHOLE(ru), (whole)(RESOLUTION - 1)), v0 = min(TO_WHOLE(rv), (whole)(RESOLUTION - 1));
    const whole v1 = select((whole)(0), v0 + 1, v0 + 1 < RESOLUTION);
    const whole row0 = (slice * RESOLUTION + v0) * RESOLUTION, row1 = (slice * RESOLUTION + v1) * RESOLUTION;
    const real across = ru - TO_REAL(u0), along = rv - TO_REAL(v0);
    real low0, low1, high0, high1;
    const whole at_seam = u0 + 1 >= RESOLUTION; // beside which the first ray lies, not the next row's
    int low_at[WIDTH], high_at[WIDTH];
    LANES_STORE(row0 + select(u0, u0 - 1, at_seam), low_at);
    LANES_STORE(row1 + select(u0, u0 - 1, at_seam), high_at);
    gather_pair(depth, low_at, &low0, &low1);
    gather_pair(depth, high_at, &high0, &high1);
    if (any_lane(at_seam))
    {
        low0 = select(low0, low1, at_seam);
        high0 = select(high0, high1, at_seam);
        low1 = select(low1, gather(depth, row0), at_seam);
        high1 = select(high1, gather(depth, row1), at_seam);
    }
    return mix(mix(low0, low1, across), mix(high0, high1, across), along);
}

// Optical depth between a point and the light. Half a voxel towards the light, so that a strand does not shade itself.
static inline real light_depth(global const float* depth, Points p, constant HairParams* params,
                               constant StepInfo* info)
{
    const float4 corner = info->grid_corner, light = params->look_light_direction;
    const float inverse = 1.0f / corner.w, last = (float)(RESOLUTION - 1);
    const real gx = (p.x - corner.x) * inverse + (light.x * 0.5f - 0.5f);
    const real gy = (p.y - corner.y) * inverse + (light.y * 0.5f - 0.5f);
    const real gz = (p.z - corner.z) * inverse + (light.z * 0.5f - 0.5f);
    // Written so that a NaN counts as outside, where no lane may read.
    const whole inside = (gx >= 0.0f) & (gy >= 0.0f) & (gz >= 0.0f) & (gx < last) & (gy < last) & (gz < last);
    const Points g = select_points(points((real)(0.0f), (real)(0.0f), (real)(0.0f)), points(gx, gy, gz), inside);
    const real u = info->sweep_axis == 0 ? g.y : g.x, v = info->sweep_axis == 2 ? g.y : g.z;
    const real main = info->sweep_axis == 0 ? g.x : info->sweep_axis == 1 ? g.y : g.z;
    const real passed = (main - (float)info->sweep_from) * (float)info->sweep_sign;
    const whole slice = clamp(TO_WHOLE(passed), (whole)(0), (whole)(RESOLUTION - 2));
    const real tau =
        mix(slice_depth(depth, u, v, slice, info), slice_depth(depth, u, v, slice + 1, info), passed - TO_REAL(slice));
    return select((real)(0.0f), tau, inside);
}

#endif

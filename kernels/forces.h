// What the air and the other hair do to a node (thesis 5.1.2 and 5.1.3): accelerations, m/s^2.
#ifndef COIF_FORCES_H
#define COIF_FORCES_H
#include "drawn_lanes.h"
#include "grid.h"
#include "turbulence.h"

// Wind with its gusts at a point.
static inline Points wind_at(Points p, constant StepInfo* info)
{
    const real gx = p.x * (1.0f / 0.15f) + info->gust_origin.x;
    const real gy = p.y * (1.0f / 0.15f) + info->gust_origin.y;
    const real gz = p.z * (1.0f / 0.15f) + info->gust_origin.z;
    const float gust_size = info->wind.w * info->gust_origin.w;
    return points(info->wind.x + gust_size * gust(gx, gy, gz, 0), info->wind.y + gust_size * gust(gx, gy, gz, 1),
                  info->wind.z + gust_size * gust(gx, gy, gz, 2));
}

// Wind across the strand, eq. 5.2 (Oshita 2004): |w x t| / |w| w, t the strand's unit tangent.
static inline Points across_wind(Points w, Points t)
{
    const real cx = w.y * t.z - w.z * t.y, cy = w.z * t.x - w.x * t.z, cz = w.x * t.y - w.y * t.x;
    const real across = cx * cx + cy * cy + cz * cz;
    const real all = fmax(dot_lanes(w, w) * dot_lanes(t, t), (real)(1e-24f));
    const real share = sqrt(across / all); // sine of the angle between wind and strand
    return points(share * w.x, share * w.y, share * w.z);
}

// What crowded hair does to a node at p: down the gradient of the density, which lies component after component.
// Trilinear; outside of the grid there is no hair.
LAID_IN Points repulsion_at(global const float* gradient, Points p, constant StepInfo* info)
{
    const float inverse = 1.0f / info->grid_corner.w, last = (float)(RESOLUTION - 1);
    const real gx = (p.x - info->grid_corner.x) * inverse - 0.5f;
    const real gy = (p.y - info->grid_corner.y) * inverse - 0.5f;
    const real gz = (p.z - info->grid_corner.z) * inverse - 0.5f;
    // Written so that a NaN counts as outside.
    const whole within = (gx >= 0.0f) & (gy >= 0.0f) & (gz >= 0.0f) & (gx < last) & (gy < last) & (gz < last);
    if (!any_lane(within))
        return points((real)(0.0f), (real)(0.0f), (real)(0.0f));
    const whole ix = TO_WHOLE(select((real)(0.0f), gx, within)), iy = TO_WHOLE(select((real)(0.0f), gy, within)),
                iz = TO_WHOLE(select((real)(0.0f), gz, within));
    const real fx = gx - TO_REAL(ix), fy = gy - TO_REAL(iy), fz = gz - TO_REAL(iz);
    int first[WIDTH];
    LANES_STORE(ix + RESOLUTION * (iy + RESOLUTION * iz), first);
    const int plane = RESOLUTION * RESOLUTION;
    real sum[3];
    for (int axis = 0; axis < 3; ++axis)
    {
        global const float* from = gradient + axis * RESOLUTION * plane;
        real v0, v1, v2, v3, v4, v5, v6, v7;
        gather_pair(from, first, &v0, &v1);
        gather_pair(from + RESOLUTION, first, &v2, &v3);
        gather_pair(from + plane, first, &v4, &v5);
        gather_pair(from + plane + RESOLUTION, first, &v6, &v7);
        const real a0 = v0 + fx * (v1 - v0), a1 = v2 + fx * (v3 - v2);
        const real a2 = v4 + fx * (v5 - v4), a3 = v6 + fx * (v7 - v6);
        const real b0 = a0 + fy * (a1 - a0), b1 = a2 + fy * (a3 - a2);
        sum[axis] = -info->repulsion * (b0 + fz * (b1 - b0));
    }
    // A few strands in one voxel of a fine grid must not explode: at most 50 m/s^2.
    const real size = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    const real share = select((real)(0.0f), fmin((real)(1.0f), 50.0f / fmax(size, (real)(1e-6f))), within);
    return points(share * sum[0], share * sum[1], share * sum[2]);
}

#endif

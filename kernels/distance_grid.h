// The head as a grid of signed distances to its surface (sim/distance_grid.h), for lanes. Samples lie on a lattice in
// the head's frame that info->body_corner and body_x, body_y, body_z place; body_distance holds them in voxels, so that
// head.scale moves and grows the grid without touching it. Build option BODY_GRID says that there is one.
#ifndef COIF_DISTANCE_GRID_H
#define COIF_DISTANCE_GRID_H
#include "lanes.h"

#define FAR_OUTSIDE 1e6f // m: where there is no grid

// The plane that the surface is nearby: unit normal, outwards along the world's axes, and how far above it a point is.
typedef struct BodyPlane
{
    real nx, ny, nz, distance;
} BodyPlane;

// At a point relative to the head's origin along the world's axes, m: the trilinear distance, and the gradient of just
// that. In a crease, where the gradient vanishes, upwards. Outside of the grid, and where the point is not a number,
// FAR_OUTSIDE.
static inline BodyPlane body_plane(global const float* body_distance, real x, real y, real z, constant StepInfo* info)
{
    const float4 r0 = info->head_row0, r1 = info->head_row1, r2 = info->head_row2, corner = info->body_corner;
    const float inverse = 1.0f / corner.w;
    // To the head's frame, by the transposed rotation.
    const real gx = (r0.x * x + r1.x * y + r2.x * z - corner.x) * inverse;
    const real gy = (r0.y * x + r1.y * y + r2.y * z - corner.y) * inverse;
    const real gz = (r0.z * x + r1.z * y + r2.z * z - corner.z) * inverse;
    const whole inside = (gx >= 0.0f) & (gy >= 0.0f) & (gz >= 0.0f) & (gx < (float)(info->body_x - 1)) &
                         (gy < (float)(info->body_y - 1)) & (gz < (float)(info->body_z - 1));
    // Lanes outside read the first cell and forget it.
    const real sx = select((real)(0.0f), gx, inside), sy = select((real)(0.0f), gy, inside),
               sz = select((real)(0.0f), gz, inside);
    const whole ix = TO_WHOLE(sx), iy = TO_WHOLE(sy), iz = TO_WHOLE(sz);
    const real fx = sx - TO_REAL(ix), fy = sy - TO_REAL(iy), fz = sz - TO_REAL(iz);

    int cell[WIDTH];
    LANES_STORE(ix + info->body_x * (iy + info->body_y * iz), cell);
    float corners[8][WIDTH];
    const int row = info->body_x, plane = info->body_x * info->body_y;
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        global const float* from = body_distance + cell[lane];
        corners[0][lane] = from[0];
        corners[1][lane] = from[1];
        corners[2][lane] = from[row];
        corners[3][lane] = from[row + 1];
        corners[4][lane] = from[plane];
        corners[5][lane] = from[plane + 1];
        corners[6][lane] = from[plane + row];
        corners[7][lane] = from[plane + row + 1];
    }
    // Along x on the cell's four edges, then along y on two of its faces, then along z; each keeps its slope.
    const real v0 = LANES_LOAD(corners[0]), v2 = LANES_LOAD(corners[2]), v4 = LANES_LOAD(corners[4]),
               v6 = LANES_LOAD(corners[6]);
    const real e0 = LANES_LOAD(corners[1]) - v0, e1 = LANES_LOAD(corners[3]) - v2, e2 = LANES_LOAD(corners[5]) - v4,
               e3 = LANES_LOAD(corners[7]) - v6;
    const real a0 = v0 + fx * e0, a1 = v2 + fx * e1, a2 = v4 + fx * e2, a3 = v6 + fx * e3;
    const real b0 = a0 + fy * (a1 - a0), b1 = a2 + fy * (a3 - a2);
    const real slope_z = b1 - b0;
    const real slope_y = (1.0f - fz) * (a1 - a0) + fz * (a3 - a2);
    const real slope_x = (1.0f - fz) * (e0 + fy * (e1 - e0)) + fz * (e2 + fy * (e3 - e2));

    // The slope of a distance is 1, in voxels and in metres; less only where surfaces vie for the nearest.
    const real wx = r0.x * slope_x + r0.y * slope_y + r0.z * slope_z;
    const real wy = r1.x * slope_x + r1.y * slope_y + r1.z * slope_z;
    const real wz = r2.x * slope_x + r2.y * slope_y + r2.z * slope_z;
    const real squared = wx * wx + wy * wy + wz * wz;
    const whole slopes = inside & (squared > 1e-8f);
    const real shorten = INVERSE_SQRT(fmax(squared, (real)(1e-8f)));
    BodyPlane at;
    at.nx = select((real)(0.0f), wx * shorten, slopes);
    at.ny = select((real)(1.0f), wy * shorten, slopes);
    at.nz = select((real)(0.0f), wz * shorten, slopes);
    at.distance = select((real)(FAR_OUTSIDE), (b0 + fz * slope_z) * corner.w, inside);
    return at;
}

#endif

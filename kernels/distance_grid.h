// The head as a grid of signed distances to its surface (sim/distance_grid.h), for lanes. Samples lie on a lattice in
// the head's frame that info->body_corner and body_x, body_y, body_z place; body_distance holds them in voxels, so that
// head.scale moves and grows the grid without touching it; body_way holds which way is out on the whole at every
// second one, with a w of 0. Build option BODY_GRID says that there is one.
#ifndef COIF_DISTANCE_GRID_H
#define COIF_DISTANCE_GRID_H
#include "drawn_lanes.h"

#define FAR_OUTSIDE 1e6f // m: of what is no point

// The samples about a point of each lane: the lowest of the eight, and how far the point is on its way to the next
// ones.
typedef struct BodyCell
{
    int first[WIDTH];
    real fx, fy, fz;
    real away; // how far the point is from the lattice, in its spacings
} BodyCell;

// Of a point in the head's frame, m, on the lattice of every `stride`-th sample along each axis.
static inline BodyCell body_cell(Points p, int size_x, int size_y, int size_z, float stride, constant StepInfo* info)
{
    const float4 corner = info->body_corner;
    const float inverse = 1.0f / (stride * corner.w);
    const real gx = (p.x - corner.x) * inverse, gy = (p.y - corner.y) * inverse, gz = (p.z - corner.z) * inverse;
    // fmin and fmax leave the number of a number and a NaN, so whatever the lane holds, it reads within the grid.
    const real sx = fmin(fmax(gx, (real)(0.0f)), (real)(size_x - 1));
    const real sy = fmin(fmax(gy, (real)(0.0f)), (real)(size_y - 1));
    const real sz = fmin(fmax(gz, (real)(0.0f)), (real)(size_z - 1));
    const whole ix = min(TO_WHOLE(sx), (whole)(size_x - 2)), iy = min(TO_WHOLE(sy), (whole)(size_y - 2)),
                iz = min(TO_WHOLE(sz), (whole)(size_z - 2));
    BodyCell cell;
    LANES_STORE(ix + size_x * (iy + size_y * iz), cell.first);
    cell.fx = sx - TO_REAL(ix);
    cell.fy = sy - TO_REAL(iy);
    cell.fz = sz - TO_REAL(iz);
    cell.away = sqrt((gx - sx) * (gx - sx) + (gy - sy) * (gy - sy) + (gz - sz) * (gz - sz));
    return cell;
}

// From the world's axes to the head's frame, by the transposed rotation.
static inline Points turn_back_by(float4 r0, float4 r1, float4 r2, Points p)
{
    return points(r0.x * p.x + r1.x * p.y + r2.x * p.z, r0.y * p.x + r1.y * p.y + r2.y * p.z,
                  r0.z * p.x + r1.z * p.y + r2.z * p.z);
}

// Distance to the surface about a point in the head's frame, m: trilinear, and outside of the grid what its border has
// and the way there.
static inline real head_height(global const float* body_distance, Points p, constant StepInfo* info)
{
    const BodyCell cell = body_cell(p, info->body_x, info->body_y, info->body_z, 1.0f, info);
    const int row = info->body_x, plane = info->body_x * info->body_y;
    real v0, v1, v2, v3, v4, v5, v6, v7;
    gather_pair(body_distance, cell.first, &v0, &v1);
    gather_pair(body_distance + row, cell.first, &v2, &v3);
    gather_pair(body_distance + plane, cell.first, &v4, &v5);
    gather_pair(body_distance + plane + row, cell.first, &v6, &v7);
    const real below = mix(mix(v0, v1, cell.fx), mix(v2, v3, cell.fx), cell.fy);
    const real above = mix(mix(v4, v5, cell.fx), mix(v6, v7, cell.fx), cell.fy);
    const real distance = (mix(below, above, cell.fz) + cell.away) * info->body_corner.w;
    return select((real)(FAR_OUTSIDE), distance, distance < FAR_OUTSIDE);
}

// The same, and the unit normal of the plane that the surface is nearby, outwards in that frame: the gradient of just
// that distance. In a crease, where it vanishes, along the head's y.
LAID_IN real head_distance(global const float* body_distance, Points p, Points* normal, constant StepInfo* info)
{
    const BodyCell cell = body_cell(p, info->body_x, info->body_y, info->body_z, 1.0f, info);
    const real fx = cell.fx, fy = cell.fy, fz = cell.fz;
    const int row = info->body_x, plane = info->body_x * info->body_y;
    // Along x on the cell's four edges, then along y on two of its faces, then along z; each keeps its slope.
    real v0, v1, v2, v3, v4, v5, v6, v7;
    gather_pair(body_distance, cell.first, &v0, &v1);
    gather_pair(body_distance + row, cell.first, &v2, &v3);
    gather_pair(body_distance + plane, cell.first, &v4, &v5);
    gather_pair(body_distance + plane + row, cell.first, &v6, &v7);
    const real e0 = v1 - v0, e1 = v3 - v2, e2 = v5 - v4, e3 = v7 - v6;
    const real a0 = v0 + fx * e0, a1 = v2 + fx * e1, a2 = v4 + fx * e2, a3 = v6 + fx * e3;
    const real b0 = a0 + fy * (a1 - a0), b1 = a2 + fy * (a3 - a2);
    const real slope_z = b1 - b0;
    const real slope_y = (1.0f - fz) * (a1 - a0) + fz * (a3 - a2);
    const real slope_x = (1.0f - fz) * (e0 + fy * (e1 - e0)) + fz * (e2 + fy * (e3 - e2));

    // The slope of a distance is 1, in voxels and in metres; less only where surfaces vie for the nearest.
    const real squared = slope_x * slope_x + slope_y * slope_y + slope_z * slope_z;
    const real distance = (b0 + fz * slope_z + cell.away) * info->body_corner.w;
    const real shorten = INVERSE_SQRT(fmax(squared, (real)(1e-8f)));
    *normal = select_points(points((real)(0.0f), (real)(1.0f), (real)(0.0f)),
                            points(slope_x * shorten, slope_y * shorten, slope_z * shorten), squared > 1e-8f);
    return select((real)(FAR_OUTSIDE), distance, distance < FAR_OUTSIDE);
}

// The plane that the surface is nearby: unit normal, outwards, and how far above it a point is.
typedef struct BodyPlane
{
    real nx, ny, nz, distance;
} BodyPlane;

// At a point relative to the head's origin along the world's axes, m, at the end of the step.
LAID_IN BodyPlane body_plane(global const float* body_distance, real x, real y, real z, constant StepInfo* info)
{
    const float4 r0 = info->head_row0, r1 = info->head_row1, r2 = info->head_row2;
    Points normal;
    const real distance = head_distance(body_distance, turn_back_by(r0, r1, r2, points(x, y, z)), &normal, info);
    normal = turn_by(r0, r1, r2, normal);
    const BodyPlane plane = {normal.x, normal.y, normal.z, distance};
    return plane;
}

// Which way is out of the body on the whole, at points as above: unit length, along the world's axes.
LAID_IN void body_way_out(global const float4* body_way, real x, real y, real z, real* wx, real* wy, real* wz,
                          constant StepInfo* info)
{
    const int size_x = info->body_x / 2 + 1, size_y = info->body_y / 2 + 1, size_z = info->body_z / 2 + 1;
    const float4 r0 = info->head_row0, r1 = info->head_row1, r2 = info->head_row2;
    const BodyCell cell = body_cell(turn_back_by(r0, r1, r2, points(x, y, z)), size_x, size_y, size_z, 2.0f, info);
    float fx[WIDTH], fy[WIDTH], fz[WIDTH], way_x[WIDTH], way_y[WIDTH], way_z[WIDTH];
    LANES_STORE(cell.fx, fx);
    LANES_STORE(cell.fy, fy);
    LANES_STORE(cell.fz, fz);
    const int row = size_x, plane = size_x * size_y;
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        global const float4* from = body_way + cell.first[lane];
        const float4 below = mix(mix(from[0], from[1], fx[lane]), mix(from[row], from[row + 1], fx[lane]), fy[lane]);
        from += plane;
        const float4 above = mix(mix(from[0], from[1], fx[lane]), mix(from[row], from[row + 1], fx[lane]), fy[lane]);
        const float4 way = mix(below, above, fz[lane]);
        way_x[lane] = way.x;
        way_y[lane] = way.y;
        way_z[lane] = way.z;
    }
    const real x_in = LANES_LOAD(way_x), y_in = LANES_LOAD(way_y), z_in = LANES_LOAD(way_z);
    const real shorten = INVERSE_SQRT(fmax(x_in * x_in + y_in * y_in + z_in * z_in, (real)(1e-8f)));
    const Points way = turn_by(r0, r1, r2, points(x_in * shorten, y_in * shorten, z_in * shorten));
    *wx = way.x;
    *wy = way.y;
    *wz = way.z;
}

// Moves a node straight out of the body to the plane n . p = level.
static inline void push_above(real* x, real* y, real* z, real nx, real ny, real nz, real level)
{
    const real lift = fmax(level - (nx * *x + ny * *y + nz * *z), (real)(0.0f));
    *x += lift * nx;
    *y += lift * ny;
    *z += lift * nz;
}

#endif

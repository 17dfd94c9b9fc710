// The density grid: a cube of resolution^3 voxels about the head, along the world's axes (thesis 5.1.3). Values sit at
// the voxels' centres and are read and written trilinearly; the nearest voxel alone would make forces jump by half as
// the grid moves under the hair. Outside the grid there is no hair.
#ifndef COIF_GRID_H
#define COIF_GRID_H
#include "shared.h"

// The voxel below a point, and how far the point is on its way to the next one along each axis.
typedef struct GridPoint
{
    int voxel; // -1 outside
    int4 at;   // the same along x, y and z
    float fx, fy, fz;
} GridPoint;

static inline GridPoint grid_point(float x, float y, float z, constant StepInfo* info)
{
    const float inverse = 1.0f / info->grid_corner.w;
    const float gx = (x - info->grid_corner.x) * inverse - 0.5f;
    const float gy = (y - info->grid_corner.y) * inverse - 0.5f;
    const float gz = (z - info->grid_corner.z) * inverse - 0.5f;
    const float last = (float)(RESOLUTION - 1);
    GridPoint point = {-1, (int4)(0), 0.0f, 0.0f, 0.0f};
    // Written so that a NaN counts as outside.
    if (!(gx >= 0.0f && gy >= 0.0f && gz >= 0.0f && gx < last && gy < last && gz < last))
        return point;
    const int ix = (int)gx, iy = (int)gy, iz = (int)gz;
    point.voxel = ix + RESOLUTION * (iy + RESOLUTION * iz);
    point.at = (int4)(ix, iy, iz, 0);
    point.fx = gx - (float)ix;
    point.fy = gy - (float)iy;
    point.fz = gz - (float)iz;
    return point;
}

static inline float corner_weight(GridPoint p, int corner)
{
    return (corner & 1 ? p.fx : 1.0f - p.fx) * (corner & 2 ? p.fy : 1.0f - p.fy) * (corner & 4 ? p.fz : 1.0f - p.fz);
}

static inline int corner_voxel(GridPoint p, int corner)
{
    return p.voxel + (corner & 1 ? 1 : 0) + (corner & 2 ? RESOLUTION : 0) + (corner & 4 ? RESOLUTION * RESOLUTION : 0);
}

// Adds those nodes of WIDTH strands, from `strand` on, that feed the density; reads them where they have just been
// stored. `touched` holds the least x, y and z of all voxels that get some, and the least of their negatives.
static inline void add_strands_density(global int* density, global int* touched, global const float* position,
                                       int strand, constant StepInfo* info)
{
    int4 least = (int4)(RESOLUTION), least_negative = (int4)(RESOLUTION);
    for (int lane = 0; lane < WIDTH && strand + lane < info->guides; ++lane)
        for (int i = density_first(strand + lane, info->density_stride); i < NODES; i += info->density_stride)
        {
            global const float* at = position + strand_value(strand + lane, i, 0, NODES);
            const GridPoint p = grid_point(at[0], at[LANES], at[2 * LANES], info);
            if (p.voxel < 0)
                continue;
            for (int corner = 0; corner < 8; ++corner)
                atomic_add(&density[corner_voxel(p, corner)],
                           convert_int_rte(corner_weight(p, corner) * (float)info->density_unit));
            least = min(least, p.at);
            least_negative = min(least_negative, -1 - p.at);
        }
    if (least.x == RESOLUTION)
        return;
    atomic_min(&touched[0], least.x);
    atomic_min(&touched[1], least.y);
    atomic_min(&touched[2], least.z);
    atomic_min(&touched[3], least_negative.x);
    atomic_min(&touched[4], least_negative.y);
    atomic_min(&touched[5], least_negative.z);
}

#endif

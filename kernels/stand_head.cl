// The head's distance grid as light is stopped by it, by the rule of add_bodies.cl: opaque from 0.7 voxels under its
// surface on, with an edge one voxel soft.
//
// Most of the grid is far from the surface, so a work-item takes WIDTH bricks side by side along x, looks at their
// middles, and only where the surface may pass through a brick at its voxels.
#include "distance_grid.h"

#define BRICK 4
#define BRICKS ((RESOLUTION + BRICK - 1) / BRICK)
#define BRICK_VOXELS (BRICK * BRICK * BRICK)
#define TO_EDGE 2.598f // voxels from a brick's middle to the centre of its outermost voxel, 1.5 sqrt(3)

// How much of the light the head stops at voxels' places, given in voxels, or what that is before it is cut off to
// between nothing and all.
static inline real depth_in_head(global const float* body_distance, Points at, constant StepInfo* info)
{
    const float4 corner = info->grid_corner;
    const Points p = points(corner.x + corner.w * at.x, corner.y + corner.w * at.y, corner.z + corner.w * at.z);
    const Points turned = turn_back_by(info->head_row0, info->head_row1, info->head_row2, p);
    return -0.2f - head_height(body_distance, turned, info) / corner.w;
}

// WIDTH voxels of a brick, from its voxel `begin` on, along x, then y, then z.
static inline void store_voxels(whole values, int begin, int bx, int by, int bz, global int* in_head)
{
    int value[WIDTH];
    LANES_STORE(values, value);
#pragma unroll
    for (int lane = 0; lane < WIDTH; lane += WIDTH < BRICK ? 1 : BRICK)
    {
        const int x = BRICK * bx + (begin + lane) % BRICK, y = BRICK * by + (begin + lane) / BRICK % BRICK;
        const int z = BRICK * bz + (begin + lane) / BRICK / BRICK;
        global int* to = in_head + (z * RESOLUTION + y) * RESOLUTION + x;
#if WIDTH >= BRICK && RESOLUTION % BRICK == 0
        vstore4(vload4(0, value + lane), 0, to);
#else
        for (int i = 0; i < (WIDTH < BRICK ? 1 : BRICK); ++i)
            if (x + i < RESOLUTION && y < RESOLUTION && z < RESOLUTION)
                to[i] = value[lane + i];
#endif
    }
}

// `head_touched`: the least x, y and z of all voxels that may hold some of the head, and the least of their negatives.
kernel void stand_head(global int* in_head, global int* head_touched, global const float* body_distance,
                       constant StepInfo* info)
{
    const int first = (int)get_global_id(0) * WIDTH, by = get_global_id(1), bz = get_global_id(2);
    const float opaque = (float)info->body_density;
    float x[WIDTH], y[WIDTH], z[WIDTH], depth[WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        x[lane] = (float)(BRICK * (first + lane)) + 0.5f * BRICK;
    const Points middles = points(LANES_LOAD(x), (real)((float)(BRICK * by) + 0.5f * BRICK),
                                  (real)((float)(BRICK * bz) + 0.5f * BRICK));
    LANES_STORE(depth_in_head(body_distance, middles, info), depth);
    // Samples of a distance differ by no more than their spacing. What lies between them is no steeper than sqrt(3),
    // and no further from the distance itself than half a cell's diagonal.
    const float unevenness = 1.733f * info->body_corner.w / info->grid_corner.w;
    const float most = fmin(1.733f * TO_EDGE, TO_EDGE + unevenness);

    int left = BRICKS, right = -1; // bricks that may hold some
    for (int brick = 0; brick < WIDTH && first + brick < BRICKS; ++brick)
    {
        const float middle = depth[brick];
        const int through = fabs(middle - 0.5f) < most + 0.5f;
        if (through || middle > 0.0f)
        {
            left = min(left, first + brick);
            right = first + brick;
        }
        for (int begin = 0; begin < BRICK_VOXELS; begin += WIDTH)
        {
            real share = (real)(middle > 0.0f ? opaque : 0.0f);
            if (through)
            {
#pragma unroll
                for (int lane = 0; lane < WIDTH; ++lane)
                {
                    x[lane] = (float)((begin + lane) % BRICK) + 0.5f;
                    y[lane] = (float)((begin + lane) / BRICK % BRICK) + 0.5f;
                    z[lane] = (float)((begin + lane) / BRICK / BRICK) + 0.5f;
                }
                const Points at = points((float)(BRICK * (first + brick)) + LANES_LOAD(x),
                                         (float)(BRICK * by) + LANES_LOAD(y), (float)(BRICK * bz) + LANES_LOAD(z));
                share = opaque * clamp(depth_in_head(body_distance, at, info), (real)(0.0f), (real)(1.0f));
            }
            store_voxels(TO_WHOLE(share), begin, first + brick, by, bz, in_head);
        }
    }
    if (right < 0)
        return;
    const int last = RESOLUTION - 1, beyond = BRICK - 1;
    atomic_min(&head_touched[0], BRICK * left);
    atomic_min(&head_touched[1], BRICK * by);
    atomic_min(&head_touched[2], BRICK * bz);
    atomic_min(&head_touched[3], -min(last, BRICK * right + beyond));
    atomic_min(&head_touched[4], -min(last, BRICK * by + beyond));
    atomic_min(&head_touched[5], -min(last, BRICK * bz + beyond));
}

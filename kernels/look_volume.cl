// The volume that light is followed through, plane after plane of all voxels: fibre per cubic metre times the way it
// runs (x, y, z), fibre (length times width, 1/m), and what of that are bodies. They count as fibre without a way, more
// so over two voxels from 0.7 under their surface on: harder edges would show as teeth, nearer ones would darken the
// roots. Work-item: WIDTH voxels along x.
#include "look.h"
#include "distance_grid.h"

kernel void look_volume(global const int4* fibre_sums, global float* fibre, constant LookVolume* volume,
                        constant Capsule* colliders, constant StepInfo* info
#ifdef BODY_GRID
                        ,
                        global const float* body_distance
#endif
)
{
    const int first = (int)get_global_id(0) * WIDTH;
    const int row = ((int)get_global_id(2) * volume->y + (int)get_global_id(1)) * volume->x, all = volume_voxels(volume);
    const float4 corner = volume->corner;
    float sums[4][WIDTH];
    const float to_density = 1.0f / (volume->unit * corner.w);
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        int4 sum = (int4)(0);
        for (int copy = 0; copy < volume->copies; ++copy)
            sum += fibre_sums[(size_t)copy * (size_t)all + (size_t)(row + first + lane)];
        sums[0][lane] = (float)sum.x * to_density;
        sums[1][lane] = (float)sum.y * to_density;
        sums[2][lane] = (float)sum.z * to_density;
        sums[3][lane] = (float)sum.w * to_density;
    }

    const float y = corner.y + ((float)get_global_id(1) + 0.5f) * corner.w;
    const float z = corner.z + ((float)get_global_id(2) + 0.5f) * corner.w;
    float places_x[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
        places_x[lane] = corner.x + ((float)(first + lane) + 0.5f) * corner.w;
    const real x = LANES_LOAD(places_x);
    real inside = (real)(0.0f); // voxels under a surface
    for (int i = 0; i < info->colliders; ++i)
    {
        const Capsule c = colliders[i];
        const real dx = x - c.center.x;
        const float dy = y - c.center.y, dz = z - c.center.z;
        const real on = clamp((dx * c.axis.x + dy * c.axis.y + dz * c.axis.z) * c.axis.w, (real)(0.0f), (real)(1.0f));
        const real ax = dx - on * c.axis.x, ay = dy - on * c.axis.y, az = dz - on * c.axis.z;
        inside = fmax(inside, (c.center.w - sqrt(ax * ax + ay * ay + az * az)) / corner.w);
    }
#ifdef BODY_GRID
    inside = fmax(inside, -body_plane(body_distance, x, (real)(y), (real)(z), info).distance / corner.w);
#endif
    const real body = fmin(fmax(0.5f * inside - 0.35f, (real)(0.0f)), (real)(1.0f)) *
                      (BODY_DEPTH / (0.785398163f * corner.w)); // look_extinction.cl
    for (int axis = 0; axis < 3; ++axis)
        LANES_STORE(LANES_LOAD(sums[axis]), fibre + axis * all + row + first);
    LANES_STORE(LANES_LOAD(sums[3]) + body, fibre + 3 * all + row + first);
    LANES_STORE(body, fibre + 4 * all + row + first);
}

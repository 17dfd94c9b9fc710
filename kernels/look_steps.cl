// What a step of a coarse voxel's side leaves of light: bodies; hair, in red, green and blue, as look_sky.cl has it to
// all orders; and how deep the hair is. Five planes of all voxels and STEPS empty ones around
// them, so that neighbours of voxels side by side lie side by side, too. A voxel is as opaque as it is full of bodies.
// Work-item: a row along x of these.
#include "look.h"

kernel void look_steps(global const float* coarse_fibre, global float* steps, constant LookVolume* coarse_volume,
                       constant HairParams* params, global const float4* forward)
{
    const int row = coarse_volume->x + 2 * STEPS, rows = coarse_volume->y + 2 * STEPS;
    const int all = row * rows * (coarse_volume->z + 2 * STEPS), item = (int)get_global_id(0);
    if (item * row >= all)
        return;
    global float* to = steps + item * row;
    for (int i = 0; i < row; ++i)
    {
        to[i] = to[all + i] = to[2 * all + i] = to[3 * all + i] = 1.0f;
        to[4 * all + i] = 0.0f;
    }
    const int y = item % rows - STEPS, z = item / rows - STEPS;
    if (y < 0 || z < 0 || y >= coarse_volume->y || z >= coarse_volume->z)
        return;
    to += STEPS;
    const int voxels = volume_voxels(coarse_volume), own = (z * coarse_volume->y + y) * coarse_volume->x;
    const float side = 0.785398163f * coarse_volume->corner.w; // look_extinction.cl
    const float4 taken = SKIN_TAKEN * fmin(forward[1] - 1.0f, 0.0f);
    for (int x = 0; x < coarse_volume->x; ++x)
    {
        const float body = coarse_fibre[4 * voxels + own + x];
        const float hair = fmax(coarse_fibre[3 * voxels + own + x] - body, 0.0f);
        if (!(body > 0.0f || hair > 0.0f))
            continue;
        const float depth = params->look_self_shadow * side * hair;
        const float open = 1.0f - clamp(side * body / (BODY_DEPTH * (float)COARSE), 0.0f, 1.0f);
        const float4 left = exp(depth * taken);
        to[x] = open;
        to[all + x] = left.x;
        to[2 * all + x] = left.y;
        to[3 * all + x] = left.z;
        to[4 * all + x] = depth;
    }
}

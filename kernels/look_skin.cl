// What the skin in each coarse voxel sends out in red, green and blue, behind the voxel's own hair: three planes as
// look_steps has them. A voxel without a point of skin has that of the next with one: a body lies deeper than its skin.
// Work-item: a row along x of these.
#include "look.h"

// Of 27 voxels the nearest one's point; -1: none.
static inline int nearest_skin(global const int* skin_in, int x, int y, int z, constant LookVolume* volume)
{
    int found = -1, nearest = 4;
    for (int k = max(z - 1, 0); k <= min(z + 1, volume->z - 1); ++k)
        for (int j = max(y - 1, 0); j <= min(y + 1, volume->y - 1); ++j)
            for (int i = max(x - 1, 0); i <= min(x + 1, volume->x - 1); ++i)
            {
                const int far = (i - x) * (i - x) + (j - y) * (j - y) + (k - z) * (k - z);
                const int there = skin_in[(k * volume->y + j) * volume->x + i];
                if (there >= 0 && far < nearest)
                {
                    found = there;
                    nearest = far;
                }
            }
    return found;
}

kernel void look_skin(global const float* steps, global const int* skin_in, global const float4* lit,
                      global float* skin_light, constant LookVolume* coarse_volume)
{
    const int row = coarse_volume->x + 2 * STEPS, rows = coarse_volume->y + 2 * STEPS;
    const int all = row * rows * (coarse_volume->z + 2 * STEPS), item = (int)get_global_id(0);
    if (item * row >= all)
        return;
    const int first = item * row;
    for (int i = first; i < first + row; ++i)
        skin_light[i] = skin_light[all + i] = skin_light[2 * all + i] = 0.0f;
    const int y = item % rows - STEPS, z = item / rows - STEPS;
    if (y < 0 || z < 0 || y >= coarse_volume->y || z >= coarse_volume->z)
        return;
    for (int x = 0; x < coarse_volume->x; ++x)
    {
        const int at = first + STEPS + x;
        const float open = steps[at];
        const int skin = open < 1.0f ? nearest_skin(skin_in, x, y, z, coarse_volume) : -1;
        if (skin < 0)
            continue;
        const float4 light = (1.0f - open) * lit[skin];
        skin_light[at] = light.x * steps[all + at];
        skin_light[all + at] = light.y * steps[2 * all + at];
        skin_light[2 * all + at] = light.z * steps[3 * all + at];
    }
}

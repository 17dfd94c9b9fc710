// The mean of COARSE^3 voxels, for the sky's rays. Work-item: a coarse voxel; of those beyond the volume there is none.
#include "look.h"

kernel void look_coarse(global const float* fibre, global float* coarse_fibre, constant LookVolume* volume,
                        constant LookVolume* coarse_volume)
{
    const int all = volume_voxels(volume), all_coarse = volume_voxels(coarse_volume);
    const int voxel = (int)get_global_id(0);
    if (voxel >= all_coarse)
        return;
    const int x = voxel % coarse_volume->x, y = voxel / coarse_volume->x % coarse_volume->y;
    const int z = voxel / (coarse_volume->x * coarse_volume->y);
    float4 sum = (float4)(0.0f);
    float body = 0.0f;
    for (int k = z * COARSE; k < min((z + 1) * COARSE, volume->z); ++k)
        for (int j = y * COARSE; j < min((y + 1) * COARSE, volume->y); ++j)
            for (int i = x * COARSE; i < min((x + 1) * COARSE, volume->x); ++i)
            {
                const int at = (k * volume->y + j) * volume->x + i;
                body += fibre[4 * all + at];
                sum += (float4)(fibre[at], fibre[all + at], fibre[2 * all + at], fibre[3 * all + at]);
            }
    const float share = 1.0f / (float)(COARSE * COARSE * COARSE);
    sum *= share;
    coarse_fibre[voxel] = sum.x;
    coarse_fibre[all_coarse + voxel] = sum.y;
    coarse_fibre[2 * all_coarse + voxel] = sum.z;
    coarse_fibre[3 * all_coarse + voxel] = sum.w;
    coarse_fibre[4 * all_coarse + voxel] = body * share;
}

// One axis of a box blur of the density: three runs, along x, y and z, equal the cube. The box is so many whole voxels
// to each side and a part of the next, which gives it any variance (Gwosdek, Grewenig, Bruhn, Weickert. Theoretical
// foundations of Gaussian convolution by extended box filtering. 2011): a width in metres asks for no whole voxels.
// Beyond the grid the density is zero.
//
// AXIS is 0, 1 or 2; BOX is one of StepInfo's; CHUNK voxels along x make a work-item.
#include "chunk.h"

kernel void blur_density(global const int* density, global int* blurred, constant int* room, constant StepInfo* info)
{
    const int x = get_global_id(0) * CHUNK, y = get_global_id(1), z = get_global_id(2);
    if (out_of_room(room, x, y, z))
        return;
    const int i = (z * RESOLUTION + y) * RESOLUTION + x, reach = (int)info->BOX.x;
    chunk sum = CHUNK_LOAD(density + i), ends = (chunk)(0);
#if AXIS == 0
    chunk left = sum, right = sum;
    for (int k = 1; k <= reach + 1; ++k)
    {
        sum += ends;
        left = CHUNK_UP(x >= k ? density[i - k] : 0, left);
        right = CHUNK_DOWN(right, x + CHUNK - 1 + k < RESOLUTION ? density[i + CHUNK - 1 + k] : 0);
        ends = left + right;
    }
#else
    const int along = AXIS == 1 ? y : z;
    const int stride = AXIS == 1 ? RESOLUTION : RESOLUTION * RESOLUTION;
    for (int k = 1; k <= reach + 1; ++k)
    {
        sum += ends;
        ends = (chunk)(0);
        if (along >= k)
            ends += CHUNK_LOAD(density + i - k * stride);
        if (along + k < RESOLUTION)
            ends += CHUNK_LOAD(density + i + k * stride);
    }
#endif
    CHUNK_STORE(CHUNK_ROUND(info->BOX.y * CHUNK_TO_REAL(sum) + info->BOX.z * CHUNK_TO_REAL(ends)), blurred + i);
}

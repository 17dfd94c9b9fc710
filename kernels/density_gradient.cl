// Central difference of the density (thesis eq. 5.8 and listing 5.3), in fixed-point units a voxel. Beyond the grid the
// density is zero. CHUNK voxels along x make a work-item; the three components lie one after the other.
#include "chunk.h"

kernel void density_gradient(global const int* density, global float* gradient, constant int* room)
{
    const int x = get_global_id(0) * CHUNK, y = get_global_id(1), z = get_global_id(2);
    if (out_of_room(room, x, y, z))
        return;
    const int i = (z * RESOLUTION + y) * RESOLUTION + x;
    const int plane = RESOLUTION * RESOLUTION, all = plane * RESOLUTION;
    const chunk zero = (chunk)(0);

    const chunk here = CHUNK_LOAD(density + i);
    const chunk left = CHUNK_UP(x > 0 ? density[i - 1] : 0, here);
    const chunk right = CHUNK_DOWN(here, x + CHUNK < RESOLUTION ? density[i + CHUNK] : 0);
    const chunk below = y > 0 ? CHUNK_LOAD(density + i - RESOLUTION) : zero;
    const chunk above = y + 1 < RESOLUTION ? CHUNK_LOAD(density + i + RESOLUTION) : zero;
    const chunk behind = z > 0 ? CHUNK_LOAD(density + i - plane) : zero;
    const chunk before = z + 1 < RESOLUTION ? CHUNK_LOAD(density + i + plane) : zero;

    CHUNK_STORE_REAL(0.5f * CHUNK_TO_REAL(right - left), gradient + i);
    CHUNK_STORE_REAL(0.5f * CHUNK_TO_REAL(above - below), gradient + all + i);
    CHUNK_STORE_REAL(0.5f * CHUNK_TO_REAL(before - behind), gradient + 2 * all + i);
}

// Central difference of the density (thesis eq. 5.8 and listing 5.3), in fixed-point units a voxel. Beyond the grid the
// density is zero. CHUNK voxels along x make a work-item; the three components lie one after the other.
#include "shared.h"

#if CHUNK == 16
typedef int16 chunk;
#define LOAD(p) vload16(0, p)
#define STORE(v, p) vstore16(convert_float16(v) * 0.5f, 0, p)
#elif CHUNK == 8
typedef int8 chunk;
#define LOAD(p) vload8(0, p)
#define STORE(v, p) vstore8(convert_float8(v) * 0.5f, 0, p)
#else
typedef int chunk;
#define LOAD(p) (*(p))
#define STORE(v, p) (*(p) = convert_float(v) * 0.5f)
#endif

kernel void density_gradient(global const int* density, global float* gradient)
{
    const int i = get_global_id(0) * CHUNK;
    const int x = i % RESOLUTION, y = i / RESOLUTION % RESOLUTION, z = i / RESOLUTION / RESOLUTION;
    const int plane = RESOLUTION * RESOLUTION, all = plane * RESOLUTION;
    const chunk zero = (chunk)(0);

    int row[CHUNK + 2];
    row[0] = x > 0 ? density[i - 1] : 0;
    row[CHUNK + 1] = x + CHUNK < RESOLUTION ? density[i + CHUNK] : 0;
    for (int k = 0; k < CHUNK; ++k)
        row[k + 1] = density[i + k];
    const chunk left = LOAD(row), right = LOAD(row + 2);
    const chunk below = y > 0 ? LOAD(density + i - RESOLUTION) : zero;
    const chunk above = y + 1 < RESOLUTION ? LOAD(density + i + RESOLUTION) : zero;
    const chunk behind = z > 0 ? LOAD(density + i - plane) : zero;
    const chunk before = z + 1 < RESOLUTION ? LOAD(density + i + plane) : zero;

    STORE(right - left, gradient + i);
    STORE(above - below, gradient + all + i);
    STORE(before - behind, gradient + 2 * all + i);
}

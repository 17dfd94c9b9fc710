// One axis of the 27-voxel box blur (thesis 5.1.3): three runs, along x, y and z, equal the cube. In fixed point, so
// that the result does not hang on the order of anything.
//
// AXIS is 0, 1 or 2; CHUNK voxels along x make a work-item.
#include "chunk.h"

// A third of a sum of voxels, rounded; exact for what is not negative.
static inline chunk third(chunk sum) { return mul_hi(sum + 1, (chunk)(0x55555556)); }

kernel void blur_density(global const int* density, global int* blurred)
{
    const int i = get_global_id(0) * CHUNK;
    const int x = i % RESOLUTION, y = i / RESOLUTION % RESOLUTION, z = i / RESOLUTION / RESOLUTION;
#if AXIS == 0
    // Neighbours along x may lie outside the chunk, and outside the row at its ends.
    int row[CHUNK + 2];
    CHUNK_STORE(CHUNK_LOAD(density + i), row + 1);
    row[0] = x > 0 ? density[i - 1] : 0;
    row[CHUNK + 1] = x + CHUNK < RESOLUTION ? density[i + CHUNK] : 0;
    const chunk sum = CHUNK_LOAD(row) + CHUNK_LOAD(row + 1) + CHUNK_LOAD(row + 2);
#else
    const int along = AXIS == 1 ? y : z;
    const int stride = AXIS == 1 ? RESOLUTION : RESOLUTION * RESOLUTION;
    chunk sum = CHUNK_LOAD(density + i);
    if (along > 0)
        sum += CHUNK_LOAD(density + i - stride);
    if (along + 1 < RESOLUTION)
        sum += CHUNK_LOAD(density + i + stride);
#endif
    CHUNK_STORE(third(sum), blurred + i);
}

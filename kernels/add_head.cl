// Hair and head together, as light meets them. Work-item: CHUNK voxels along x.
#include "chunk.h"

kernel void add_head(global const int* density, global const int* in_head, global int* occupied,
                     constant int* light_room)
{
    const int x = get_global_id(0) * CHUNK, y = get_global_id(1), z = get_global_id(2);
    if (out_of_room(light_room + 6, x, y, z))
        return;
    const int i = (z * RESOLUTION + y) * RESOLUTION + x;
    CHUNK_STORE(max(CHUNK_LOAD(density + i), CHUNK_LOAD(in_head + i)), occupied + i);
}

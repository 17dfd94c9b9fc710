// Sets to zero what is left of the last step's density (thesis, listing 5.2). Work-item: CHUNK voxels along x.
#include "chunk.h"

kernel void clear_density(global int* density, constant int* room)
{
    const int x = get_global_id(0) * CHUNK, y = get_global_id(1), z = get_global_id(2);
    if (!out_of_room(room, x, y, z))
        CHUNK_STORE((chunk)(0), density + (z * RESOLUTION + y) * RESOLUTION + x);
}

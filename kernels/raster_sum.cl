// Where each chunk's pieces begin within a tile's, and how many that has. Work-item: a tile.
#include "raster.h"

kernel void raster_sum(global int* counts, global int* tile_count, constant RasterFrame* frame)
{
    const int tile = get_global_id(0), tiles = frame->tiles_x * frame->tiles_y;
    if (tile >= tiles)
        return;
    int sum = 0;
    for (int chunk = 0; chunk < frame->chunks; ++chunk)
    {
        const int own = counts[chunk * tiles + tile];
        counts[chunk * tiles + tile] = sum;
        sum += own;
    }
    tile_count[tile] = sum;
}

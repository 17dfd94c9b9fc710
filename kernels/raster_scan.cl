// Where each tile's pieces begin, and behind the last where they end. One work-item.
#include "raster.h"

kernel void raster_scan(global const int* tile_count, global int* tile_begin, constant RasterFrame* frame)
{
    int sum = 0;
    for (int tile = 0; tile < frame->tiles_x * frame->tiles_y; ++tile)
    {
        tile_begin[tile] = sum;
        sum += tile_count[tile];
    }
    tile_begin[frame->tiles_x * frame->tiles_y] = sum;
}

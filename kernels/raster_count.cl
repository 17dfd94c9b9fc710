// How many pieces of each chunk of points meet each tile. Work-item: a chunk.
#include "raster.h"

kernel void raster_count(global const float* points, global int* counts, constant RasterFrame* frame)
{
    const int chunk = get_global_id(0);
    if (chunk >= frame->chunks)
        return;
    const int tiles = frame->tiles_x * frame->tiles_y;
    global int* own = counts + chunk * tiles;
    for (int tile = 0; tile < tiles; ++tile)
        own[tile] = 0;
    const int2 pieces = chunk_pieces(chunk, frame);
    if (pieces.x >= pieces.y)
        return;
    float8 a = vload8(pieces.x, points);
    for (int i = pieces.x; i < pieces.y; ++i)
    {
        const float8 b = vload8(i + 1, points);
        const int4 at = piece_tiles(a, b, piece_bounds(a, b), frame);
        for (int y = at.z; y <= at.w; ++y)
            for (int x = at.x; x <= at.y; ++x)
                ++own[y * frame->tiles_x + x];
        a = b;
    }
}

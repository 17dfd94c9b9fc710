// The pieces tile by tile, in the order of their points. Work-item: a chunk, as raster_count has them.
#include "raster.h"

kernel void raster_fill(global const float* points, global int* counts, global const int* tile_begin,
                        global RasterPiece* binned, constant RasterFrame* frame)
{
    const int chunk = get_global_id(0);
    if (chunk >= frame->chunks)
        return;
    global int* own = counts + chunk * frame->tiles_x * frame->tiles_y;
    const int2 pieces = chunk_pieces(chunk, frame);
    if (pieces.x >= pieces.y)
        return;
    float8 a = vload8(pieces.x, points);
    for (int i = pieces.x; i < pieces.y; ++i)
    {
        const float8 b = vload8(i + 1, points);
        const float4 bounds = piece_bounds(a, b);
        const int4 at = piece_tiles(a, b, bounds, frame);
        RasterPiece piece;
        piece.depth = as_uint(0.5f * (a.s2 + b.s2));
        piece.point = i;
        for (int y = at.z; y <= at.w; ++y)
            for (int x = at.x; x <= at.y; ++x)
            {
                const int tile = y * frame->tiles_x + x;
                piece.cells = piece_cells(bounds, x * TILE, y * TILE);
                binned[tile_begin[tile] + own[tile]++] = piece;
            }
        a = b;
    }
}

// The pieces of a tile from near to far: by the upper 16 bits of where each lies between the nearest and the farthest,
// least significant byte first, so that those which are equal keep their order. Work-item: a tile.
#include "raster.h"

static inline void sort_by(global const RasterPiece* from, global RasterPiece* to, int count, uint least, uint down,
                           uint byte)
{
    int begin[256];
    for (int i = 0; i < 256; ++i)
        begin[i] = 0;
    for (int i = 0; i < count; ++i)
        ++begin[((from[i].depth - least) >> down >> byte) & 255u];
    int sum = 0;
    for (int i = 0; i < 256; ++i)
    {
        const int own = begin[i];
        begin[i] = sum;
        sum += own;
    }
    for (int i = 0; i < count; ++i)
    {
        const RasterPiece piece = from[i];
        to[begin[((piece.depth - least) >> down >> byte) & 255u]++] = piece;
    }
}

kernel void raster_sort(global RasterPiece* binned, global RasterPiece* half_sorted, global const int* tile_begin,
                        constant RasterFrame* frame)
{
    const int tile = get_global_id(0);
    if (tile >= frame->tiles_x * frame->tiles_y)
        return;
    const int begin = tile_begin[tile], count = tile_begin[tile + 1] - begin;
    if (count < 2)
        return;
    uint least = 0xffffffffu, most = 0u;
    for (int i = 0; i < count; ++i)
    {
        least = min(least, binned[begin + i].depth);
        most = max(most, binned[begin + i].depth);
    }
    const uint down = max(16, 32 - (int)clz(most - least)) - 16;
    sort_by(binned + begin, half_sorted + begin, count, least, down, 0);
    sort_by(half_sorted + begin, binned + begin, count, least, down, 8);
}

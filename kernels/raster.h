// The strand rasteriser's contract between host and device, and what its passes share. It draws drawn strands into
// tiles of the picture, in the GL's window coordinates: y up, depth 0 at the near plane and 1 at the far one.
//
//   raster_solids    how far the solid things in each block of pixels are
//   raster_measure   how many pieces each segment is cut into, none where it is not seen
//   raster_points    the curves' points, placed, shaded and projected
//   raster_count     how many pieces meet each tile, chunk of points by chunk
//   raster_sum       where each chunk's pieces begin within a tile's
//   raster_scan      where each tile's begin
//   raster_fill      the pieces, tile by tile
//   raster_sort      those of a tile from near to far
//   raster_compose   what they make of the tile's pixels
//
// No pass adds in an order that hangs on the hour: chunks fill their own places, and equal depths keep their order.
#ifndef COIF_RASTER_H
#define COIF_RASTER_H
#include "shared.h"

#define TILE 64  // pixels a side
#define BLOCK 16 // pixels a side of what is hidden or not

#define MOST_PIECES 30

// A number in [0, 1) of each strand, of which some are drawn: those below the share. It hangs on nothing but the
// strand's number, and any number of neighbours is evenly spread (Weyl's sequence of the golden section).
#define STRAND_TURN(strand) ((float)(((unsigned)(strand)*2654435769u) >> 8) * (1.0f / 16777216.0f))
#define RAMP 64 // colours that tell a value

#ifdef __cplusplus
namespace coif
{
#endif

typedef struct RasterFrame
{
    float4 clip_x, clip_y, clip_z, clip_w; // rows: from about the head's origin, m, to clip space
    float4 eye;                            // m; w: metres that a pixel covers at a distance of one metre
    float near;                            // m
    float depth_at_infinity, depth_over;   // depth in the window: the first plus the second over the distance
    float kept;                            // share of the strands that are drawn, each as much wider
    int width, height;                     // pixels
    int tiles_x, tiles_y;
    int blocks_x, blocks_y;
    int strands; // drawn strands that there are
    int braided; // of them, that may be; they come first
    int listed;  // strands of this batch
    int points;  // of this batch
    int chunks;  // that they are counted in
    int later;   // is there a picture of nearer strands already?
} RasterFrame;

// A strand of a batch and where its points go.
typedef struct RasterStrand
{
    int strand, first;
} RasterStrand;

// A piece of a curve in a tile: from its point to the next.
typedef struct RasterPiece
{
    unsigned depth; // bits of a float of the middle's, which order as the depths do
    int point;
    int cells; // of the tile, that it may touch: first and last column, first and last row, a byte each
} RasterPiece;

#define CELL 4 // pixels a side

// Across a strand, from its right to its left as it runs up the picture, that light is told apart in where strands are
// wide (NEAR_FIELD), and so many halves of a point: red of each, green, blue.
#define NEAR_CELLS 16
#define NEAR_LIGHT (3 * NEAR_CELLS)

#ifdef __cplusplus
} // namespace coif
#else

// A point: x, y, depth, width in pixels; red and green as halves, blue and opacity; the direction across which one
// piece ends and the next begins. Halves hold no negative numbers, so that their signs are free for marks. A point
// whose x is no number is none.
#define MARK_LAST 0x80000000u // of opacity's: no piece begins here
#define MARK_TIP 0x8000u      // of blue's: the strand ends here
#define MARK_ROOT 0x80000000u // of green's: it begins here

// Halves without a sign, from and to numbers below 65504; what is below 2^-14 is nothing.
#define TO_HALF(bits_of_scaled) (((bits_of_scaled) + 0x1000u) >> 13)
#define HALF_SCALE 1.92592994e-34f // 2^-112
static inline float from_half(uint half_bits) { return as_float((half_bits & 0x7fffu) << 13) * 5.19229686e33f; }

// Pixels that two points' ribbon may touch: lowest x, highest x, lowest y, highest y.
static inline float4 piece_bounds(float8 a, float8 b)
{
    // As far out as half its width and half a pixel. Across a steep piece it ends where its corners are, which lie
    // further out where the strand turns.
    const float out = 0.5f * max(a.s3, b.s3) + 0.5f;
    const float dx = b.s0 - a.s0, dy = b.s1 - a.s1, size = sqrt(dx * dx + dy * dy);
    const float over_a = size * out / max(fabs(a.s6 * dx + a.s7 * dy), 0.1f * size + 1e-9f);
    const float over_b = size * out / max(fabs(b.s6 * dx + b.s7 * dy), 0.1f * size + 1e-9f);
    const float up_a = as_uint(a.s4) & MARK_ROOT ? out : min(out, fabs(a.s6) * over_a);
    const float up_b = as_uint(b.s5) & MARK_TIP ? out : min(out, fabs(b.s6) * over_b);
    return (float4)(min(a.s0, b.s0) - out, max(a.s0, b.s0) + out, min(a.s1 - up_a, b.s1 - up_b),
                    max(a.s1 + up_a, b.s1 + up_b));
}

// Pieces of a chunk: the first, and the one after the last.
static inline int2 chunk_pieces(int chunk, constant RasterFrame* frame)
{
    const int each = (frame->points + frame->chunks - 1) / frame->chunks;
    return (int2)(chunk * each, min((chunk + 1) * each, frame->points - 1));
}

// Those of a tile, which begins at (x, y), as RasterPiece has them.
static inline int piece_cells(float4 bounds, int x, int y)
{
    const float4 from = (float4)((float)x, (float)x, (float)y, (float)y);
    const int4 at = convert_int4(clamp(bounds - from, 0.0f, (float)(TILE - 1))) / CELL;
    return at.x | at.y << 8 | at.z << 16 | at.w << 24;
}

// Tiles that a piece may touch: first x, last x, first y, last y; the first beyond the last if none.
static inline int4 piece_tiles(float8 a, float8 b, float4 bounds, constant RasterFrame* frame)
{
    if ((as_uint(a.s5) & MARK_LAST) || isnan(a.s0) || isnan(b.s0))
        return (int4)(0, -1, 0, -1);
    if (!(bounds.x < (float)frame->width && bounds.y > 0.0f && bounds.z < (float)frame->height && bounds.w > 0.0f))
        return (int4)(0, -1, 0, -1);
    const float4 in_tiles = clamp(bounds, 0.0f, 16384.0f) * (1.0f / TILE);
    return (int4)((int)in_tiles.x, min((int)in_tiles.y, frame->tiles_x - 1), (int)in_tiles.z,
                  min((int)in_tiles.w, frame->tiles_y - 1));
}

#endif
#endif

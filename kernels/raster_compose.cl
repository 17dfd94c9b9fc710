// A tile's pixels from its pieces, from near to far: each covers what those before it have left open, until nothing is.
// What is solid hides what lies behind it. Work-item: BAND rows of a tile; lanes: a square of pixels.
//
// A piece is a ribbon between two points; where the next begins, across the direction that both have there, is the same
// to the bit for either, so that no pixel of a strand is covered twice or missed. Along whichever of rows and columns
// cross it, a ribbon covers each pixel by what it shares with it, which adds up to its area however thin it is.
//
// Pieces are in order by their middles' depth. Where they are wide (HELD) that order shows: of two strands that lie along
// each other now one is in front, now the other. There one layer waits at each pixel, so that the next may go before it.
// And it is seen how they are lit from side to side (NEAR_FIELD).
#include "raster.h"

#if WIDTH == 1
#define SIDE 1
typedef float real;
typedef int whole;
typedef uint bits;
#define LOAD(p) (*(p))
#define STORE(v, p) (*(p) = (v))
#define AS_BITS(v) as_uint(v)
#define TO_WHOLE(v) ((int)(v))
#define TO_REAL(v) ((float)(v))
#define PIXEL_X 0.5f
#define PIXEL_Y 0.5f
static inline float greatest(real v) { return v; }
#else
#define SIDE 4
typedef float16 real;
typedef int16 whole;
typedef uint16 bits;
#define LOAD(p) vload16(0, p)
#define STORE(v, p) vstore16(v, 0, p)
#define AS_BITS(v) as_uint16(v)
#define TO_WHOLE(v) convert_int16(v)
#define TO_REAL(v) convert_float16(v)
#define PIXEL_X                                                                                                        \
    ((float16)(0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f, 0.5f, 1.5f, 2.5f, 3.5f))
#define PIXEL_Y                                                                                                        \
    ((float16)(0.5f, 0.5f, 0.5f, 0.5f, 1.5f, 1.5f, 1.5f, 1.5f, 2.5f, 2.5f, 2.5f, 2.5f, 3.5f, 3.5f, 3.5f, 3.5f))
static inline float greatest(real v)
{
    const float8 in8 = max(v.lo, v.hi);
    const float4 in4 = max(in8.lo, in8.hi);
    const float2 in2 = max(in4.lo, in4.hi);
    return max(in2.x, in2.y);
}
#endif

#ifdef NEAR_FIELD
#include "raster_across.h"
#define WITH_LIGHT(light) , light
#else
#define WITH_LIGHT(light)
#endif

#define ACROSS (TILE / SIDE)
#define DOWN (BAND / SIDE)
#define CLOSED (1.0f / 512.0f)
#define AHEAD 16 // pieces

// SIDE x SIDE pixels.
typedef struct Square
{
    float open[SIDE * SIDE]; // share that is still seen through
    float red[SIDE * SIDE], green[SIDE * SIDE], blue[SIDE * SIDE], solid[SIDE * SIDE];
#ifdef HELD
    float held_depth[SIDE * SIDE], held_alpha[SIDE * SIDE];
    float held_red[SIDE * SIDE], held_green[SIDE * SIDE], held_blue[SIDE * SIDE];
#endif
} Square;

typedef struct Canvas
{
    Square square[DOWN * ACROSS];
    ulong open[DOWN]; // bits of the squares of each row that are not closed yet
    int open_rows;
} Canvas;

static inline void load_square(Square* square, global const uint2* picture, global const float* solid, int x0, int y0,
                               constant RasterFrame* frame)
{
    for (int i = 0; i < SIDE * SIDE; ++i)
    {
        const int x = x0 + i % SIDE, y = y0 + i / SIDE;
        const bool there = x < frame->width && y < frame->height;
        const int at = there ? y * frame->width + x : 0;
        const uint2 is = frame->later && there ? picture[at] : (uint2)(0u, 0u);
        square->red[i] = from_half(is.x);
        square->green[i] = from_half(is.x >> 16);
        square->blue[i] = from_half(is.y);
        square->open[i] = there ? 1.0f - from_half(is.y >> 16) : 0.0f;
        square->solid[i] = solid[at];
    }
}

// A layer over what is nearer; what that leaves open.
static inline real lay(Square* square, real alpha, real red, real green, real blue)
{
    const real open = LOAD(square->open), taken = open * alpha, left = open - taken;
    STORE(left, square->open);
    STORE(LOAD(square->red) + taken * red, square->red);
    STORE(LOAD(square->green) + taken * green, square->green);
    STORE(LOAD(square->blue) + taken * blue, square->blue);
    return left;
}

#ifdef HELD
static inline void hold_none(Square* square)
{
    STORE((real)(-1.0f), square->held_depth); // before all
    STORE((real)(0.0f), square->held_alpha);
    STORE((real)(0.0f), square->held_red);
    STORE((real)(0.0f), square->held_green);
    STORE((real)(0.0f), square->held_blue);
}

// Of a layer and the one that waits, the nearer is laid and the other waits.
static inline real lay_nearer(Square* square, real depth, real alpha, real red, real green, real blue)
{
    const real other_depth = LOAD(square->held_depth), other_alpha = LOAD(square->held_alpha);
    const real other_red = LOAD(square->held_red), other_green = LOAD(square->held_green),
               other_blue = LOAD(square->held_blue);
    const whole waits = (alpha > 0.0f) & (depth >= other_depth);
    STORE(select(other_depth, depth, waits), square->held_depth);
    STORE(select(other_alpha, alpha, waits), square->held_alpha);
    STORE(select(other_red, red, waits), square->held_red);
    STORE(select(other_green, green, waits), square->held_green);
    STORE(select(other_blue, blue, waits), square->held_blue);
    return lay(square, select(alpha, other_alpha, waits), select(red, other_red, waits),
               select(green, other_green, waits), select(blue, other_blue, waits));
}
#endif

static inline void begin_canvas(Canvas* canvas, global const uint2* picture, global const float* solid, int x0, int y0,
                                constant RasterFrame* frame)
{
    const bool whole_tile = !frame->later && x0 + TILE <= frame->width && y0 + BAND <= frame->height;
    canvas->open_rows = 0;
    for (int down = 0; down < DOWN; ++down)
    {
        canvas->open[down] = 0;
        for (int across = 0; across < ACROSS; ++across)
        {
            Square* square = canvas->square + down * ACROSS + across;
            if (whole_tile)
            {
                STORE((real)(0.0f), square->red);
                STORE((real)(0.0f), square->green);
                STORE((real)(0.0f), square->blue);
                STORE((real)(1.0f), square->open);
                for (int y = 0; y < SIDE; ++y)
                    for (int x = 0; x < SIDE; ++x)
                        square->solid[y * SIDE + x] =
                            solid[(y0 + down * SIDE + y) * frame->width + x0 + across * SIDE + x];
            }
            else
                load_square(square, picture, solid, x0 + across * SIDE, y0 + down * SIDE, frame);
#ifdef HELD
            hold_none(square);
#endif
            canvas->open[down] |= (ulong)(greatest(LOAD(square->open)) > CLOSED) << across;
        }
        canvas->open_rows += canvas->open[down] != 0;
    }
}

static inline bits half_bits(real v) { return TO_HALF(AS_BITS(clamp(v, 0.0f, 65000.0f) * HALF_SCALE)); }

static inline void store_canvas(const Canvas* canvas, global uint2* picture, int x0, int y0,
                                constant RasterFrame* frame)
{
    const bool whole_tile = x0 + TILE <= frame->width && y0 + BAND <= frame->height;
    for (int s = 0; s < DOWN * ACROSS; ++s)
    {
        const Square* square = canvas->square + s;
        uint rg[SIDE * SIDE], ba[SIDE * SIDE];
        STORE(half_bits(LOAD(square->red)) | half_bits(LOAD(square->green)) << 16, rg);
        STORE(half_bits(LOAD(square->blue)) | half_bits(1.0f - LOAD(square->open)) << 16, ba);
        const int x = x0 + s % ACROSS * SIDE, y = y0 + s / ACROSS * SIDE;
        for (int j = 0; j < SIDE; ++j)
            for (int i = 0; i < SIDE; ++i)
                if (whole_tile || (x + i < frame->width && y + j < frame->height))
                    picture[(y + j) * frame->width + x + i] = (uint2)(rg[j * SIDE + i], ba[j * SIDE + i]);
    }
}

// One number of both points: at the first, and how much more it is at the second.
typedef struct Span
{
    float at, more;
} Span;
static inline Span span(float a, float b)
{
    const Span s = {a, b - a};
    return s;
}

// Squares from pixel `low` to `high`, the first and the last whose middle may lie within, as bits.
static inline ulong squares_between(float low, float high)
{
    const int begin = (int)clamp(low + 0.5f, 0.0f, (float)TILE) / SIDE;
    const int end = (int)clamp(high + 0.5f, 0.0f, (float)TILE - 1.0f) / SIDE;
    return begin > end || high < 0.0f ? 0ul : (~0ul >> (63 - end)) & (~0ul << begin);
}

// Rows of squares in the band that a piece may touch: the first, and the last.
static inline int2 rows_of(int cells, int band)
{
    const int first = (cells >> 16 & 255) * CELL - band * BAND;
    const int last = (cells >> 24 & 255) * CELL + CELL - 1 - band * BAND;
    return (int2)(max(first, 0) / SIDE, last < 0 ? -1 : min(last, BAND - 1) / SIDE);
}

// Is any square open that the piece may touch? Most lie behind what is closed already.
static inline bool is_seen(const Canvas* canvas, int cells, int band)
{
    const int2 rows = rows_of(cells, band);
    const int first = (cells & 255) * CELL / SIDE, last = ((cells >> 8 & 255) * CELL + CELL - 1) / SIDE;
    ulong open = 0ul;
    for (int down = rows.x; down <= rows.y; ++down)
        open |= canvas->open[down];
    return open & (~0ul >> (63 - last)) & (~0ul << first);
}

static inline void draw_piece(Canvas* canvas, float8 a, float8 b, int2 rows, int x0,
                              int y0 WITH_LIGHT(global const ushort* near_light))
{
    const float ax = a.s0 - (float)x0, ay = a.s1 - (float)y0, bx = b.s0 - (float)x0, by = b.s1 - (float)y0;
    const float reach = 0.5f * max(a.s3, b.s3) + 0.5f;
    const float low_x = min(ax, bx) - reach, high_x = max(ax, bx) + reach;
    const ulong columns = squares_between(low_x, high_x);
    const float dx = bx - ax, dy = by - ay, squared = dx * dx + dy * dy;
    if (!(squared > 1e-8f))
        return;
    const float size = sqrt(squared), inverse = 1.0f / size, nx = -dy * inverse, ny = dx * inverse;
    const uint rg_a = as_uint(a.s4), rg_b = as_uint(b.s4), bo_a = as_uint(a.s5), bo_b = as_uint(b.s5);
    const bool root = rg_a & MARK_ROOT, tip = bo_b & MARK_TIP;
    const float crossing = 1.0f / max(fabs(nx), fabs(ny)); // a row or column, for a pixel across
    const Span width = span(a.s3 * crossing, b.s3 * crossing);
    const Span opacity = span(from_half(bo_a >> 16), from_half(bo_b >> 16));
    const Span red = span(from_half(rg_a), from_half(rg_b)), green = span(from_half(rg_a >> 16), from_half(rg_b >> 16)),
               blue = span(from_half(bo_a), from_half(bo_b)), depth = span(a.s2, b.s2);
#ifdef NEAR_FIELD
    Across near_a, near_b;
    load_across(near_light, &near_a);
    load_across(near_light + NEAR_LIGHT, &near_b);
#endif
    const bool steep = fabs(nx) > 1e-3f;
    const float slant = steep ? ny / nx : 0.0f, wide = steep ? reach / fabs(nx) : 1e9f;
    for (int down = rows.x; down <= rows.y; ++down)
    {
        const float top = (float)(down * SIDE) + 0.5f - ay;
        const float x_at_top = ax - slant * top, x_below = x_at_top - slant * (float)(SIDE - 1);
        ulong squares = canvas->open[down] & columns &
                        squares_between(min(x_at_top, x_below) - wide, max(x_at_top, x_below) + wide);
        while (squares)
        {
            const ulong lowest = squares & (~squares + 1ul);
            const int across = 63 - (int)clz(lowest);
            squares ^= lowest;
            Square* square = canvas->square + down * ACROSS + across;
            const real x = (float)(across * SIDE) + PIXEL_X, y = (float)(down * SIDE) + PIXEL_Y;
            const real right_a = x - ax, up_from_a = y - ay, right_b = x - bx, up_from_b = y - by;
            const real along = right_a * dx + up_from_a * dy;
            const real u = clamp(along * (inverse * inverse), 0.0f, 1.0f);
            const real aside = right_a * (nx * crossing) + up_from_a * (ny * crossing), off = fabs(aside);
            const real wide_here = width.at + width.more * u;
            real alpha = clamp(0.5f * wide_here + 0.5f - off, (real)(0.0f), min(wide_here, 1.0f)) *
                         (opacity.at + opacity.more * u);
            if (root)
                alpha *= clamp(along * inverse + 0.5f, 0.0f, 1.0f);
            else
                alpha = select((real)(0.0f), alpha, fma((real)(a.s6), right_a, a.s7 * up_from_a) >= 0.0f);
            if (tip)
                alpha *= clamp(size - along * inverse + 0.5f, 0.0f, 1.0f);
            else
                alpha = select((real)(0.0f), alpha, fma((real)(b.s6), right_b, b.s7 * up_from_b) < 0.0f);
            const real far = depth.at + depth.more * u;
            alpha = select((real)(0.0f), alpha, far < LOAD(square->solid));
#ifdef NEAR_FIELD
            if (!(greatest(alpha) > 0.0f))
                continue;
#endif
            real red_here = red.at + red.more * u, green_here = green.at + green.more * u;
            real blue_here = blue.at + blue.more * u;
#ifdef NEAR_FIELD
            const Stretch seen = stretch_across(aside, wide_here);
            red_here += mix(light_in(&near_a, 0, seen), light_in(&near_b, 0, seen), u);
            green_here += mix(light_in(&near_a, 1, seen), light_in(&near_b, 1, seen), u);
            blue_here += mix(light_in(&near_a, 2, seen), light_in(&near_b, 2, seen), u);
#endif
#ifdef HELD
            const real left = lay_nearer(square, far, alpha, red_here, green_here, blue_here);
#else
            const real left = lay(square, alpha, red_here, green_here, blue_here);
#endif
            if (greatest(left) <= CLOSED)
            {
                canvas->open[down] ^= lowest;
                canvas->open_rows -= canvas->open[down] == 0ul;
            }
        }
    }
}

kernel void raster_compose(global const float* points, global const RasterPiece* binned, global const int* tile_begin,
                           global const float* solid, constant RasterFrame* frame,
#ifdef NEAR_FIELD
                           global const ushort* near_light,
#endif
                           global uint2* picture)
{
    const int tile = get_global_id(0) / (TILE / BAND), band = get_global_id(0) % (TILE / BAND);
    if (tile >= frame->tiles_x * frame->tiles_y)
        return;
    const int x0 = tile % frame->tiles_x * TILE, y0 = tile / frame->tiles_x * TILE + band * BAND;
    const int begin = tile_begin[tile], end = tile_begin[tile + 1];
    if (y0 >= frame->height)
        return;
    if (begin == end)
    {
        if (!frame->later)
            for (int y = y0; y < min(y0 + BAND, frame->height); ++y)
                for (int x = x0; x < min(x0 + TILE, frame->width); ++x)
                    picture[y * frame->width + x] = (uint2)(0u, 0u);
        return;
    }
    Canvas canvas;
    begin_canvas(&canvas, picture, solid, x0, y0, frame);
    // Some at a time, so that their points are fetched side by side and not one after the other.
    for (int i = begin; i < end && canvas.open_rows > 0;)
    {
        float8 a[AHEAD], b[AHEAD];
        int cells[AHEAD], count = 0;
#ifdef NEAR_FIELD
        global const ushort* light[AHEAD];
#endif
        for (; i < end && count < AHEAD; ++i)
        {
            const RasterPiece piece = binned[i];
            if (!is_seen(&canvas, piece.cells, band))
                continue;
            a[count] = vload8(piece.point, points);
            b[count] = vload8(piece.point + 1, points);
#ifdef NEAR_FIELD
            light[count] = near_light + (size_t)piece.point * NEAR_LIGHT;
#endif
            cells[count++] = piece.cells;
        }
        for (int k = 0; k < count; ++k)
            if (is_seen(&canvas, cells[k], band))
                draw_piece(&canvas, a[k], b[k], rows_of(cells[k], band), x0, y0 WITH_LIGHT(light[k]));
    }
#ifdef HELD
    for (int s = 0; s < DOWN * ACROSS; ++s)
    {
        Square* square = canvas.square + s;
        lay(square, LOAD(square->held_alpha), LOAD(square->held_red), LOAD(square->held_green), LOAD(square->held_blue));
    }
#endif
    store_canvas(&canvas, picture, x0, y0, frame);
}

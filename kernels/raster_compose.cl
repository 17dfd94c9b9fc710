// A tile's pixels from its pieces, from near to far: each covers what those before it have left open, until nothing is.
// What is solid hides what lies behind it. Work-item: BAND rows of a tile; lanes: pixels beside each other.
//
// A piece is a ribbon between two points; where the next begins, across the direction that both have there, is the same
// to the bit for either, so that no pixel of a strand is covered twice or missed. A ribbon is never thinner than a
// pixel: below that its coverage shrinks instead, and half a pixel on either side lets the edges fade.
#include "raster.h"

#if WIDTH == 1
#define PIXELS 1
typedef float real;
typedef int whole;
typedef uint bits;
#define LOAD(p) (*(p))
#define STORE(v, p) (*(p) = (v))
#define TO_REAL(v) ((float)(v))
#define AS_BITS(v) as_uint(v)
#define PIXEL_NUMBERS 0.5f
static inline int any_pixel(whole test) { return test; }
#else
#define PIXELS 8
typedef float8 real;
typedef int8 whole;
typedef uint8 bits;
#define LOAD(p) vload8(0, p)
#define STORE(v, p) vstore8(v, 0, p)
#define AS_BITS(v) as_uint8(v)
#define PIXEL_NUMBERS ((float8)(0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f))
static inline int any_pixel(whole test)
{
    const int4 in4 = test.lo | test.hi;
    const int2 in2 = in4.lo | in4.hi;
    return in2.x | in2.y;
}
#endif

#define ROW (TILE + PIXELS) // lanes may run out of the tile
#define CLOSED (1.0f / 512.0f)

typedef struct PixelRow
{
    float open[ROW], red[ROW], green[ROW], blue[ROW]; // share that is still seen through; premultiplied
} PixelRow;

static inline void begin_rows(PixelRow* rows, global const uint2* picture, int x0, int y0, constant RasterFrame* frame)
{
    for (int y = 0; y < BAND; ++y)
        for (int x = 0; x < ROW; ++x)
        {
            const bool nearer = frame->later && x < TILE && x0 + x < frame->width && y0 + y < frame->height;
            const uint2 is = nearer ? picture[(y0 + y) * frame->width + x0 + x] : (uint2)(0u, 0u);
            rows[y].red[x] = from_half(is.x);
            rows[y].green[x] = from_half(is.x >> 16);
            rows[y].blue[x] = from_half(is.y);
            rows[y].open[x] = 1.0f - from_half(is.y >> 16);
        }
}

static inline bits half_bits(real v) { return TO_HALF(AS_BITS(clamp(v, 0.0f, 65000.0f) * HALF_SCALE)); }

static inline void store_rows(const PixelRow* rows, global uint2* picture, int x0, int y0, constant RasterFrame* frame)
{
    for (int y = 0; y < min(BAND, frame->height - y0); ++y)
        for (int x = 0; x < min(TILE, frame->width - x0); x += PIXELS)
        {
            uint rg[PIXELS], ba[PIXELS];
            STORE(half_bits(LOAD(rows[y].red + x)) | half_bits(LOAD(rows[y].green + x)) << 16, rg);
            STORE(half_bits(LOAD(rows[y].blue + x)) | half_bits(1.0f - LOAD(rows[y].open + x)) << 16, ba);
            for (int lane = 0; lane < min(PIXELS, frame->width - x0 - x); ++lane)
                picture[(y0 + y) * frame->width + x0 + x + lane] = (uint2)(rg[lane], ba[lane]);
        }
}

static inline bool all_closed(const PixelRow* rows)
{
    for (int y = 0; y < BAND; ++y)
        for (int x = 0; x < TILE; x += PIXELS)
            if (any_pixel(LOAD(rows[y].open + x) > CLOSED))
                return false;
    return true;
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

static inline void draw_piece(PixelRow* rows, float8 a, float8 b, int x0, int y0, global const float* solid,
                              constant RasterFrame* frame)
{
    const float ax = a.s0 - (float)x0, ay = a.s1 - (float)y0, bx = b.s0 - (float)x0, by = b.s1 - (float)y0;
    const float dx = bx - ax, dy = by - ay, squared = dx * dx + dy * dy;
    if (!(squared > 1e-8f))
        return;
    const float size = sqrt(squared), inverse = 1.0f / size, nx = -dy * inverse, ny = dx * inverse;
    const uint rg_a = as_uint(a.s4), rg_b = as_uint(b.s4), bo_a = as_uint(a.s5), bo_b = as_uint(b.s5);
    const bool root = rg_a & MARK_ROOT, tip = bo_b & MARK_TIP;
    const Span half_drawn = span(0.5f * fmax(a.s3, 1.0f) + 0.5f, 0.5f * fmax(b.s3, 1.0f) + 0.5f);
    const Span cover =
        span(from_half(bo_a >> 16) * fmin(a.s3, 1.0f), from_half(bo_b >> 16) * fmin(b.s3, 1.0f));
    const Span red = span(from_half(rg_a), from_half(rg_b)), green = span(from_half(rg_a >> 16), from_half(rg_b >> 16)),
               blue = span(from_half(bo_a), from_half(bo_b)), depth = span(a.s2, b.s2);
    const float reach = fmax(half_drawn.at, half_drawn.at + half_drawn.more);

    // Rows that its corners reach. Where the strand turns sharply they lie further out.
    const float turn_a = fabs(a.s6 * dx + a.s7 * dy) * inverse, turn_b = fabs(b.s6 * dx + b.s7 * dy) * inverse;
    const float up_a = reach * (root ? 1.0f : fmin(1.0f, fabs(a.s6) / fmax(turn_a, 0.1f)));
    const float up_b = reach * (tip ? 1.0f : fmin(1.0f, fabs(b.s6) / fmax(turn_b, 0.1f)));
    const int first = (int)clamp(ceil(fmin(ay - up_a, by - up_b) - 0.5f), 0.0f, (float)BAND);
    const int last = (int)clamp(floor(fmax(ay + up_a, by + up_b) - 0.5f), -1.0f, (float)(BAND - 1));
    const float low_x = fmin(ax, bx) - reach, high_x = fmax(ax, bx) + reach;
    const bool steep = fabs(nx) > 1e-3f;
    const float slant = steep ? ny / nx : 0.0f, wide = steep ? reach / fabs(nx) : 1e9f;
    for (int y = first; y <= last; ++y)
    {
        const float fy = (float)y + 0.5f, from_a = fy - ay, from_b = fy - by;
        const float middle = ax - slant * from_a;
        const int begin = (int)clamp(ceil(fmax(middle - wide, low_x) - 0.5f), 0.0f, (float)TILE);
        const int end = (int)clamp(floor(fmin(middle + wide, high_x) - 0.5f), -1.0f, (float)(TILE - 1));
        const float edge_a = a.s7 * from_a, edge_b = b.s7 * from_b;
        PixelRow* row = rows + y;
        for (int x = begin; x <= end; x += PIXELS)
        {
            const real open = LOAD(row->open + x);
            if (!any_pixel(open > CLOSED))
                continue;
            const real to_a = ((float)x + PIXEL_NUMBERS) - ax, to_b = ((float)x + PIXEL_NUMBERS) - bx;
            const real along = to_a * dx + from_a * dy;
            const real u = clamp(along * (inverse * inverse), 0.0f, 1.0f);
            const real off = fabs(to_a * nx + from_a * ny);
            real alpha = clamp(half_drawn.at + half_drawn.more * u - off, 0.0f, 1.0f) * (cover.at + cover.more * u);
            if (root)
                alpha *= clamp(along * inverse + 0.5f, 0.0f, 1.0f);
            else
                alpha = select((real)(0.0f), alpha, fma((real)(a.s6), to_a, (real)(edge_a)) >= 0.0f);
            if (tip)
                alpha *= clamp(size - along * inverse + 0.5f, 0.0f, 1.0f);
            else
                alpha = select((real)(0.0f), alpha, fma((real)(b.s6), to_b, (real)(edge_b)) < 0.0f);
            alpha = select((real)(0.0f), alpha, depth.at + depth.more * u < LOAD(solid + y * frame->width + x));
            const real taken = open * alpha;
            STORE(open - taken, row->open + x);
            STORE(LOAD(row->red + x) + taken * (red.at + red.more * u), row->red + x);
            STORE(LOAD(row->green + x) + taken * (green.at + green.more * u), row->green + x);
            STORE(LOAD(row->blue + x) + taken * (blue.at + blue.more * u), row->blue + x);
        }
    }
}

kernel void raster_compose(global const float* points, global const RasterPiece* binned, global const int* tile_begin,
                           global const float* solid, constant RasterFrame* frame, global uint2* picture)
{
    const int tile = get_global_id(0) / (TILE / BAND), band = get_global_id(0) % (TILE / BAND);
    if (tile >= frame->tiles_x * frame->tiles_y)
        return;
    const int x0 = tile % frame->tiles_x * TILE, y0 = tile / frame->tiles_x * TILE + band * BAND;
    const int begin = tile_begin[tile], end = tile_begin[tile + 1];
    if (y0 >= frame->height || (begin == end && frame->later))
        return;
    PixelRow rows[BAND];
    begin_rows(rows, picture, x0, y0, frame);
    global const float* solid_here = solid + y0 * frame->width + x0;
    for (int i = begin; i < end; ++i)
    {
        const int point = binned[i].point;
        draw_piece(rows, vload8(point, points), vload8(point + 1, points), x0, y0, solid_here, frame);
        if ((i - begin) % 256 == 255 && all_closed(rows))
            break;
    }
    store_rows(rows, picture, x0, y0, frame);
}

// The points of the curves, shaded and projected; with NEAR_FIELD, how they are lit from side to side besides. Work-item:
// a strand; lanes: places along it.
//
// First the places themselves, then all that hangs on those beside them. Where a run of pieces begins and ends, what
// would come next is guessed from the three places there (a parabola), and marked as no point.
#define ROOM ((NODES - 2) * (MOST_PIECES + 3) + 2 * WIDTH + 2)
#include "strand_places.h"
#ifdef NEAR_FIELD
#include "raster_near.h"
#endif

// All places in their order; where a run begins or ends, `t` is no number.
static inline void list_places(global const uchar* pieces, int strand, Places* at)
{
    int n = 0, run = 0;
    for (int k = 1; k < NODES - 1; ++k)
    {
        const int count = pieces[strand * NODES + k];
        if (run && !count)
        {
            at->segment[n] = k - 1;
            at->t[n++] = NAN;
        }
        if (count && !run)
        {
            at->segment[n] = k;
            at->t[n++] = NAN;
            at->segment[n] = k;
            at->t[n++] = 0.0f;
        }
        for (int i = 1; i <= count; ++i)
        {
            at->segment[n] = k;
            at->t[n++] = (float)i / (float)count;
        }
        run = count;
    }
    if (run)
    {
        at->segment[n] = NODES - 2;
        at->t[n++] = NAN;
    }
    at->count = n;
    for (int i = 0; i < WIDTH; ++i) // what fills the last lanes
    {
        at->segment[n + i] = 1;
        at->t[n + i] = 0.0f;
    }
}

// What would come beside place i, from there and the one and two places on (`step` -1 or 1).
static inline void guess(Places* at, int i, int onward)
{
    const int a = i + onward, b = i + 2 * onward, c = i + 3 * onward;
    const bool three = c >= 0 && c < at->count && !isnan(at->t[c]);
    at->x[i] = three ? 3.0f * (at->x[a] - at->x[b]) + at->x[c] : 2.0f * at->x[a] - at->x[b];
    at->y[i] = three ? 3.0f * (at->y[a] - at->y[b]) + at->y[c] : 2.0f * at->y[a] - at->y[b];
    at->z[i] = three ? 3.0f * (at->z[a] - at->z[b]) + at->z[c] : 2.0f * at->z[a] - at->z[b];
}

static inline real clip_of(float4 row, real x, real y, real z) { return row.x * x + row.y * y + row.z * z + row.w; }

#ifdef VALUES
static inline Reals ramp_at(global const float4* ramp, real value)
{
    const real at = clamp(value, (real)(0.0f), (real)(1.0f)) * (float)RAMP - 0.5f;
    const whole first = clamp(TO_WHOLE(at), (whole)(0), (whole)(RAMP - 2));
    const real share = clamp(at - TO_REAL(first), (real)(0.0f), (real)(1.0f));
    int i[WIDTH];
    float r[2][WIDTH], g[2][WIDTH], b[2][WIDTH];
    LANES_STORE(first, i);
    for (int lane = 0; lane < WIDTH; ++lane)
        for (int side = 0; side < 2; ++side)
        {
            const float4 color = ramp[i[lane] + side];
            r[side][lane] = color.x;
            g[side][lane] = color.y;
            b[side][lane] = color.z;
        }
    return reals(mix(LANES_LOAD(r[0]), LANES_LOAD(r[1]), share), mix(LANES_LOAD(g[0]), LANES_LOAD(g[1]), share),
                 mix(LANES_LOAD(b[0]), LANES_LOAD(b[1]), share), share);
}
#endif

#ifdef SHADED
static inline Reals shaded_at(global const uint2* shaded, whole first, real share)
{
    int i[WIDTH];
    float r[2][WIDTH], g[2][WIDTH], b[2][WIDTH];
    LANES_STORE(first, i);
    for (int lane = 0; lane < WIDTH; ++lane)
        for (int side = 0; side < 2; ++side)
        {
            const uint2 color = shaded[i[lane] + side];
            r[side][lane] = from_half(color.x);
            g[side][lane] = from_half(color.x >> 16);
            b[side][lane] = from_half(color.y);
        }
    return reals(mix(LANES_LOAD(r[0]), LANES_LOAD(r[1]), share), mix(LANES_LOAD(g[0]), LANES_LOAD(g[1]), share),
                 mix(LANES_LOAD(b[0]), LANES_LOAD(b[1]), share), share);
}
#endif

kernel void raster_points(global const float4* drawn_position, global const float4* drawn_frame,
                          global const StrandLook* looks, global const DrawnStrand* strands,
                          global const float4* braids, global const float* wave_table,
#ifdef VALUES
                          global const float* values, global const float4* ramp,
#endif
#ifdef SHADED
                          global const uint2* shaded,
#endif
#ifdef NEAR_FIELD
                          constant LookFrame* look_frame, constant LookRay* rays, global const ushort* straight_light,
                          global ushort* near_light,
#endif
                          constant HairParams* params, constant RasterFrame* frame, global const uchar* pieces,
                          global const RasterStrand* listed, global float* points)
{
    if ((int)get_global_id(0) >= frame->listed)
        return;
    const RasterStrand own = listed[get_global_id(0)];
    const RibbonLook look = look_of(own.strand, looks, strands, braids, params, frame->braided);
    StrandNodes n;
    load_strand(&n, drawn_position, drawn_frame, own.strand);
    Places at;
    list_places(pieces, own.strand, &at);
    for (int i = 0; i < at.count; i += WIDTH)
        place_curve(&n, &look, &at, i, params, wave_table);
    for (int i = 0; i < at.count; ++i)
        if (isnan(at.t[i]))
            guess(&at, i, i + 1 < at.count && !isnan(at.t[i + 1]) ? 1 : -1);

    const float4 eye = frame->eye, cx = frame->clip_x, cy = frame->clip_y, cw = frame->clip_w;
#if !defined(VALUES) && !defined(SHADED)
    const float brightness = FIRST_LANE(brightness_of(params, wave_table, look.laid.own));
    const float4 sun = params->look_light_color, to_light = params->look_light_direction;
#endif
    const float half_width = 0.5f * (float)frame->width, half_height = 0.5f * (float)frame->height;
    const float wider = widening(own.strand, frame);
#ifdef NEAR_FIELD
    const float per_log = per_log_of(look_frame, FIRST_LANE(brightness_of(params, wave_table, look.laid.own)));
#endif
#ifdef VALUES
    float of_node[NODE_ROOM];
    for (int k = 0; k < NODE_ROOM; ++k)
        of_node[k] = values[own.strand * NODES + min(k, NODES - 1)];
#endif
    // The first and the last are no points.
    for (int i = 1; i < at.count - 1; i += WIDTH)
    {
        const int* segment = at.segment + i;
        const real given = LANES_LOAD(at.t + i), t = select((real)(0.0f), given, given == given);
        real x = LANES_LOAD(at.x + i), y = LANES_LOAD(at.y + i), z = LANES_LOAD(at.z + i);
        const real bx = LANES_LOAD(at.x + i - 1), by = LANES_LOAD(at.y + i - 1), bz = LANES_LOAD(at.z + i - 1);
        const real ax = LANES_LOAD(at.x + i + 1), ay = LANES_LOAD(at.y + i + 1), az = LANES_LOAD(at.z + i + 1);
        real tx = ax - bx, ty = ay - by + 1e-12f, tz = az - bz;
        const real shorten = INVERSE_SQRT(fmax(tx * tx + ty * ty + tz * tz, (real)(1e-30f)));
        tx *= shorten;
        ty *= shorten;
        tz *= shorten;

        const whole numbers = LANES_LOAD(segment);
        const real along = (TO_REAL(numbers - 1) + t) * (1.0f / (float)(NODES - 2));
        const real light = LANES_LOAD(at.open + i) * mix(pick(n.light, segment, 0), pick(n.light, segment, 1), t);
        real red, green, blue;
#ifdef VALUES // lit little, so that a colour is the legend's
        const Reals told = ramp_at(ramp, mix(pick(of_node, segment, 0), pick(of_node, segment, 1), t));
        const real lit = 0.65f + 0.35f * light;
        red = told.x * lit;
        green = told.y * lit;
        blue = told.z * lit;
#elif defined(SHADED) // SHADED places a segment have been: linear between them
        const real at_place = (TO_REAL(numbers - 1) + t) * (float)SHADED;
        const whole place = min(TO_WHOLE(at_place), (whole)((NODES - 2) * SHADED - 1));
        const Reals told = shaded_at(shaded + own.strand * ((NODES - 2) * SHADED + 1), place, at_place - TO_REAL(place));
        red = told.x;
        green = told.y;
        blue = told.z;
#ifdef NEAR_FIELD
        real ex = eye.x - x, ey = eye.y - y, ez = eye.z - z;
        const real near_eye = INVERSE_SQRT(fmax(ex * ex + ey * ey + ez * ez, (real)(1e-30f)));
        const int shaded_places = (NODES - 2) * SHADED + 1;
        store_near(reals(tx, ty, tz, t), reals(ex * near_eye, ey * near_eye, ez * near_eye, t),
                   absorption_at(&look, profile_at(params->look_color_along, along), per_log),
                   straight_light + (size_t)own.strand * (size_t)(look_frame->suns * shaded_places), shaded_places,
                   place, at_place - TO_REAL(place), look_frame, rays, min(WIDTH, at.count - 1 - i),
                   near_light + (size_t)(own.first + i - 1) * NEAR_LIGHT);
#endif
#else
        const real ex = eye.x - x, ey = eye.y - y, ez = eye.z - z;
        const real near_eye = INVERSE_SQRT(fmax(ex * ex + ey * ey + ez * ez, (real)(1e-30f)));
        const Reals fibre =
            kajiya_kay(params, wave_table, tx * to_light.x + ty * to_light.y + tz * to_light.z,
                       (tx * ex + ty * ey + tz * ez) * near_eye, light);
        const real tip = profile_at(params->look_color_along, along);
        const float4 from = look.root_color, to = look.tip_color - look.root_color;
        red = scattered(fibre, (from.x + to.x * tip) * brightness, light * sun.x);
        green = scattered(fibre, (from.y + to.y * tip) * brightness, light * sun.y);
        blue = scattered(fibre, (from.z + to.z * tip) * brightness, light * sun.z);
#endif
        const real opacity = look.opacity * profile_at(params->look_opacity_along, along);

        // Before the near plane a point moves along its piece up to it.
        real w = clip_of(cw, x, y, z);
        whole there = given == given;
        const whole before = w < frame->near;
        if (any_lane(before & there))
        {
            const real wa = clip_of(cw, ax, ay, az), wb = clip_of(cw, bx, by, bz);
            const whole on = wa > frame->near, back = wb > frame->near;
            const real to_on = clamp((frame->near - w) / (wa - w), (real)(0.0f), (real)(1.0f));
            const real to_back = clamp((frame->near - w) / (wb - w), (real)(0.0f), (real)(1.0f));
            x = select(x, select(mix(x, bx, to_back), mix(x, ax, to_on), on), before);
            y = select(y, select(mix(y, by, to_back), mix(y, ay, to_on), on), before);
            z = select(z, select(mix(z, bz, to_back), mix(z, az, to_on), on), before);
            there &= ~before | on | back;
            w = fmax(clip_of(cw, x, y, z), (real)(frame->near));
        }
        const real inverse = 1.0f / w;
        const real px = clip_of(cx, x, y, z) * inverse, py = clip_of(cy, x, y, z) * inverse;
        const real screen_x = half_width + half_width * px, screen_y = half_height + half_height * py;
        const real depth = clamp(frame->depth_at_infinity + frame->depth_over * inverse, (real)(0.0f), (real)(1.0f));
        // Where the tangent goes on screen.
        real mx = half_width * (cx.x * tx + cx.y * ty + cx.z * tz - px * (cw.x * tx + cw.y * ty + cw.z * tz));
        real my = half_height * (cy.x * tx + cy.y * ty + cy.z * tz - py * (cw.x * tx + cw.y * ty + cw.z * tz));
        const real short_by = INVERSE_SQRT(fmax(mx * mx + my * my, (real)(1e-20f)));
        mx *= short_by;
        my *= short_by;
        const real width = fmax(wider * ribbon_width(params, wave_table, look.width, along), (real)(0.0f)) *
                           inverse * (1.0f / eye.w);
        there &= (fabs(screen_x) < 1e6f) & (fabs(screen_y) < 1e6f) & (width < 1e6f) & (mx == mx) & (my == my) &
                 (red + green + blue + opacity < 1e9f);

        float stored[6][WIDTH];
        uint rg[WIDTH], bo[WIDTH];
        LANES_STORE(select((real)(NAN), screen_x, there), stored[0]);
        LANES_STORE(screen_y, stored[1]);
        LANES_STORE(depth, stored[2]);
        LANES_STORE(width, stored[3]);
        LANES_STORE(mx, stored[4]);
        LANES_STORE(my, stored[5]);
        LANES_STORE(half_bits(red) | half_bits(green) << 16, rg);
        LANES_STORE(half_bits(blue) | half_bits(opacity) << 16, bo);
        for (int lane = 0; lane < min(WIDTH, at.count - 1 - i); ++lane)
        {
            const bool last = isnan(at.t[i + lane + 1]);
            const uint marks = (last ? MARK_LAST : 0) | (last && segment[lane] == NODES - 2 ? MARK_TIP : 0);
            const uint root = segment[lane] == 1 && isnan(at.t[i + lane - 1]) ? MARK_ROOT : 0;
            const float8 point = (float8)(stored[0][lane], stored[1][lane], stored[2][lane], stored[3][lane],
                                          as_float(rg[lane] | root), as_float(bo[lane] | marks), stored[4][lane],
                                          stored[5][lane]);
            vstore8(point, own.first + i - 1 + lane, points);
        }
    }
}

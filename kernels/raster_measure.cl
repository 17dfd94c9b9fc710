// How many pieces each segment of a strand is cut into: as many as its bend on screen asks for, none where it lies
// outside of the view or behind what is solid. Work-item: a strand; lanes: its segments.
#include "drawn_lanes.h"
#include "raster_strand.h"

static inline real clip_of(float4 row, real x, real y, real z) { return row.x * x + row.y * y + row.z * z + row.w; }

// Is the box, in pixels, hidden behind what is solid, if it is nowhere nearer than `depth`?
static inline bool is_hidden(int x0, int x1, int y0, int y1, float depth, global const float* farthest,
                             constant RasterFrame* frame)
{
    x0 = max(x0, 0) / BLOCK;
    y0 = max(y0, 0) / BLOCK;
    x1 = min(x1 / BLOCK, frame->blocks_x - 1);
    y1 = min(y1 / BLOCK, frame->blocks_y - 1);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
            if (depth < farthest[y * frame->blocks_x + x])
                return false;
    return true;
}

kernel void raster_measure(global const float4* drawn_position, global const float4* drawn_frame,
                           global const StrandLook* looks, global const DrawnStrand* strands,
                           global const float4* braids, global const float* wave_table, global const float* farthest,
                           constant HairParams* params, constant RasterFrame* frame, global uchar* pieces,
                           global int* strand_points, global float* strand_depth)
{
    const int strand = get_global_id(0);
    if (strand >= frame->strands)
        return;
    const RibbonLook look = look_of(strand, looks, strands, braids, params, frame->braided);
    StrandNodes n;
    load_strand(&n, drawn_position, drawn_frame, strand);
    const float wider = widening(strand, frame);
    const float4 thick = params->look_width_along, share = params->wave_along;
    const float most_laid = fmax(fmax(share.x, share.y), fmax(share.z, share.w));
    const Waves laid = look.laid;
    const float most = most_laid * (sqrt(laid.normal_amplitude * laid.normal_amplitude +
                                         laid.binormal_amplitude * laid.binormal_amplitude) +
                                    laid.curl + laid.frizz) +
                       0.5f * wider * look.width * fmax(fmax(thick.x, thick.y), fmax(thick.z, thick.w));

    const float4 cw = frame->clip_w, eye = frame->eye;
    const float half_width = 0.5f * (float)frame->width, half_height = 0.5f * (float)frame->height;
    int run = 0, so_far = 0; // does the curve go on; how many points are there up to here
    for (int first = 1; first < NODES - 1; first += WIDTH)
    {
#define NODE(name, k) LANES_LOAD(n.name + first + (k))
        const real x0 = NODE(x, -1), x1 = NODE(x, 0), x2 = NODE(x, 1), x3 = NODE(x, 2);
        const real y0 = NODE(y, -1), y1 = NODE(y, 0), y2 = NODE(y, 1), y3 = NODE(y, 2);
        const real z0 = NODE(z, -1), z1 = NODE(z, 0), z2 = NODE(z, 1), z3 = NODE(z, 2);
        const real distance1 = NODE(distance, 0), distance2 = NODE(distance, 1);
#undef NODE
#define SIZE(x, y, z) sqrt((x) * (x) + (y) * (y) + (z) * (z))
        const Points bend1 = points(x0 - 2.0f * x1 + x2, y0 - 2.0f * y1 + y2, z0 - 2.0f * z1 + z2);
        const Points bend2 = points(x1 - 2.0f * x2 + x3, y1 - 2.0f * y2 + y3, z1 - 2.0f * z2 + z3);
        const real bend1_squared = dot_lanes(bend1, bend1), bend2_squared = dot_lanes(bend2, bend2);
        const real bend = sqrt(fmax(bend1_squared, bend2_squared));
        const real bulge = fmax(SIZE(x2 - x0, y2 - y0, z2 - z0), SIZE(x3 - x1, y3 - y1, z3 - z1)) * (1.0f / 3.0f);
        const real length = SIZE(x2 - x1, y2 - y1, z2 - z1);
        const Points ray = points(0.5f * (x1 + x2) - eye.x, 0.5f * (y1 + y2) - eye.y, 0.5f * (z1 + z2) - eye.z);
        const real from_eye = fmax(sqrt(dot_lanes(ray, ray)), (real)(1e-9f));
        const real along1 = dot_lanes(bend1, ray) / from_eye, along2 = dot_lanes(bend2, ray) / from_eye;
        const real seen_bend = sqrt(fmax(fmax(bend1_squared - along1 * along1, bend2_squared - along2 * along2), 0.0f));
        const real pixel = fmax(eye.w * from_eye, (real)(1e-9f));

        // A chord strays from an arc by an eighth of the second difference, and with the square of the piece's length.
        // What it strays along the eye's ray is not seen.
        real stray = (real)(0.0f);
        if (params->smoothing_curve != CURVE_LINEAR)
            stray = 0.125f * seen_bend / pixel;
        const real segment = distance2 - distance1;
        const real at = TO_REAL(LANE_NUMBERS + first);
        stray += waves_stray(params, wave_table, look.laid, segment, (at - 0.5f) * (1.0f / (float)(NODES - 2))) / pixel;
        real aside = (real)(most); // of the curve through the nodes
        if (look.braid.pitch > 0.0f)
        {
            stray += braid_stray(look.braid, segment, at * (1.0f / (float)(NODES - 2))) / pixel;
            aside += is_plaited(look.braid, at * (1.0f / (float)(NODES - 2))) *
                     (look.braid.swing + look.braid.depth + 2.0f * look.braid.plait);
        }
        const real wanted = ceil(sqrt(stray * (1.0f / BEND_TOLERANCE)));

        // A third of the way its Bezier points lie a sixth of the second differences off the chord (Bourke's cubic goes
        // further), and the curve lies between them and its ends.
        const real w1 = clip_of(cw, x1, y1, z1), w2 = clip_of(cw, x2, y2, z2);
        const real room = (params->smoothing_curve == CURVE_CUBIC ? bulge : bend * (1.0f / 6.0f)) + aside;
        const real nearest = fmin(w1, w2) - room;
        const real i1 = 1.0f / w1, i2 = 1.0f / w2;
        const real sx1 = half_width + half_width * clip_of(frame->clip_x, x1, y1, z1) * i1;
        const real sx2 = half_width + half_width * clip_of(frame->clip_x, x2, y2, z2) * i2;
        const real sy1 = half_height + half_height * clip_of(frame->clip_y, x1, y1, z1) * i1;
        const real sy2 = half_height + half_height * clip_of(frame->clip_y, x2, y2, z2) * i2;
        // What lies aside moves by what it comes nearer, too.
        const real off_middle = fmax(fabs(sx1 - half_width), fabs(sx2 - half_width)) +
                                fmax(fabs(sy1 - half_height), fabs(sy2 - half_height));
        const real about = (1.0f + eye.w * off_middle) * room / (eye.w * fmax(nearest, (real)(frame->near))) + 2.0f;
        const whole in_front = nearest > frame->near;
        const real low_x = fmin(sx1, sx2) - about, high_x = fmax(sx1, sx2) + about;
        const real low_y = fmin(sy1, sy2) - about, high_y = fmax(sy1, sy2) + about;
        const whole outside = in_front & ((low_x > (float)frame->width) | (high_x < 0.0f) |
                                          (low_y > (float)frame->height) | (high_y < 0.0f));
        // Written so that no number at all counts as not there.
        const real sum = x0 + x1 + x2 + x3 + y0 + y1 + y2 + y3 + z0 + z1 + z2 + z3 + distance1 + distance2;
        const whole there = (length > 1e-7f) & (fabs(sum) < 1e12f) & (fmax(w1, w2) > frame->near) & (wanted >= 0.0f);
        const real depth = frame->depth_at_infinity + frame->depth_over / fmax(nearest, (real)(frame->near));

        int shown[WIDTH], count[WIDTH], before[WIDTH], box[4][WIDTH];
        float depths[WIDTH];
        const real most_x = (real)((float)frame->width), most_y = (real)((float)frame->height), none = (real)(-1.0f);
        LANES_STORE(there & ~outside, shown);
        LANES_STORE(in_front, before);
        LANES_STORE(TO_WHOLE(clamp(wanted, (real)(1.0f), (real)((float)params->smoothing_subdivisions))), count);
        LANES_STORE(TO_WHOLE(clamp(low_x, none, most_x)), box[0]);
        LANES_STORE(TO_WHOLE(clamp(high_x, none, most_x)), box[1]);
        LANES_STORE(TO_WHOLE(clamp(low_y, none, most_y)), box[2]);
        LANES_STORE(TO_WHOLE(clamp(high_y, none, most_y)), box[3]);
        LANES_STORE(depth, depths);
        for (int lane = 0; lane < min(WIDTH, NODES - 1 - first); ++lane)
        {
            const bool seen = shown[lane] && wider > 0.0f &&
                              !(before[lane] && is_hidden(box[0][lane], box[1][lane], box[2][lane], box[3][lane],
                                                          depths[lane], farthest, frame));
            pieces[strand * NODES + first + lane] = seen ? count[lane] : 0;
            // Two places between runs: what would come behind the one and before the other.
            if (seen)
                so_far += count[lane] + (run ? 0 : so_far ? 3 : 1);
            run = seen;
        }
    }
    strand_points[strand] = so_far;
    const int middle = (NODES + 1) / 2;
    strand_depth[strand] = cw.x * n.x[middle] + cw.y * n.y[middle] + cw.z * n.z[middle] + cw.w;
}

// The colour of each place: what suns and sky bring there, what the fibre makes of it, and what others hand on to it.
// LEVEL, a build option as looks are chosen by: 1 Karis' fit, 2 the far field of a fibre, both with shadows; 3 with dual
// scattering. NEAR_FIELD: some of F D is left to whoever draws the strands, and D told.
//
//   L = sum over suns of E [D (F + B(s)) + G (F_G(v) + B(s + v))] + sky      (after Zinke 2008, eq. 23 to 27)
//   D = exp(-tau): light that comes straight; G: light handed on by fibres, wider by v; F, F_G: the fibre for either;
//   B: what the fibres behind throw back. fibre.h has each.
//
// Work-item: a strand; lanes: places along it. Shares of light that one crossing hands on or throws back (Zinke 2008,
// eq. 6 and 12) are tables over absorption, for the hair's root, middle and tip; a parabola through them serves the
// places between.
// Light is looked up where the eye's ray meets the hair, and nearer to the sun (look.h): what the eye sees through gaps
// the sun shines on through the same gaps, where both come from about the same side. How far that is falls as one over
// the distance of their directions, the hot spot's law (Nilson, Kuusk. A reflectance model for the homogeneous plant
// canopy and its inversion. 1989), and is no more than OUT_TO_SUN. A fibre sends on light of the inclination that it
// came with, mirrored: what of the sky is seen in it comes from a cone about it, and where hair stands on end towards
// the eye that is the skin's side, however bright the sky is.
#include "look_fibre.h"
#include "look_rays.h"

// Rows of `shares` hold, for each of six values, the coefficients of 1, (1 - cos theta)^2 and (1 - cos theta)^5: what
// one crossing sends forward and backward, the variances of either, what the fibres behind throw back and its variance.
// Rows are even in sqrt(absorption) / (1 + sqrt(absorption)). app/fibre_shares.h
enum
{
    FORWARD,
    BACKWARD,
    FORWARD_VARIANCE,
    BACKWARD_VARIANCE,
    BEHIND,
    BEHIND_VARIANCE
};

typedef struct ShareRow
{
    float16 most;
    float4 rest;
} ShareRow;

static inline ShareRow find_row(global const float* shares, float absorption)
{
    const float r = sqrt(fmax(absorption, 0.0f));
    const float at = fmin(r / (1.0f + r) * (float)(SHARE_ROWS - 1), (float)(SHARE_ROWS - 1) - 1e-3f);
    const int below = (int)at;
    const float on = at - (float)below;
    global const float* row = shares + below * SHARE_TERMS;
    ShareRow found;
    found.most = mix(vload16(0, row), vload16(0, row + SHARE_TERMS), on);
    found.rest = mix(vload4(0, row + 16), vload4(0, row + SHARE_TERMS + 16), on);
    return found;
}

// Rows for the root, the middle and the tip, as a parabola in the share of the tip's colour.
typedef struct ShareCurve
{
    float begin[SHARE_TERMS], slope[SHARE_TERMS], bend[SHARE_TERMS];
} ShareCurve;

static inline void find_curve(global const float* shares, float root, float middle, float tip, ShareCurve* curve)
{
    const ShareRow a = find_row(shares, root), b = find_row(shares, middle), c = find_row(shares, tip);
    vstore16(a.most, 0, curve->begin);
    vstore4(a.rest, 0, curve->begin + 16);
    vstore16(4.0f * b.most - 3.0f * a.most - c.most, 0, curve->slope);
    vstore4(4.0f * b.rest - 3.0f * a.rest - c.rest, 0, curve->slope + 16);
    vstore16(2.0f * (a.most - 2.0f * b.most + c.most), 0, curve->bend);
    vstore4(2.0f * (a.rest - 2.0f * b.rest + c.rest), 0, curve->bend + 16);
}

typedef struct Inclined
{
    real squared, fifth; // powers of 1 - cos theta
} Inclined;

static inline Inclined inclined(real cosine)
{
    const real g = 1.0f - cosine, g2 = g * g;
    const Inclined at = {g2, g2 * g2 * g};
    return at;
}

static inline real share_at(const ShareCurve* curve, int value, real tip, Inclined at)
{
    real p[3];
    for (int i = 0; i < 3; ++i)
        p[i] = curve->begin[3 * value + i] + tip * (curve->slope[3 * value + i] + tip * curve->bend[3 * value + i]);
    return fmin(fmax(p[0] + at.squared * p[1] + at.fifth * p[2], (real)(1e-5f)), (real)(1.0f));
}

// Of one crossing, in each channel.
typedef struct Crossing
{
    Rgb forward, backward;
} Crossing;

static inline Crossing crossing_at(const ShareCurve* curves, real tip, Inclined at)
{
    Crossing c;
    c.forward = rgb(share_at(&curves[0], FORWARD, tip, at), share_at(&curves[1], FORWARD, tip, at),
                    share_at(&curves[2], FORWARD, tip, at));
    c.backward = rgb(share_at(&curves[0], BACKWARD, tip, at), share_at(&curves[1], BACKWARD, tip, at),
                     share_at(&curves[2], BACKWARD, tip, at));
    return c;
}

#ifdef CULLED
// Is any segment seen that places from `first` to `last` colour? `pieces`: of a strand's segments, by raster_measure.
// Who draws a segment reads the place after its last one, too.
static inline bool is_seen(global const uchar* pieces, int first, int last)
{
    bool seen = false;
    for (int k = max(first - 2, 0) / PIECES; k <= min(last / PIECES, NODES - 3); ++k)
        seen |= pieces[k + 1] > 0;
    return seen;
}
#endif

kernel void look_shade(global const float4* places, global const StrandLook* looks,
                       global const DrawnStrand* strands, global const float4* braids, global const float* wave_table,
                       constant HairParams* params, constant LookFrame* look_frame, constant LookVolume* volume,
                       constant LookVolume* coarse_volume, constant LookRay* rays, global const float* depth,
                       constant LookRay* eye_rays, global const float* eye_depth, global const float* around,
                       global const float* shares,
#ifdef NEAR_FIELD
                       global ushort* straight_light,
#endif
#ifdef CULLED
                       global const uchar* pieces,
#endif
                       global uint2* shaded)
{
    const int strand = (int)get_global_id(0);
    if (strand >= volume->strands || STRAND_TURN(strand) >= look_frame->eye.w * (1.0f + FADE))
        return;
    const RibbonLook look = look_of(strand, looks, strands, braids, params, look_frame->braided);
    const Fibre fibre = fibre_of(look_frame);
    const float per_log = per_log_of(look_frame, FIRST_LANE(brightness_of(params, wave_table, look.laid.own)));
    const float4 root = look.root_color, step_color = look.tip_color - look.root_color;
    ShareCurve curves[3];
    const float4 middle = root + 0.5f * step_color, tip_color = look.tip_color;
    find_curve(shares, FIRST_LANE(absorption_of((real)(root.x), per_log)),
               FIRST_LANE(absorption_of((real)(middle.x), per_log)),
               FIRST_LANE(absorption_of((real)(tip_color.x), per_log)), &curves[0]);
    find_curve(shares, FIRST_LANE(absorption_of((real)(root.y), per_log)),
               FIRST_LANE(absorption_of((real)(middle.y), per_log)),
               FIRST_LANE(absorption_of((real)(tip_color.y), per_log)), &curves[1]);
    find_curve(shares, FIRST_LANE(absorption_of((real)(root.z), per_log)),
               FIRST_LANE(absorption_of((real)(middle.z), per_log)),
               FIRST_LANE(absorption_of((real)(tip_color.z), per_log)), &curves[2]);

    const int count = volume->places;
    global const float4* own = places + (size_t)strand * (size_t)count;
    const float4 eye = look_frame->eye;
    const LookRay to_eye = eye_rays[0];
    const float sky_moved = SKY_TO_EYE * coarse_volume->corner.w;
    const size_t all = (size_t)volume_voxels(volume);
    for (int i = 0; i < count; i += WIDTH)
    {
#ifdef CULLED
        if (!is_seen(pieces + strand * NODES, i, min(i + WIDTH, count) - 1))
            continue;
#endif
        float shares_along[WIDTH];
        for (int lane = 0; lane < WIDTH; ++lane)
            shares_along[lane] = (float)min(i + lane, count - 1) / (float)(count - 1);
        const SeenPlaces place = load_places(own, i, count, eye);
        const Points p = place.at;
        const real hidden = depth_to(eye_depth, to_eye, in_voxels(p, to_eye.direction, 0.0f, volume), volume);
        const Points seen = points(p.x + hidden * to_eye.direction.x, p.y + hidden * to_eye.direction.y,
                                   p.z + hidden * to_eye.direction.z);
        const real tx = place.tangent.x, ty = place.tangent.y, tz = place.tangent.z;
        const real ex = place.eye.x, ey = place.eye.y, ez = place.eye.z;
        const real along_eye = tx * ex + ty * ey + tz * ez;
        const real along = LANES_LOAD(shares_along);
        const real tip = profile_at(params->look_color_along, along);
        const Rgb absorb = absorption_at(&look, tip, per_log);
        real open = (real)(1.0f);
        if (look.braid.pitch > 0.0f)
            open = braid_at(look.braid, along).w;

        Rgb sum = rgb((real)(0.0f), (real)(0.0f), (real)(0.0f));
        for (int k = 0; k < look_frame->suns; ++k)
        {
            const LookRay ray = rays[k];
            const float4 l = ray.direction, e = ray.irradiance;
            const real to_both = ex * l.x + ey * l.y + ez * l.z;
            const FibreAngles a = fibre_angles(tx * l.x + ty * l.y + tz * l.z, along_eye, to_both);
            const real out = OUT_TO_SUN * INVERSE_SQRT(fmax(2.0f - 2.0f * to_both, (real)(1.0f)));
            const real tau = depth_to(depth + k * all, ray, in_voxels(seen, l, out, volume), volume);
            const real straight = open * exp(-tau);
#if LEVEL == 1
            const Rgb f = karis(fibre, a, absorb, look_frame->roughness);
#else
            Rgb f = far_field(fibre, a, lobe_heights(fibre, a, (real)(l.w)), absorb, look_frame->nodes, false);
#endif
#ifdef NEAR_FIELD
            uint left[WIDTH];
            LANES_STORE(half_bits(straight), left);
            global ushort* to =
                straight_light + ((size_t)strand * (size_t)look_frame->suns + (size_t)k) * (size_t)count;
            for (int lane = 0; lane < min(WIDTH, count - i); ++lane)
                to[i + lane] = (ushort)left[lane];
            const float far = 1.0f - look_frame->near;
            f = rgb(far * f.r, far * f.g, far * f.b);
#endif
#if LEVEL == 3
            const Inclined at = inclined(a.ci);
            const Rgb on = rgb(share_at(&curves[0], FORWARD, tip, at), share_at(&curves[1], FORWARD, tip, at),
                               share_at(&curves[2], FORWARD, tip, at));
            const Rgb behind = rgb(share_at(&curves[0], BEHIND, tip, at), share_at(&curves[1], BEHIND, tip, at),
                                   share_at(&curves[2], BEHIND, tip, at));
            // All channels are as wide as green.
            const real further = share_at(&curves[1], FORWARD_VARIANCE, tip, at) * fibres_crossed(on.g, tau) + l.w;
            const real back_v = share_at(&curves[1], BEHIND_VARIANCE, tip, at);
            const real facing = 0.5f * fmax(a.cos_phi, (real)(0.0f));
            const real back = facing * longitudinal(a.si, a.ci, a.so, a.co, back_v + l.w);
            const real back_further = facing * longitudinal(a.si, a.ci, a.so, a.co, back_v + further);
            const Rgb g = far_field(fibre, a, lobe_heights(fibre, a, further), absorb, 2, true);
            sum.r += e.x * (straight * (f.r + behind.r * back) +
                            open * forwarded(on.r, tau) * (g.r + behind.r * back_further));
            sum.g += e.y * (straight * (f.g + behind.g * back) +
                            open * forwarded(on.g, tau) * (g.g + behind.g * back_further));
            sum.b += e.z * (straight * (f.b + behind.b * back) +
                            open * forwarded(on.b, tau) * (g.b + behind.b * back_further));
#else
            sum.r += e.x * straight * f.r;
            sum.g += e.y * straight * f.g;
            sum.b += e.z * straight * f.b;
#endif
        }

        // The sky, in the two halves of the cone: what lies before the fibre it throws back, what lies behind it comes
        // through. The mean direction of a half is 2 / pi from the axis.
        const real eye_cosine = sqrt(fmax(1.0f - along_eye * along_eye, (real)(0.0f)));
        const real down = -look_frame->cone * along_eye, aside = look_frame->cone * 0.636619772f;
        float at[3][WIDTH], cone[3][WIDTH], half_cone[3][WIDTH], before[3][WIDTH], beyond[3][WIDTH],
            shares_through[WIDTH];
        LANES_STORE(seen.x + sky_moved * to_eye.direction.x, at[0]);
        LANES_STORE(seen.y + sky_moved * to_eye.direction.y, at[1]);
        LANES_STORE(seen.z + sky_moved * to_eye.direction.z, at[2]);
        LANES_STORE(down * tx, cone[0]);
        LANES_STORE(down * ty, cone[1]);
        LANES_STORE(down * tz, cone[2]);
        LANES_STORE(aside * (ex - tx * along_eye), half_cone[0]);
        LANES_STORE(aside * (ey - ty * along_eye), half_cone[1]);
        LANES_STORE(aside * (ez - tz * along_eye), half_cone[2]);
        for (int lane = 0; lane < WIDTH; ++lane)
        {
            const TwoSides sides =
                two_sides(around, (float4)(at[0][lane], at[1][lane], at[2][lane], 0.0f),
                          (float4)(cone[0][lane], cone[1][lane], cone[2][lane], 0.0f),
                          (float4)(half_cone[0][lane], half_cone[1][lane], half_cone[2][lane], 0.0f), coarse_volume);
            before[0][lane] = sides.front.x;
            before[1][lane] = sides.front.y;
            before[2][lane] = sides.front.z;
            beyond[0][lane] = sides.behind.x;
            beyond[1][lane] = sides.behind.y;
            beyond[2][lane] = sides.behind.z;
            shares_through[lane] = sides.behind.w;
        }
        const Crossing c = crossing_at(curves, tip, inclined(eye_cosine));
        const Rgb comes = rgb(LANES_LOAD(before[0]), LANES_LOAD(before[1]), LANES_LOAD(before[2]));
        const Rgb through = rgb(LANES_LOAD(beyond[0]), LANES_LOAD(beyond[1]), LANES_LOAD(beyond[2]));
#if LEVEL == 3
        // What comes through cannot come back as well: a white stack lets through and throws back all light, not more.
        const real dense = 1.0f - fmin(LANES_LOAD(shares_through), (real)(1.0f));
        const Rgb back = rgb(c.backward.r + dense * back_albedo(c.forward.r, c.backward.r),
                             c.backward.g + dense * back_albedo(c.forward.g, c.backward.g),
                             c.backward.b + dense * back_albedo(c.forward.b, c.backward.b));
#else
        const Rgb back = c.backward;
#endif
        sum.r += open * (back.r * comes.r + c.forward.r * through.r);
        sum.g += open * (back.g * comes.g + c.forward.g * through.g);
        sum.b += open * (back.b * comes.b + c.forward.b * through.b);
        uint rg[WIDTH], b[WIDTH];
        LANES_STORE(half_bits(sum.r) | half_bits(sum.g) << 16, rg);
        LANES_STORE(half_bits(sum.b), b);
        for (int lane = 0; lane < min(WIDTH, count - i); ++lane)
            shaded[(size_t)strand * (size_t)count + (size_t)(i + lane)] = (uint2)(rg[lane], b[lane]);
    }
}

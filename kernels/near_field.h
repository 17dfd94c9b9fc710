// How one fibre scatters light at one place across it (near field): Chiang 2016, eq. 1 to 11, as
// app/traced/fibre_near.h has it. For strands that are drawn so wide that it is seen; the mean over h is far_field() of
// fibre.h, but that R has a lobe of its own width here. Pure functions; what fibre.h says of names and units holds.
#ifndef COIF_NEAR_FIELD_H
#define COIF_NEAR_FIELD_H
#include "fibre.h"

// A logistic cut off at half a turn to either side (Chiang 2016, eq. 8 to 10): one over its scale, and four times its
// height. Of two the wider is the lower one.
STRUCT(LobeWidth) { REAL inverse, height; };

CURVE_FUNCTION LobeWidth lobe_width(REAL s)
{
    LobeWidth of;
    of.inverse = 1.0f / max(s, 1e-4f);
    REAL w = exp(-FIBRE_PI * of.inverse);
    of.height = of.inverse * (1.0f + w) / (1.0f - w);
    return of;
}

CURVE_FUNCTION REAL lobe_at(REAL x, LobeWidth a, LobeWidth b)
{
    REAL e = exp(-fabs(wrapped(x)) * min(a.inverse, b.inverse));
    return min(a.height, b.height) * e / squared(1.0f + e);
}

// The share of it that lies below x; further turns of x count further lobes.
CURVE_FUNCTION REAL lobe_below(REAL x, LobeWidth of)
{
    REAL turns = floor(x * (0.5f / FIBRE_PI) + 0.5f), y = x - 2.0f * FIBRE_PI * turns;
    REAL e = exp(-fabs(y) * of.inverse), half_share = 0.5f * of.height / of.inverse * (1.0f - e) / (1.0f + e);
    return turns + SELECT(-half_share, half_share, y > 0.0f);
}

// What of a `slice` of h about a place hangs not on the light: what is left of it in each lobe but R, where that
// leaves, and how wide it is at least, so that it covers the slice. At -h all is the same but for the sign of azimuths.
STRUCT(NearPlace)
{
    Rgb tt, trt, rest;
    REAL phi_tt, phi_trt;
    LobeWidth wide_tt, wide_trt;
};

CURVE_FUNCTION NearPlace near_place(Fibre f, FibreAngles a, Rgb absorb, float h, float slice)
{
    FibrePlace p = place_across(f, a, h, slice);
    NearPlace n;
    n.phi_tt = p.through;
    n.phi_trt = p.back;
    n.wide_tt = lobe_width(p.wide_tt);
    n.wide_trt = lobe_width(p.wide_trt);
    REAL entering = squared(1.0f - p.mirrored);
    Rgb t = rgb(exp(absorb.r * p.way), exp(absorb.g * p.way), exp(absorb.b * p.way));
    n.tt = rgb(t.r * entering, t.g * entering, t.b * entering);
    Rgb again = rgb(t.r * p.mirrored, t.g * p.mirrored, t.b * p.mirrored); // of each reflection inside
    n.trt = rgb(n.tt.r * again.r, n.tt.g * again.g, n.tt.b * again.b);
    n.rest = rgb(n.trt.r * again.r / (1.0f - again.r), n.trt.g * again.g / (1.0f - again.g),
                 n.trt.b * again.b / (1.0f - again.b));
    return n;
}

// What of a light hangs not on the place: the longitudinal heights of its lobes, all of R, the azimuth and the width of
// azimuthal lobes.
STRUCT(NearLight)
{
    REAL reflected, tt, trt, rest, phi;
    LobeWidth own;
};

// `a`, but that phi is counted from the eye to the light, and positive where that is on the side of h below 0.
// `variance`: of LookRay, the square of the light's radius r, which about the fibre is wider by 1 / cos. A logistic of
// scale pi / 8 r is as high in its middle, 2 / (pi r), as a disc.
CURVE_FUNCTION NearLight near_light(Fibre f, FibreAngles a, float variance)
{
    REAL s = min(sqrt(f.logistic * f.logistic + 0.154212569f * variance / (a.ci * a.ci)), FIBRE_PI);
    REAL wide = variance;
    LobeHeights m = lobe_heights(f, a, wide);
    // As far_field() has it, but that where it grazes its lobe's width keeps it off the very edge.
    REAL cosine = max(a.cos_half, min(0.7f * s, 1.0f));
    NearLight l;
    l.reflected = m.r * 0.25f * cosine * fresnel(a.co * cosine, f.ior);
    l.tt = m.tt;
    l.trt = m.trt;
    l.rest = m.rest;
    l.phi = a.phi;
    l.own = lobe_width(s);
    return l;
}

CURVE_FUNCTION NearLight mirrored_light(NearLight l)
{
    l.phi = -l.phi;
    return l;
}

// The azimuth that R leaves at.
CURVE_FUNCTION float reflected_at(float h) { return -2.0f * asin(h < -1.0f ? -1.0f : h > 1.0f ? 1.0f : h); }

// What R sends from all places that it leaves from at a greater azimuth, as a share of the width.
CURVE_FUNCTION REAL reflected_beyond(NearLight l, float azimuth)
{
    return l.reflected * lobe_below(l.phi - azimuth, l.own);
}

// `r`: that of the place's slice, over the slice's share of the width.
CURVE_FUNCTION Rgb near_field(NearPlace p, NearLight l, REAL r)
{
    REAL tt = l.tt * lobe_at(l.phi - p.phi_tt, l.own, p.wide_tt);
    REAL trt = l.trt * lobe_at(l.phi - p.phi_trt, l.own, p.wide_trt);
    return rgb(r + tt * p.tt.r + trt * p.trt.r + l.rest * p.rest.r, r + tt * p.tt.g + trt * p.trt.g + l.rest * p.rest.g,
               r + tt * p.tt.b + trt * p.trt.b + l.rest * p.rest.b);
}

#endif

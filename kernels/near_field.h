// How one fibre scatters light at one place across it (near field): Chiang 2016, eq. 1 to 11, as
// app/traced/fibre_near.h has it. For strands that are drawn so wide that it is seen; the mean over h is far_field() of
// fibre.h, but that R has a lobe of its own width here. Pure functions; what fibre.h says of names and units holds.
#ifndef COIF_NEAR_FIELD_H
#define COIF_NEAR_FIELD_H
#include "fibre.h"

// What of a place hangs not on the light: what is left of it in each lobe, where that leaves and how wide it is at
// least, so that it covers a `slice` of h.
STRUCT(NearPlace)
{
    REAL r;
    Rgb tt, trt, rest;
    REAL phi_tt, phi_trt, wide_r, wide_tt, wide_trt;
    float phi_r;
};

CURVE_FUNCTION NearPlace near_place(Fibre f, FibreAngles a, Rgb absorb, float h, float slice)
{
    FibrePlace p = place_across(f, a, h, slice);
    NearPlace n;
    n.r = p.mirrored;
    n.phi_r = -2.0f * asin(h);
    n.phi_tt = p.through;
    n.phi_trt = p.back;
    n.wide_r = min(0.5f * slice / sqrt(1.0f - h * h), FIBRE_PI);
    n.wide_tt = p.wide_tt;
    n.wide_trt = p.wide_trt;
    REAL entering = squared(1.0f - p.mirrored);
    Rgb t = rgb(exp(absorb.r * p.way), exp(absorb.g * p.way), exp(absorb.b * p.way));
    n.tt = rgb(t.r * entering, t.g * entering, t.b * entering);
    Rgb again = rgb(t.r * p.mirrored, t.g * p.mirrored, t.b * p.mirrored); // of each reflection inside
    n.trt = rgb(n.tt.r * again.r, n.tt.g * again.g, n.tt.b * again.b);
    n.rest = rgb(n.trt.r * again.r / (1.0f - again.r), n.trt.g * again.g / (1.0f - again.g),
                 n.trt.b * again.b / (1.0f - again.b));
    return n;
}

// Cut off at half a turn to either side.
CURVE_FUNCTION REAL trimmed_logistic(REAL x, REAL s)
{
    REAL inverse_s = 1.0f / s, e = exp(-fabs(wrapped(x)) * inverse_s), w = exp(-FIBRE_PI * inverse_s);
    return inverse_s * e * (1.0f + w) / (squared(1.0f + e) * (1.0f - w));
}

// `phi` from the eye to the light, positive where the light is on the side of h below 0; `s`: scale of the azimuthal
// lobes.
CURVE_FUNCTION Rgb near_field(NearPlace p, LobeHeights m, REAL phi, REAL s)
{
    REAL r = m.r * p.r * trimmed_logistic(phi - p.phi_r, max(s, p.wide_r));
    REAL tt = m.tt * trimmed_logistic(phi - p.phi_tt, max(s, p.wide_tt));
    REAL trt = m.trt * trimmed_logistic(phi - p.phi_trt, max(s, p.wide_trt));
    return rgb(r + tt * p.tt.r + trt * p.trt.r + m.rest * p.rest.r, r + tt * p.tt.g + trt * p.trt.g + m.rest * p.rest.g,
               r + tt * p.tt.b + trt * p.trt.b + m.rest * p.rest.b);
}

// Scale of the azimuthal lobes of a light that is as wide as `variance` tells (of LookRay): the square of its radius r,
// which about the fibre is wider by 1 / cos. A logistic of pi / 8 r is as high in its middle, 2 / (pi r), as a disc.
CURVE_FUNCTION REAL logistic_of(Fibre f, FibreAngles a, float variance)
{
    return min(sqrt(f.logistic * f.logistic + 0.154212569f * variance / (a.ci * a.ci)), FIBRE_PI);
}

#endif

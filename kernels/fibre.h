// How one hair fibre scatters light, seen from afar, and what many of them do together. Pure functions, read by OpenCL
// for lanes and by the tests' C++; the names that they expect are those of ribbon.h, and SELECT(no, yes, test).
//
// theta is the inclination to the fibre's normal plane, positive towards the tip; phi the angle about the fibre between
// light and eye, 0 where the light comes from the eye's side. Directions point away from the fibre. si, ci, so, co:
// sine and cosine of theta of the light and of the eye. What is scattered is radiance per unit of irradiance on a
// surface that faces the light: the fibre's cosine is in it. Variances v are of sin theta, and absorption is per radius
// of the fibre.
//
//   d'Eon 2011   d'Eon, Francois, Hill, Letteri, Aubry. An energy-conserving hair reflectance model. 2011.
//   Chiang 2016  Chiang, Bitterli, Tappan, Burley. A practical and controllable hair and fur model. 2016.
//   Karis 2016   Karis. Physically based hair shading in Unreal. SIGGRAPH course, 2016.
//   Zinke 2008   Zinke, Yuksel, Weber, Keyser. Dual scattering approximation for fast multiple scattering in hair.
//   2008.
#ifndef COIF_FIBRE_H
#define COIF_FIBRE_H

#define FIBRE_PI 3.14159265f

// What is the same for a whole strand.
STRUCT(Fibre)
{
    float variance; // longitudinal, of the lobe R: Chiang 2016, eq. 7; TT has a quarter, TRT and the rest four times
    float logistic; // scale of the azimuthal lobes, rad: Chiang 2016, eq. 8
    float ior;
    float sin_tilt, cos_tilt;             // of the cuticle's scales
    float sin_twice_tilt, cos_twice_tilt; // R leans by twice the tilt to the root
    float sin_four_tilt, cos_four_tilt;   // TRT by four times to the tip
};

// Between a fibre, a light and the eye.
STRUCT(FibreAngles)
{
    REAL si, ci, so, co;
    REAL phi, cos_phi, cos_half; // half of phi
};

STRUCT(Rgb) { REAL r, g, b; };

CURVE_FUNCTION Rgb rgb(REAL r, REAL g, REAL b)
{
    Rgb c;
    c.r = r;
    c.g = g;
    c.b = b;
    return c;
}

CURVE_FUNCTION REAL squared(REAL x) { return x * x; }

// Abramowitz, Stegun 1964, 4.4.46: within 2e-8.
CURVE_FUNCTION REAL arc_cosine(REAL x)
{
    REAL a = min(fabs(x), 1.0f);
    REAL p = 0.0066700901f - 0.0012624911f * a;
    p = -0.0170881256f + a * p;
    p = 0.0308918810f + a * p;
    p = -0.0501743046f + a * p;
    p = 0.0889789874f + a * p;
    p = -0.2145988016f + a * p;
    p = 1.5707963050f + a * p;
    p *= sqrt(1.0f - a);
    return SELECT(p, FIBRE_PI - p, x < 0.0f);
}

CURVE_FUNCTION REAL arc_sine(REAL x) { return 0.5f * FIBRE_PI - arc_cosine(x); }

CURVE_FUNCTION REAL wrapped(REAL angle) { return angle - 2.0f * FIBRE_PI * floor(angle * (0.5f / FIBRE_PI) + 0.5f); }

// I0(x) exp(-x) for x no less than 0. Abramowitz, Stegun 1964, 9.8.1 and 9.8.2: within 2e-7.
CURVE_FUNCTION REAL scaled_bessel(REAL x)
{
    REAL low = min(x, 3.75f), t = squared(low * (1.0f / 3.75f));
    REAL p = 0.0360768f + 0.0045813f * t;
    p = 0.2659732f + t * p;
    p = 1.2067492f + t * p;
    p = 3.0899424f + t * p;
    p = 3.5156229f + t * p;
    p = exp(-low) * (1.0f + t * p);
    REAL inverse = 1.0f / max(x, 3.75f), u = 3.75f * inverse;
    REAL q = -0.01647633f + 0.00392377f * u;
    q = 0.02635537f + u * q;
    q = -0.02057706f + u * q;
    q = 0.00916281f + u * q;
    q = -0.00157565f + u * q;
    q = 0.00225319f + u * q;
    q = 0.01328592f + u * q;
    q = 0.39894228f + u * q;
    return SELECT(p, q * sqrt(inverse), x > 3.75f);
}

// M of d'Eon 2011, eq. 7, written so that nothing overflows whatever the variance (above 0).
CURVE_FUNCTION REAL longitudinal(REAL si, REAL ci, REAL so, REAL co, REAL v)
{
    REAL inverse = 1.0f / v;
    return scaled_bessel(ci * co * inverse) * exp((ci * co - si * so - 1.0f) * inverse) * inverse /
           (1.0f - exp(-2.0f * inverse));
}

// The same for a lobe that leans: the eye is taken to be further to the tip by an angle of that sine and cosine.
CURVE_FUNCTION REAL leaning(FibreAngles a, float sine, float cosine, REAL v)
{
    return longitudinal(a.si, a.ci, a.so * cosine + a.co * sine, fabs(a.co * cosine - a.so * sine), v);
}

// Two logistics of scale 1 / inverse_s, at x and at y. Divisions are what most of the time goes into: one serves both.
CURVE_FUNCTION REAL logistics(REAL x, REAL y, REAL inverse_s)
{
    REAL e = exp(-fabs(x) * inverse_s), f = exp(-fabs(y) * inverse_s);
    REAL under_e = squared(1.0f + e), under_f = squared(1.0f + f);
    return inverse_s * (e * under_f + f * under_e) / (under_e * under_f);
}

// Of the light within 90 degrees of `angle` (in [-pi, pi]) about the fibre, the share that a lobe has there: a trimmed
// logistic (Chiang 2016, eq. 11) whose share below x is 1/2 + sign(x) / 2 (1 - e) / (1 + e) (1 + w) / (1 - w), with
// e = exp(-|x| / s) and w = exp(-pi / s).
CURVE_FUNCTION REAL logistic_half(REAL angle, REAL s)
{
    REAL inverse_s = 1.0f / s, a = fabs(angle), w = exp(-FIBRE_PI * inverse_s);
    REAL to = exp(-min(a + 0.5f * FIBRE_PI, FIBRE_PI) * inverse_s), from = exp(-fabs(a - 0.5f * FIBRE_PI) * inverse_s),
         around = exp(-min(1.5f * FIBRE_PI - a, FIBRE_PI) * inverse_s);
    REAL below = (1.0f - from) * (1.0f + to) * (1.0f + around);
    REAL share = (1.0f - to) * (1.0f + from) * (1.0f + around) - SELECT(-below, below, a > 0.5f * FIBRE_PI) -
                 (1.0f - around) * (1.0f + to) * (1.0f + from);
    return 0.5f + 0.5f * share * (1.0f + w) / ((1.0f + to) * (1.0f + from) * (1.0f + around) * (1.0f - w));
}

// Fresnel's share of unpolarised light that a dielectric reflects.
CURVE_FUNCTION REAL fresnel(REAL cosine, float ior)
{
    REAL c = clamp(cosine, 0.0f, 1.0f);
    float slower = 1.0f / (ior * ior);
    REAL t = sqrt(max(1.0f - (1.0f - c * c) * slower, 0.0f));
    REAL under_s = c + ior * t, under_p = ior * c + t, inverse = 1.0f / (under_s * under_p);
    REAL s = (c - ior * t) * under_p * inverse, p = (ior * c - t) * under_s * inverse;
    return 0.5f * (s * s + p * p);
}

// From the cosines of tangent and light, tangent and eye, light and eye. The guards keep a light along the strand, or
// an eye, at a thousandth of a radian from it.
CURVE_FUNCTION FibreAngles fibre_angles(REAL along_light, REAL along_eye, REAL light_eye)
{
    FibreAngles a;
    a.si = clamp(along_light, -0.9999995f, 0.9999995f);
    a.so = clamp(along_eye, -0.9999995f, 0.9999995f);
    a.ci = sqrt(1.0f - a.si * a.si);
    a.co = sqrt(1.0f - a.so * a.so);
    a.cos_phi = clamp((light_eye - a.si * a.so) / (a.ci * a.co), -1.0f, 1.0f);
    a.phi = arc_cosine(a.cos_phi);
    a.cos_half = sqrt(0.5f + 0.5f * a.cos_phi);
    return a;
}

// What of the lobes hangs neither on the colour nor on the place across the fibre.
STRUCT(LobeHeights) { REAL r, tt, trt, rest; };

// Longitudinal heights, each lobe widened by a further variance.
CURVE_FUNCTION LobeHeights lobe_heights(Fibre f, FibreAngles a, REAL further)
{
    LobeHeights m;
    m.r = leaning(a, f.sin_twice_tilt, f.cos_twice_tilt, f.variance + further);
    m.tt = leaning(a, -f.sin_tilt, f.cos_tilt, 0.25f * f.variance + further);
    m.trt = leaning(a, -f.sin_four_tilt, f.cos_four_tilt, 4.0f * f.variance + further);
    m.rest = longitudinal(a.si, a.ci, a.so, a.co, 4.0f * f.variance + further) * (0.5f / FIBRE_PI);
    return m;
}

// A place across the fibre, h from its middle in [-1, 1], and how light goes in there (Chiang 2016, eq. 2 to 6).
STRUCT(FibrePlace)
{
    REAL mirrored;          // Fresnel's share
    REAL way;               // inside, from wall to wall, in radii and below 0: exp(way * absorption) is left
    REAL through, back;     // azimuths that TT and TRT leave at, but for whole turns
    REAL wide_tt, wide_trt; // scale of the logistic that covers what `slice` of h turns either lobe by
};

CURVE_FUNCTION FibrePlace place_across(Fibre f, FibreAngles a, float h, float slice)
{
    // Bravais' index of the normal plane (Marschner et al. 2003, section 4.1), and the cosine of the way inside.
    float slower = 1.0f / (f.ior * f.ior);
    REAL per_bent = a.co / sqrt(max(f.ior * f.ior - a.so * a.so, 1e-6f));
    REAL inner = 1.0f / sqrt(max(1.0f - a.so * a.so * slower, 1e-6f));
    float cos_outer = sqrt(1.0f - h * h), outer = asin(h);
    REAL sin_inner = h * per_bent, cos_inner = sqrt(max(1.0f - sin_inner * sin_inner, 1e-6f));
    REAL turn = arc_sine(sin_inner);
    REAL per_turn = 2.0f * per_bent / cos_inner;
    float per_outer = 2.0f / cos_outer;
    FibrePlace p;
    p.mirrored = fresnel(a.co * cos_outer, f.ior);
    p.way = -2.0f * cos_inner * inner;
    p.through = 2.0f * turn - 2.0f * outer + FIBRE_PI;
    p.back = 4.0f * turn - 2.0f * outer;
    p.wide_tt = min(0.25f * slice * fabs(per_turn - per_outer), FIBRE_PI);
    p.wide_trt = min(0.25f * slice * fabs(2.0f * per_turn - per_outer), FIBRE_PI);
    return p;
}

// The lobes averaged over the fibre's width, at `nodes` places across it (Chiang 2016, eq. 2 to 6): a strand is thinner
// than a pixel, so that the place is not known. Each place's azimuthal lobe is widened to cover its own share of the
// width. `around`: light that has gone through other fibres comes from the whole half plane in front, and so is
// averaged over it (N^G of Zinke 2008, eq. 21).
//
// R needs no places: its average has a closed form, cos(phi / 2) F / 4 (Marschner et al. 2003, eq. 4 with p = 0).
CURVE_FUNCTION Rgb far_field(Fibre f, FibreAngles a, LobeHeights m, Rgb absorb, int nodes, bool around)
{
    float slice = 2.0f / (float)nodes, share = 1.0f / (float)nodes;
    REAL white = m.r * 0.25f * a.cos_half * fresnel(a.co * a.cos_half, f.ior);
    if (around) // cos(phi / 2) / 4 averaged over the half plane; the mean of the angle stands for it in F
    {
        REAL sin_half = sqrt(max(1.0f - a.cos_half * a.cos_half, 0.0f));
        REAL turned = SELECT(0.70710678f * a.cos_half, 1.0f - 0.70710678f * sin_half, a.cos_phi < 0.0f);
        white = m.r * (1.0f / FIBRE_PI) * turned * fresnel(a.co * 0.70710678f, f.ior);
    }
    Rgb sum = rgb(white, white, white);
    for (int i = 0; i < nodes / 2; ++i) // places on both sides alike, but for the sign of the azimuth
    {
        FibrePlace p = place_across(f, a, ((float)i + 0.5f) * slice, slice);
        REAL mirrored = p.mirrored, entering = squared(1.0f - mirrored) * share;
        REAL s_tt = max(f.logistic, p.wide_tt), s_trt = max(f.logistic, p.wide_trt);
        REAL n_tt, n_trt;
        if (around)
        {
            n_tt = (logistic_half(wrapped(a.phi - p.through), s_tt) + logistic_half(wrapped(a.phi + p.through), s_tt)) *
                   (1.0f / FIBRE_PI);
            n_trt = (logistic_half(wrapped(a.phi - p.back), s_trt) + logistic_half(wrapped(a.phi + p.back), s_trt)) *
                    (1.0f / FIBRE_PI);
        }
        else
        {
            REAL per_tt = 1.0f / s_tt, per_trt = 1.0f / s_trt;
            REAL e_tt = exp(-FIBRE_PI * per_tt), e_trt = exp(-FIBRE_PI * per_trt);
            n_tt = logistics(wrapped(a.phi - p.through), wrapped(a.phi + p.through), per_tt) *
                   ((1.0f + e_tt) / (1.0f - e_tt));
            n_trt = logistics(wrapped(a.phi - p.back), wrapped(a.phi + p.back), per_trt) *
                    ((1.0f + e_trt) / (1.0f - e_trt));
        }
        REAL tt = m.tt * n_tt * entering, trt = m.trt * n_trt * entering * mirrored;
        REAL rest = m.rest * entering * mirrored * mirrored * 2.0f;
        // Each channel's series of further reflections ends in a division; one serves all three.
        Rgb t = rgb(exp(absorb.r * p.way), exp(absorb.g * p.way), exp(absorb.b * p.way));
        Rgb under = rgb(1.0f - t.r * mirrored, 1.0f - t.g * mirrored, 1.0f - t.b * mirrored);
        rest /= under.r * under.g * under.b;
        sum.r += t.r * (tt + t.r * (trt + t.r * rest * under.g * under.b));
        sum.g += t.g * (tt + t.g * (trt + t.g * rest * under.r * under.b));
        sum.b += t.b * (tt + t.b * (trt + t.b * rest * under.r * under.g));
    }
    return sum;
}

CURVE_FUNCTION REAL gaussian(REAL x, REAL width) { return exp(-0.5f * squared(x / width)) / (2.50662827f * width); }

CURVE_FUNCTION REAL schlick(REAL cosine)
{
    REAL m = 1.0f - cosine, m2 = m * m;
    return 0.0465f + 0.9535f * m2 * m2 * m;
}

// Fits of the azimuthal lobes for an index of 1.55, with gaussians in sin theta: Karis 2016, "simplified model".
// `roughness` as authored, not below 0.02.
CURVE_FUNCTION Rgb karis(Fibre f, FibreAngles a, Rgb absorb, float roughness)
{
    float wide = roughness * roughness;
    // Of half the angle between the inclinations.
    REAL cos_d = sqrt(max(0.5f + 0.5f * (a.ci * a.co + a.si * a.so), 1e-4f));
    REAL index = 1.19f / cos_d + 0.36f * cos_d;
    REAL both = a.si + a.so; // 0 where the eye lies on the cone of reflection

    REAL shift = -2.0f * f.sin_twice_tilt * (f.cos_twice_tilt * a.cos_half * a.co + f.sin_twice_tilt * a.so) * 0.5f;
    REAL cos_light_eye = clamp(a.cos_phi * a.ci * a.co + a.si * a.so, -1.0f, 1.0f);
    REAL white = gaussian(both - shift, wide * 1.41421356f * a.cos_half + 1e-3f) * 0.25f * a.cos_half *
                 schlick(sqrt(0.5f + 0.5f * cos_light_eye));

    REAL h = a.cos_half * (1.0f + (0.6f - 0.8f * a.cos_phi) / index);
    REAL mirrored = schlick(cos_d * sqrt(max(1.0f - h * h, 0.0f)));
    REAL tt =
        gaussian(both - f.sin_tilt, 0.5f * wide + 1e-4f) * squared(1.0f - mirrored) * exp(-3.65f * a.cos_phi - 3.98f);
    REAL way_tt = -2.0f * sqrt(max(1.0f - squared(h / index), 0.0f)) / cos_d;

    REAL inside = schlick(cos_d * 0.5f);
    REAL trt = gaussian(both - f.sin_four_tilt, 2.0f * wide + 1e-4f) * squared(1.0f - inside) * inside *
               exp(17.0f * a.cos_phi - 16.78f);
    REAL way_trt = -3.2f / cos_d;
    return rgb(white + tt * exp(absorb.r * way_tt) + trt * exp(absorb.r * way_trt),
               white + tt * exp(absorb.g * way_tt) + trt * exp(absorb.g * way_trt),
               white + tt * exp(absorb.b * way_tt) + trt * exp(absorb.b * way_trt));
}

// Absorption of hair that many fibres give a colour (linear), by Chiang 2016, eq. 9; `per_log` is the square of the
// inverse of its polynomial in the azimuthal roughness.
CURVE_FUNCTION REAL absorption_of(REAL color, float per_log)
{
    return squared(log(clamp(color, 1e-4f, 0.9999f))) * per_log;
}

// Light that comes through other fibres instead of past them: crossings are Poisson with mean tau, and each hands on
// the share `forward` (Zinke 2008, eq. 5 and 6, summed over the distribution).
CURVE_FUNCTION REAL forwarded(REAL forward, REAL tau) { return exp((forward - 1.0f) * tau) - exp(-tau); }

// Fibres that forwarded light has crossed, on average: of a Poisson number, given that it is not 0.
CURVE_FUNCTION REAL fibres_crossed(REAL forward, REAL tau)
{
    REAL met = forward * tau, small = 1.0f + 0.5f * met;
    return SELECT(small, met / (1.0f - exp(-max(met, 1e-3f))), met > 1e-3f);
}

// What the endless stack of fibres behind one throws back (Zinke 2008, eq. 12 and 13, to all orders: what two stacks
// make of each other, Stokes 1862), less what the fibre itself does.
CURVE_FUNCTION REAL back_albedo(REAL forward, REAL backward)
{
    REAL q = 1.0f + backward * backward - forward * forward;
    REAL root = sqrt(max(q * q - 4.0f * backward * backward, 0.0f));
    return max(2.0f * backward / max(q + root, 1e-6f) - backward, 0.0f);
}

#endif

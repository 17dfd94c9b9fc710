// A strand as it is drawn: how finely its curve is cut, what is laid on it, how wide it is and how it scatters light.
// Read by OpenCL and by GLSL, as strand_curve.h is. STYLE(name) is a parameter of the hairstyle, WITH_STYLE hands them
// down where a language has to; WAVE_NORMAL and WAVE_BINORMAL read the waves' table (sim/wave.h).
#ifndef COIF_RIBBON_H
#define COIF_RIBBON_H
#include "strand_curve.h"

#define BEND_TOLERANCE 0.5f // pixels that a piece may stray from the curve

// What is laid on a strand.
STRUCT(Waves)
{
    float normal_amplitude, normal_frequency, binormal_amplitude, binormal_frequency; // m, 1/m
    float curl, frizz;                                                                // m
    int own, together; // seeds: the strand's, and that of its curl, which the strands of a clump share
    float curl_begin;  // turns
};

CURVE_FUNCTION bool has_waves(Waves laid)
{
    return laid.normal_amplitude > 0.0f || laid.binormal_amplitude > 0.0f || laid.curl > 0.0f || laid.frizz > 0.0f;
}

// Moves along the strand's normal (x) and binormal (y), m, before the profile wave.along, at `distance` (m) from the
// root.
CURVE_FUNCTION REAL4 laid_across(WITH_STYLE Waves laid, REAL along, REAL distance)
{
    REAL x = 0.0f, y = 0.0f;
    if (laid.normal_amplitude > 0.0f || laid.binormal_amplitude > 0.0f)
    {
        REAL first = WAVE_NORMAL(wave_place(laid.own, distance, laid.normal_frequency, STYLE(wave_normal_randomness)));
        REAL second =
            WAVE_BINORMAL(wave_place(laid.own, distance, laid.binormal_frequency, STYLE(wave_binormal_randomness)));
        x = first * laid.normal_amplitude * wave_onset(along, STYLE(wave_normal_begin));
        y = second * laid.binormal_amplitude * wave_onset(along, STYLE(wave_binormal_begin));
    }
    if (laid.curl > 0.0f)
    {
        REAL size = laid.curl * wave_onset(along, STYLE(curl_begin));
        REAL4 turned = curl_at(laid.together, laid.curl_begin, distance, STYLE(curl_pitch), STYLE(curl_variation),
                               STYLE(curl_hand));
        x += size * turned.x;
        y += size * turned.y;
    }
    if (laid.frizz > 0.0f)
    {
        REAL size = laid.frizz * frizz_onset(along);
        REAL4 frizzed = frizz_at(laid.own, distance, STYLE(frizz_frequency));
        x += size * frizzed.x;
        y += size * frizzed.y;
    }
    return FLOAT4(x, y, 0.0f, 0.0f);
}

// How far a segment's chord strays, m, for what is laid on it: a sine of height a and length l strays by
// a (pi / n)^2 / 2 when a wave is cut in n. `segment` in m, `along` at its middle.
CURVE_FUNCTION REAL waves_stray(WITH_STYLE Waves laid, REAL segment, REAL along)
{
    REAL waves_n = segment * laid.normal_frequency, waves_b = segment * laid.binormal_frequency;
    REAL stray_n = laid.normal_amplitude * waves_n * waves_n, stray_b = laid.binormal_amplitude * waves_b * waves_b;
    REAL stray = sqrt(stray_n * stray_n + stray_b * stray_b);
    if (laid.curl > 0.0f)
    {
        REAL less = curl_less(laid.together, STYLE(curl_variation));
        REAL turns = segment / (STYLE(curl_pitch) * (1.0f - 0.5f * less));
        stray += laid.curl * (1.0f - less) * turns * turns;
    }
    if (laid.frizz > 0.0f)
    {
        REAL minds = 0.55f * segment * STYLE(frizz_frequency); // the sine that bends as much as a smooth step does
        stray += laid.frizz * frizz_size(laid.own) * minds * minds;
    }
    return 4.93f * stray * profile_at(STYLE(wave_along), along);
}

// The braid that a strand is plaited into, if any: laid on when it is drawn, about the line that its nodes follow
// (kernels/tails.h).
STRUCT(Braid)
{
    float4 place;            // in its plait
    float behind, per_along; // m behind the ring: at the root, where it is negative, and from root to tip
    float pitch, swing, depth, plait, bound; // as braid_offset() takes them; pitch 0: no braid
};

// From the three values a strand of braid_values() (sim/tied_hair.h).
CURVE_FUNCTION Braid braid_of(float4 a, float4 b, float4 c)
{
    Braid braid;
    braid.place = a;
    braid.place.w = 0.0f;
    braid.behind = a.w;
    braid.per_along = b.x;
    braid.pitch = b.y;
    braid.swing = b.z;
    braid.depth = b.w;
    braid.plait = c.x;
    braid.bound = c.y;
    return braid;
}

// Moves along the strand's normal, binormal and tangent; w: the share of light that comes there, less between plaits,
// which the light's grid is too coarse to tell apart.
CURVE_FUNCTION REAL4 braid_at(Braid braid, REAL along)
{
    REAL behind = braid.behind + along * braid.per_along, share = braid_share(behind, braid.pitch);
    REAL4 by = braid_offset(behind, braid.place, braid.pitch, braid.swing, braid.depth, braid.plait, braid.bound);
    REAL x = by.x / (braid.swing + braid.plait), y = by.y / (braid.depth + BRAID_FLAT * braid.plait);
    REAL open = 0.35f + 0.65f * smoothstep(0.25f, 0.95f, sqrt(x * x + y * y));
    REAL whole_light = 1.0f;
    return FLOAT4(share * by.x, share * by.y, share * by.z, mix(whole_light, open, share));
}

// Is a segment that ends at `along` plaited? 1 or 0.
CURVE_FUNCTION REAL is_plaited(Braid braid, REAL along) { return step(0.0f, braid.behind + along * braid.per_along); }

// As waves_stray(), for a segment that ends at `along`.
CURVE_FUNCTION REAL braid_stray(Braid braid, REAL segment, REAL along)
{
    REAL woven = segment / braid.pitch;
    float bend = sqrt(braid.swing * braid.swing + 16.0f * braid.depth * braid.depth); // to the side, and to the front
    return is_plaited(braid, along) * 4.93f * bend * woven * woven;
}

// m, for a strand that is `width` wide.
CURVE_FUNCTION REAL ribbon_width(WITH_STYLE float width, REAL along)
{
    return width * (1.0f - STYLE(look_taper) * along * along) * profile_at(STYLE(look_width_along), along);
}

CURVE_FUNCTION REAL brightness_of(WITH_STYLE int seed)
{
    return exp(STYLE(look_variation) * 2.0f * (strand_random(seed, RANDOM_BRIGHTNESS) - 0.5f));
}

// Kajiya-Kay: a fibre scatters light as a thin cylinder does, so only angles to its tangent count (Kajiya, Kay.
// Rendering fur with three dimensional textures. 1989; thesis eq. 5.9 and 5.10, with the exponents of listing A.2).
//
// Cosines of the angles to the light and to the eye; the share of the light that reaches the place. Gives what is
// ambient (x), diffuse (y) and specular (z).
CURVE_FUNCTION REAL4 kajiya_kay(WITH_STYLE REAL to_light, REAL to_eye, REAL light)
{
    REAL tl = clamp(to_light, -1.0f, 1.0f), te = clamp(to_eye, -1.0f, 1.0f);
    REAL sin_tl = sqrt(1.0f - tl * tl), sin_te = sqrt(1.0f - te * te);
    REAL diffuse = STYLE(look_diffuse) * POWER(sin_tl, STYLE(look_diffuse_exponent));
    // Listing A.2 measures the eye's angle from the other end of the tangent: the cone of reflection has its mirror
    // there.
    REAL specular = STYLE(look_specular) * POWER(max(sin_tl * sin_te - tl * te, 0.0f), STYLE(look_specular_exponent));
    // Hair that hides from the light hides from the surroundings too, though far less: they come in from all sides.
    REAL hidden = 0.4f, open = 1.0f;
    return FLOAT4(STYLE(look_ambient) * mix(hidden, open, POWER(light, 0.35f)), diffuse, specular, 0.0f);
}

// One channel of what it makes of hair of a colour and of the light that reaches it. The highlight leaves the surface
// almost uncoloured.
CURVE_FUNCTION REAL scattered(REAL4 fibre, REAL hair, REAL lit)
{
    REAL white = 1.0f;
    return hair * (fibre.x + fibre.y * lit) + mix(white, hair, 0.4f) * fibre.z * lit;
}

#endif

// The curve that is drawn through a strand's nodes: smoothing, what is laid on it, profiles, and what differs from
// strand to strand. Read by OpenCL (float3, float4) and by GLSL (where shaders/curve.glsl gives vec3 and vec4 those
// names), so that the two never hold two copies. Only scalar code and FLOAT4(): the two languages agree on little more.
// No local is const, which in GLSL 1.50 asks for a constant expression. REAL, WHOLE and BITS are float, int and uint,
// or as many of them as there are lanes, and REAL4 four REALs: what they hold may differ along a strand, all else does
// not.
#ifndef COIF_STRAND_CURVE_H
#define COIF_STRAND_CURVE_H

#define CURVE_LINEAR 0
#define CURVE_COSINE 1
#define CURVE_CUBIC 2
#define CURVE_CATMULL_ROM 3

// Weights of four neighbouring nodes at t in [0, 1] between the two in the middle (thesis 5.2.1, listings 5.5 and 5.6;
// cosine and cubic after Bourke, Interpolation methods, 1999).
CURVE_FUNCTION REAL4 curve_weights(int curve, REAL t)
{
    if (curve == CURVE_LINEAR)
        return FLOAT4(0.0f, 1.0f - t, t, 0.0f);
    if (curve == CURVE_COSINE)
    {
        REAL s = 0.5f - 0.5f * cos(3.14159265f * t);
        return FLOAT4(0.0f, 1.0f - s, s, 0.0f);
    }
    REAL t2 = t * t, t3 = t2 * t;
    if (curve == CURVE_CUBIC)
        return FLOAT4(-t3 + 2.0f * t2 - t, t3 - 2.0f * t2 + 1.0f, -t3 + t2 + t, t3 - t2);
    return FLOAT4(-0.5f * t3 + t2 - 0.5f * t, 1.5f * t3 - 2.5f * t2 + 1.0f, -1.5f * t3 + 2.0f * t2 + 0.5f * t,
                  0.5f * t3 - 0.5f * t2);
}

// A profile's four numbers stand at 0, 1/3, 2/3 and 1 of the strand, with straight lines between them. `along` is 0 at
// the root and 1 at the tip.
CURVE_FUNCTION REAL profile_at(float4 profile, REAL along)
{
    REAL t = 3.0f * along;
    return profile.x + (profile.y - profile.x) * clamp(t, 0.0f, 1.0f) +
           (profile.z - profile.y) * clamp(t - 1.0f, 0.0f, 1.0f) +
           (profile.w - profile.z) * clamp(t - 2.0f, 0.0f, 1.0f);
}

// The waves' table (a 1-D texture for GLSL) holds this many waves, each a little different; see sim/wave.cpp.
#define WAVE_PERIODS 32

// How far waves have set in at `along` (0 at the root, 1 at the tip), beginning at `begin`: smooth, full after a
// quarter of the strand.
CURVE_FUNCTION REAL wave_onset(REAL along, float begin)
{
    REAL t = clamp((along - begin) * 4.0f, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// How far a strand has come into its braid at `behind` (m) from the ring, wholly after a third of a turn.
CURVE_FUNCTION REAL braid_share(REAL behind, float pitch)
{
    REAL t = clamp(3.0f * behind / pitch, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

#define BRAID_FLAT 0.7f // plaits are pressed flat where they cross

// Where a strand lies off the line that its braid is plaited about, `behind` (m) the ring: along the braid's width,
// front and length. The plaits' middles swing as sin a to the sides and sin 2a to front and back, a third of a turn
// apart; the strand keeps its place (in the plait's radii; z: phase) in a cross-section that turns with the plait.
// Towards `bound` (m) all are drawn together, and hang loose beyond. `swing`, `depth` and `plait` in m.
CURVE_FUNCTION REAL4 braid_offset(REAL behind, float4 place, float pitch, float swing, float depth, float plait,
                                  float bound)
{
    float rate = 6.28318531f / pitch;
    REAL angle = rate * behind + place.z;
    REAL slope_x = swing * rate * cos(angle), slope_y = 2.0f * depth * rate * cos(2.0f * angle);
    // Across the plait: along the width first, then what is left.
    REAL across = 1.0f / sqrt(1.0f + slope_x * slope_x);
    REAL whole_slope = 1.0f / sqrt(1.0f + slope_x * slope_x + slope_y * slope_y);
    float u = plait * place.x, v = BRAID_FLAT * plait * place.y;
    REAL woven_x = swing * sin(angle) + u * across - v * slope_x * slope_y * across * whole_slope;
    REAL woven_y = depth * sin(2.0f * angle) + v * whole_slope / across;
    REAL woven_z = -u * slope_x * across - v * slope_y * across * whole_slope;
    REAL t = clamp((behind - bound) / (0.5f * pitch) + 1.0f, 0.0f, 1.0f);
    REAL loose = t * t * (3.0f - 2.0f * t);
    REAL tassel = plait * (0.75f + 0.5f * clamp((behind - bound) / pitch, 0.0f, 1.0f));
    REAL gathered_x = tassel * (0.6f * sin(place.z) + 0.5f * place.x), gathered_y = 0.9f * tassel * place.y;
    return FLOAT4(woven_x * (1.0f - loose) + gathered_x * loose, woven_y * (1.0f - loose) + gathered_y * loose,
                  woven_z * (1.0f - loose), 0.0f);
}

// A number in [0, 1) that depends on nothing but the strand and what it is for. PCG output, O'Neill 2014.
CURVE_FUNCTION REAL strand_random(WHOLE seed, WHOLE purpose)
{
    BITS state = TO_UINT(seed) * 747796405u + TO_UINT(purpose) * 2891336453u + 277803737u;
    BITS word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return TO_FLOAT(((word >> 22u) ^ word) >> 8u) * (1.0f / 16777216.0f);
}

#define RANDOM_BRIGHTNESS 1
#define RANDOM_WAVE_SHIFT 2
#define RANDOM_WAVE_PLACE 3
#define RANDOM_LAYER 4
#define RANDOM_CURL_PHASE 5
#define RANDOM_CURL_TOGETHER 6
#define RANDOM_CURL_VARIATION 7
#define RANDOM_CURL_HAND 8
#define RANDOM_FRIZZ 9
#define RANDOM_FRIZZ_SHIFT 10
#define RANDOM_CLUMP 11
#define RANDOM_FLYAWAY 12      // and six more
#define RANDOM_FRIZZ_FIRST 256 // and upwards and downwards: two for each turn of mind

// Where in the table, in whole tables, a strand's wave is at `distance` (m) from the root. With no randomness all
// strands wave in step; the more, the further apart their phases and the places of the table that they use.
CURVE_FUNCTION REAL wave_place(int seed, REAL distance, float frequency, float randomness)
{
    REAL shift = randomness * strand_random(seed, RANDOM_WAVE_SHIFT), place = 0.0f;
    if (randomness > 0.0f)
        place = floor(strand_random(seed, RANDOM_WAVE_PLACE) * 32.0f);
    return (distance * frequency + shift + place) * (1.0f / 32.0f);
}

#define CURL_LEFT 1
#define CURL_BOTH 2

// By how much less than the style's a curl's radius is.
CURVE_FUNCTION REAL curl_less(int together, float variation)
{
    return variation * strand_random(together, RANDOM_CURL_VARIATION);
}

// A helix of radius 1 across the strand at `distance` (m) from the root: along the normal, along the binormal. It
// begins `begin` turns on. What varies, varies with the seed `together`: the strand's, or that of all strands of a
// clump; half as much as the radius does the pitch (m).
CURVE_FUNCTION REAL4 curl_at(int together, float begin, REAL distance, float pitch, float variation, int hand)
{
    REAL less = curl_less(together, variation);
    REAL turns = distance / (pitch * (1.0f - 0.5f * less));
    if (hand == CURL_LEFT)
        turns = -turns;
    if (hand == CURL_BOTH)
        turns *= 2.0f * step(0.5f, strand_random(together, RANDOM_CURL_HAND)) - 1.0f;
    turns = begin + turns;
    REAL angle = 6.28318531f * (turns - floor(turns));
    return FLOAT4((1.0f - less) * cos(angle), (1.0f - less) * sin(angle), 0.0f, 0.0f);
}

// Noise between -1 and 1 that takes a random value at each whole number and goes smoothly from one to the next.
CURVE_FUNCTION REAL wandering(int seed, int purpose, REAL place)
{
    REAL cell = floor(place), t = place - cell;
    WHOLE at = purpose + 2 * TO_INT(cell);
    REAL a = strand_random(seed, at), b = strand_random(seed, at + 2);
    return 2.0f * (a + (b - a) * t * t * (3.0f - 2.0f * t)) - 1.0f;
}

// How far frizz has set in: at once, but from nothing, and no further at the tip.
CURVE_FUNCTION REAL frizz_onset(REAL along) { return along * (2.0f - along); }

// Of a strand's own, along each of two directions. Most have little of it and some all, or it would be a blur.
CURVE_FUNCTION REAL frizz_size(int seed)
{
    REAL most = strand_random(seed, RANDOM_FRIZZ);
    return 0.70710678f * (0.2f + 0.8f * most * most);
}

// Frizz of size 1 at most, as curl_at.
CURVE_FUNCTION REAL4 frizz_at(int seed, REAL distance, float frequency)
{
    REAL place = distance * frequency + strand_random(seed, RANDOM_FRIZZ_SHIFT);
    REAL own = frizz_size(seed);
    // Each turns while the other goes straight on.
    return FLOAT4(own * wandering(seed, RANDOM_FRIZZ_FIRST, place),
                  own * wandering(seed, RANDOM_FRIZZ_FIRST + 1, place + 0.5f), 0.0f, 0.0f);
}

#endif

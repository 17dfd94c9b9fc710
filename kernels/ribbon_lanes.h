// Gives strand_curve.h and ribbon.h the names that they expect, for lanes: WIDTH places along one strand side by side.
// What is the strand's own is said once for all of them, and each strand may be cut in as many pieces as it needs.
#ifndef COIF_RIBBON_LANES_H
#define COIF_RIBBON_LANES_H
#include "lanes.h"

typedef struct Reals
{
    real x, y, z, w;
} Reals;

static inline Reals reals(real x, real y, real z, real w)
{
    const Reals of = {x, y, z, w};
    return of;
}

// The waves' table: a pair of values for each place, from which it begins again. Linear between them.
#define WAVE_SAMPLES 1024
static inline real wave_at(global const float* table, int side, real place)
{
    const real at = (place - floor(place)) * (float)WAVE_SAMPLES - 0.5f, below = floor(at);
    const whole first = TO_WHOLE(below) & (WAVE_SAMPLES - 1), second = (first + 1) & (WAVE_SAMPLES - 1);
    int i[WIDTH], j[WIDTH];
    float a[WIDTH], b[WIDTH];
    LANES_STORE(first, i);
    LANES_STORE(second, j);
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        a[lane] = table[2 * i[lane] + side];
        b[lane] = table[2 * j[lane] + side];
    }
    const real low = LANES_LOAD(a);
    return low + (LANES_LOAD(b) - low) * (at - below);
}

#define CURVE_FUNCTION LAID_IN
#define REAL real
#define REAL4 Reals
#define WHOLE whole
#define BITS bits
#define FLOAT4(x, y, z, w) reals(x, y, z, w)
#define TO_INT(v) TO_WHOLE(v)
#define TO_UINT(v) AS_BITS(v)
#define TO_FLOAT(v) TO_REAL(v)
#define STRUCT(name)                                                                                                   \
    typedef struct name name;                                                                                          \
    struct name
#define WITH_STYLE constant HairParams *params, global const float *wave_table,
#define STYLE(name) params->name
#define POWER(x, y) exp2((y)*log2(x)) // half the time of powr(), and x is no less than 0
#define WAVE_NORMAL(place) wave_at(wave_table, 0, place)
#define WAVE_BINORMAL(place) wave_at(wave_table, 1, place)
#include "ribbon.h"

#endif

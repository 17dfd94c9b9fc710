// What a pixel sees of a strand that is lit from side to side as raster_near.h says: the mean over as much of its width
// as the pixel shares with it, so that pixels add up to the whole however thin it is.
#ifndef COIF_RASTER_ACROSS_H
#define COIF_RASTER_ACROSS_H

// Of a point, in each channel: in each cell, and in all before it.
typedef struct Across
{
    float in[3][NEAR_CELLS], before[3][NEAR_CELLS];
} Across;

static inline void load_across(global const ushort* near_light, Across* across)
{
    for (int c = 0; c < 3; ++c)
    {
        const uint16 halves = convert_uint16(vload16(c, near_light));
        const float16 in = as_float16((halves & 0x7fffu) << 13) * 5.19229686e33f; // from_half()
        float16 sum = in;
        sum += (float16)(0.0f, sum.s012, sum.s3456, sum.s789a, sum.sbcd, sum.se);
        sum += (float16)(0.0f, 0.0f, sum.s01, sum.s2345, sum.s6789, sum.sab, sum.scd);
        sum += (float16)((float4)(0.0f), sum.s0123, sum.s4567, sum.s89ab);
        sum += (float16)((float8)(0.0f), sum.lo);
        vstore16(in, 0, across->in[c]);
        vstore16(sum - in, 0, across->before[c]);
    }
}

static inline real entry_of(const float* table, whole at)
{
#if SIDE == 4 && NEAR_CELLS == 16 && defined(__AVX512F__)
    return __builtin_ia32_permvarsf512(vload16(0, table), at);
#elif SIDE == 1
    return table[at];
#else
    int i[SIDE * SIDE];
    float v[SIDE * SIDE];
    STORE(at, i);
    for (int k = 0; k < SIDE * SIDE; ++k)
        v[k] = table[i[k]];
    return LOAD(v);
#endif
}

// From one place across to another: cells, and how far into them.
typedef struct Stretch
{
    whole first, last;
    real in_first, in_last, per_length;
} Stretch;

// `aside`: from the strand's middle, and `wide`, in the pixels that it crosses. No less than a cell's length is looked
// at, or their borders would show.
static inline Stretch stretch_across(real aside, real wide)
{
    const real per_pixel = (float)NEAR_CELLS / fmax(wide, (real)(1e-6f));
    const real middle = 0.5f * (float)NEAR_CELLS + aside * per_pixel,
               half_length = fmax(0.5f * per_pixel, (real)(0.5f));
    const real from = clamp(middle - half_length, (real)(0.0f), (real)((float)NEAR_CELLS));
    const real to = clamp(middle + half_length, (real)(0.0f), (real)((float)NEAR_CELLS));
    Stretch s;
    s.first = min(TO_WHOLE(from), (whole)(NEAR_CELLS - 1));
    s.last = min(TO_WHOLE(to), (whole)(NEAR_CELLS - 1));
    s.in_first = from - TO_REAL(s.first);
    s.in_last = to - TO_REAL(s.last);
    s.per_length = 1.0f / fmax(to - from, (real)(1e-3f));
    return s;
}

static inline real light_in(const Across* across, int channel, Stretch s)
{
    const float *in = across->in[channel], *before = across->before[channel];
    return (entry_of(before, s.last) + s.in_last * entry_of(in, s.last) - entry_of(before, s.first) -
            s.in_first * entry_of(in, s.first)) *
           s.per_length;
}

#endif

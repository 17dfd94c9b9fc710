// The lane type: a strand is a lane of a vector on CPUs (WIDTH 8 or 16) and a work-item on GPUs (WIDTH 1), and one
// source serves both.
//
// select() tests the top bit for vectors and non-zero for scalars, so it is fed comparisons only.
#ifndef COIF_LANES_H
#define COIF_LANES_H
#include "shared.h"

#if WIDTH == 16
typedef float16 real;
typedef int16 whole;
typedef uint16 bits;
#define LANES_LOAD(p) vload16(0, p)
#define LANES_STORE(v, p) vstore16(v, 0, p)
#define TO_WHOLE(v) convert_int16(v)
#define TO_REAL(v) convert_float16(v)
#define AS_BITS(v) as_uint16(v)
#elif WIDTH == 8
typedef float8 real;
typedef int8 whole;
typedef uint8 bits;
#define LANES_LOAD(p) vload8(0, p)
#define LANES_STORE(v, p) vstore8(v, 0, p)
#define TO_WHOLE(v) convert_int8(v)
#define TO_REAL(v) convert_float8(v)
#define AS_BITS(v) as_uint8(v)
#else
typedef float real;
typedef int whole;
typedef uint bits;
#define LANES_LOAD(p) (*(p))
#define LANES_STORE(v, p) (*(p) = (v))
#define TO_WHOLE(v) convert_int(v)
#define TO_REAL(v) convert_float(v)
#define AS_BITS(v) as_uint(v)
#endif

// A call hands lanes over through memory, and a CPU's compiler calls what is long. What much of the time is spent in
// says that it is to be laid in where it is called, as GPUs' compilers do with everything.
#define LAID_IN __attribute__((always_inline)) static inline

// 1 / sqrt(x) of a positive number, to two units in the last place. On CPUs that is faster than rsqrt(x); where there
// is an estimate to 14 bits, one step of Newton's method from it takes a quarter of the time of a root and a division.
#if WIDTH == 16 && defined(__AVX512F__)
static inline real inverse_sqrt(real x)
{
    const real estimate = __builtin_ia32_rsqrt14ps512_mask(x, (real)(0.0f), (unsigned short)0xffff);
    return estimate * (1.5f - 0.5f * x * estimate * estimate);
}
#define INVERSE_SQRT(x) inverse_sqrt(x)
#else
#define INVERSE_SQRT(x) (1.0f / sqrt(x))
#endif

// Is it so in any lane? PoCL's any() tests lane after lane, which costs more than what it decides about.
static inline int any_lane(whole test)
{
#if WIDTH == 16
    const int8 in8 = test.lo | test.hi;
    const int4 in4 = in8.lo | in8.hi;
    const int2 in2 = in4.lo | in4.hi;
    return in2.x | in2.y;
#elif WIDTH == 8
    const int4 in4 = test.lo | test.hi;
    const int2 in2 = in4.lo | in4.hi;
    return in2.x | in2.y;
#else
    return test;
#endif
}

// The line of memory at p is wanted soon: what a CPU's vector of strands reads comes in bursts, with much work between.
#if WIDTH > 1
#define FETCH_SOON(p) __builtin_prefetch((const void*)(size_t)(p))
#else
#define FETCH_SOON(p)
#endif

// Two values side by side for each lane.
static inline void gather_pair(global const float* from, const int* first, real* low, real* high)
{
#if WIDTH == 1
    *low = from[first[0]];
    *high = from[first[0] + 1];
#else
    float pairs[2 * WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        vstore2(vload2(0, from + first[lane]), lane, pairs);
    const real a = LANES_LOAD(pairs), b = LANES_LOAD(pairs + WIDTH);
    *low = (real)(a.even, b.even);
    *high = (real)(a.odd, b.odd);
#endif
}

// The smallest lane.
static inline float least(real v)
{
#if WIDTH == 16
    const float8 in8 = fmin(v.lo, v.hi);
    const float4 in4 = fmin(in8.lo, in8.hi);
    const float2 in2 = fmin(in4.lo, in4.hi);
    return fmin(in2.x, in2.y);
#elif WIDTH == 8
    const float4 in4 = fmin(v.lo, v.hi);
    const float2 in2 = fmin(in4.lo, in4.hi);
    return fmin(in2.x, in2.y);
#else
    return v;
#endif
}

static inline float greatest(real v) { return -least(-v); }

#endif

// Gusts: gradient noise on a lattice of 0.15 m cells (Perlin. An image synthesizer. 1985, with the quintic fade of
// Improving noise. 2002), three independent components. Gradients come from a hash of the lattice point, not from a
// table, so that lanes need no gathers. The field drifts with the wind (Taylor's frozen turbulence, 1938).
#ifndef COIF_TURBULENCE_H
#define COIF_TURBULENCE_H
#include "lanes.h"

#define GUST_PERIOD 256 // cells after which the noise repeats; the host wraps the drift at it, so time never coarsens

static inline bits gust_hash(whole x, whole y, whole z, uint component)
{
    bits h = AS_BITS(x & (GUST_PERIOD - 1)) * 0x8da6b343u ^ AS_BITS(y & (GUST_PERIOD - 1)) * 0xd8163841u ^
             AS_BITS(z & (GUST_PERIOD - 1)) * 0xcb1ab31fu ^ component * 0x9e3779b9u;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

// Ten bits of a hash as a number in [-1, 1].
static inline real gust_unit(bits h, int shift) { return TO_REAL((h >> shift) & 1023u) * (2.0f / 1023.0f) - 1.0f; }

static inline real gust_corner(whole x, whole y, whole z, real dx, real dy, real dz, uint component)
{
    const bits h = gust_hash(x, y, z, component);
    return gust_unit(h, 0) * dx + gust_unit(h, 10) * dy + gust_unit(h, 20) * dz;
}

static inline real gust_fade(real t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }

// One component at a point in cells; about within [-1, 1], zero on average.
static inline real gust(real x, real y, real z, uint component)
{
    const real fx = floor(x), fy = floor(y), fz = floor(z);
    const whole ix = TO_WHOLE(fx), iy = TO_WHOLE(fy), iz = TO_WHOLE(fz);
    const real dx = x - fx, dy = y - fy, dz = z - fz;
    const real wx = gust_fade(dx), wy = gust_fade(dy), wz = gust_fade(dz);
    real sum = (real)(0.0f);
    for (int c = 0; c < 8; ++c)
    {
        const int cx = c & 1, cy = (c >> 1) & 1, cz = c >> 2;
        const real weight = (cx ? wx : 1.0f - wx) * (cy ? wy : 1.0f - wy) * (cz ? wz : 1.0f - wz);
        sum +=
            weight * gust_corner(ix + cx, iy + cy, iz + cz, dx - (float)cx, dy - (float)cy, dz - (float)cz, component);
    }
    return sum;
}

#endif

// Spheres that hair stays outside of (thesis 5.1.2, collision constraints): (centre, radius) relative to the head's
// origin, m.
#ifndef COIF_CONTACT_H
#define COIF_CONTACT_H
#include "lanes.h"

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

// The smallest lane.
static inline float least(real v)
{
    float lanes[WIDTH];
    LANES_STORE(v, lanes);
    float low = lanes[0];
#pragma unroll
    for (int lane = 1; lane < WIDTH; ++lane)
        low = fmin(low, lanes[lane]);
    return low;
}

static inline float greatest(real v) { return -least(-v); }

// The spheres that come near a box, by their numbers in rising order. Returns how many.
static inline int spheres_near(constant float4* spheres, int count, float3 low, float3 high, float room, short* which)
{
    int found = 0;
    for (int c = 0; c < count; ++c)
    {
        const float4 sphere = spheres[c];
        const float3 away = sphere.xyz - clamp(sphere.xyz, low, high);
        const float reach = sphere.w + room;
        if (dot(away, away) < reach * reach)
            which[found++] = (short)c;
    }
    return found;
}

// Moves a node straight out of a sphere to its surface. A node at the very centre leaves upwards.
static inline void push_out(real* x, real* y, real* z, float4 sphere)
{
    real dx = *x - sphere.x, dy = *y - sphere.y, dz = *z - sphere.z;
    const real squared = dx * dx + dy * dy + dz * dz;
    const float radius2 = sphere.w * sphere.w;
    if (!any_lane(squared < radius2))
        return;
    dy = select(dy, (real)(sphere.w), squared < 1e-12f * radius2);
    const real length2 = fmax(dx * dx + dy * dy + dz * dz, 1e-12f * radius2);
    const real out = sphere.w * INVERSE_SQRT(length2);
    *x = select(*x, sphere.x + dx * out, squared < radius2);
    *y = select(*y, sphere.y + dy * out, squared < radius2);
    *z = select(*z, sphere.z + dz * out, squared < radius2);
}

#endif

// Drawn strands in lanes: WIDTH of them side by side in a work-item. Their nodes lie strand after strand as float4, so
// that the renderer reads them as they are, and are gathered into lanes and scattered from them here.
#ifndef COIF_DRAWN_LANES_H
#define COIF_DRAWN_LANES_H
#include "lanes.h"

// One point of each lane's strand.
typedef struct Points
{
    real x, y, z;
} Points;

static inline Points points(real x, real y, real z)
{
    const Points p = {x, y, z};
    return p;
}

static inline Points minus(Points a, Points b) { return points(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline Points plus(Points a, Points b) { return points(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline Points times(real s, Points p) { return points(s * p.x, s * p.y, s * p.z); }

static inline Points turn_by(float4 row0, float4 row1, float4 row2, Points p)
{
    return points(row0.x * p.x + row0.y * p.y + row0.z * p.z, row1.x * p.x + row1.y * p.y + row1.z * p.z,
                  row2.x * p.x + row2.y * p.y + row2.z * p.z);
}

// A point of each lane, axis after axis as guides lie.
static inline Points load_lanes(global const float* from)
{
    return points(LANES_LOAD(from), LANES_LOAD(from + LANES), LANES_LOAD(from + 2 * LANES));
}

static inline void store_lanes(Points p, global float* to)
{
    LANES_STORE(p.x, to);
    LANES_STORE(p.y, to + LANES);
    LANES_STORE(p.z, to + 2 * LANES);
}

static inline real dot_lanes(Points a, Points b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static inline Points select_points(Points no, Points yes, whole which)
{
    return points(select(no.x, yes.x, which), select(no.y, yes.y, which), select(no.z, yes.z, which));
}

// One value for each lane. Written out, for through memory it takes twice as long.
static inline real gather(global const float* from, whole at)
{
#if WIDTH == 16
    return (real)(from[at.s0], from[at.s1], from[at.s2], from[at.s3], from[at.s4], from[at.s5], from[at.s6],
                  from[at.s7], from[at.s8], from[at.s9], from[at.sa], from[at.sb], from[at.sc], from[at.sd],
                  from[at.se], from[at.sf]);
#elif WIDTH == 8
    return (real)(from[at.s0], from[at.s1], from[at.s2], from[at.s3], from[at.s4], from[at.s5], from[at.s6],
                  from[at.s7]);
#else
    return from[at];
#endif
}

// The strands of the lanes from `first` on. Lanes past the last strand repeat it: they compute and store the same.
static inline void number_lanes(int first, int count, int* strand)
{
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        strand[lane] = min(first + lane, count - 1);
}

// Four strands' points at a time, whose components then find their lanes.
static inline Points load_node(global const float4* nodes, const int* strand, int node)
{
    nodes += node;
#define NODE_OF(lane) nodes[strand[lane] * NODES]
#define FOUR_FROM(lane) (float16)(NODE_OF(lane), NODE_OF(lane + 1), NODE_OF(lane + 2), NODE_OF(lane + 3))
#if WIDTH == 16
    const float16 a = FOUR_FROM(0), b = FOUR_FROM(4), c = FOUR_FROM(8), d = FOUR_FROM(12);
    return points((real)(a.s048c, b.s048c, c.s048c, d.s048c), (real)(a.s159d, b.s159d, c.s159d, d.s159d),
                  (real)(a.s26ae, b.s26ae, c.s26ae, d.s26ae));
#elif WIDTH == 8
    const float16 a = FOUR_FROM(0), b = FOUR_FROM(4);
    return points((real)(a.s048c, b.s048c), (real)(a.s159d, b.s159d), (real)(a.s26ae, b.s26ae));
#else
    const float4 p = NODE_OF(0);
    return points(p.x, p.y, p.z);
#endif
}

LAID_IN void store_node(global float4* nodes, const int* strand, int node, Points p, real with)
{
    nodes += node;
#if WIDTH == 1
    NODE_OF(0) = (float4)(p.x, p.y, p.z, with);
#else
#define STORE_FOUR(lane, part)                                                                                         \
    {                                                                                                                  \
        const float4 x = p.x.part, y = p.y.part, z = p.z.part, w = with.part;                                          \
        NODE_OF(lane) = (float4)(x.x, y.x, z.x, w.x);                                                                  \
        NODE_OF(lane + 1) = (float4)(x.y, y.y, z.y, w.y);                                                              \
        NODE_OF(lane + 2) = (float4)(x.z, y.z, z.z, w.z);                                                              \
        NODE_OF(lane + 3) = (float4)(x.w, y.w, z.w, w.w);                                                              \
    }
    STORE_FOUR(0, s0123)
    STORE_FOUR(4, s4567)
#if WIDTH == 16
    STORE_FOUR(8, s89ab)
    STORE_FOUR(12, scdef)
#endif
#undef STORE_FOUR
#endif
#undef FOUR_FROM
#undef NODE_OF
}

#endif

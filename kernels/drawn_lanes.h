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

// One value for each lane.
static inline real gather(global const float* from, whole at)
{
    int index[WIDTH];
    float value[WIDTH];
    LANES_STORE(at, index);
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        value[lane] = from[index[lane]];
    return LANES_LOAD(value);
}

// The strands of the lanes from `first` on. Lanes past the last strand repeat it: they compute and store the same.
static inline void number_lanes(int first, int count, int* strand)
{
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        strand[lane] = min(first + lane, count - 1);
}

static inline Points load_node(global const float4* nodes, const int* strand, int node)
{
    float x[WIDTH], y[WIDTH], z[WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const float4 p = nodes[strand[lane] * NODES + node];
        x[lane] = p.x;
        y[lane] = p.y;
        z[lane] = p.z;
    }
    return points(LANES_LOAD(x), LANES_LOAD(y), LANES_LOAD(z));
}

static inline void store_node(global float4* nodes, const int* strand, int node, Points p, real with)
{
    float x[WIDTH], y[WIDTH], z[WIDTH], w[WIDTH];
    LANES_STORE(p.x, x);
    LANES_STORE(p.y, y);
    LANES_STORE(p.z, z);
    LANES_STORE(with, w);
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        nodes[strand[lane] * NODES + node] = (float4)(x[lane], y[lane], z[lane], w[lane]);
}

#endif

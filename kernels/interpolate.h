// What both ways of making drawn strands share: reading guides, cutting each strand at its own length, keeping it out
// of colliders, and its light. A strand is a lane: the guides of WIDTH drawn strands are gathered node by node, and
// from then on everything is done for all of them at once.
#ifndef COIF_INTERPOLATE_H
#define COIF_INTERPOLATE_H
#include "drawn_room.h"
#include "flyaway.h"
#include "interpolate_light.h"

// A node of one guide for each lane; `guide` holds where the guides' values begin.
LAID_IN Points guide_node(global const float* position, const int* guide, int node)
{
    global const float* from = position + node * 3 * LANES;
    const whole at = LANES_LOAD(guide);
    return points(gather(from, at), gather(from + LANES, at), gather(from + 2 * LANES, at));
}

// What a node at distance d along the strand, in segments, adds to a Catmull-Rom curve: the weights of strand_curve.h
// as one function (Keys. Cubic convolution interpolation for digital image processing. 1981, eq. 15), factored so that
// it is 0 and 1 exactly where it should be.
static inline real catmull_rom(real distance_along)
{
    const real u = fabs(distance_along), left = fmax(2.0f - u, (real)(0.0f));
    return (1.0f - u) * select(0.5f * left * left, 1.0f + u * (1.0f - 1.5f * u), u < 1.0f);
}

// Cuts each strand at `cut` of its length: its nodes move along the curve through them towards the root. Each lane asks
// for other neighbours, but all of them for a few in a row: those are weighed one after the other, with nothing
// gathered.
static inline void cut_strands(const Points* full, real cut, Points* node)
{
    const float shortest = least(cut), longest = greatest(cut);
    for (int k = 0; k < NODES; ++k)
    {
        node[k] = full[k];
        if (k < 2 || shortest >= 1.0f)
            continue;
        const real at = 1.0f + (float)(k - 1) * cut;
        const int first = (int)(1.0f + (float)(k - 1) * shortest);
        const int last = min((int)(1.0f + (float)(k - 1) * longest), NODES - 2);
        Points sum = points((real)(0.0f), (real)(0.0f), (real)(0.0f));
        for (int i = first - 1; i <= last + 2; ++i)
        {
            const Points from = full[min(i, NODES - 1)];
            const real weight = catmull_rom(at - (float)i);
            sum = points(sum.x + weight * from.x, sum.y + weight * from.y, sum.z + weight * from.z);
        }
        node[k] = sum;
    }
}

// Finishes drawn strands whose nodes follow the guides at full length: cuts them to their own lengths, lets some fly
// away, pushes them out of the colliders with room for what is laid on them, and stores positions with the share of the
// light that reaches them in w.
static inline void finish_strands(const Points* full, const int* strand, global const DrawnStrand* strands,
                                  global const StrandLook* looks, global float4* drawn_position,
                                  global const float* depth, global const float* body_distance,
                                  global const float4* body_way, constant Capsule* colliders,
                                  constant HairParams* params, constant StepInfo* info
#ifdef BRAIDED
                                  ,
                                  const BraidedLanes* braid
#endif
)
{
    float cuts[WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        cuts[lane] = strands[strand[lane]].root.w;
    Points node[NODES];
    cut_strands(full, LANES_LOAD(cuts), node);
#ifdef FLYAWAY
    fly_away(node, strand, strands, params, info);
#endif
    keep_out(node, layers_of(strand, strands, params), adornment_of(strand, looks, params), body_distance, body_way,
             colliders, params, info
#ifdef BRAIDED
             ,
             braid, LANES_LOAD(cuts)
#endif
    );
    for (int k = 0; k < NODES; ++k)
    {
        real light = (real)(1.0f);
#ifdef SHADOW
        light = exp(-light_depth(depth, node[k], params, info));
#endif
        store_node(drawn_position, strand, k, node[k], light);
    }
}

#endif

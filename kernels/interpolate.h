// What both ways of making drawn strands share: reading guides, cutting each strand at its own length, keeping it out
// of colliders, and its light. A strand is a lane: the guides of WIDTH drawn strands are gathered node by node, and
// from then on everything is done for all of them at once.
#ifndef COIF_INTERPOLATE_H
#define COIF_INTERPOLATE_H
#include "drawn_contact.h"
#include "drawn_lanes.h"
#include "interpolate_light.h"

#define CURVE_FUNCTION static inline
#define FLOAT4(x, y, z, w) ((float4)(x, y, z, w))
#define UINT uint
#define TO_UINT(v) ((uint)(v))
#define TO_FLOAT(v) ((float)(v))
#include "strand_curve.h"

// A node of one guide for each lane; `guide` holds where the guides' values begin.
static inline Points guide_node(global const float* position, const int* guide, int node)
{
    global const float* from = position + node * 3 * LANES;
    float x[WIDTH], y[WIDTH], z[WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        x[lane] = from[guide[lane]];
        y[lane] = from[guide[lane] + LANES];
        z[lane] = from[guide[lane] + 2 * LANES];
    }
    return points(LANES_LOAD(x), LANES_LOAD(y), LANES_LOAD(z));
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

#ifdef BRAIDED
// What of the lanes is plaited, and where: in nodes, m for a node, m, and half the braid's thickness.
typedef struct BraidedLanes
{
    real ring, per_node, pitch, depth;
    whole which;
} BraidedLanes;

// braid_share() at a place along the strands, in nodes.
static inline real braid_shares(const BraidedLanes* braid, real node)
{
    const real t = clamp(3.0f * (node - braid->ring) * braid->per_node / braid->pitch, (real)(0.0f), (real)(1.0f));
    return select((real)(0.0f), t * t * (3.0f - 2.0f * t), braid->which);
}
#endif

#define NEAR_MARGIN 0.01f // m

// Finishes drawn strands whose nodes follow the guides at full length: cuts them to their own lengths, pushes them out
// of the colliders with room for their waves, and stores positions with the share of the light that reaches them in w.
static inline void finish_strands(const Points* full, const int* strand, global const DrawnStrand* strands,
                                  global const StrandLook* looks,
                                  global float4* drawn_position, global const float* depth,
                                  global const float* body_distance, global const float4* body_way,
                                  constant Capsule* colliders, constant HairParams* params, constant StepInfo* info
#ifdef BRAIDED
                                  ,
                                  const BraidedLanes* braid
#endif
)
{
    float cuts[WIDTH], layers[WIDTH], waves_n[WIDTH], waves_b[WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        cuts[lane] = strands[strand[lane]].root.w;
        layers[lane] = params->interpolation_layer * strand_random(strands[strand[lane]].seed, RANDOM_LAYER);
#ifdef VARIED
        waves_n[lane] = looks[strand[lane]].wave.x;
        waves_b[lane] = looks[strand[lane]].wave.z;
#else
        waves_n[lane] = params->wave_normal_amplitude;
        waves_b[lane] = params->wave_binormal_amplitude;
#endif
    }
    const real layer = LANES_LOAD(layers);
    Points node[NODES];
    cut_strands(full, LANES_LOAD(cuts), node);

    Points low = node[1], high = node[1];
    for (int k = 2; k < NODES; ++k)
    {
        low = points(fmin(low.x, node[k].x), fmin(low.y, node[k].y), fmin(low.z, node[k].z));
        high = points(fmax(high.x, node[k].x), fmax(high.y, node[k].y), fmax(high.z, node[k].z));
    }
    const real wave_n = LANES_LOAD(waves_n), wave_b = LANES_LOAD(waves_b);
    float most_room = info->clearance + greatest(layer + wave_n + wave_b);
#ifdef BRAIDED
    most_room += greatest(braid->depth);
#endif
    short near[MOST_COLLIDERS];
    int near_count =
        colliders_near(colliders, info->colliders, (float3)(least(low.x), least(low.y), least(low.z)),
                       (float3)(greatest(high.x), greatest(high.y), greatest(high.z)), most_room + NEAR_MARGIN, near);

    for (int k = 0; k < NODES; ++k)
    {
        Points p = node[k];
        if (k > 1)
        {
            const float along = (float)(k - 1) / (float)(NODES - 2);
            const real onset_n = wave_n * wave_onset(along, params->wave_normal_begin);
            const real onset_b = wave_b * wave_onset(along, params->wave_binormal_begin);
            real room =
                info->clearance + layer * min(1.0f, 4.0f * along) + sqrt(onset_n * onset_n + onset_b * onset_b);
#ifdef BRAIDED // as one body
            room = mix(room, info->clearance + braid->depth,
                       braid_shares(braid, 1.0f + (float)(k - 1) * LANES_LOAD(cuts)));
#endif
            out_of_all(body_distance, body_way, colliders, near, near_count, &p, room, info);
            const Points moved = points(p.x - node[k].x, p.y - node[k].y, p.z - node[k].z);
            // Pushed so far that it may have come into a collider that was not near.
            if (near_count < info->colliders && any_lane(dot_lanes(moved, moved) > NEAR_MARGIN * NEAR_MARGIN))
            {
                near_count = info->colliders;
                for (int c = 0; c < near_count; ++c)
                    near[c] = (short)c;
                p = node[k];
                out_of_all(body_distance, body_way, colliders, near, near_count, &p, room, info);
            }
        }
        real light = (real)(1.0f);
#ifdef SHADOW
        light = exp(-light_depth(depth, p, params, info));
#endif
        store_node(drawn_position, strand, k, p, light);
    }
}

#endif

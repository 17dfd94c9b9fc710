// The room that drawn strands keep from head and colliders, for what is laid on them later.
#ifndef COIF_DRAWN_ROOM_H
#define COIF_DRAWN_ROOM_H
#include "curve.h"
#include "drawn_contact.h"

#define NEAR_MARGIN 0.01f // m

// What lies between the head and each strand, m: the strands there have one of their own.
static inline real layers_of(const int* strand, global const DrawnStrand* strands, constant HairParams* params)
{
    float layers[WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
        layers[lane] = params->interpolation_layer * strand_random(strands[strand[lane]].seed, RANDOM_LAYER);
    return LANES_LOAD(layers);
}

// Amplitudes of what is laid on each strand, m.
typedef struct Adornment
{
    real normal, binormal, curl, frizz;
} Adornment;

static inline Adornment adornment_of(const int* strand, global const StrandLook* looks, constant HairParams* params)
{
#ifdef VARIED
    float n[WIDTH], b[WIDTH], curl[WIDTH], frizz[WIDTH];
#pragma unroll
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const StrandLook look = looks[strand[lane]];
        n[lane] = look.wave.x;
        b[lane] = look.wave.z;
        curl[lane] = look.own.y;
        frizz[lane] = look.own.z;
    }
    const Adornment of = {LANES_LOAD(n), LANES_LOAD(b), LANES_LOAD(curl), LANES_LOAD(frizz)};
#else
    const Adornment of = {(real)(params->wave_normal_amplitude), (real)(params->wave_binormal_amplitude),
                          (real)(params->curl_radius), (real)(params->frizz_amount)};
#endif
    return of;
}

// What that may take at `along`, m.
static inline real laid_on(float along, Adornment of, constant HairParams* params)
{
    const real n = of.normal * wave_onset(along, params->wave_normal_begin);
    const real b = of.binormal * wave_onset(along, params->wave_binormal_begin);
    const real curl = of.curl * wave_onset(along, params->curl_begin);
    const real frizz = of.frizz * frizz_onset(along);
    return profile_at(params->wave_along, along) * (sqrt(n * n + b * b) + curl + frizz);
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

// Moves nodes 2 and up out of head and colliders, with room to spare.
static inline void keep_out(Points* node, real layer, Adornment of, global const float* body_distance,
                            global const float4* body_way, constant Capsule* colliders, constant HairParams* params,
                            constant StepInfo* info
#ifdef BRAIDED
                            ,
                            const BraidedLanes* braid, real cut
#endif
)
{
    Points low = node[1], high = node[1];
    real most = (real)(0.0f);
    for (int k = 2; k < NODES; ++k)
    {
        low = points(fmin(low.x, node[k].x), fmin(low.y, node[k].y), fmin(low.z, node[k].z));
        high = points(fmax(high.x, node[k].x), fmax(high.y, node[k].y), fmax(high.z, node[k].z));
        most = fmax(most, laid_on((float)(k - 1) / (float)(NODES - 2), of, params));
    }
    float most_room = info->clearance + greatest(layer) + greatest(most);
#ifdef BRAIDED
    most_room += greatest(braid->depth);
#endif
    short near[MOST_COLLIDERS];
    int near_count =
        colliders_near(colliders, info->colliders, (float3)(least(low.x), least(low.y), least(low.z)),
                       (float3)(greatest(high.x), greatest(high.y), greatest(high.z)), most_room + NEAR_MARGIN, near);

    for (int k = 2; k < NODES; ++k)
    {
        const float along = (float)(k - 1) / (float)(NODES - 2);
        real room = info->clearance + layer * min(1.0f, 4.0f * along) + laid_on(along, of, params);
#ifdef BRAIDED // as one body
        room = mix(room, info->clearance + braid->depth, braid_shares(braid, 1.0f + (float)(k - 1) * cut));
#endif
        Points p = node[k];
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
        node[k] = p;
    }
}

#endif

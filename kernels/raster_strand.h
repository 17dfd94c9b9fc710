// One drawn strand as the rasteriser's passes read it: its nodes beside each other, so that lanes along it load them as
// they are, and what it looks like.
#ifndef COIF_RASTER_STRAND_H
#define COIF_RASTER_STRAND_H
#include "raster.h"
#include "ribbon_lanes.h"

#if WIDTH == 1
#define FIRST_LANE(v) (v)
#define LANE_NUMBERS ((int)(0))
#elif WIDTH == 8
#define FIRST_LANE(v) ((v).s0)
#define LANE_NUMBERS ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#else
#define FIRST_LANE(v) ((v).s0)
#define LANE_NUMBERS ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#endif

static inline bits half_bits(real v) { return TO_HALF(AS_BITS(clamp(v, (real)(0.0f), (real)(65000.0f)) * HALF_SCALE)); }

#define NODE_ROOM (NODES + WIDTH + 2)

// Beyond the last node the last again.
typedef struct StrandNodes
{
    float x[NODE_ROOM], y[NODE_ROOM], z[NODE_ROOM], light[NODE_ROOM];
    float normal_x[NODE_ROOM], normal_y[NODE_ROOM], normal_z[NODE_ROOM], distance[NODE_ROOM];
} StrandNodes;

static inline void load_strand(StrandNodes* nodes, global const float4* drawn_position,
                               global const float4* drawn_frame, int strand)
{
    for (int k = 0; k < NODE_ROOM; ++k)
    {
        const int at = strand * NODES + min(k, NODES - 1);
        const float4 p = drawn_position[at], n = drawn_frame[at];
        nodes->x[k] = p.x;
        nodes->y[k] = p.y;
        nodes->z[k] = p.z;
        nodes->light[k] = p.w;
        nodes->normal_x[k] = n.x;
        nodes->normal_y[k] = n.y;
        nodes->normal_z[k] = n.z;
        nodes->distance[k] = n.w;
    }
}

typedef struct RibbonLook
{
    float4 root_color, tip_color; // linear
    float width;                  // m
    float opacity;
    Waves laid;
    Braid braid;
} RibbonLook;

static inline RibbonLook look_of(int strand, global const StrandLook* looks, global const DrawnStrand* strands,
                                 global const float4* braids, constant HairParams* params, int braided)
{
    RibbonLook look;
#ifdef VARIED
    const StrandLook own = looks[strand];
    look.root_color = own.root_color;
    look.tip_color = own.tip_color;
    look.width = own.root_color.w;
    look.opacity = own.tip_color.w;
    look.laid.normal_amplitude = own.wave.x;
    look.laid.normal_frequency = own.wave.y;
    look.laid.binormal_amplitude = own.wave.z;
    look.laid.binormal_frequency = own.wave.w;
    look.laid.own = (int)own.own.x;
    look.laid.curl = own.own.y;
    look.laid.frizz = own.own.z;
#else
    look.root_color = params->look_root_color;
    look.tip_color = params->look_tip_color;
    look.width = params->look_width;
    look.opacity = params->look_opacity;
    look.laid.normal_amplitude = params->wave_normal_amplitude;
    look.laid.normal_frequency = params->wave_normal_frequency;
    look.laid.binormal_amplitude = params->wave_binormal_amplitude;
    look.laid.binormal_frequency = params->wave_binormal_frequency;
    look.laid.own = strand + 7919 * params->interpolation_seed;
    look.laid.curl = params->curl_radius;
    look.laid.frizz = params->frizz_amount;
#endif
    look.laid.together = look.laid.own;
    look.laid.curl_begin = 0.0f;
    if (look.laid.curl > 0.0f)
    {
        look.laid.curl_begin = params->curl_phase * FIRST_LANE(strand_random(look.laid.own, RANDOM_CURL_PHASE));
        if (params->clump_strength > 0.0f)
        {
            look.laid.together = strands[strand].leader + 7919 * params->interpolation_seed;
            look.laid.curl_begin += FIRST_LANE(strand_random(look.laid.together, RANDOM_CURL_TOGETHER));
        }
    }
    look.braid.pitch = 0.0f;
    if (strand < braided)
        look.braid = braid_of(braids[3 * strand], braids[3 * strand + 1], braids[3 * strand + 2]);
    return look;
}

// How much wider a strand is drawn for those that are left out; nothing if it is one of them. Which they are hangs on
// nothing but their numbers, and each goes little by little.
#define FADE 0.1f // of all strands, that are on their way
static inline float widening(int strand, constant RasterFrame* frame)
{
    if (frame->kept >= 1.0f)
        return 1.0f;
    const float turn = STRAND_TURN(strand);
    const float begin = frame->kept * (1.0f - FADE), span = fmax(frame->kept * 2.0f * FADE, 1e-6f);
    // Of those between begin and begin + span half are left on the whole.
    return clamp((begin + span - turn) / span, 0.0f, 1.0f) / frame->kept;
}

#endif

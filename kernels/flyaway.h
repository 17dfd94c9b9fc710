// Strands that fly away from the others: each at a place and in a direction of its own it leaves them, and goes on
// beside them.
#ifndef COIF_FLYAWAY_H
#define COIF_FLYAWAY_H
#include "curve.h"
#include "drawn_lanes.h"

// Not those that lead a clump: it would follow them.
static inline bool flies_away(int strand, DrawnStrand own, constant HairParams* params)
{
    return params->flyaway_distance > 0.0f && strand_random(own.seed, RANDOM_FLYAWAY) < params->flyaway_share &&
           (params->clump_strength == 0.0f || own.leader != strand);
}

// Bends the strands that fly away; none becomes longer or shorter. All that is random lies in the head's frame, so that
// it goes along with the head.
static inline void fly_away(Points* node, const int* strand, global const DrawnStrand* strands,
                            constant HairParams* params, constant StepInfo* info)
{
    float reaches[WIDTH], begins[WIDTH], overs[WIDTH], x[WIDTH], y[WIDTH], z[WIDTH], turns[WIDTH];
    int count = 0;
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const DrawnStrand own = strands[strand[lane]];
        const bool flies = flies_away(strand[lane], own, params);
        count += flies;
        reaches[lane] =
            flies ? params->flyaway_distance * (0.2f + 0.8f * strand_random(own.seed, RANDOM_FLYAWAY + 1)) : 0.0f;
        begins[lane] = 0.5f * strand_random(own.seed, RANDOM_FLYAWAY + 2);
        overs[lane] = 0.2f + 0.6f * strand_random(own.seed, RANDOM_FLYAWAY + 3);
        x[lane] = 2.0f * strand_random(own.seed, RANDOM_FLYAWAY + 4) - 1.0f;
        y[lane] = 2.0f * strand_random(own.seed, RANDOM_FLYAWAY + 5) - 1.0f;
        z[lane] = 2.0f * strand_random(own.seed, RANDOM_FLYAWAY + 6) - 1.0f;
        turns[lane] = strand_random(own.seed, RANDOM_FLYAWAY + 3);
    }
    if (count == 0)
        return;
    const real begin = LANES_LOAD(begins), over = LANES_LOAD(overs), turn = LANES_LOAD(turns);
    const Points own =
        turn_by(info->head_row0, info->head_row1, info->head_row2, points(LANES_LOAD(x), LANES_LOAD(y), LANES_LOAD(z)));
    const float3 center =
        (float3)(dot(info->head_row0.xyz, info->head_center.xyz), dot(info->head_row1.xyz, info->head_center.xyz),
                 dot(info->head_row2.xyz, info->head_center.xyz));
    real whole_length = (real)(0.0f);
    for (int k = 2; k < NODES; ++k)
    {
        const Points d = points(node[k].x - node[k - 1].x, node[k].y - node[k - 1].y, node[k].z - node[k - 1].z);
        whole_length += sqrt(dot_lanes(d, d));
    }
    // Short strands fly no further than they can without a kink.
    const real reach = fmin(LANES_LOAD(reaches), 0.5f * over * whole_length);
    const whole flies = reach > 0.0f;
    Points before = node[1];
    for (int k = 2; k < NODES; ++k)
    {
        const Points from = node[k];
        const Points d = points(from.x - before.x, from.y - before.y, from.z - before.z);
        before = from;
        const real along = (real)((float)(k - 1) / (float)(NODES - 2));
        const real t = fmin(fmax((along - begin) / over, (real)(0.0f)), (real)(1.0f));
        const real lift = reach * t * t * (3.0f - 2.0f * t);
        // Away from the head, each another way, and to either side as it goes on.
        const Points out = points(from.x - center.x, from.y - center.y, from.z - center.z);
        const real shorten = INVERSE_SQRT(fmax(dot_lanes(out, out), (real)(1e-12f)));
        const Points up = points(out.x * shorten, out.y * shorten, out.z * shorten);
        const Points side =
            points(up.y * own.z - up.z * own.y, up.z * own.x - up.x * own.z, up.x * own.y - up.y * own.x);
        const real sway = 0.5f * sin(6.28318531f * (turn + along));
        const Points wanted = points(from.x + lift * (0.7f * up.x + 0.5f * own.x + sway * side.x),
                                     from.y + lift * (0.7f * up.y + 0.5f * own.y + sway * side.y),
                                     from.z + lift * (0.7f * up.z + 0.5f * own.z + sway * side.z));
        const Points last = node[k - 1];
        const Points go = points(wanted.x - last.x, wanted.y - last.y, wanted.z - last.z);
        const real stretch = sqrt(dot_lanes(d, d) / fmax(dot_lanes(go, go), (real)(1e-12f)));
        node[k] = select_points(from, points(last.x + stretch * go.x, last.y + stretch * go.y, last.z + stretch * go.z),
                                flies);
    }
}

#endif

// A normal at each node of a drawn strand that neither twists nor flips along it, so that waves keep their side: carried
// from segment to segment by the smallest rotation that turns one tangent into the next (parallel transport; Bergou,
// Wardetzky, Robinson, Audoly, Grinspun. Discrete elastic rods. 2008, section 4.2.2). A geometry shader sees four nodes
// only and could not.
//
// At the root the normal points away from the head, as far as the strand's direction lets it. One work-item a strand.
// w holds the strand's length from the root on, m, for the waves' phase.
#include "shared.h"

static inline float3 unit_or(float3 v, float3 otherwise)
{
    const float squared = dot(v, v);
    return squared > 1e-20f ? v * (1.0f / sqrt(squared)) : otherwise;
}

kernel void transport_frames(global const float4* drawn_position, global const DrawnStrand* strands,
                             global float4* drawn_frame, constant StepInfo* info)
{
    const int index = get_global_id(0);
    global const float4* p = drawn_position + index * NODES;
    global float4* frame = drawn_frame + index * NODES;

    const float3 center = (float3)(dot(info->head_row0.xyz, info->head_center.xyz),
                                   dot(info->head_row1.xyz, info->head_center.xyz),
                                   dot(info->head_row2.xyz, info->head_center.xyz));
    const float3 outward = unit_or(p[1].xyz - center, (float3)(0.0f, 1.0f, 0.0f));
    float3 tangent = unit_or(p[1].xyz - p[0].xyz, outward);
    // Where a strand leaves along the normal, any perpendicular will do, but all strands should take the same one.
    const float3 side = unit_or(cross((float3)(0.0f, 1.0f, 0.0f), tangent), (float3)(1.0f, 0.0f, 0.0f));
    const float3 across = outward - tangent * dot(outward, tangent);
    float3 normal = unit_or(dot(across, across) > 1e-4f ? across : side - tangent * dot(side, tangent), side);

    float length_so_far = 0.0f;
    for (int k = 0; k < NODES; ++k)
    {
        if (k > 0)
        {
            const float3 segment = p[k].xyz - p[k - 1].xyz;
            const float3 next = unit_or(segment, tangent);
            // Rotation of t onto t' applied to n perpendicular to t: n - (n.t') / (1 + t.t') (t + t').
            const float turn = 1.0f + dot(tangent, next);
            if (turn > 1e-4f)
                normal -= (tangent + next) * (dot(normal, next) / turn);
            normal = unit_or(normal - next * dot(normal, next), side);
            tangent = next;
            if (k > 1)
                length_so_far += sqrt(dot(segment, segment));
        }
        frame[k] = (float4)(normal, length_so_far);
    }
}

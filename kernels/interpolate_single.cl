// Drawn strands that are copies of one guide, turned about the head's centre by two random angles (thesis 5.1.4). One
// work-item a strand; the copies come after the mixed strands.
#include "interpolate.h"

// Rotation about y by `yaw` after a rotation about x by `pitch`.
static inline float3 turn_yaw_pitch(float3 v, float yaw, float pitch)
{
    const float cp = cos(pitch), sp = sin(pitch), cy = cos(yaw), sy = sin(yaw);
    const float3 a = (float3)(v.x, cp * v.y - sp * v.z, sp * v.y + cp * v.z);
    return (float3)(cy * a.x + sy * a.z, a.y, -sy * a.x + cy * a.z);
}

kernel void interpolate_single(global const float* position, global const DrawnStrand* strands,
                               global float4* drawn_position, global const float* depth, constant float4* colliders,
                               constant HairParams* params, constant StepInfo* info)
{
    const int index = info->drawn_multi + get_global_id(0);
    const DrawnStrand strand = strands[index];
    const float4 r0 = info->head_row0, r1 = info->head_row1, r2 = info->head_row2;
    const float4 c0 = (float4)(r0.x, r1.x, r2.x, 0.0f), c1 = (float4)(r0.y, r1.y, r2.y, 0.0f),
                 c2 = (float4)(r0.z, r1.z, r2.z, 0.0f); // the inverse rotation: world to head
    float3 node[NODES];
    for (int k = 0; k < NODES; ++k)
    {
        const float3 own = turn_by(c0, c1, c2, guide_node(position, strand.guide0, k)) - info->head_center.xyz;
        const float3 turned = turn_yaw_pitch(own, strand.weights.x, strand.weights.y) + info->head_center.xyz;
        node[k] = turn_by(r0, r1, r2, turned);
    }
    finish_strand(node, strand, drawn_position, index, depth, colliders, params, info);
}

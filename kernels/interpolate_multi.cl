// Drawn strands mixed of the three guides about their root (thesis 5.1.4, listing 5.4): each node moves from its own root
// as the guides' nodes do from theirs, in barycentric shares. One work-item a strand, so that each guide's node is read
// once.
#include "interpolate.h"

kernel void interpolate_multi(global const float* position, global const DrawnStrand* strands,
                              global float4* drawn_position, global const float* depth, constant float4* colliders,
                              constant HairParams* params, constant StepInfo* info)
{
    const int index = get_global_id(0);
    const DrawnStrand strand = strands[index];
    const float3 root = turn_by(info->head_row0, info->head_row1, info->head_row2, strand.root.xyz);
    const float4 w = strand.weights;
    const float3 guide_root = w.x * guide_node(position, strand.guide0, 1) + w.y * guide_node(position, strand.guide1, 1) +
                              w.z * guide_node(position, strand.guide2, 1);
    float3 node[NODES];
    for (int k = 0; k < NODES; ++k)
        node[k] = root - guide_root + w.x * guide_node(position, strand.guide0, k) +
                  w.y * guide_node(position, strand.guide1, k) + w.z * guide_node(position, strand.guide2, k);
    finish_strand(node, strand, drawn_position, index, depth, colliders, params, info);
}

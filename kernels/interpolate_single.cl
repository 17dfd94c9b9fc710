// Drawn strands that are copies of one guide, turned about the head's centre by two random angles (thesis 5.1.4) and
// moved to a root of their own, which on a head that is no ball the turn alone would miss; they come after the mixed
// strands. Work-item: WIDTH strands.
#include "interpolate.h"

kernel void interpolate_single(global const float* position, global const DrawnStrand* strands,
                               global const StrandLook* looks, global float4* drawn_position, global const float* depth,
                               global const float* body_distance, global const float4* body_way,
                               constant Capsule* colliders, constant HairParams* params, constant StepInfo* info)
{
    const int first = info->drawn_multi + get_global_id(0) * WIDTH;
    if (first >= info->drawn)
        return;
    int strand[WIDTH], guide[WIDTH];
    number_lanes(first, info->drawn, strand);
    float yaw[WIDTH], pitch[WIDTH], rx[WIDTH], ry[WIDTH], rz[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const DrawnStrand own = strands[strand[lane]];
        guide[lane] = strand_value(own.guide0, 0, 0, NODES);
        yaw[lane] = own.weights.x;
        pitch[lane] = own.weights.y;
        rx[lane] = own.root.x;
        ry[lane] = own.root.y;
        rz[lane] = own.root.z;
    }
    const real cy = cos(LANES_LOAD(yaw)), sy = sin(LANES_LOAD(yaw));
    const real cp = cos(LANES_LOAD(pitch)), sp = sin(LANES_LOAD(pitch));
    const float4 r0 = info->head_row0, r1 = info->head_row1, r2 = info->head_row2, center = info->head_center;
    const float4 c0 = (float4)(r0.x, r1.x, r2.x, 0.0f), c1 = (float4)(r0.y, r1.y, r2.y, 0.0f),
                 c2 = (float4)(r0.z, r1.z, r2.z, 0.0f); // the inverse rotation: world to head

    Points node[NODES];
    for (int k = 0; k < NODES; ++k)
    {
        const Points own = turn_by(c0, c1, c2, guide_node(position, guide, k));
        const real x = own.x - center.x, y = own.y - center.y, z = own.z - center.z;
        // About x by the pitch, then about y by the yaw.
        const real py = cp * y - sp * z, pz = sp * y + cp * z;
        const Points turned = points(cy * x + sy * pz + center.x, py + center.y, cy * pz - sy * x + center.z);
        node[k] = turn_by(r0, r1, r2, turned);
    }
    const Points root = turn_by(r0, r1, r2, points(LANES_LOAD(rx), LANES_LOAD(ry), LANES_LOAD(rz)));
    const Points shift = points(root.x - node[1].x, root.y - node[1].y, root.z - node[1].z);
    for (int k = 0; k < NODES; ++k)
        node[k] = points(node[k].x + shift.x, node[k].y + shift.y, node[k].z + shift.z);
    finish_strands(node, strand, strands, looks, drawn_position, depth, body_distance, body_way, colliders, params, info);
}

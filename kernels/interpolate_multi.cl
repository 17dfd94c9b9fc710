// Drawn strands mixed of the three guides about their root (thesis 5.1.4, listing 5.4): each node moves from its own
// root as the guides' nodes do from theirs, in barycentric shares. Work-item: WIDTH strands.
#include "interpolate.h"

// The share of its weight that a guide keeps beside the heaviest one. Guides that part company, to either side of the
// face or of a shoulder, must not be mixed: their mean would lie inside the head. It fades as they part, so that
// nothing jumps, and is gone where they are twice info->parting further apart than at their roots.
static inline real kept_weight(global const float* position, const int* heaviest, const int* guide, float parting)
{
    const Points h = guide_node(position, heaviest, 1), g = guide_node(position, guide, 1);
    const Points at_root = points(g.x - h.x, g.y - h.y, g.z - h.z);
    real farthest = (real)(0.0f);
    for (int check = 0; check < 2; ++check)
    {
        const int k = check ? (NODES + 1) / 2 : NODES - 1;
        const Points a = guide_node(position, heaviest, k), b = guide_node(position, guide, k);
        const Points apart = points(b.x - a.x, b.y - a.y, b.z - a.z);
        farthest = fmax(farthest, dot_lanes(apart, apart));
    }
    const real parted = sqrt(farthest) - sqrt(dot_lanes(at_root, at_root));
    return 1.0f - smoothstep((real)(parting), (real)(2.0f * parting), parted);
}

#ifdef TIED
#include "tails.h"
#endif

kernel void interpolate_multi(global const float* position, global const DrawnStrand* strands,
                              global const StrandLook* looks, global float4* drawn_position, global const float* depth,
#ifdef TIED
                              global const TiedStrand* tied, constant Tail* tails,
#endif
                              global const float* body_distance, global const float4* body_way,
                              constant Capsule* colliders, constant HairParams* params, constant StepInfo* info)
{
    const int first = get_global_id(0) * WIDTH;
    if (first >= info->drawn_multi)
        return;
    int strand[WIDTH], guide0[WIDTH], guide1[WIDTH], guide2[WIDTH];
    number_lanes(first, info->drawn_multi, strand);
    float rx[WIDTH], ry[WIDTH], rz[WIDTH], share0[WIDTH], share1[WIDTH], share2[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const DrawnStrand own = strands[strand[lane]];
        guide0[lane] = strand_value(own.guide0, 0, 0, NODES);
        guide1[lane] = strand_value(own.guide1, 0, 0, NODES);
        guide2[lane] = strand_value(own.guide2, 0, 0, NODES);
        share0[lane] = own.weights.x;
        share1[lane] = own.weights.y;
        share2[lane] = own.weights.z;
        rx[lane] = own.root.x;
        ry[lane] = own.root.y;
        rz[lane] = own.root.z;
    }
    // The heaviest guide comes first (sim/groom.cpp), so there is always weight left.
    const real share_b = LANES_LOAD(share1) * kept_weight(position, guide0, guide1, info->parting);
    const real share_c = LANES_LOAD(share2) * kept_weight(position, guide0, guide2, info->parting);
    const real sum = LANES_LOAD(share0) + share_b + share_c;
    const real w0 = LANES_LOAD(share0) / sum, w1 = share_b / sum, w2 = share_c / sum;

    Points node[NODES];
    for (int k = 0; k < NODES; ++k)
    {
        const Points a = guide_node(position, guide0, k), b = guide_node(position, guide1, k),
                     c = guide_node(position, guide2, k);
        node[k] =
            points(w0 * a.x + w1 * b.x + w2 * c.x, w0 * a.y + w1 * b.y + w2 * c.y, w0 * a.z + w1 * b.z + w2 * c.z);
    }
    const Points root = turn_by(info->head_row0, info->head_row1, info->head_row2,
                                points(LANES_LOAD(rx), LANES_LOAD(ry), LANES_LOAD(rz)));
    const Points shift = points(root.x - node[1].x, root.y - node[1].y, root.z - node[1].z);
#ifdef TIED
    const TiedLanes ties = tied_lanes(tied, tails, strand);
#define SHIFTED(k) shifted_share(&ties, k)
#else
#define SHIFTED(k) 1.0f
#endif
    for (int k = 0; k < NODES; ++k)
        node[k] = points(node[k].x + SHIFTED(k) * shift.x, node[k].y + SHIFTED(k) * shift.y,
                         node[k].z + SHIFTED(k) * shift.z);
#ifdef TIED
    hang_in_tails(&ties, position, node, info);
#endif
    finish_strands(node, strand, strands, looks, drawn_position, depth, body_distance, body_way, colliders, params, info
#ifdef BRAIDED
                   ,
                   &ties.braid
#endif
    );
}

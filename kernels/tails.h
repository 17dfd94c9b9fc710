// Drawn strands that ties hold: all through their rings, and behind them as tails or braids about the line of one guide
// of each. Strands that only went their guides' ways would fan out there: nothing else tells of the hair between them
// that holds them together.
#ifndef COIF_TAILS_H
#define COIF_TAILS_H
#include "interpolate.h"

// What ties make of each lane's strand.
typedef struct TiedLanes
{
    int guide[WIDTH];           // that its tail follows
    real ring;                  // of the strand, in nodes; 0: not tied
    real guide_ring, from_ring; // of the guide, in nodes; the guide's nodes for one of the strand's
    real per_node, length;      // m behind the ring for a node of the strand; in all
    real place_x, place_y, radius, fullest, together;
    Points axis, side; // in the head's frame
    whole which;       // lanes that are tied
#ifdef BRAIDED
    BraidedLanes braid;
#endif
} TiedLanes;

static inline TiedLanes tied_lanes(global const TiedStrand* tied, constant Tail* tails, const int* strand)
{
    TiedLanes lanes;
    float value[18][WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const TiedStrand own = tied[strand[lane]];
        const Tail tail = tails[own.tail];
        lanes.guide[lane] = strand_value(tail.guide, 0, 0, NODES);
        const float left = (float)(NODES - 1) - own.ring;
        const float of[18] = {own.ring,           tail.ring,   ((float)(NODES - 1) - tail.ring) / left,
                              tail.length / left, tail.length, own.place.x,
                              own.place.y,        tail.radius, tail.fullest,
                              tail.together,      tail.axis.x, tail.axis.y,
                              tail.axis.z,        tail.side.x, tail.side.y,
                              tail.side.z,        tail.axis.w, tail.depth + BRAID_FLAT * tail.plait};
        for (int i = 0; i < 18; ++i)
            value[i][lane] = of[i];
    }
    lanes.ring = LANES_LOAD(value[0]);
    lanes.guide_ring = LANES_LOAD(value[1]);
    lanes.from_ring = LANES_LOAD(value[2]);
    lanes.per_node = LANES_LOAD(value[3]);
    lanes.length = LANES_LOAD(value[4]);
    lanes.place_x = LANES_LOAD(value[5]);
    lanes.place_y = LANES_LOAD(value[6]);
    lanes.radius = LANES_LOAD(value[7]);
    lanes.fullest = LANES_LOAD(value[8]);
    lanes.together = LANES_LOAD(value[9]);
    lanes.axis = points(LANES_LOAD(value[10]), LANES_LOAD(value[11]), LANES_LOAD(value[12]));
    lanes.side = points(LANES_LOAD(value[13]), LANES_LOAD(value[14]), LANES_LOAD(value[15]));
    lanes.which = lanes.ring > 0.0f;
#ifdef BRAIDED
    lanes.braid.ring = lanes.ring;
    lanes.braid.per_node = lanes.per_node;
    lanes.braid.pitch = LANES_LOAD(value[16]);
    lanes.braid.depth = LANES_LOAD(value[17]);
    lanes.braid.which = lanes.which & (lanes.braid.pitch > 0.0f);
#endif
    return lanes;
}

// A tied strand's own root moves less and less of it on the way to the ring, so that all of them go through.
static inline real shifted_share(const TiedLanes* lanes, int node)
{
    const real t = clamp(((float)node - 1.0f) / fmax(lanes->ring - 1.0f, (real)(1e-3f)), (real)(0.0f), (real)(1.0f));
    return select((real)(1.0f), 1.0f - t * t * (3.0f - 2.0f * t), lanes->which);
}

// The line that a tail hangs about, where it is as far out of the ring, as a share of all, as node k is: all its
// strands end together, however long their own tails are.
static inline Points tail_middle(global const float* position, const TiedLanes* lanes, int k)
{
    const real at = lanes->guide_ring + fmax((float)k - lanes->ring, (real)(0.0f)) * lanes->from_ring;
    const whole below = clamp(TO_WHOLE(at), (whole)(1), (whole)(NODES - 2));
    int first[WIDTH];
    LANES_STORE(below, first);
    Points sum = points((real)(0.0f), (real)(0.0f), (real)(0.0f));
    for (int i = -1; i <= 2; ++i)
    {
        int from[WIDTH];
        for (int lane = 0; lane < WIDTH; ++lane)
            from[lane] = lanes->guide[lane] + min(first[lane] + i, NODES - 1) * 3 * LANES;
        const Points p = guide_node(position, from, 0);
        const real weight = catmull_rom(at - TO_REAL(below + i));
        sum = points(sum.x + weight * p.x, sum.y + weight * p.y, sum.z + weight * p.z);
    }
    return sum;
}

static inline Points unit_of(Points v)
{
    const real shorten = INVERSE_SQRT(fmax(dot_lanes(v, v), (real)(1e-20f)));
    return points(v.x * shorten, v.y * shorten, v.z * shorten);
}

// Moves the nodes behind the rings towards their places in the tails, and onto the middles of braids, about which
// shaders/strand.geom plaits them.
static inline void hang_in_tails(const TiedLanes* lanes, global const float* position, Points* node,
                                 constant StepInfo* info)
{
    const float4 r0 = info->head_row0, r1 = info->head_row1, r2 = info->head_row2;
    Points tangent = turn_by(r0, r1, r2, lanes->axis), normal = turn_by(r0, r1, r2, lanes->side);
    Points last = tail_middle(position, lanes, 1);
    for (int k = 2; k < NODES; ++k)
    {
        const whole behind = lanes->which & ((float)k > lanes->ring);
        if (!any_lane(behind))
            continue;
        // The frame goes on along the middle by the smallest rotations, as kernels/transport_frames.cl has it.
        const Points middle = tail_middle(position, lanes, k);
        const Points next =
            select_points(tangent, unit_of(points(middle.x - last.x, middle.y - last.y, middle.z - last.z)), behind);
        const real by = dot_lanes(normal, next) / fmax(1.0f + dot_lanes(tangent, next), (real)(1e-3f));
        normal = unit_of(points(normal.x - by * (tangent.x + next.x), normal.y - by * (tangent.y + next.y),
                                normal.z - by * (tangent.z + next.z)));
        tangent = next;
        last = select_points(last, middle, behind);
        const real way = ((float)k - lanes->ring) * lanes->per_node; // m
        const real t = clamp(3.0f * way / lanes->length, (real)(0.0f), (real)(1.0f));
        const real thin = clamp(1.6f * way / lanes->length - 0.6f, (real)(0.0f), (real)(1.0f)); // towards the tips
        const real wide = mix(lanes->radius, lanes->fullest, t * (2.0f - t)) * (1.0f - 0.5f * thin * thin);
        const real x = wide * lanes->place_x, y = wide * lanes->place_y;
        const Points front =
            points(tangent.y * normal.z - tangent.z * normal.y, tangent.z * normal.x - tangent.x * normal.z,
                   tangent.x * normal.y - tangent.y * normal.x);
        Points to = points(middle.x + x * normal.x + y * front.x, middle.y + x * normal.y + y * front.y,
                           middle.z + x * normal.z + y * front.z);
        const real s = clamp(4.0f * way / lanes->length, (real)(0.0f), (real)(1.0f));
        real share = lanes->together * s * (2.0f - s);
#ifdef BRAIDED
        to = select_points(to, middle, lanes->braid.which);
        share = select(share, braid_shares(&lanes->braid, (real)((float)k)), lanes->braid.which);
#endif
        share = select((real)(0.0f), share, behind);
        node[k] = points(mix(node[k].x, to.x, share), mix(node[k].y, to.y, share), mix(node[k].z, to.z, share));
    }
}

#endif

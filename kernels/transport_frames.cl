// A normal at each node of a drawn strand that neither twists nor flips along it, so that waves keep their side:
// carried from segment to segment by the smallest rotation that turns one tangent into the next (parallel transport;
// Bergou, Wardetzky, Robinson, Audoly, Grinspun. Discrete elastic rods. 2008, section 4.2.2). A geometry shader sees
// four nodes only and could not.
//
// At the root the normal points away from the head, as far as the strand's direction lets it. Work-item: WIDTH strands.
// w holds the strand's length from the root on, m, for the phase of waves and curls; in a clump it counts along the way
// of the leader, so that all of them turn together.
#include "drawn_lanes.h"

static inline Points unit_or(Points v, Points otherwise)
{
    const real squared = dot_lanes(v, v);
    const real shorten = INVERSE_SQRT(fmax(squared, (real)(1e-20f)));
    return select_points(otherwise, points(v.x * shorten, v.y * shorten, v.z * shorten), squared > 1e-20f);
}

// v without its part along the unit vector `along`.
static inline Points across(Points v, Points along)
{
    const real part = dot_lanes(v, along);
    return points(v.x - along.x * part, v.y - along.y * part, v.z - along.z * part);
}

#ifdef BRAIDED
// What braided strands share: the way across the braid at its ring, and where along each strand that is.
typedef struct BraidSides
{
    Points axis, side;
    real ring; // in nodes of the strand as it is cut; beyond its tip: it is not braided
} BraidSides;

static inline BraidSides braid_sides(global const DrawnStrand* strands, global const TiedStrand* tied,
                                     constant Tail* tails, const int* strand, constant StepInfo* info)
{
    float ring[WIDTH], ax[WIDTH], ay[WIDTH], az[WIDTH], sx[WIDTH], sy[WIDTH], sz[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const int mixed = strand[lane] < info->drawn_multi;
        const TiedStrand own = tied[mixed ? strand[lane] : 0];
        constant Tail* braid = tails + own.tail;
        ring[lane] = mixed && own.ring > 0.0f && braid->axis.w > 0.0f
                         ? 1.0f + (own.ring - 1.0f) / strands[strand[lane]].root.w
                         : (float)NODES;
        ax[lane] = braid->axis.x;
        ay[lane] = braid->axis.y;
        az[lane] = braid->axis.z;
        sx[lane] = braid->side.x;
        sy[lane] = braid->side.y;
        sz[lane] = braid->side.z;
    }
    BraidSides sides;
    sides.axis = turn_by(info->head_row0, info->head_row1, info->head_row2,
                         points(LANES_LOAD(ax), LANES_LOAD(ay), LANES_LOAD(az)));
    sides.side = turn_by(info->head_row0, info->head_row1, info->head_row2,
                         points(LANES_LOAD(sx), LANES_LOAD(sy), LANES_LOAD(sz)));
    sides.ring = LANES_LOAD(ring);
    return sides;
}
#endif

kernel void transport_frames(global const float4* drawn_position, global float4* drawn_frame,
                             global const DrawnStrand* strands,
#ifdef BRAIDED
                             global const TiedStrand* tied, constant Tail* tails,
#endif
                             constant StepInfo* info)
{
    const int first = get_global_id(0) * WIDTH;
    if (first >= info->drawn)
        return;
    int strand[WIDTH];
    number_lanes(first, info->drawn, strand);
    const real zero = (real)(0.0f), one = (real)(1.0f);
    Points last = load_node(drawn_position, strand, 0), p = load_node(drawn_position, strand, 1);

    const float3 center =
        (float3)(dot(info->head_row0.xyz, info->head_center.xyz), dot(info->head_row1.xyz, info->head_center.xyz),
                 dot(info->head_row2.xyz, info->head_center.xyz));
    const Points outward = unit_or(points(p.x - center.x, p.y - center.y, p.z - center.z), points(zero, one, zero));
    Points tangent = unit_or(points(p.x - last.x, p.y - last.y, p.z - last.z), outward);
    // Where a strand leaves along the normal, any perpendicular will do, but all strands should take the same one: here
    // up x tangent.
    const Points side = unit_or(points(tangent.z, zero, -tangent.x), points(one, zero, zero));
    const Points lean = across(outward, tangent);
    Points normal = unit_or(select_points(across(side, tangent), lean, dot_lanes(lean, lean) > 1e-4f), side);
    real length_so_far = zero;
#ifdef CLUMPS
    float ahead[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
        ahead[lane] = strands[strand[lane]].weights.w;
    length_so_far = LANES_LOAD(ahead);
#endif
    store_node(drawn_frame, strand, 0, normal, length_so_far);

#ifdef BRAIDED
    const BraidSides braid = braid_sides(strands, tied, tails, strand, info);
#endif
    for (int k = 1; k < NODES; ++k)
    {
        p = load_node(drawn_position, strand, k);
        const Points segment = points(p.x - last.x, p.y - last.y, p.z - last.z);
        const Points next = unit_or(segment, tangent);
#ifdef BRAIDED // all strands of a braid carry the same normal on from its ring
        const whole enters = ((float)k > braid.ring) & ((float)k - 1.0f <= braid.ring);
        normal = select_points(normal, braid.side, enters);
        tangent = select_points(tangent, braid.axis, enters);
#endif
        // Rotation of t onto t' applied to n perpendicular to t: n - (n.t') / (1 + t.t') (t + t').
        const real turn = 1.0f + dot_lanes(tangent, next);
        const real by = select(zero, dot_lanes(normal, next) / turn, turn > 1e-4f);
        normal = points(normal.x - by * (tangent.x + next.x), normal.y - by * (tangent.y + next.y),
                        normal.z - by * (tangent.z + next.z));
        normal = unit_or(across(normal, next), side);
        tangent = next;
        if (k > 1)
            length_so_far += sqrt(dot_lanes(segment, segment));
        store_node(drawn_frame, strand, k, normal, length_so_far);
        last = p;
    }
}

// How a substep of the direct solver keeps nodes out of the bodies: it pushes and rubs them where they would come to
// lie inside, and at the end lays each strand around them at its exact length.
#ifndef COIF_BODIES_CONTACT_H
#define COIF_BODIES_CONTACT_H
#include "bodies.h"
#include "held.h"

// Takes a node that would end inside a capsule to its surface, and rubs it: Coulomb friction takes up to `friction`
// times the way it was pushed from how far it slid over the body. Node from x, going by *move, while the head went
// last -> now.
static inline void push_off_capsules(const Bodies* bodies, HeadPose last, HeadPose now, Points x, Points* move,
                                     real inside, float friction)
{
    const Points at = points(x.x + move->x, x.y + move->y, x.z + move->z);
    const Nearest nearest = nearest_capsule(bodies, now, at);
    const real gap = fmin(nearest.distance + inside, (real)(0.0f));
    if (!any_lane(gap < 0.0f))
        return;
    const Points n = away_in_world(now, nearest);
    Points carried = out_of_head(now, into_head(last, x)); // where x would be, were it fixed to the head
    carried = select_points(x, carried, nearest.on_head);
    Points slid = points(at.x - carried.x, at.y - carried.y, at.z - carried.z);
    const real out = dot_lanes(slid, n);
    slid = points(slid.x - out * n.x, slid.y - out * n.y, slid.z - out * n.z);
    const real slid2 = dot_lanes(slid, slid);
    const real most = -friction * gap;
    const real share = fmin(most * INVERSE_SQRT(fmax(slid2, (real)(1e-30f))), (real)(1.0f));
    *move = points(move->x - gap * n.x - share * slid.x, move->y - gap * n.y - share * slid.y,
                   move->z - gap * n.z - share * slid.z);
}

#ifdef BODY_GRID
// The same by the plane that the head's surface is near this node (find_planes).
static inline void push_off_plane(const Bodies* bodies, HeadPose last, HeadPose now, int node, Points x, Points* move,
                                  real inside, float friction)
{
    const Points n = bodies->normal[node], to = into_head(now, plus(x, *move));
    real gap = fmin(dot_lanes(n, to) - bodies->level[node] + inside, (real)(0.0f));
    gap = select((real)(0.0f), gap, bodies->may_meet[node]);
    if (!any_lane(gap < 0.0f))
        return;
    Points slid = minus(to, into_head(last, x));
    slid = minus(slid, times(dot_lanes(slid, n), n));
    const real slid2 = dot_lanes(slid, slid);
    const real share = fmin(-friction * gap * INVERSE_SQRT(fmax(slid2, (real)(1e-30f))), (real)(1.0f));
    const Points by = plus(times(gap, n), times(share, slid));
    *move = minus(*move, turn_by(now.row0, now.row1, now.row2, by));
}
#endif

// Root to tip, the last word of a substep: each node at its exact length from its parent and, if that is inside a body,
// on the circle where that length meets the body's surface (its tangent plane, found again from where that led). Where
// the parent lies too deep for that, straight outwards: then length has the say. `rest` and `inside` in m; `inside[k]`
// is how deep node k may still be; nodes before the lane's `held` stay (direct.h). Only the last substep's walk need be
// `exact` (nearest_body). Returns the strands that it found in contact.
#define WALK_ROUNDS 6
#define TOUCHING 1e-5f // of a segment: what lies that deep is on the surface, until the last substep
static inline whole walk_out(const Bodies* bodies, HeadPose head, Points* x, real rest, held_count held,
                             const real* inside, int exact)
{
    whole touched = (whole)(0);
    const real deep_enough = exact ? (real)(0.0f) : -TOUCHING * rest;
    for (int k = 2; k < NODES; ++k)
    {
        const Points parent = x[k - 1];
        Points d = points(x[k].x - parent.x, x[k].y - parent.y, x[k].z - parent.z);
        const real squared = dot_lanes(d, d);
        const real scale = rest * INVERSE_SQRT(fmax(squared, 1e-12f * rest * rest));
        d = points(d.x * scale, d.y * scale, d.z * scale);
        Points at = points(parent.x + d.x, parent.y + d.y, parent.z + d.z);
        Points last_n = d; // the plane of the round before
        real last_offset = (real)(0.0f);
        whole was_in = (whole)(0);
#ifdef BODY_GRID
        const whole clear = bodies->near_count == 0 ? kept_clear(bodies, head, k, at) : (whole)(0);
#else
        const whole clear = (whole)(0);
#endif
        for (int turn = 0; turn < WALK_ROUNDS && any_lane(~clear); ++turn)
        {
            const Nearest nearest = nearest_body(bodies, head, k, at, exact);
            const real gap = nearest.distance + inside[k];
            const whole in = UNLESS_HELD(k, held, (whole)(0), gap < deep_enough) & ~clear;
            if (!any_lane(in))
                break;
            touched |= in;
            const Points n = away_in_world(head, nearest);
            // Height of the parent over the plane, and the direction along the plane.
            const real along = dot_lanes(n, d), height = clamp(gap - along, -rest, rest);
            Points t = points(d.x - along * n.x, d.y - along * n.y, d.z - along * n.z);
            const real t_squared = dot_lanes(t, t);
            // Straight into the plane: any way along it, here across the axis that n is least along.
            const whole steep = t_squared < 1e-8f * rest * rest;
            const whole not_x = fabs(n.x) > 0.6f;
            const Points side = select_points(points((real)(0.0f), n.z, -n.y), points(-n.z, (real)(0.0f), n.x), not_x);
            t = select_points(t, side, steep);
            const real flat =
                sqrt((rest - height) * (rest + height)) * INVERSE_SQRT(fmax(dot_lanes(t, t), (real)(1e-30f)));
            const Points moved =
                points(flat * t.x - height * n.x, flat * t.y - height * n.y, flat * t.z - height * n.z);
            d = select_points(d, moved, in);
            // In a crease one body leads into another, to and fro: where both their planes and the length meet, which
            // are the last plane's foot, as far along the rest of this normal as it takes, and the edge.
            const real offset = along - gap;
            const whole pinched = in & was_in & (dot_lanes(last_n, d) < last_offset);
            if (any_lane(pinched))
            {
                const real both = dot_lanes(last_n, n);
                Points across = points(n.x - both * last_n.x, n.y - both * last_n.y, n.z - both * last_n.z);
                const real spread = dot_lanes(across, across), shorten = INVERSE_SQRT(fmax(spread, (real)(1e-3f)));
                across = points(shorten * across.x, shorten * across.y, shorten * across.z);
                const real further = (offset - both * last_offset) * shorten;
                const Points edge =
                    points(last_n.y * across.z - last_n.z * across.y, last_n.z * across.x - last_n.x * across.z,
                           last_n.x * across.y - last_n.y * across.x);
                // Out of reach of the length: towards the edge, where next round's planes stand further apart.
                const real foot2 = last_offset * last_offset + further * further;
                const real part = fmin((real)(1.0f), rest * INVERSE_SQRT(fmax(foot2, 1e-12f * rest * rest)));
                real way = sqrt(fmax(rest * rest - foot2, (real)(0.0f)));
                way = select(way, -way, dot_lanes(edge, d) < 0.0f);
                d = select_points(d,
                                  points(part * (last_offset * last_n.x + further * across.x) + way * edge.x,
                                         part * (last_offset * last_n.y + further * across.y) + way * edge.y,
                                         part * (last_offset * last_n.z + further * across.z) + way * edge.z),
                                  pinched & (spread > 1e-3f));
            }
            last_n = n;
            last_offset = offset;
            was_in = in;
            at = points(parent.x + d.x, parent.y + d.y, parent.z + d.z);
        }
        x[k] = POINTS_UNLESS_HELD(k, held, x[k], at);
    }
    return touched;
}

#endif

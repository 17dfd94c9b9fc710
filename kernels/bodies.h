// The bodies that simulated hair stays outside of, as a signed distance with a direction: spheres and capsules that are
// fixed to the head or to the world, and the grid of distances to the head's mesh.
//
// Positions are relative to where the head's origin was when the step began, along the world's axes.
#ifndef COIF_BODIES_H
#define COIF_BODIES_H
#include "contact.h"
#include "distance_grid.h"

// The head at one moment: rows of its rotation, and its origin in their w.
typedef struct HeadPose
{
    float4 row0, row1, row2;
} HeadPose;

static inline HeadPose head_pose(constant StepPath* path, int sixteenth)
{
    const HeadPose pose = {path->row[3 * sixteenth], path->row[3 * sixteenth + 1], path->row[3 * sixteenth + 2]};
    return pose;
}

static inline Points out_of_head(HeadPose h, Points p)
{
    return points(h.row0.x * p.x + h.row0.y * p.y + h.row0.z * p.z + h.row0.w,
                  h.row1.x * p.x + h.row1.y * p.y + h.row1.z * p.z + h.row1.w,
                  h.row2.x * p.x + h.row2.y * p.y + h.row2.z * p.z + h.row2.w);
}

static inline Points into_head(HeadPose h, Points p)
{
    return turn_back_by(h.row0, h.row1, h.row2, points(p.x - h.row0.w, p.y - h.row1.w, p.z - h.row2.w));
}

// What hair near some bodies needs to know of them. `near` numbers those in reach, the head's own first.
typedef struct Bodies
{
    constant Capsule* all; // in the head's frame or against the path's origin
    short near[MOST_COLLIDERS];
    int near_head, near_count;
#ifdef BODY_GRID
    global const float* grid; // distances to the head's mesh, distance_grid.h
    constant StepInfo* info;
#endif
} Bodies;

static inline int any_near(const Bodies* bodies)
{
#ifdef BODY_GRID
    return 1; // hair grows on it
#else
    return bodies->near_count > 0;
#endif
}

// Distance of p to a sphere or capsule, and the unit vector away from it. At its very middle: upwards.
static inline real capsule_distance(constant Capsule* body, Points p, Points* away)
{
    const float radius = body->center.w;
    Points on_axis;
    nearest_on_axis(*body, p.x, p.y, p.z, &on_axis.x, &on_axis.y, &on_axis.z);
    const Points d = points(p.x - on_axis.x, p.y - on_axis.y, p.z - on_axis.z);
    const real squared = dot_lanes(d, d);
    const float least_squared = 1e-12f * radius * radius;
    const real inverse = INVERSE_SQRT(fmax(squared, (real)(least_squared)));
    *away = select_points(points((real)(0.0f), (real)(1.0f), (real)(0.0f)),
                          points(d.x * inverse, d.y * inverse, d.z * inverse), squared > least_squared);
    return squared * inverse - radius;
}

static inline void nearer(real distance_to, Points away, real* nearest, Points* normal)
{
    const whole is = distance_to < *nearest;
    *nearest = select(*nearest, distance_to, is);
    *normal = select_points(*normal, away, is);
}

// Distance of p to the nearest body (m; negative inside, 1e9 where none is near), the unit vector away from it, and
// whether it is a part of the head.
static inline real nearest_body(const Bodies* bodies, HeadPose head, Points p, Points* normal, whole* on_head)
{
    real nearest = (real)(1e9f);
    Points out = points((real)(0.0f), (real)(1.0f), (real)(0.0f)), away;
#ifdef BODY_GRID
    const int of_the_head = 1;
#else
    const int of_the_head = bodies->near_head > 0;
#endif
    if (of_the_head)
    {
        const Points local_p = into_head(head, p);
#ifdef BODY_GRID
        nearest = head_distance(bodies->grid, local_p, &out, bodies->info);
#endif
        for (int i = 0; i < bodies->near_head; ++i)
            nearer(capsule_distance(bodies->all + bodies->near[i], local_p, &away), away, &nearest, &out);
        out = turn_by(head.row0, head.row1, head.row2, out);
    }
    const real of_head = nearest;
    for (int i = bodies->near_head; i < bodies->near_count; ++i)
        nearer(capsule_distance(bodies->all + bodies->near[i], p, &away), away, &nearest, &out);
    *normal = out;
    *on_head = nearest == of_head;
    return nearest;
}

// Finds the bodies that strands with these roots can reach before the step is over.
static inline void bodies_near(Bodies* bodies, constant Capsule* all, constant StepInfo* info, HeadPose begin,
                               HeadPose end, Points root, real reach)
{
    bodies->all = all;
    bodies->near_head = bodies->near_count = 0;
    const Points in_head = into_head(begin, root), after = out_of_head(end, in_head);
    const Points moved = points(after.x - root.x, after.y - root.y, after.z - root.z);
    const real with_motion = reach + sqrt(dot_lanes(moved, moved));
    for (int c = 0; c < info->colliders; ++c)
    {
        const int on_head = c < info->head_colliders;
        Points away;
        const real gap = capsule_distance(all + c, on_head ? in_head : root, &away);
        if (any_lane(gap < (on_head ? reach : with_motion)))
            bodies->near[bodies->near_count++] = (short)c;
        if (on_head)
            bodies->near_head = bodies->near_count;
    }
}

// Takes a node that would end inside a body to its surface, and rubs it: Coulomb friction takes up to `friction` times
// the way it was pushed from how far it slid over the body. Node from x, going by *move, while the head went last ->
// now.
static inline void push_and_rub(const Bodies* bodies, HeadPose last, HeadPose now, Points x, Points* move, real inside,
                                float friction)
{
    Points n;
    whole on_head;
    const Points at = points(x.x + move->x, x.y + move->y, x.z + move->z);
    const real gap = fmin(nearest_body(bodies, now, at, &n, &on_head) + inside, (real)(0.0f));
    if (!any_lane(gap < 0.0f))
        return;
    Points carried = out_of_head(now, into_head(last, x)); // where x would be, were it fixed to the head
    carried = select_points(x, carried, on_head);
    Points slid = points(at.x - carried.x, at.y - carried.y, at.z - carried.z);
    const real out = dot_lanes(slid, n);
    slid = points(slid.x - out * n.x, slid.y - out * n.y, slid.z - out * n.z);
    const real slid2 = dot_lanes(slid, slid);
    const real most = -friction * gap;
    const real share = fmin(most * INVERSE_SQRT(fmax(slid2, (real)(1e-30f))), (real)(1.0f));
    *move = points(move->x - gap * n.x - share * slid.x, move->y - gap * n.y - share * slid.y,
                   move->z - gap * n.z - share * slid.z);
}

// Root to tip, the last word of a substep: each node at its exact length from its parent and,
// if that is inside a body, on the circle where that length meets the body's surface (its tangent plane, found again
// from where that led). Where the parent lies too deep for that, straight outwards: then length has the say.
// `inside[k]` is how deep node k may still be. Returns the strands that it found in contact.
#define WALK_ROUNDS 4
static inline whole walk_out(const Bodies* bodies, HeadPose head, Points* x, real rest, const real* inside)
{
    whole touched = (whole)(0);
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
        for (int turn = 0; turn < WALK_ROUNDS; ++turn)
        {
            Points n;
            whole on_head;
            const real gap = nearest_body(bodies, head, at, &n, &on_head) + inside[k];
            const whole in = gap < 0.0f;
            if (!any_lane(in))
                break;
            touched |= in;
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
                const real left = rest * rest - last_offset * last_offset - further * further;
                real way = sqrt(fmax(left, (real)(0.0f)));
                way = select(way, -way, dot_lanes(edge, d) < 0.0f);
                d = select_points(d,
                                  points(last_offset * last_n.x + further * across.x + way * edge.x,
                                         last_offset * last_n.y + further * across.y + way * edge.y,
                                         last_offset * last_n.z + further * across.z + way * edge.z),
                                  pinched & (spread > 1e-3f) & (left > 0.0f));
            }
            last_n = n;
            last_offset = offset;
            was_in = in;
            at = points(parent.x + d.x, parent.y + d.y, parent.z + d.z);
        }
        x[k] = at;
    }
    return touched;
}

#endif

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

#endif

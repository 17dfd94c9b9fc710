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

static inline HeadPose head_pose(constant StepPath* path, int part)
{
    const HeadPose pose = {path->row[3 * part], path->row[3 * part + 1], path->row[3 * part + 2]};
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
    // Where each node is when the step begins, and how far from the surface; the plane that this is nearby: unit normal
    // and height. All in the head's frame.
    Points start[NODES], normal[NODES];
    real distance[NODES], level[NODES];
    whole may_meet[NODES]; // in the step
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

#ifdef BODY_GRID
// One look at the grid for each node, where it is when the step begins: its substeps go by that. A node goes `move` in
// each of them at its speed, and would go `carried` if it went with the head's origin. What comes in all the same, for
// the head has turned, is found by walk_out().
#define NEAR_BY 0.005f // m
static inline void find_planes(Bodies* bodies, HeadPose begin, const Points* x, const Points* move, Points carried,
                               int substeps)
{
    const real twice = (real)(2.0f * (float)substeps);
    for (int i = 1; i < NODES; ++i)
    {
        const Points p = into_head(begin, x[i]), way = times(twice, minus(move[i], carried));
        const real distance = head_distance(bodies->grid, p, &bodies->normal[i], bodies->info);
        const real room = distance - NEAR_BY;
        bodies->start[i] = p;
        bodies->distance[i] = distance;
        bodies->level[i] = dot_lanes(bodies->normal[i], p) - distance;
        bodies->may_meet[i] = (room < 0.0f) | !(dot_lanes(way, way) < room * room);
    }
}

// Nodes that went less far than the surface was away: it has not come nearer than by that, but for what interpolating
// the grid makes of distances.
static inline whole kept_clear(const Bodies* bodies, HeadPose head, int node, Points p)
{
    const Points way = minus(into_head(head, p), bodies->start[node]);
    const real distance = fmax(bodies->distance[node], (real)(0.0f));
    return 2.0f * dot_lanes(way, way) < distance * distance;
}
#endif

// What of the bodies is nearest to a point.
typedef struct Nearest
{
    real distance; // m; negative inside, 1e9 where nothing is near
    Points away;   // unit vector, along the head's axes if that is a part of the head, else along the world's
    whole on_head;
} Nearest;

static inline void nearer(Nearest* nearest, constant Capsule* body, Points p, whole on_head)
{
    Points away;
    const real distance_to = capsule_distance(body, p, &away);
    const whole is = distance_to < nearest->distance;
    nearest->distance = select(nearest->distance, distance_to, is);
    nearest->away = select_points(nearest->away, away, is);
    nearest->on_head = select(nearest->on_head, on_head, is);
}

static inline Nearest nearest_capsule(const Bodies* bodies, HeadPose head, Points p)
{
    Nearest nearest = {(real)(1e9f), points((real)(0.0f), (real)(1.0f), (real)(0.0f)), (whole)(0)};
    if (bodies->near_head > 0)
    {
        const Points in_head = into_head(head, p);
        for (int i = 0; i < bodies->near_head; ++i)
            nearer(&nearest, bodies->all + bodies->near[i], in_head, (whole)(-1));
    }
    for (int i = bodies->near_head; i < bodies->near_count; ++i)
        nearer(&nearest, bodies->all + bodies->near[i], p, (whole)(0));
    return nearest;
}

// To a node of the strand that has come to p. Unless it is to be `exact`, the head's surface is the node's plane
// (find_planes) as long as it is not a sample of the grid away from where that was found.
static inline Nearest nearest_body(const Bodies* bodies, HeadPose head, int node, Points p, int exact)
{
    Nearest nearest = nearest_capsule(bodies, head, p);
#ifdef BODY_GRID
    const Points in_head = into_head(head, p), way = minus(in_head, bodies->start[node]);
    const float sample = bodies->info->body_corner.w;
    const whole anew = exact ? (whole)(-1) : !(dot_lanes(way, way) < sample * sample);
    Points away = bodies->normal[node];
    real to_grid = dot_lanes(away, in_head) - bodies->level[node];
    if (any_lane(anew))
    {
        Points normal;
        const real distance = head_distance(bodies->grid, in_head, &normal, bodies->info);
        to_grid = select(to_grid, distance, anew);
        away = select_points(away, normal, anew);
    }
    const whole is = to_grid <= nearest.distance;
    nearest.distance = select(nearest.distance, to_grid, is);
    nearest.away = select_points(nearest.away, away, is);
    nearest.on_head |= is;
#endif
    return nearest;
}

// Most who ask are outside and do not need it.
static inline Points away_in_world(HeadPose head, Nearest nearest)
{
    return select_points(nearest.away, turn_by(head.row0, head.row1, head.row2, nearest.away), nearest.on_head);
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

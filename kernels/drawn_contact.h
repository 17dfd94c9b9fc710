// Drawn strands out of the head's mesh and of the colliders, with room to spare. They are made anew each frame and keep
// no memory, so that a small move of the guides must move them little: neighbours are taken out side by side.
#ifndef COIF_DRAWN_CONTACT_H
#define COIF_DRAWN_CONTACT_H
#include "contact_union.h"
#include "distance_grid.h"
#include "drawn_lanes.h"

#define STEPS_OUT 5
#define STEPS_OUT_ALONG 2 // of them: what is not out by then goes to what is nearest

// Out of the head's distance grid with room to spare: the way that the grid says is out on the whole, so that
// neighbours arrive beside each other, as far as the surface says.
static inline void out_of_body(global const float* body_distance, global const float4* body_way, Points* p, real room,
                               constant StepInfo* info)
{
#ifdef BODY_GRID
    const float enough = 0.01f * info->body_corner.w; // voxels
    const float flat = 0.25f * info->body_corner.w; // a way over which the surface is a plane: the last that is needed
    Points way = *p;
    real left = (real)(2.0f * flat);
    for (int taken = 0; taken < STEPS_OUT; ++taken)
    {
        const BodyPlane plane = body_plane(body_distance, p->x, p->y, p->z, info);
        const real within = room - plane.distance;
        left = select((real)(0.0f), within, (left > flat) & (within > enough));
        if (!any_lane(left > 0.0f))
            return;
        if (taken == 0)
            body_way_out(body_way, p->x, p->y, p->z, &way.x, &way.y, &way.z, info);
        if (taken >= STEPS_OUT - STEPS_OUT_ALONG)
            way = points(plane.nx, plane.ny, plane.nz);
        const real go = left / fmax(dot_lanes(way, points(plane.nx, plane.ny, plane.nz)), (real)(0.5f));
        *p = points(p->x + go * way.x, p->y + go * way.y, p->z + go * way.z);
    }
#endif
}

// Out of the head and of the colliders numbered in `which`. What one pushes into the other goes on straight the way
// that both together have pushed it, as long as it takes to be out of both.
LAID_IN void out_of_all(global const float* body_distance, global const float4* body_way, constant Capsule* colliders,
                        const short* which, int count, Points* p, real room, constant StepInfo* info)
{
#ifndef BODY_GRID
    out_of(colliders, which, count, p, room);
#else
    out_of_body(body_distance, body_way, p, room, info);
    if (count == 0)
        return;
    const Points from = *p;
    const real moved = out_of(colliders, which, count, p, room);
    whole caught = moved > 0.0f;
    if (!any_lane(caught))
        return;
    // Between the two ways out, of which each leads into the other body.
    Points way;
    body_way_out(body_way, p->x, p->y, p->z, &way.x, &way.y, &way.z, info);
    const real per_move = 1.0f / select((real)(1.0f), moved, caught);
    way = points(way.x + (p->x - from.x) * per_move, way.y + (p->y - from.y) * per_move,
                 way.z + (p->z - from.z) * per_move);
    const real shorten = INVERSE_SQRT(fmax(dot_lanes(way, way), (real)(1e-6f)));
    way = points(way.x * shorten, way.y * shorten, way.z * shorten);
    for (int taken = 0; taken < 8; ++taken)
    {
        const BodyPlane plane = body_plane(body_distance, p->x, p->y, p->z, info);
        const real within = room - plane.distance;
        caught &= within > 0.01f * info->body_corner.w;
        if (!any_lane(caught))
            return;
        const real rise = dot_lanes(way, points(plane.nx, plane.ny, plane.nz));
        real go = select((real)(0.0f), within / fmax(rise, (real)(0.5f)), caught);
        for (int c = 0; c < count; ++c)
        {
            const Points at = points(p->x + go * way.x, p->y + go * way.y, p->z + go * way.z);
            go = select(go, leave(colliders[which[c]], *p, way, at, room, go), caught);
        }
        *p = points(p->x + go * way.x, p->y + go * way.y, p->z + go * way.z);
    }
    // A collider that sticks in the head leaves no way: the head comes first.
    Points free = *p;
    out_of_body(body_distance, body_way, &free, room, info);
    *p = select_points(*p, free, caught);
#endif
}

#endif

// Out of all colliders at once, where they overlap too, as the spheres of a head do. Guides end their substep with it,
// and drawn strands need it, because a mix of guides or a turned copy of one may lie inside.
#ifndef COIF_CONTACT_UNION_H
#define COIF_CONTACT_UNION_H
#include "contact.h"
#include "drawn_lanes.h"

// From what of a collider's axis is nearest to `at`, to p.
static inline Points from_axis(Capsule collider, Points at, Points p)
{
    real cx, cy, cz;
    nearest_on_axis(collider, at.x, at.y, at.z, &cx, &cy, &cz);
    return points(p.x - cx, p.y - cy, p.z - cz);
}

// Where the ray p + t direction, now at t, is inside the sphere that the collider is to its point `at`: the t at which
// it leaves it. Elsewhere t. The sphere lies within the collider, so a capsule is left in a few rounds, and never by
// more than it takes.
static inline real leave(Capsule collider, Points p, Points direction, Points at, real room, real t)
{
    const Points out = from_axis(collider, at, p);
    const real radius = collider.center.w + room, b = dot_lanes(out, direction);
    const real discriminant = b * b - dot_lanes(out, out) + radius * radius;
    const real half_chord = sqrt(fmax(discriminant, (real)(0.0f)));
    return select(t, half_chord - b, (discriminant > 0.0f) & (-b - half_chord <= t) & (half_chord - b > t));
}

// Out of the union of all colliders with `room` to spare: along the mean of the ways out of those that hold the point,
// each weighed by the square of its depth, as far as it takes to leave every one. So the way out turns smoothly from
// node to node where they overlap; pushing out of one at a time would go to and fro there, and the deepest one alone
// would put neighbours on different sides of a crease. `which` numbers the colliders that matter.
// Returns how far each point has moved.
static inline real out_of(constant Capsule* colliders, const short* which, int count, Points* p, real room)
{
    real t = (real)(0.0f);
    Points way = points(t, t, t);
    real weights = t;
    short touched[MOST_COLLIDERS]; // by any lane
    int touched_count = 0;
    for (int c = 0; c < count; ++c)
    {
        const Points out = from_axis(colliders[which[c]], *p, *p);
        const real radius = colliders[which[c]].center.w + room, squared = dot_lanes(out, out);
        if (!any_lane(squared < radius * radius))
            continue;
        touched[touched_count++] = which[c];
        const real length_out = sqrt(squared), depth = fmax(radius - length_out, (real)(0.0f));
        const whole at_center = length_out <= 1e-6f * radius;
        const real weight = depth * depth / select(length_out, (real)(1.0f), at_center);
        way = points(way.x + weight * out.x, way.y + select(weight * out.y, depth * depth, at_center),
                     way.z + weight * out.z);
        weights += depth * depth;
    }
    if (touched_count == 0)
        return t;
    // Where the ways out cancel, upwards.
    const real length_way = sqrt(dot_lanes(way, way));
    const whole inside = weights > 0.0f, lost = length_way <= 1e-4f * weights;
    const real shorten = 1.0f / select(length_way, (real)(1.0f), lost);
    const Points direction = select_points(points(way.x * shorten, way.y * shorten, way.z * shorten),
                                           points((real)(0.0f), (real)(1.0f), (real)(0.0f)), lost);

    // What the points are in now, and then what those that left have come into.
    Points at = *p;
    for (int round = 0; round < 16; ++round)
    {
        real further = t;
        for (int c = 0; c < touched_count; ++c)
            further = fmax(further, leave(colliders[touched[c]], *p, direction, at, room, t));
        further = select(t, further, inside);
        if (!any_lane(further > t))
            break;
        t = further;
        at = points(p->x + t * direction.x, p->y + t * direction.y, p->z + t * direction.z);
        touched_count = 0;
        for (int c = 0; c < count; ++c)
        {
            const Points out = from_axis(colliders[which[c]], at, at);
            const real radius = colliders[which[c]].center.w + room;
            if (any_lane((dot_lanes(out, out) < radius * radius) & inside))
                touched[touched_count++] = which[c];
        }
    }
    *p = at;
    return t;
}

#endif

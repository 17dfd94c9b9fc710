// Spheres and capsules that hair stays outside of (thesis 5.1.2, collision constraints). To a point a capsule is the
// sphere about what of its axis is nearest.
#ifndef COIF_CONTACT_H
#define COIF_CONTACT_H
#include "lanes.h"

// The point of a capsule's axis that is nearest to (x, y, z). Ericson, Real-Time Collision Detection, 2005, 5.1.2.
static inline void nearest_on_axis(Capsule capsule, real x, real y, real z, real* cx, real* cy, real* cz)
{
    const float4 center = capsule.center, axis = capsule.axis;
    *cx = (real)(center.x);
    *cy = (real)(center.y);
    *cz = (real)(center.z);
    if (!(axis.w > 0.0f))
        return;
    const real along = (x - center.x) * axis.x + (y - center.y) * axis.y + (z - center.z) * axis.z;
    const real share = fmin(fmax(along * axis.w, (real)(0.0f)), (real)(1.0f));
    *cx += share * axis.x;
    *cy += share * axis.y;
    *cz += share * axis.z;
}

// The colliders that come near a box, by their numbers in rising order. Returns how many. A capsule counts as the box
// about its axis, widened by its radius.
static inline int colliders_near(constant Capsule* colliders, int count, float3 low, float3 high, float room,
                                 short* which)
{
    int found = 0;
    for (int c = 0; c < count; ++c)
    {
        const float4 center = colliders[c].center;
        const float3 other = center.xyz + colliders[c].axis.xyz;
        const float3 away = fmax(fmax(fmin(center.xyz, other) - high, low - fmax(center.xyz, other)), (float3)(0.0f));
        const float reach = center.w + room;
        if (dot(away, away) < reach * reach)
            which[found++] = (short)c;
    }
    return found;
}

// Moves a node straight out of a collider to its surface. A node at the very centre leaves upwards.
static inline void push_out(real* x, real* y, real* z, Capsule collider)
{
    real cx, cy, cz;
    nearest_on_axis(collider, *x, *y, *z, &cx, &cy, &cz);
    real dx = *x - cx, dy = *y - cy, dz = *z - cz;
    const real squared = dx * dx + dy * dy + dz * dz;
    const float radius = collider.center.w, radius2 = radius * radius;
    if (!any_lane(squared < radius2))
        return;
    dy = select(dy, (real)(radius), squared < 1e-12f * radius2);
    const real length2 = fmax(dx * dx + dy * dy + dz * dz, 1e-12f * radius2);
    const real out = radius * INVERSE_SQRT(length2);
    *x = select(*x, cx + dx * out, squared < radius2);
    *y = select(*y, cy + dy * out, squared < radius2);
    *z = select(*z, cz + dz * out, squared < radius2);
}

#endif

// Spheres that hair stays outside of (thesis 5.1.2, collision constraints): (centre, radius) relative to the head's
// origin, m.
#ifndef COIF_CONTACT_H
#define COIF_CONTACT_H
#include "lanes.h"

// Moves a node straight out of a sphere to its surface. A node at the very centre leaves upwards.
static inline void push_out(real* x, real* y, real* z, float4 sphere)
{
    real dx = *x - sphere.x, dy = *y - sphere.y, dz = *z - sphere.z;
    const real squared = dx * dx + dy * dy + dz * dz;
    const float radius2 = sphere.w * sphere.w;
    if (!ANY(squared < radius2))
        return;
    dy = select(dy, (real)(sphere.w), squared < 1e-12f * radius2);
    const real length2 = fmax(dx * dx + dy * dy + dz * dz, 1e-12f * radius2);
    const real out = sphere.w * INVERSE_SQRT(length2);
    *x = select(*x, sphere.x + dx * out, squared < radius2);
    *y = select(*y, sphere.y + dy * out, squared < radius2);
    *z = select(*z, sphere.z + dz * out, squared < radius2);
}

#endif

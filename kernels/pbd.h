// The constraints of position-based dynamics for one strand of each lane (thesis 5.1.2, listing A.1; Mueller,
// Heidelberger, Hennix, Ratcliff. Position based dynamics. 2007). Nodes 0 and 1, or with HELD those before
// each lane's `held`, are prescribed and never move.
#ifndef COIF_PBD_H
#define COIF_PBD_H
#include "held.h"

// Of two prescribed or free nodes at distance d apart, how far along their difference the free ones move.
// `rest` may be zero (hair of no length): the guard is relative to the difference itself.
static inline real excess(real dx, real dy, real dz, real rest)
{
    const real squared = dx * dx + dy * dy + dz * dz;
    const real safe = fmax(squared, (real)(1e-24f));
    return select((real)(0.0f), 1.0f - rest * INVERSE_SQRT(safe), squared > 1e-24f);
}

// One batch of distance constraints: segments (first, first + 1), (first + 2, ...): no two share a node, so on a device
// that ran them side by side they would not collide either (Tariq, Bavoil. Real time hair simulation. 2008).
static inline void keep_lengths(real* x, real* y, real* z, real rest, float strength, held_count held, int first)
{
    for (int i = first; i + 1 < NODES; i += 2)
    {
        const real dx = x[i + 1] - x[i], dy = y[i + 1] - y[i], dz = z[i + 1] - z[i];
        const real move = strength * excess(dx, dy, dz, rest);
        const lane_share far = HELD_SHARE(i >= held, 0.5f, 1.0f);
        if (i > 1) // node 1 is left alone rather than moved by zero times what may be NaN: bad strands restart from it
        {
            x[i] = UNLESS_HELD(i, held, x[i], x[i] + 0.5f * move * dx);
            y[i] = UNLESS_HELD(i, held, y[i], y[i] + 0.5f * move * dy);
            z[i] = UNLESS_HELD(i, held, z[i], z[i] + 0.5f * move * dz);
        }
        x[i + 1] = UNLESS_HELD(i + 1, held, x[i + 1], x[i + 1] - far * move * dx);
        y[i + 1] = UNLESS_HELD(i + 1, held, y[i + 1], y[i + 1] - far * move * dy);
        z[i + 1] = UNLESS_HELD(i + 1, held, z[i + 1], z[i + 1] - far * move * dz);
    }
}

// Bending as a distance to the last prescribed node but one: where each node is as far from it as on a straight strand,
// the strand is straight and goes on along the prescribed segment (thesis, angular constraints). Only the outer node
// moves. bend[i] is the strength after attenuation, eq. 5.6.
static inline void straighten(real* x, real* y, real* z, real rest, float scale, const float* bend, held_count held)
{
    real from_x = x[0], from_y = y[0], from_z = z[0];
#ifdef HELD
    for (int i = 1; i < NODES && any_lane(i < held - 1); ++i)
    {
        from_x = select(from_x, x[i], i == held - 2);
        from_y = select(from_y, y[i], i == held - 2);
        from_z = select(from_z, z[i], i == held - 2);
    }
#endif
    for (int i = 2; i < NODES; ++i)
    {
        const real dx = x[i] - from_x, dy = y[i] - from_y, dz = z[i] - from_z;
        const real move = bend[i] * excess(dx, dy, dz, rest * (scale * HELD_SEGMENTS(i, held)));
        x[i] = UNLESS_HELD(i, held, x[i], x[i] - move * dx);
        y[i] = UNLESS_HELD(i, held, y[i], y[i] - move * dy);
        z[i] = UNLESS_HELD(i, held, z[i], z[i] - move * dz);
    }
}

// Brings a node to at most `most` from its parent, which stays: what the sweeps leave of stretch (Mueller, Kim,
// Chentanez. Fast simulation of inextensible hair and fur. 2012, section 3.1, where it is a strand's only constraint).
static inline void limit_length(real* x, real* y, real* z, real parent_x, real parent_y, real parent_z, real most)
{
    const real dx = *x - parent_x, dy = *y - parent_y, dz = *z - parent_z;
    const real beyond = excess(dx, dy, dz, most);
    const real back = select((real)(0.0f), beyond, beyond > 1e-6f); // no less: that is how floats round
    *x -= back * dx;
    *y -= back * dy;
    *z -= back * dz;
}

#endif

// The constraints of position-based dynamics for one strand of each lane (thesis 5.1.2, listing A.1; Mueller,
// Heidelberger, Hennix, Ratcliff. Position based dynamics. 2007). Nodes 0 and 1 are prescribed and never move.
#ifndef COIF_PBD_H
#define COIF_PBD_H
#include "lanes.h"

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
static inline void keep_lengths(real* x, real* y, real* z, real rest, float strength, int first)
{
    for (int i = first; i + 1 < NODES; i += 2)
    {
        const real dx = x[i + 1] - x[i], dy = y[i + 1] - y[i], dz = z[i + 1] - z[i];
        const real move = strength * excess(dx, dy, dz, rest);
        const float far = i > 1 ? 0.5f : 1.0f;
        if (i > 1) // node 1 is left alone rather than moved by zero times what may be NaN: bad strands restart from it
        {
            x[i] += 0.5f * move * dx;
            y[i] += 0.5f * move * dy;
            z[i] += 0.5f * move * dz;
        }
        x[i + 1] -= far * move * dx;
        y[i + 1] -= far * move * dy;
        z[i + 1] -= far * move * dz;
    }
}

// Bending as a distance to node 0: where each node is as far from it as on a straight strand, the strand is straight
// and goes on along the prescribed segment (thesis, angular constraints). Only the outer node moves. bend[i] is the
// strength after attenuation, eq. 5.6.
static inline void straighten(real* x, real* y, real* z, real rest, float scale, const float* bend)
{
    for (int i = 2; i < NODES; ++i)
    {
        const real dx = x[i] - x[0], dy = y[i] - y[0], dz = z[i] - z[0];
        const real move = bend[i] * excess(dx, dy, dz, rest * (scale * (float)i));
        x[i] -= move * dx;
        y[i] -= move * dy;
        z[i] -= move * dz;
    }
}

// Brings a node to at most `most` from its parent, which stays: what the sweeps leave of stretch (Mueller, Kim,
// Chentanez. Fast simulation of inextensible hair and fur. 2012, section 3.1, where it is a strand's only constraint).
static inline void limit_length(real* x, real* y, real* z, real parent_x, real parent_y, real parent_z, real most)
{
    const real dx = *x - parent_x, dy = *y - parent_y, dz = *z - parent_z;
    const real back = fmax(excess(dx, dy, dz, most), (real)(0.0f));
    *x -= back * dx;
    *y -= back * dy;
    *z -= back * dz;
}

#endif

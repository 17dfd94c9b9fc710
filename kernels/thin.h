// A far block steps with every other node (sim/far.h): what its strands are between those. `thinned` says of each block
// whether it does now and whether it did in the step before.
#ifndef COIF_THIN_H
#define COIF_THIN_H

#define THIN_NOW 1
#define THIN_BEFORE 2

#ifndef __cplusplus
#include "drawn_lanes.h"
#define THIN_NODES (NODES / 2 + 1)

// Values of all nodes from those of a thin chain, by cubics: Catmull and Rom's through two of them and their neighbours
// and, at the tip, the parabola through the last three.
static inline void lay_between(global const float* thin, Points* x)
{
    Points before = load_lanes(thin), here = load_lanes(thin + 3 * LANES), next = here;
    x[0] = times((real)(0.5f), plus(before, here));
    x[1] = here;
    Points beyond = load_lanes(thin + 6 * LANES);
    for (int k = 2; k < THIN_NODES; ++k)
    {
        next = beyond;
        beyond = k + 1 < THIN_NODES ? load_lanes(thin + (k + 1) * 3 * LANES)
                                    : plus(before, times((real)(3.0f), minus(next, here)));
        x[2 * k - 2] = minus(times((real)(0.5625f), plus(here, next)), times((real)(0.0625f), plus(before, beyond)));
        x[2 * k - 1] = next;
        before = here;
        here = next;
    }
}
#endif
#endif

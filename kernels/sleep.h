// When a block of strands sleeps (simulate_direct.cl). At rest is a strand that for SLEEP_AFTER has gone no faster than
// so many of its lengths a second; one that swings to and fro must not seem to be where it turns. It wakes when the
// other hair has come to push it by more than WOKEN_BY, as a mean along it: a two-hundredth of gravity, which would
// move the tip of a strand that hangs by as much of its length.
#ifndef COIF_SLEEP_H
#define COIF_SLEEP_H

#define SLEEP_AFTER 0.5f   // s
#define SLEEP_SPEED 0.005f // lengths a second
#define WOKEN_BY 0.05f     // m/s^2

#ifndef __cplusplus
#include "shared.h"
static inline int sleeps(global const float* still, int block)
{
    float shortest = still[block * LANES];
    for (int lane = 1; lane < LANES; ++lane)
        shortest = fmin(shortest, still[block * LANES + lane]);
    return shortest >= SLEEP_AFTER;
}
#endif

#endif

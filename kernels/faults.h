// What every solver tells of strands that it had to reset.
#ifndef COIF_FAULTS_H
#define COIF_FAULTS_H
#include "lanes.h"

// Counts the resets of the WIDTH strands from `strand` on that are `bad`, and says why: what came in bad before the
// step is told apart from what its forces made of it.
static inline void note_faults(global int* resets, global int* faults, int strand, int guides, whole bad_position,
                               whole bad_motion, whole bad)
{
    int position_lanes[WIDTH], motion_lanes[WIDTH], bad_lanes[WIDTH];
    LANES_STORE(bad_position, position_lanes);
    LANES_STORE(bad_motion, motion_lanes);
    LANES_STORE(bad, bad_lanes);
    for (int lane = 0; lane < WIDTH; ++lane)
        if (bad_lanes[lane] && strand + lane < guides)
        {
            atomic_inc(&resets[strand + lane]);
            faults[strand + lane] = position_lanes[lane] ? FAULT_POSITION
                                    : motion_lanes[lane] ? FAULT_VELOCITY
                                                         : FAULT_FORCES;
        }
}

#endif

// The part of the grid that light may be stopped in, a box as in grid_room.cl: of the hair, and of the head with
// BODY_GRID; all of it where other bodies stand in it. Behind it, in light_room[6] and on, the part that has to be
// written anew: that, and what it was for the last picture. One work-item.
#include "shared.h"

kernel void light_room(constant int* room, constant int* head_touched, global int* light_room, constant StepInfo* info)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        int low = room[axis], high = room[axis + 3];
#ifdef BODY_GRID
        low = min(low, head_touched[axis]);
        high = max(high, min(RESOLUTION, 1 - head_touched[axis + 3]));
#endif
        low = info->colliders > 0 ? 0 : low;
        high = info->colliders > 0 ? RESOLUTION : high;
        light_room[axis + 6] = min(low, light_room[axis]);
        light_room[axis + 9] = max(high, light_room[axis + 3]);
        light_room[axis] = low;
        light_room[axis + 3] = high;
    }
}

// The part of the grid that the other passes see to in this step, the box from (room[0], room[1], room[2]) up to before
// (room[3], room[4], room[5]): all voxels that hair has touched in this step and in the last one, whose density is to
// go, and as many more to each side as blurring and the gradient carry it. Everything else is zero and stays so.
// One work-item.
#include "shared.h"

kernel void grid_room(global int* touched, global int* touched_before, global int* room, constant StepInfo* info)
{
    const float4 light = info->light_box, push = info->push_box;
    // A box blurs over x whole voxels to each side and a part of the next.
    const int reach = 1 + (light.w > 0.0f ? (int)light.x + 1 : 0) + (push.w > 0.0f ? (int)push.x + 1 : 0);
    for (int axis = 0; axis < 3; ++axis)
    {
        const int least = min(touched[axis], touched_before[axis]);
        const int least_negative = min(touched[3 + axis], touched_before[3 + axis]);
        room[axis] = max(0, least - reach);
        room[3 + axis] = min(RESOLUTION, 1 - least_negative + reach);
    }
    for (int i = 0; i < 6; ++i)
    {
        touched_before[i] = touched[i];
        touched[i] = RESOLUTION;
    }
}

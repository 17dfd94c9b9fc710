// The density of the guides as they lie, where the last step had no use for it. Work-item: WIDTH strands.
#include "grid.h"

kernel void deposit_density(global const float* position, global int* density, global int* touched,
                            constant StepInfo* info)
{
    add_strands_density(density, touched, position, get_global_id(0) * WIDTH, info);
}

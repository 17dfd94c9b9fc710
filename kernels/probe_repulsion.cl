// What the repulsion alone does to each node, m/s^2: for `coif measure`, which asks whether it hangs on where the grid
// lies, and whether all of it adds up to nothing. No frame runs it. Work-item: WIDTH strands.
#include "forces.h"

kernel void probe_repulsion(global const float* position, global const float* gradient, global float* acceleration,
                            constant StepInfo* info)
{
    const int strand = get_global_id(0) * WIDTH;
    const int first = strand_value(strand, 0, 0, NODES);
    for (int i = 0; i < NODES; ++i)
    {
        const int at = first + i * 3 * LANES;
        real x = (real)(0.0f), y = (real)(0.0f), z = (real)(0.0f);
        add_repulsion(&x, &y, &z, LANES_LOAD(position + at), LANES_LOAD(position + at + LANES),
                      LANES_LOAD(position + at + 2 * LANES), gradient, info);
        LANES_STORE(x, acceleration + at);
        LANES_STORE(y, acceleration + at + LANES);
        LANES_STORE(z, acceleration + at + 2 * LANES);
    }
}

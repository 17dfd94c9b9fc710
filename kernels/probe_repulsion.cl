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
        store_lanes(repulsion_at(gradient, load_lanes(position + at), info), acceleration + at);
    }
}

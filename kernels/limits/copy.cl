// What memory gives: reads and writes as many bytes as there are, once each. Work-item: WIDTH floats.
#include "../lanes.h"

kernel void copy(global const float* from, global float* to)
{
    const size_t at = get_global_id(0) * WIDTH;
    LANES_STORE(LANES_LOAD(from + at), to + at);
}

// What arithmetic gives: chains of multiplications and additions, as many side by side as hide how long each takes.
// Work-item: WIDTH lanes, each of which does 2 * CHAINS * LINKS operations.
#include "../lanes.h"

kernel void multiply_add(global float* sums)
{
    const size_t at = get_global_id(0) * WIDTH;
    const real start = LANES_LOAD(sums + at);
    real chain[CHAINS];
    for (int c = 0; c < CHAINS; ++c)
        chain[c] = start + (float)c;
    for (int link = 0; link < LINKS; ++link)
        for (int c = 0; c < CHAINS; ++c)
            chain[c] = chain[c] * 0.999f + 0.001f;
    real sum = (real)(0.0f);
    for (int c = 0; c < CHAINS; ++c)
        sum += chain[c];
    LANES_STORE(sum, sums + at);
}

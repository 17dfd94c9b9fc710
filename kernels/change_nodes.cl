// Blocks that have just become far go on with every other node, those that have come near with all: sim/far.h. A node
// and a segment of a thin chain have twice the mass and the length, so its tension over both is a quarter.
// Work-item: WIDTH strands. NODES is that of the full chain.
#include "thin.h"

kernel void change_nodes(global const float* position, global float* velocity, global float* multiplier,
                         global float* thin_position, global float* thin_velocity, global float* thin_multiplier,
                         global float* tension, global float* still, global const int* thinned,
                         global const float* segment_length, constant HairParams* params, constant StepInfo* info)
{
    const int strand = get_global_id(0) * WIDTH; // of the first lane
    if (strand >= (info->guides + LANES - 1) / LANES * LANES)
        return;
    const int change = thinned[strand / LANES];
    if (change != THIN_NOW && change != THIN_BEFORE)
        return;
    const int block = strand / LANES;
    const int first = strand_value(strand, 0, 0, NODES), thin = strand_value(strand, 0, 0, THIN_NODES);
    global float* pull = multiplier + block * NODES * LANES + strand % LANES;
    global float* thin_pull = thin_multiplier + block * THIN_NODES * LANES + strand % LANES;
    LANES_STORE((real)(0.0f), still + strand); // awake, for it will not rest where it did
    LANES_STORE((change == THIN_NOW ? 0.25f : 4.0f) * LANES_LOAD(tension + strand), tension + strand);

    if (change == THIN_NOW)
    {
        const real rest = fmax(2.0f * LANES_LOAD(segment_length + strand) * params->strand_spacing, (real)(1e-9f));
        // Segments go the way that two did together.
        Points at = load_lanes(position + first + 3 * LANES), was = at;
        Points v = load_lanes(velocity + first + 3 * LANES);
        store_lanes(plus(at, times((real)(2.0f), minus(load_lanes(position + first), at))), thin_position + thin);
        store_lanes(plus(v, times((real)(2.0f), minus(load_lanes(velocity + first), v))), thin_velocity + thin);
        for (int k = 1; k < THIN_NODES; ++k)
        {
            const int node = (2 * k - 1) * 3 * LANES;
            const Points now = load_lanes(position + first + node), d = minus(now, was);
            const real scale = rest * INVERSE_SQRT(fmax(dot_lanes(d, d), 1e-12f * rest * rest));
            at = plus(at, times(scale, d));
            was = now;
            store_lanes(at, thin_position + thin + k * 3 * LANES);
            store_lanes(load_lanes(velocity + first + node), thin_velocity + thin + k * 3 * LANES);
            const real both = LANES_LOAD(pull + (2 * k - 2) * LANES) + LANES_LOAD(pull + (2 * k - 1) * LANES);
            LANES_STORE(0.125f * both, thin_pull + k * LANES);
        }
        LANES_STORE((real)(0.0f), thin_pull);
        return;
    }
    // Where it is it has been laid already (fill_in.cl).
    Points v[NODES];
    lay_between(thin_velocity + thin, v);
    for (int i = 0; i < NODES; ++i)
        store_lanes(v[i], velocity + first + i * 3 * LANES);
    for (int k = 2; k < THIN_NODES; ++k)
    {
        // Linear from middle to middle of the thin segments.
        const int last = THIN_NODES - 1;
        const real here = LANES_LOAD(thin_pull + k * LANES);
        const real before = LANES_LOAD(thin_pull + max(k - 1, 2) * LANES);
        const real after = LANES_LOAD(thin_pull + min(k + 1, last) * LANES);
        const real slope = (after - before) / (float)max(min(k + 1, last) - max(k - 1, 2), 1);
        LANES_STORE(4.0f * here - slope, pull + (2 * k - 2) * LANES);
        LANES_STORE(4.0f * here + slope, pull + (2 * k - 1) * LANES);
    }
}

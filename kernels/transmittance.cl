// Sweeps the density grid away from the light and leaves the optical depth at each voxel's centre (light_grid.h; rays,
// slices and slants are explained there).
//   tau += k ds, k = extinction per unit of density, trapezoidal between slices: Bertails et al. 2005, section 4.2
//
// CHUNK rays side by side make a work-item: in a slice they all lie equally far between the voxels, so they are blended
// with the same weights.
#include "chunk.h"

// The density of CHUNK neighbours along u, from column `u` on, around the ring; beyond the last row or column there is
// no hair. `forward` reads the next column instead, without going around.
static inline chunk_real row_of(global const int* occupied, int slice, int u, int v, int su, int sv, int forward)
{
    if (v >= RESOLUTION)
        return (chunk_real)(0.0f);
    const int row = slice + v * sv, at = row + u + forward;
    if (su == 1 && u + CHUNK < RESOLUTION)
        return CHUNK_TO_REAL(CHUNK_LOAD(occupied + at));
    const int all = RESOLUTION * RESOLUTION * RESOLUTION;
    if (su == 1 && at >= RESOLUTION && at + CHUNK <= all)
    {
        // Before the ring's seam and behind it; what else is read belongs to other rows.
        const chunk column = u + CHUNK_LANES;
        const chunk values = select(CHUNK_LOAD(occupied + at - RESOLUTION), CHUNK_LOAD(occupied + at),
                                    column < RESOLUTION);
        return CHUNK_TO_REAL(select(values, (chunk)(0), column + forward == RESOLUTION & column < RESOLUTION));
    }
    int values[CHUNK];
    for (int lane = 0; lane < CHUNK; ++lane)
    {
        const int column = (u + lane < RESOLUTION ? u + lane : u + lane - RESOLUTION) + forward;
        values[lane] = column < RESOLUTION ? occupied[row + column * su] : 0;
    }
    return CHUNK_TO_REAL(CHUNK_LOAD(values));
}

// Columns from `u` on, around the ring.
static inline chunk columns_from(int u)
{
    const chunk column = u + CHUNK_LANES;
    return select(column - RESOLUTION, column, column < RESOLUTION);
}

// Is there nothing in CHUNK + 1 columns from `u` on, around the ring, of rows `v` and v + 1?
static inline int is_empty(int u, int v, int low_u, int high_u, int low_v, int high_v)
{
    const int before_seam = u >= high_u || u + CHUNK < low_u, behind_seam = u + CHUNK - RESOLUTION < low_u;
    return v + 1 < low_v || v >= high_v || (before_seam && behind_seam);
}

kernel void transmittance(global const int* occupied, global float* depth, constant int* light_room,
                          constant StepInfo* info)
{
    const int ray = get_global_id(0) * CHUNK;
    const int i = ray % RESOLUTION, j = ray / RESOLUTION;
    const int axis = info->sweep_axis;
    // Strides of the slice's two axes and of the sweep's own: u is x unless the sweep runs along x.
    const int su = axis == 0 ? RESOLUTION : 1;
    const int sv = axis == 2 ? RESOLUTION : RESOLUTION * RESOLUTION;
    const int ss = axis == 0 ? 1 : axis == 1 ? RESOLUTION : RESOLUTION * RESOLUTION;

    // What of the slices, and of their columns and rows, may hold something.
    const int low_u = light_room[axis == 0 ? 1 : 0], high_u = light_room[axis == 0 ? 4 : 3];
    const int low_v = light_room[axis == 2 ? 1 : 2], high_v = light_room[axis == 2 ? 4 : 5];

    chunk_real tau = (chunk_real)(0.0f), before = (chunk_real)(0.0f);
    int last_u = i, last_v = j;
    for (int passed = 0; passed < RESOLUTION; ++passed)
    {
        const int along = info->sweep_from + info->sweep_sign * passed, slice = along * ss;
        const float shift_u = info->sweep.x * (float)passed, shift_v = info->sweep.y * (float)passed;
        const int whole_u = convert_int_rtn(shift_u), whole_v = convert_int_rtn(shift_v);
        const float fu = shift_u - (float)whole_u, fv = shift_v - (float)whole_v;
        // On the ring: shifts are never longer than the grid.
        const int u = (i + whole_u + RESOLUTION) % RESOLUTION, v = (j + whole_v + RESOLUTION) % RESOLUTION;

        // A ray that has just come around starts afresh from outside.
        if (abs(v - last_v) > 1)
            tau = before = (chunk_real)(0.0f);
        if (u != last_u)
        {
            const chunk carried = abs_diff(columns_from(u), columns_from(last_u)) <= (chunk_bits)(1);
            tau = select((chunk_real)(0.0f), tau, carried);
            before = select((chunk_real)(0.0f), before, carried);
        }
        last_u = u;
        last_v = v;

        chunk_real here = (chunk_real)(0.0f);
        if (along >= light_room[axis] && along < light_room[axis + 3] &&
            !is_empty(u, v, low_u, high_u, low_v, high_v))
            here = (1.0f - fv) * ((1.0f - fu) * row_of(occupied, slice, u, v, su, sv, 0) +
                                  fu * row_of(occupied, slice, u, v, su, sv, 1)) +
                   fv * ((1.0f - fu) * row_of(occupied, slice, u, v + 1, su, sv, 0) +
                         fu * row_of(occupied, slice, u, v + 1, su, sv, 1));
        tau += 0.5f * (before + here) * (info->sweep.z * info->sweep.w);
        before = here;
        CHUNK_STORE_REAL(tau, depth + (passed * RESOLUTION + j) * RESOLUTION + i);
    }
}

// The optical depth along each ray of a bundle, slice after slice away from its light, trapezoidal between slices
// (Bertails et al. 2005, section 4.2). A ray's slice holds what lies between its voxel's middle and the light:
// depth[ray of the bundle][slice][v][u], and u and v belong to the ray, which wraps around the volume's sides as
// light_grid.h says. With FRONT it is told instead how far a point lies behind the place where the ray has come through
// SEEN, m; 0 in front of it. Work-item: WIDTH rays along u; second: v; third: the bundle.
#include "lanes.h"
#include "look.h"

static inline int on_ring(int at, int size)
{
    const int rest = at % size;
    return rest < 0 ? rest + size : rest;
}

#ifdef FRONT
#define FOUND behind
#else
#define FOUND tau
#endif

kernel void look_sweep(global const float* extinction, global float* depth, constant LookVolume* volume,
                       constant LookRay* rays)
{
    const LookRay ray = rays[get_global_id(2)];
    const Slices s = slices_of(volume, ray.axis);
    const int first = (int)get_global_id(0) * WIDTH, j = (int)get_global_id(1);
    if (first >= s.u || j >= s.v)
        return;
    const size_t all = (size_t)volume_voxels(volume);
    global const float* taken = extinction + get_global_id(2) * all;
    global float* found = depth + get_global_id(2) * all;

    real tau = (real)(0.0f), before = (real)(0.0f);
#ifdef FRONT
    real behind = (real)(0.0f);
#endif
    int lanes[WIDTH], last_v = j;
    for (int lane = 0; lane < WIDTH; ++lane)
        lanes[lane] = lane;
    const whole lane = LANES_LOAD(lanes);
    whole last_u = first + lane;
    for (int passed = 0; passed < s.count; ++passed)
    {
        const int slice = (ray.from + ray.sign * passed) * s.stride;
        const float shift_u = ray.slant.x * (float)passed, shift_v = ray.slant.y * (float)passed;
        const int whole_u = convert_int_rtn(shift_u), whole_v = convert_int_rtn(shift_v);
        const float fu = shift_u - (float)whole_u, fv = shift_v - (float)whole_v;
        const int u = on_ring(first + whole_u, s.u), v = on_ring(j + whole_v, s.v);
        // Beyond the last row there is nothing.
        const int row = slice + v * s.stride_v + u, next_row = v + 1 < s.v ? row + s.stride_v : row;
        const float is_next = v + 1 < s.v ? 1.0f : 0.0f;
        whole columns = u + lane;
        real corners[4];
        if (u + WIDTH < s.u)
        {
            corners[0] = LANES_LOAD(taken + row);
            corners[1] = LANES_LOAD(taken + row + 1);
            corners[2] = is_next * LANES_LOAD(taken + next_row);
            corners[3] = is_next * LANES_LOAD(taken + next_row + 1);
        }
        else if (s.u >= WIDTH && row >= s.u && next_row + WIDTH < (int)all)
        {
            // Some lanes have come around: they are a row's length before the others. What lies beyond the last voxel
            // of a row is nothing, too.
            const whole around = columns >= s.u, at_end = columns == s.u - 1;
            columns = select(columns, columns - s.u, around);
            corners[0] = select(LANES_LOAD(taken + row), LANES_LOAD(taken + row - s.u), around);
            corners[1] = select(LANES_LOAD(taken + row + 1), LANES_LOAD(taken + row + 1 - s.u), around);
            corners[2] = is_next * select(LANES_LOAD(taken + next_row), LANES_LOAD(taken + next_row - s.u), around);
            corners[3] =
                is_next * select(LANES_LOAD(taken + next_row + 1), LANES_LOAD(taken + next_row + 1 - s.u), around);
            corners[1] = select(corners[1], (real)(0.0f), at_end);
            corners[3] = select(corners[3], (real)(0.0f), at_end);
        }
        else
        {
            float values[4][WIDTH];
            int column = u;
            for (int i = 0; i < WIDTH; ++i)
            {
                lanes[i] = column;
                for (int corner = 0; corner < 4; ++corner)
                {
                    const int at_u = column + (corner & 1), at_v = v + (corner >> 1);
                    values[corner][i] = at_u < s.u && at_v < s.v ? taken[slice + at_v * s.stride_v + at_u] : 0.0f;
                }
                column = column + 1 < s.u ? column + 1 : 0;
            }
            columns = LANES_LOAD(lanes);
            for (int corner = 0; corner < 4; ++corner)
                corners[corner] = LANES_LOAD(values[corner]);
        }
        // A ray that has just come around starts afresh from outside.
        const whole fresh = (columns - last_u > 1) | (last_u - columns > 1) | (whole)(abs(v - last_v) > 1 ? -1 : 0);
        tau = select(tau, (real)(0.0f), fresh);
        before = select(before, (real)(0.0f), fresh);
        last_u = columns;
        last_v = v;
        const real here = (1.0f - fv) * ((1.0f - fu) * corners[0] + fu * corners[1]) +
                          fv * ((1.0f - fu) * corners[2] + fu * corners[3]);
        const real added = (0.5f * ray.slant.z) * (before + here);
        tau += added;
        before = here;
#ifdef FRONT
        const real since = fmin(tau - SEEN, added) / fmax(added, (real)(1e-12f)); // of this step
        behind = select((real)(0.0f), select(since * ray.slant.z, behind + ray.slant.z, behind > 0.0f), tau > SEEN);
#endif
        global float* to = found + (passed * s.v + j) * s.u + first;
        if (first + WIDTH <= s.u)
            LANES_STORE(FOUND, to);
        else
        {
            float rest[WIDTH];
            LANES_STORE(FOUND, rest);
            for (int lane = 0; first + lane < s.u; ++lane)
                to[lane] = rest[lane];
        }
    }
}

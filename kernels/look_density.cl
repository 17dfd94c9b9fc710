// Fibre in the volume: length times width over the square of a voxel's side, and the same times the way it runs, each
// shared out trilinearly (look.h's LookVolume::unit makes them integers that cannot overflow). Work-item: one of
// `copies` workers, with its share of the strands and sums of its own; with ATOMIC a strand, and one sum for all.
#include "look.h"

// To a voxel and to the next one along x, which lies beside it, rounded: `half_up` has the signs of `value`.
static inline void add_fibre(global int4* sums, int voxel, float4 value, float4 half_up, float further)
{
    const int8 both = convert_int8_rtz((float8)(value * (1.0f - further) + half_up, value * further + half_up));
    global int* sum = (global int*)(sums + voxel);
#ifdef ATOMIC
    const int4 here = both.lo, next = both.hi;
    atomic_add(sum, here.x);
    atomic_add(sum + 1, here.y);
    atomic_add(sum + 2, here.z);
    atomic_add(sum + 3, here.w);
    atomic_add(sum + 4, next.x);
    atomic_add(sum + 5, next.y);
    atomic_add(sum + 6, next.z);
    atomic_add(sum + 7, next.w);
#else
    vstore8(vload8(0, sum) + both, 0, sum);
#endif
}

static inline void add_piece(global int4* sums, float4 a, float4 b, constant LookVolume* volume)
{
    const float inverse = 1.0f / volume->corner.w;
    const float3 from = (a.xyz - volume->corner.xyz) * inverse - 0.5f, way = (b.xyz - a.xyz) * inverse;
    const float size = length(way);
    if (!(size > 1e-9f && size < 1e4f))
        return;
    const int steps = max((int)(size + 0.5f), 1), row = volume->x, plane = volume->x * volume->y;
    const float share = size / (float)steps * volume->unit * inverse;
    const float4 along = (float4)(way / size, 1.0f), half_up = copysign((float4)(0.5f), along);
    for (int i = 0; i < steps; ++i)
    {
        const float part = ((float)i + 0.5f) / (float)steps;
        const float3 at = from + way * part, below = floor(at), on = at - below;
        if (!(below.x >= 0.0f && below.y >= 0.0f && below.z >= 0.0f && below.x < (float)(volume->x - 1) &&
              below.y < (float)(volume->y - 1) && below.z < (float)(volume->z - 1)))
            continue;
        const int voxel = (int)below.x + row * (int)below.y + plane * (int)below.z;
        const float4 value = along * (share * mix(a.w, b.w, part));
        const float4 low = value * (1.0f - on.z), high = value * on.z;
        add_fibre(sums, voxel, low * (1.0f - on.y), half_up, on.x);
        add_fibre(sums, voxel + row, low * on.y, half_up, on.x);
        add_fibre(sums, voxel + plane, high * (1.0f - on.y), half_up, on.x);
        add_fibre(sums, voxel + plane + row, high * on.y, half_up, on.x);
    }
}

kernel void look_density(global const float4* places, global int4* fibre_sums, constant LookVolume* volume)
{
    const int worker = (int)get_global_id(0);
#ifdef ATOMIC
    const int first = worker, end = min(worker + 1, volume->strands);
    global int4* sums = fibre_sums;
#else
    const int first = (int)((long)volume->strands * worker / volume->copies);
    const int end = (int)((long)volume->strands * (worker + 1) / volume->copies);
    global int4* sums = fibre_sums + (size_t)worker * (size_t)volume_voxels(volume);
    for (int i = 0; i < volume_voxels(volume); ++i)
        sums[i] = (int4)(0);
#endif
    for (int strand = first; strand < end; ++strand)
        for (int i = 0; i + 1 < volume->places; ++i)
        {
            const int at = strand * volume->places + i;
            add_piece(sums, places[at], places[at + 1], volume);
        }
}

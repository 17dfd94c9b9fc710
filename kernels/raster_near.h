// What points of a curve send to the eye from each of NEAR_CELLS cells across the strand, of the light that comes
// straight from the suns: look_shade.cl has left it out of the colours where strands are wide. The strand may turn from
// point to point, but lobes are wider than it does, so that pixels find what lies between two points linearly.
#ifndef COIF_RASTER_NEAR_H
#define COIF_RASTER_NEAR_H
#include "look_fibre.h"
#include "near_field.h"

// The share of a sun's light, between places.
static inline real straight_at(global const ushort* straight, whole first, real share)
{
    int i[WIDTH];
    float low[WIDTH], high[WIDTH];
    LANES_STORE(first, i);
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        low[lane] = from_half(straight[i[lane]]);
        high[lane] = from_half(straight[i[lane] + 1]);
    }
    return mix(LANES_LOAD(low), LANES_LOAD(high), share);
}

// A point of each lane: its tangent, and the way to the eye, of unit length; where it is between `straight`'s places,
// which those of the next sun are `stride` from. `count` points are stored.
static inline void store_near(Reals tangent, Reals eye, Rgb absorb, global const ushort* straight, int stride,
                              whole first, real share, constant LookFrame* look_frame, constant LookRay* rays,
                              int count, global ushort* to)
{
    const Fibre fibre = fibre_of(look_frame);
    const real along_eye = tangent.x * eye.x + tangent.y * eye.y + tangent.z * eye.z;
    // Across the strand, as the eye sees it.
    const real sx = eye.y * tangent.z - eye.z * tangent.y, sy = eye.z * tangent.x - eye.x * tangent.z,
               sz = eye.x * tangent.y - eye.y * tangent.x;
    const float slice = 2.0f / (float)NEAR_CELLS;
    NearPlace places[NEAR_CELLS / 2]; // from the middle to one side, which serve for both
    float edges[NEAR_CELLS + 1];
    Rgb sums[NEAR_CELLS];
    const FibreAngles seen = fibre_angles((real)(0.0f), along_eye, (real)(1.0f));
    for (int i = 0; i < NEAR_CELLS / 2; ++i)
        places[i] = near_place(fibre, seen, absorb, ((float)i + 0.5f) * slice, slice);
    for (int cell = 0; cell <= NEAR_CELLS; ++cell)
        edges[cell] = reflected_at(1.0f - (float)cell * slice);
    for (int cell = 0; cell < NEAR_CELLS; ++cell)
        sums[cell] = rgb((real)(0.0f), (real)(0.0f), (real)(0.0f));
    for (int k = 0; k < look_frame->suns; ++k)
    {
        const float4 l = rays[k].direction, e = rays[k].irradiance * look_frame->near;
        FibreAngles a = fibre_angles(tangent.x * l.x + tangent.y * l.y + tangent.z * l.z, along_eye,
                                     eye.x * l.x + eye.y * l.y + eye.z * l.z);
        a.phi = select(a.phi, -a.phi, sx * l.x + sy * l.y + sz * l.z < 0.0f);
        const real lit = straight_at(straight + k * stride, first, share);
        const NearLight light = near_light(fibre, a, l.w), mirrored = mirrored_light(light);
        real beyond = reflected_beyond(light, edges[0]);
        for (int cell = 0; cell < NEAR_CELLS; ++cell)
        {
            const real after = reflected_beyond(light, edges[cell + 1]), r = (float)NEAR_CELLS * (beyond - after);
            beyond = after;
            const Rgb f = cell < NEAR_CELLS / 2 ? near_field(places[NEAR_CELLS / 2 - 1 - cell], light, r)
                                                : near_field(places[cell - NEAR_CELLS / 2], mirrored, r);
            sums[cell].r += e.x * lit * f.r;
            sums[cell].g += e.y * lit * f.g;
            sums[cell].b += e.z * lit * f.b;
        }
    }
    for (int cell = 0; cell < NEAR_CELLS; ++cell)
    {
        uint r[WIDTH], g[WIDTH], b[WIDTH];
        LANES_STORE(half_bits(sums[cell].r), r);
        LANES_STORE(half_bits(sums[cell].g), g);
        LANES_STORE(half_bits(sums[cell].b), b);
        for (int lane = 0; lane < count; ++lane)
        {
            global ushort* point = to + lane * NEAR_LIGHT + cell;
            point[0] = (ushort)r[lane];
            point[NEAR_CELLS] = (ushort)g[lane];
            point[2 * NEAR_CELLS] = (ushort)b[lane];
        }
    }
}

#endif

// Places along one drawn strand, and the curve through its nodes with all that is laid on it. Whoever reads this says
// how many places there is ROOM for, and lists them by segment and t in [0, 1].
#ifndef COIF_STRAND_PLACES_H
#define COIF_STRAND_PLACES_H
#include "raster_strand.h"

typedef struct Places
{
    float x[ROOM], y[ROOM], z[ROOM], t[ROOM], open[ROOM];
    int segment[ROOM];
    int count;
} Places;

static inline real pick(const float* values, const int* at, int on)
{
    float picked[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
        picked[lane] = values[at[lane] + on];
    return LANES_LOAD(picked);
}

static inline void place_curve(const StrandNodes* n, const RibbonLook* look, Places* at, int i,
                               constant HairParams* params, global const float* wave_table)
{
    const int* segment = at->segment + i;
    const real given = LANES_LOAD(at->t + i), t = select((real)(0.0f), given, given == given);
    const real x0 = pick(n->x, segment, -1), x1 = pick(n->x, segment, 0), x2 = pick(n->x, segment, 1),
               x3 = pick(n->x, segment, 2);
    const real y0 = pick(n->y, segment, -1), y1 = pick(n->y, segment, 0), y2 = pick(n->y, segment, 1),
               y3 = pick(n->y, segment, 2);
    const real z0 = pick(n->z, segment, -1), z1 = pick(n->z, segment, 0), z2 = pick(n->z, segment, 1),
               z3 = pick(n->z, segment, 2);
    const Reals w = curve_weights(params->smoothing_curve, t);
    real x = w.x * x0 + w.y * x1 + w.z * x2 + w.w * x3;
    real y = w.x * y0 + w.y * y1 + w.z * y2 + w.w * y3;
    real z = w.x * z0 + w.y * z1 + w.z * z2 + w.w * z3;
    real open = (real)(1.0f);
    const bool waved = has_waves(look->laid);
    if (waved || look->braid.pitch > 0.0f)
    {
        real tx = mix(x2 - x0, x3 - x1, t), ty = mix(y2 - y0, y3 - y1, t), tz = mix(z2 - z0, z3 - z1, t);
        real shorten = INVERSE_SQRT(fmax(tx * tx + ty * ty + tz * tz, (real)(1e-20f)));
        tx *= shorten;
        ty *= shorten;
        tz *= shorten;
        real nx = mix(pick(n->normal_x, segment, 0), pick(n->normal_x, segment, 1), t);
        real ny = mix(pick(n->normal_y, segment, 0), pick(n->normal_y, segment, 1), t);
        real nz = mix(pick(n->normal_z, segment, 0), pick(n->normal_z, segment, 1), t);
        const real part = nx * tx + ny * ty + nz * tz;
        nx -= tx * part;
        ny -= ty * part;
        nz -= tz * part;
        shorten = INVERSE_SQRT(fmax(nx * nx + ny * ny + nz * nz, (real)(1e-20f)));
        nx *= shorten;
        ny *= shorten;
        nz *= shorten;
        const real bx = ty * nz - tz * ny, by = tz * nx - tx * nz, bz = tx * ny - ty * nx;
        const whole numbers = LANES_LOAD(segment);
        const real along = (TO_REAL(numbers - 1) + t) * (1.0f / (float)(NODES - 2));
        if (waved)
        {
            const real distance = mix(pick(n->distance, segment, 0), pick(n->distance, segment, 1), t);
            const Reals by_waves = laid_across(params, wave_table, look->laid, along, distance);
            const real share = profile_at(params->wave_along, along);
            x += share * (nx * by_waves.x + bx * by_waves.y);
            y += share * (ny * by_waves.x + by * by_waves.y);
            z += share * (nz * by_waves.x + bz * by_waves.y);
        }
        if (look->braid.pitch > 0.0f)
        {
            const Reals plaited = braid_at(look->braid, along);
            x += plaited.x * nx + plaited.y * bx + plaited.z * tx;
            y += plaited.x * ny + plaited.y * by + plaited.z * ty;
            z += plaited.x * nz + plaited.y * bz + plaited.z * tz;
            open = plaited.w;
        }
    }
    LANES_STORE(x, at->x + i);
    LANES_STORE(y, at->y + i);
    LANES_STORE(z, at->z + i);
    LANES_STORE(open, at->open + i);
}

#endif

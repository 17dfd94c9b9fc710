// What the air and the other hair do to a node (thesis 5.1.2 and 5.1.3): accelerations, m/s^2.
#ifndef COIF_FORCES_H
#define COIF_FORCES_H
#include "grid.h"
#include "turbulence.h"

// Wind across the strand, eq. 5.2 (Oshita 2004): |w x t| / |w| w, t the strand's unit tangent.
static inline void add_wind(real* ax, real* ay, real* az, real x, real y, real z, real tx, real ty, real tz,
                            constant StepInfo* info)
{
    const real gx = x * (1.0f / 0.15f) + info->gust_origin.x;
    const real gy = y * (1.0f / 0.15f) + info->gust_origin.y;
    const real gz = z * (1.0f / 0.15f) + info->gust_origin.z;
    const float gust_size = info->wind.w * info->gust_origin.w;
    const real wx = info->wind.x + gust_size * gust(gx, gy, gz, 0);
    const real wy = info->wind.y + gust_size * gust(gx, gy, gz, 1);
    const real wz = info->wind.z + gust_size * gust(gx, gy, gz, 2);
    const real cx = wy * tz - wz * ty, cy = wz * tx - wx * tz, cz = wx * ty - wy * tx;
    const real across = cx * cx + cy * cy + cz * cz;
    const real all = fmax((wx * wx + wy * wy + wz * wz) * (tx * tx + ty * ty + tz * tz), (real)(1e-24f));
    const real share = sqrt(across / all); // sine of the angle between wind and strand
    *ax += share * wx;
    *ay += share * wy;
    *az += share * wz;
}

static inline void add_repulsion(real* ax, real* ay, real* az, real x, real y, real z, global const float* gradient,
                                 constant StepInfo* info)
{
    float px[WIDTH], py[WIDTH], pz[WIDTH], fx[WIDTH], fy[WIDTH], fz[WIDTH];
    LANES_STORE(x, px);
    LANES_STORE(y, py);
    LANES_STORE(z, pz);
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        float3 push = -info->repulsion * fetch_gradient(gradient, px[lane], py[lane], pz[lane], info);
        // A few strands in one voxel of a fine grid must not explode: at most 50 m/s^2.
        push *= fmin(1.0f, 50.0f / fmax(length(push), 1e-6f));
        fx[lane] = push.x;
        fy[lane] = push.y;
        fz[lane] = push.z;
    }
    *ax += LANES_LOAD(fx);
    *ay += LANES_LOAD(fy);
    *az += LANES_LOAD(fz);
}

#endif

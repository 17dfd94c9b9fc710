// What the air and the other hair do to a node (thesis 5.1.2 and 5.1.3): accelerations, m/s^2.
#ifndef COIF_FORCES_H
#define COIF_FORCES_H
#include "drawn_lanes.h"
#include "grid.h"
#include "turbulence.h"

// Wind with its gusts at a point.
static inline Points wind_at(Points p, constant StepInfo* info)
{
    const real gx = p.x * (1.0f / 0.15f) + info->gust_origin.x;
    const real gy = p.y * (1.0f / 0.15f) + info->gust_origin.y;
    const real gz = p.z * (1.0f / 0.15f) + info->gust_origin.z;
    const float gust_size = info->wind.w * info->gust_origin.w;
    return points(info->wind.x + gust_size * gust(gx, gy, gz, 0), info->wind.y + gust_size * gust(gx, gy, gz, 1),
                  info->wind.z + gust_size * gust(gx, gy, gz, 2));
}

// Wind across the strand, eq. 5.2 (Oshita 2004): |w x t| / |w| w, t the strand's unit tangent.
static inline Points across_wind(Points w, Points t)
{
    const real cx = w.y * t.z - w.z * t.y, cy = w.z * t.x - w.x * t.z, cz = w.x * t.y - w.y * t.x;
    const real across = cx * cx + cy * cy + cz * cz;
    const real all = fmax(dot_lanes(w, w) * dot_lanes(t, t), (real)(1e-24f));
    const real share = sqrt(across / all); // sine of the angle between wind and strand
    return points(share * w.x, share * w.y, share * w.z);
}

// What crowded hair does to a node at p.
static inline Points repulsion_at(global const float* gradient, Points p, constant StepInfo* info)
{
    float px[WIDTH], py[WIDTH], pz[WIDTH], fx[WIDTH], fy[WIDTH], fz[WIDTH];
    LANES_STORE(p.x, px);
    LANES_STORE(p.y, py);
    LANES_STORE(p.z, pz);
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        float3 push = -info->repulsion * fetch_gradient(gradient, px[lane], py[lane], pz[lane], info);
        // A few strands in one voxel of a fine grid must not explode: at most 50 m/s^2.
        push *= fmin(1.0f, 50.0f / fmax(length(push), 1e-6f));
        fx[lane] = push.x;
        fy[lane] = push.y;
        fz[lane] = push.z;
    }
    return points(LANES_LOAD(fx), LANES_LOAD(fy), LANES_LOAD(fz));
}

#endif

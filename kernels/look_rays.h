// Reads what look_sweep.cl has left: the optical depth between a point of each lane and a light.
#ifndef COIF_LOOK_RAYS_H
#define COIF_LOOK_RAYS_H
#include "drawn_lanes.h"
#include "look.h"

static inline real ring_lanes(real at, int size) { return at - floor(at / (float)size) * (float)size; }

// How far `at` is on its way from one ray to the next. One that is between the last voxel and the first, on its way
// around, tells of the other side's hair: its neighbour stands in for it.
static inline real beside(real share, real at, int size)
{
    const real first = select(share, (real)(1.0f), at < share);
    return select(first, (real)(0.0f), at + 1.0f - share > (float)(size - 1));
}

// Bilinear between the four rays about (u, v) in each lane's slice.
LAID_IN real depth_in_slice(global const float* depth, LookRay ray, Slices s, real u, real v, whole slice)
{
    const real passed = TO_REAL(slice);
    const real ru = ring_lanes(u - ray.slant.x * passed, s.u), rv = ring_lanes(v - ray.slant.y * passed, s.v);
    const whole u0 = clamp(TO_WHOLE(ru), (whole)(0), (whole)(s.u - 1));
    const whole v0 = clamp(TO_WHOLE(rv), (whole)(0), (whole)(s.v - 1));
    const whole u1 = select((whole)(0), u0 + 1, u0 + 1 < s.u), v1 = select((whole)(0), v0 + 1, v0 + 1 < s.v);
    const whole row0 = (slice * s.v + v0) * s.u, row1 = (slice * s.v + v1) * s.u;
    const real across = beside(ru - TO_REAL(u0), u, s.u), along = beside(rv - TO_REAL(v0), v, s.v);
    const real low = mix(gather(depth, row0 + u0), gather(depth, row0 + u1), across);
    const real high = mix(gather(depth, row1 + u0), gather(depth, row1 + u1), across);
    return mix(low, high, along);
}

// At a point, in voxels from the first one's middle. Outside of the volume nothing is in the way but what lies in it
// further to the light.
LAID_IN real depth_to(global const float* depth, LookRay ray, Points p, constant LookVolume* volume)
{
    // Forward along the ray to where it comes into the volume.
    const real last_x = (real)(volume->x - 1) - 1e-3f, last_y = (real)(volume->y - 1) - 1e-3f,
               last_z = (real)(volume->z - 1) - 1e-3f;
    const float4 l = ray.direction;
    const float ix = 1.0f / (fabs(l.x) > 1e-6f ? l.x : 1e-6f), iy = 1.0f / (fabs(l.y) > 1e-6f ? l.y : 1e-6f),
                iz = 1.0f / (fabs(l.z) > 1e-6f ? l.z : 1e-6f);
    const real ax = -p.x * ix, bx = (last_x - p.x) * ix, ay = -p.y * iy, by = (last_y - p.y) * iy, az = -p.z * iz,
               bz = (last_z - p.z) * iz;
    const real enters = fmax(fmax(fmin(ax, bx), fmin(ay, by)), fmax(fmin(az, bz), (real)(0.0f)));
    const real leaves = fmin(fmin(fmax(ax, bx), fmax(ay, by)), fmax(az, bz));
    // Written so that a NaN counts as outside, where no lane may read.
    const whole meets = (enters <= leaves) & (enters < 1e6f);
    const real go = select((real)(0.0f), enters, meets);
    const real gx = fmin(fmax(select((real)(0.0f), p.x + go * l.x, meets), (real)(0.0f)), last_x);
    const real gy = fmin(fmax(select((real)(0.0f), p.y + go * l.y, meets), (real)(0.0f)), last_y);
    const real gz = fmin(fmax(select((real)(0.0f), p.z + go * l.z, meets), (real)(0.0f)), last_z);

    const Slices s = slices_of(volume, ray.axis);
    const real u = ray.axis == 0 ? gy : gx, v = ray.axis == 2 ? gy : gz;
    const real main = ray.axis == 0 ? gx : ray.axis == 1 ? gy : gz;
    const real passed = (main - (float)ray.from) * (float)ray.sign;
    const whole slice = clamp(TO_WHOLE(passed), (whole)(0), (whole)(s.count - 2));
    const real tau = mix(depth_in_slice(depth, ray, s, u, v, slice), depth_in_slice(depth, ray, s, u, v, slice + 1),
                         passed - TO_REAL(slice));
    return select((real)(0.0f), fmax(tau, (real)(0.0f)), meets);
}

// A point in voxels from the first one's middle, moved by so many voxels along a direction.
static inline Points in_voxels(Points p, float4 direction, real moved, constant LookVolume* volume)
{
    const float4 corner = volume->corner;
    const float inverse = 1.0f / corner.w;
    return points((p.x - corner.x) * inverse + (moved * direction.x - 0.5f),
                  (p.y - corner.y) * inverse + (moved * direction.y - 0.5f),
                  (p.z - corner.z) * inverse + (moved * direction.z - 0.5f));
}

// What comes from two sides that differ in sign, at a point of one lane. Each is told by the mean of the directions
// that it is seen from, as what is lit there weighs them: `middle` and `aside`, `middle` and -`aside`.
typedef struct TwoSides
{
    float4 front, behind;
} TwoSides;

// Of 16 floats for each coarse voxel: the means over all directions of four values, then of those times x, y and z of
// where they come from, times 3 (look_sky.cl).
static inline float16 moments_at(global const float* moments, float x, float y, float z,
                                 constant LookVolume* coarse_volume)
{
    const float4 corner = coarse_volume->corner;
    const float inverse = 1.0f / corner.w;
    const float last_x = (float)(coarse_volume->x - 1) - 1e-3f, last_y = (float)(coarse_volume->y - 1) - 1e-3f,
                last_z = (float)(coarse_volume->z - 1) - 1e-3f;
    const float gx = fmin(fmax((x - corner.x) * inverse - 0.5f, 0.0f), last_x);
    const float gy = fmin(fmax((y - corner.y) * inverse - 0.5f, 0.0f), last_y);
    const float gz = fmin(fmax((z - corner.z) * inverse - 0.5f, 0.0f), last_z);
    const int ix = (int)gx, iy = (int)gy, iz = (int)gz;
    const int row = coarse_volume->x * 16, plane = row * coarse_volume->y;
    global const float* at = moments + iz * plane + iy * row + ix * 16;
    const float fx = gx - (float)ix, fy = gy - (float)iy, fz = gz - (float)iz;
    const float16 low =
        mix(mix(vload16(0, at), vload16(0, at + 16), fx), mix(vload16(0, at + row), vload16(0, at + row + 16), fx), fy);
    at += plane;
    const float16 high =
        mix(mix(vload16(0, at), vload16(0, at + 16), fx), mix(vload16(0, at + row), vload16(0, at + row + 16), fx), fy);
    return mix(low, high, fz);
}

static inline float4 leaning_to(float16 moments, float4 way)
{
    return moments.lo.hi * way.x + moments.hi.lo * way.y + moments.hi.hi * way.z;
}

static inline TwoSides two_sides(global const float* moments, float4 at, float4 middle, float4 aside,
                                 constant LookVolume* coarse_volume)
{
    const float16 found = moments_at(moments, at.x, at.y, at.z, coarse_volume);
    const float4 mean = found.lo.lo + leaning_to(found, middle), lean = leaning_to(found, aside);
    TwoSides sides;
    sides.front = fmax(mean + lean, 0.0f);
    sides.behind = fmax(mean - lean, 0.0f);
    return sides;
}

#endif

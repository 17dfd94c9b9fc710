// What a metre of each voxel takes away from light along a ray, 1/m: fibres shade by the area that they turn to it.
// Those that run one way shade by the sine of their angle to it, those that run any way by pi / 4 of their area, and
// between the two by how much of one way there is (Bertails et al. 2005, section 4.2, has the isotropic one alone).
// Where it lies: look.h's Slices. Work-item: WIDTH voxels along x, and along y too where they are turned; second: the
// ray.
#include "lanes.h"
#include "look.h"

static inline real taken_at(global const float* fibre, int at, int all, float4 l)
{
#if defined(BODIES) // alone
    return LANES_LOAD(fibre + 4 * all + at) * 0.785398163f;
#else
    const real x = LANES_LOAD(fibre + at), y = LANES_LOAD(fibre + all + at), z = LANES_LOAD(fibre + 2 * all + at);
#ifdef FRONT // hair alone: what lies behind a body is not seen
    const real amount = LANES_LOAD(fibre + 3 * all + at) - LANES_LOAD(fibre + 4 * all + at);
#else
    const real amount = LANES_LOAD(fibre + 3 * all + at);
#endif
    const real squared = x * x + y * y + z * z, per_way = INVERSE_SQRT(fmax(squared, (real)(1e-24f)));
    const real way = squared * per_way, along = (x * l.x + y * l.y + z * l.z) * per_way;
    const real across2 = fmax(1.0f - along * along, (real)(0.0f));
    const real across = across2 * INVERSE_SQRT(fmax(across2, (real)(1e-12f)));
    return way * across + fmax(amount - way, (real)(0.0f)) * 0.785398163f;
#endif
}

kernel void look_extinction(global const float* fibre, global float* extinction, constant LookVolume* volume,
                            constant LookRay* rays, constant HairParams* params)
{
    const int all = volume_voxels(volume), at = (int)get_global_id(0) * WIDTH;
    if (at >= all)
        return;
    const LookRay ray = rays[get_global_id(1)];
    const float shadow = params->look_self_shadow;
    global float* to = extinction + get_global_id(1) * (size_t)all;
    if (ray.axis != 0)
    {
        LANES_STORE(shadow * taken_at(fibre, at, all, ray.direction), to + at);
        return;
    }
    const int row = at / volume->x, first = at - row * volume->x, y = row % volume->y;
    if (y % WIDTH != 0)
        return; // with the row that begins its tile
    const int rows = min(WIDTH, volume->y - y);
    float tile[WIDTH][WIDTH]; // of x, along y
    for (int i = 0; i < rows; ++i)
    {
        float values[WIDTH];
        LANES_STORE(shadow * taken_at(fibre, at + i * volume->x, all, ray.direction), values);
        for (int lane = 0; lane < WIDTH; ++lane)
            tile[lane][i] = values[lane];
    }
    const Slices s = slices_of(volume, 0);
    to += first * s.stride + row / volume->y * s.stride_v + y;
    for (int lane = 0; lane < WIDTH; ++lane)
        for (int i = 0; i < rows; ++i)
            to[lane * s.stride + i] = tile[lane][i];
}

// What is left of a uniform sky in each coarse voxel, and where from: the mean over SKY_RAYS directions d of what comes
// along them, and of that times 3 d. Of light that comes straight, exp(-tau), and in each channel of that with what fibres
// hand on, exp(-tau k), where k is what a stack of fibres lit from all sides takes away, to all orders: nothing of white
// light (handed_on() of app/shading.cpp). 16 floats a voxel: means, then x, y and z. The power
// of a mean would be far too bright: tau differs from direction to direction. Work-item: WIDTH coarse voxels along x.
#include "look_rays.h"

kernel void look_sky(global const float* sky_depth, global float* sky, constant LookVolume* coarse_volume,
                     constant LookRay* sky_rays, global const float4* forward, global const float* steps,
                     constant int* sky_steps)
{
    const int first = (int)get_global_id(0) * WIDTH, y = (int)get_global_id(1), z = (int)get_global_id(2);
    float columns[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
        columns[lane] = (float)(first + lane);
    const real x = LANES_LOAD(columns);
    const float4 handed_on = forward[1];
    const size_t all = (size_t)volume_voxels(coarse_volume);
    const int row = coarse_volume->x + 2 * STEPS, plane = row * (coarse_volume->y + 2 * STEPS);
    const int own = (z + STEPS) * plane + (y + STEPS) * row + first + STEPS;
    real sums[16];
    for (int i = 0; i < 16; ++i)
        sums[i] = (real)(0.0f);
    for (int i = 0; i < SKY_RAYS; ++i)
    {
        const LookRay ray = sky_rays[i];
        const Slices s = slices_of(coarse_volume, ray.axis);
        const real u = ray.axis == 0 ? (real)(y) : x, v = ray.axis == 2 ? (real)(y) : (real)(z);
        const real main = ray.axis == 0 ? x : ray.axis == 1 ? (real)(y) : (real)(z);
        const whole slice = clamp(TO_WHOLE((main - (float)ray.from) * (float)ray.sign), (whole)(0),
                                  (whole)(s.count - 1));
        const real tau = depth_in_slice(sky_depth + i * all, ray, s, u, v, slice);
        real open = (real)(1.0f); // past bodies near by, which hand nothing on
        for (int step = 0; step < STEPS; ++step)
            open *= LANES_LOAD(steps + own + sky_steps[i * STEPS + step]);
        const real left[4] = {exp(-tau), open * exp((handed_on.x - 1.0f) * tau),
                              open * exp((handed_on.y - 1.0f) * tau), open * exp((handed_on.z - 1.0f) * tau)};
        for (int c = 0; c < 4; ++c)
        {
            sums[c] += left[c];
            sums[4 + c] += 3.0f * ray.direction.x * left[c];
            sums[8 + c] += 3.0f * ray.direction.y * left[c];
            sums[12 + c] += 3.0f * ray.direction.z * left[c];
        }
    }
    global float* to = sky + (size_t)((z * coarse_volume->y + y) * coarse_volume->x + first) * 16;
    for (int i = 0; i < 16; ++i)
    {
        float mean[WIDTH];
        LANES_STORE(sums[i] * (1.0f / (float)SKY_RAYS), mean);
        for (int lane = 0; lane < WIDTH; ++lane)
            to[lane * 16 + i] = mean[lane];
    }
}

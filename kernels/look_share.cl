// How much of the suns' light on a strand comes straight, and how much by way of other fibres (forwarded() of fibre.h):
// what the levels without dual scattering leave out. Sums over the places of every `stride`-th strand, by luminance
// (Rec. 709). Work-item: such a strand; lanes: places along it.
#include "look_rays.h"

kernel void look_share(global const float4* places, constant LookFrame* look_frame, constant LookVolume* volume,
                       constant LookRay* rays, global const float* depth, global const float4* forward,
                       global float2* straight_and_handed)
{
    const int strand = (int)get_global_id(0) * look_frame->stride, count = volume->places;
    if (strand >= volume->strands)
        return;
    global const float4* own = places + (size_t)strand * (size_t)count;
    const size_t all = (size_t)volume_voxels(volume);
    const float4 on = forward[0];
    float2 sums = (float2)(0.0f);
    for (int i = 0; i < count; i += WIDTH)
    {
        float x[WIDTH], y[WIDTH], z[WIDTH], counts[WIDTH];
        for (int lane = 0; lane < WIDTH; ++lane)
        {
            const float4 p = own[min(i + lane, count - 1)];
            x[lane] = p.x;
            y[lane] = p.y;
            z[lane] = p.z;
            counts[lane] = i + lane < count ? 1.0f : 0.0f;
        }
        const Points p = points(LANES_LOAD(x), LANES_LOAD(y), LANES_LOAD(z));
        for (int k = 0; k < look_frame->suns; ++k)
        {
            const LookRay ray = rays[k];
            const float4 e = ray.irradiance * (float4)(0.2126f, 0.7152f, 0.0722f, 0.0f);
            const real tau = depth_to(depth + k * all, ray, in_voxels(p, ray.direction, OUT_TO_SUN, volume), volume);
            const real straight = exp(-tau);
            const real handed = e.x * (exp((on.x - 1.0f) * tau) - straight) +
                                e.y * (exp((on.y - 1.0f) * tau) - straight) +
                                e.z * (exp((on.z - 1.0f) * tau) - straight);
            float of_straight[WIDTH], of_handed[WIDTH];
            LANES_STORE((e.x + e.y + e.z) * straight, of_straight);
            LANES_STORE(handed, of_handed);
            for (int lane = 0; lane < WIDTH; ++lane)
                sums += counts[lane] * (float2)(of_straight[lane], of_handed[lane]);
        }
    }
    straight_and_handed[get_global_id(0)] = sums;
}

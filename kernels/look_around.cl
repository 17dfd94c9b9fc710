// Light from all around each coarse voxel, as look_shade takes it: means of red, green and blue, and of the share of the
// sky that is left in green, then x, y and z of each (look_sky.cl). LEVEL as in look_shade: below 3, of the sky what
// comes straight. SKIN: and what the skin sends back. Work-item: a coarse voxel.
#include "look.h"

kernel void look_around(global const float* sky,
#ifdef SKIN
                        global const float* bounced,
#endif
                        global float* around, constant LookFrame* look_frame, constant LookVolume* coarse_volume)
{
    const size_t voxel = get_global_id(0);
    if (voxel >= (size_t)volume_voxels(coarse_volume))
        return;
    const float4 bright = look_frame->sky;
    for (int moment = 0; moment < 4; ++moment)
    {
        const size_t at = 16 * voxel + 4 * (size_t)moment;
        const float4 left = vload4(0, sky + at); // straight, red, green, blue
#if LEVEL == 3
        float4 light = (float4)(bright.xyz * left.yzw, left.z);
#else
        float4 light = (float4)(bright.xyz * left.x, left.z);
#endif
#ifdef SKIN
        light.xyz += (float3)(bounced[at], bounced[at + 1], bounced[at + 2]);
#endif
        vstore4(light, 0, around + at);
    }
}

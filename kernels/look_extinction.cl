// What a metre of each voxel takes away from light along a ray, 1/m: fibres shade by the area that they turn to it.
// Those that run one way shade by the sine of their angle to it, those that run any way by pi / 4 of their area, and
// between the two by how much of one way there is (Bertails et al. 2005, section 4.2, has the isotropic one alone).
// Work-item: WIDTH voxels along x; second: the ray.
#include "lanes.h"
#include "look.h"

kernel void look_extinction(global const float* fibre, global float* extinction, constant LookVolume* volume,
                            constant LookRay* rays, constant HairParams* params)
{
    const int all = volume_voxels(volume), at = (int)get_global_id(0) * WIDTH;
    if (at >= all)
        return;
#if defined(BODIES) // alone
    const real taken = LANES_LOAD(fibre + 4 * all + at) * 0.785398163f;
#else
    const real x = LANES_LOAD(fibre + at), y = LANES_LOAD(fibre + all + at), z = LANES_LOAD(fibre + 2 * all + at);
#ifdef FRONT // hair alone: what lies behind a body is not seen
    const real amount = LANES_LOAD(fibre + 3 * all + at) - LANES_LOAD(fibre + 4 * all + at);
#else
    const real amount = LANES_LOAD(fibre + 3 * all + at);
#endif
    const float4 l = rays[get_global_id(1)].direction;
    const real way = sqrt(x * x + y * y + z * z), per_way = 1.0f / fmax(way, (real)(1e-12f));
    const real along = (x * l.x + y * l.y + z * l.z) * per_way;
    const real across = sqrt(fmax(1.0f - along * along, (real)(0.0f)));
    const real taken = way * across + fmax(amount - way, (real)(0.0f)) * 0.785398163f;
#endif
    LANES_STORE(params->look_self_shadow * taken, extinction + get_global_id(1) * (size_t)all + at);
}

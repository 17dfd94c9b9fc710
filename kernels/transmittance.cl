// Sweeps the density grid away from the light and leaves the optical depth at each voxel's centre (light_grid.h; rays,
// slices and slants are explained there). One work-item a ray.
// Colliders stop the light: a slice whose point lies in one adds BODY_DEPTH.
//   tau += k ds, k = extinction per unit of density, trapezoidal between slices: Bertails et al. 2005, section 4.2
#include "shared.h"

#define LIGHT_FUNCTION static inline
#include "light_grid.h"

static inline float density_at(global const int* density, int u, int v, int slice, int su, int sv, int ss)
{
    const bool inside = u >= 0 && v >= 0 && u < RESOLUTION && v < RESOLUTION;
    return inside ? convert_float(density[u * su + v * sv + slice * ss]) : 0.0f;
}

#define BODY_DEPTH 3.0f

// Marks the slices whose point of the ray (i, j) lies inside a sphere that is given in voxels. Spheres count as smaller by
// 0.7 voxels, so that hair lying on the head is not dark before its time.
static inline void mark_body(uint* body, float i, float j, float u, float v, float s, float radius,
                             constant StepInfo* info)
{
    const float resolution = (float)RESOLUTION;
    const float middle = (s - (float)info->sweep_from) * (float)info->sweep_sign; // slices passed at its centre
    const int first = max(0, (int)ceil(fmax(middle - radius, -1.0f)));
    const int last = min(RESOLUTION - 1, (int)floor(fmin(middle + radius, resolution)));
    for (int passed = first; passed <= last; ++passed)
    {
        const float at_u = light_ring(i + info->sweep.x * (float)passed, resolution);
        const float at_v = light_ring(j + info->sweep.y * (float)passed, resolution);
        const float away = (float)passed - middle;
        if ((at_u - u) * (at_u - u) + (at_v - v) * (at_v - v) + away * away < radius * radius)
            body[passed >> 5] |= 1u << (passed & 31);
    }
}

kernel void transmittance(global const int* density, global float* depth, constant float4* colliders,
                          constant StepInfo* info)
{
    const int i = get_global_id(0) % RESOLUTION, j = get_global_id(0) / RESOLUTION;
    const int axis = info->sweep_axis;
    // Strides of the slice's two axes and of the sweep's own: x for u unless the sweep runs along x.
    const int su = axis == 0 ? RESOLUTION : 1;
    const int sv = axis == 2 ? RESOLUTION : RESOLUTION * RESOLUTION;
    const int ss = axis == 0 ? 1 : axis == 1 ? RESOLUTION : RESOLUTION * RESOLUTION;

    uint body[(RESOLUTION + 31) / 32] = {0};
    for (int c = 0; c < info->colliders; ++c)
    {
        const float3 at = (colliders[c].xyz - info->grid_corner.xyz) / info->grid_corner.w - 0.5f;
        mark_body(body, (float)i, (float)j, axis == 0 ? at.y : at.x, axis == 2 ? at.y : at.z,
                  axis == 0 ? at.x : axis == 1 ? at.y : at.z, colliders[c].w / info->grid_corner.w - 0.7f, info);
    }

    float tau = 0.0f, before = 0.0f;
    int turns_u = 0, turns_v = 0;
    for (int passed = 0; passed < RESOLUTION; ++passed)
    {
        const int slice = info->sweep_from + info->sweep_sign * passed;
        const float u = (float)i + info->sweep.x * (float)passed, v = (float)j + info->sweep.y * (float)passed;
        const int now_u = convert_int_rtn(u / (float)RESOLUTION), now_v = convert_int_rtn(v / (float)RESOLUTION);
        if (now_u != turns_u || now_v != turns_v)
            tau = before = 0.0f; // a fresh ray from outside
        turns_u = now_u;
        turns_v = now_v;
        const float ru = u - (float)(now_u * RESOLUTION), rv = v - (float)(now_v * RESOLUTION);
        const int u0 = convert_int_rtn(ru), v0 = convert_int_rtn(rv);
        const float fu = ru - (float)u0, fv = rv - (float)v0;
        const float here = (1.0f - fv) * ((1.0f - fu) * density_at(density, u0, v0, slice, su, sv, ss) +
                                          fu * density_at(density, u0 + 1, v0, slice, su, sv, ss)) +
                           fv * ((1.0f - fu) * density_at(density, u0, v0 + 1, slice, su, sv, ss) +
                                 fu * density_at(density, u0 + 1, v0 + 1, slice, su, sv, ss));
        tau += 0.5f * (before + here) * info->sweep.z * info->sweep.w;
        before = here;
        if (body[passed >> 5] >> (passed & 31) & 1u)
            tau += BODY_DEPTH;
        depth[(passed * RESOLUTION + j) * RESOLUTION + i] = tau;
    }
}

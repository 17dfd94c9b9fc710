// Stands the colliders, opaque, in the copy of the density that light is swept through, with edges one voxel soft, so that
// their shadows have no teeth. Spheres count as smaller by 0.7 voxels, so that hair lying on the head is not dark before
// its time. One work-item a row of voxels along x in the box about one collider: y, z and the collider's number.
#include "shared.h"

kernel void add_bodies(global int* occupied, constant float4* colliders, constant StepInfo* info)
{
    const float4 sphere = colliders[get_global_id(2)];
    const float voxel = info->grid_corner.w;
    const float3 center = (sphere.xyz - info->grid_corner.xyz) / voxel - 0.5f;
    const float radius = sphere.w / voxel - 0.7f;
    const float y = (float)get_global_id(0) - center.y, z = (float)get_global_id(1) - center.z;
    const float reach = radius + 0.5f, squared = reach * reach - y * y - z * z;
    if (!(reach > 0.0f && squared > 0.0f))
        return;
    const float half_row = sqrt(squared);
    const int first = max(0, convert_int_sat_rtp(center.x - half_row));
    const int last = min(RESOLUTION - 1, convert_int_sat_rtn(center.x + half_row));
    const int row = ((int)get_global_id(1) * RESOLUTION + (int)get_global_id(0)) * RESOLUTION;
    for (int i = first; i <= last; ++i)
    {
        const float x = (float)i - center.x;
        const float inside = clamp(reach - sqrt(x * x + y * y + z * z), 0.0f, 1.0f);
        // The greatest wins, in whatever order the colliders come.
        atomic_max(&occupied[row + i], convert_int_rtz(inside * (float)info->body_density));
    }
}

// Stands the colliders, opaque, in the copy of the density that light is swept through. Spheres count as smaller by 0.7
// voxels, so that hair lying on the head is not dark before its time. One work-item a row of voxels along x in the box
// about one collider: y, z and the collider's number.
#include "shared.h"

kernel void add_bodies(global int* occupied, constant float4* colliders, constant StepInfo* info)
{
    const float4 sphere = colliders[get_global_id(2)];
    const float voxel = info->grid_corner.w;
    const float3 center = (sphere.xyz - info->grid_corner.xyz) / voxel - 0.5f;
    const float radius = sphere.w / voxel - 0.7f;
    const float y = (float)get_global_id(0) - center.y, z = (float)get_global_id(1) - center.z;
    const float squared = radius * radius - y * y - z * z;
    if (!(radius > 0.0f && squared > 0.0f))
        return;
    const float half_row = sqrt(squared);
    const int first = max(0, convert_int_sat_rtp(center.x - half_row));
    const int last = min(RESOLUTION - 1, convert_int_sat_rtn(center.x + half_row));
    const int row = ((int)get_global_id(1) * RESOLUTION + (int)get_global_id(0)) * RESOLUTION;
    for (int x = first; x <= last; ++x)
        occupied[row + x] = info->body_density; // the same from every collider, so their order does not matter
}

// Stands the colliders, opaque, in the copy of the density that light is swept through, with edges one voxel soft, so
// that their shadows have no teeth. They count as smaller by 0.7 voxels, so that hair lying on the head is not dark
// before its time. One work-item a row of voxels along x in the box about one collider: y, z and the collider's number.
#include "shared.h"

kernel void add_bodies(global int* occupied, constant Capsule* colliders, constant StepInfo* info)
{
    const Capsule collider = colliders[get_global_id(2)];
    const float voxel = info->grid_corner.w;
    const float3 center = (collider.center.xyz - info->grid_corner.xyz) / voxel - 0.5f;
    const float3 axis = collider.axis.xyz / voxel;
    const float y = (float)get_global_id(0) - center.y, z = (float)get_global_id(1) - center.z;
    // How far the row passes the box about the axis, and so how much of the row may be touched.
    const float beside_y = y - clamp(y, fmin(0.0f, axis.y), fmax(0.0f, axis.y));
    const float beside_z = z - clamp(z, fmin(0.0f, axis.z), fmax(0.0f, axis.z));
    const float reach = collider.center.w / voxel - 0.7f + 0.5f;
    const float squared = reach * reach - beside_y * beside_y - beside_z * beside_z;
    if (!(reach > 0.0f && squared > 0.0f))
        return;
    const float half_row = sqrt(squared);
    const int first = max(0, convert_int_sat_rtp(center.x + fmin(0.0f, axis.x) - half_row));
    const int last = min(RESOLUTION - 1, convert_int_sat_rtn(center.x + fmax(0.0f, axis.x) + half_row));
    const int row = ((int)get_global_id(1) * RESOLUTION + (int)get_global_id(0)) * RESOLUTION;
    const float per_length2 = collider.axis.w * voxel * voxel; // 0 for a sphere
    for (int i = first; i <= last; ++i)
    {
        const float3 from = (float3)((float)i - center.x, y, z);
        const float3 away = from - axis * clamp(dot(from, axis) * per_length2, 0.0f, 1.0f);
        const float inside = clamp(reach - sqrt(dot(away, away)), 0.0f, 1.0f);
        // The greatest wins, in whatever order the colliders come.
        atomic_max(&occupied[row + i], convert_int_rtz(inside * (float)info->body_density));
    }
}

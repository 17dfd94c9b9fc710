// Stands the head's distance grid in the light, by the rule of add_bodies.cl: opaque from 0.7 voxels under its surface
// on, with an edge one voxel soft. Work-item: WIDTH voxels along x.
#include "distance_grid.h"

kernel void add_head(global int* occupied, global const float* body_distance, constant StepInfo* info)
{
    const int first = (int)get_global_id(0) * WIDTH;
    const float4 corner = info->grid_corner, body = info->body_corner;
    const float y = corner.y + ((float)get_global_id(1) + 0.5f) * corner.w;
    const float z = corner.z + ((float)get_global_id(2) + 0.5f) * corner.w;

    // Most voxels are far from the head: those from the first to the last of which all lie on one side of the mesh's
    // box in the head's frame. The grid is wider than the box by its margin (sim/distance_grid.cpp).
    const float from_x = corner.x + ((float)first + 0.5f) * corner.w, to_x = from_x + (float)(WIDTH - 1) * corner.w;
    const float3 across = info->head_row1.xyz * y + info->head_row2.xyz * z;
    const float3 a = info->head_row0.xyz * from_x + across, b = info->head_row0.xyz * to_x + across;
    const float3 side =
        body.w * (float3)((float)(info->body_x - 1), (float)(info->body_y - 1), (float)(info->body_z - 1));
    const float margin = 0.09f * fmax(side.x, fmax(side.y, side.z));
    const float3 beyond = fmax(fmin(a, b) - (body.xyz + side - margin), body.xyz + margin - fmax(a, b));
    if (fmax(beyond.x, fmax(beyond.y, beyond.z)) > 0.0f)
        return;

    float x[WIDTH], inside[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
        x[lane] = corner.x + ((float)(first + lane) + 0.5f) * corner.w;
    const real depth = -body_plane(body_distance, LANES_LOAD(x), (real)(y), (real)(z), info).distance / corner.w;
    LANES_STORE(fmin(fmax(depth - 0.7f + 0.5f, (real)(0.0f)), (real)(1.0f)), inside);
    global int* row = occupied + ((int)get_global_id(2) * RESOLUTION + (int)get_global_id(1)) * RESOLUTION;
    for (int lane = 0; lane < WIDTH; ++lane)
        if (first + lane < RESOLUTION && inside[lane] > 0.0f)
            row[first + lane] = max(row[first + lane], convert_int_rtz(inside[lane] * (float)info->body_density));
}

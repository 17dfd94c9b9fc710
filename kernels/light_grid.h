// How much hair lies between a point and the light: the optical depth, swept once through the density grid away from
// the light (Bertails, Menardais, Cani, Wong. A practical self-shadowing algorithm for interactive hair animation.
// 2005).
//
// The sweep runs along rays, one a voxel of the first slice, so that no ray needs another: along the grid's axis that
// the light leans to most, slice after slice, each slice moved sideways by the light's slant. A ray that leaves at one
// side comes in again, empty, at the other. So depth[slice][j][i] belongs to the ray (i, j), not to the voxel (i, j),
// and a point finds its ray by taking the slant away. Read by GLSL for the head; kernels/interpolate_light.h has it
// for lanes.
#ifndef COIF_LIGHT_GRID_H
#define COIF_LIGHT_GRID_H

// A coordinate on the ring of rays.
LIGHT_FUNCTION float light_ring(float at, float resolution) { return at - floor(at / resolution) * resolution; }

// The ray's coordinate of a point at grid coordinate `at`, in the slice `passed` slices after the first.
LIGHT_FUNCTION float light_ray(float at, float slant, float passed, float resolution)
{
    return light_ring(at - slant * passed, resolution);
}

#endif

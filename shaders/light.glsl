// The share of the light that hair and head let through to a point: the swept grid of kernels/light_grid.h, read from a
// texture whose sides wrap around.
#define LIGHT_FUNCTION
#include "light_grid.h"

uniform sampler3D optical_depth;

float light_at(vec3 point)
{
    if (frame.slices.w == 0)
        return 1.0;
    float resolution = float(frame.slices.w);
    vec3 g = (point - frame.grid_corner.xyz) / frame.grid_corner.w - 0.5;
    if (any(lessThan(g, vec3(0.0))) || any(greaterThanEqual(g, vec3(resolution - 1.0))))
        return 1.0;
    int axis = frame.slices.x;
    float u = axis == 0 ? g.y : g.x;
    float v = axis == 2 ? g.y : g.z;
    float passed = (g[axis] - float(frame.slices.y)) * float(frame.slices.z);
    float slice = clamp(floor(passed), 0.0, resolution - 2.0);
    float tau[2];
    for (int s = 0; s < 2; ++s)
        tau[s] = texture(optical_depth, vec3(light_ray(u, frame.sweep.x, slice + float(s), resolution) + 0.5,
                                             light_ray(v, frame.sweep.y, slice + float(s), resolution) + 0.5,
                                             slice + float(s) + 0.5) / resolution).r;
    return exp(-mix(tau[0], tau[1], passed - slice));
}

// The same for a point that may lie beyond the grid: what the way to the light (of unit length) meets where it comes in.
float light_beyond(vec3 point, vec3 light)
{
    float voxel = frame.grid_corner.w;
    vec3 low = frame.grid_corner.xyz + 0.501 * voxel;
    vec3 high = frame.grid_corner.xyz + (float(frame.slices.w) - 0.501) * voxel;
    vec3 slope = mix(light, vec3(1e-6), lessThan(abs(light), vec3(1e-6)));
    vec3 one = (low - point) / slope, other = (high - point) / slope;
    vec3 begin = min(one, other), end = max(one, other);
    float enters = max(max(begin.x, begin.y), max(begin.z, 0.0)), leaves = min(end.x, min(end.y, end.z));
    return enters < leaves ? light_at(clamp(point + light * enters, low, high)) : 1.0;
}

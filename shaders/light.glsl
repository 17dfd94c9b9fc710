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

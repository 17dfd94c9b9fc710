#version 150
// The ground under the head: Lambert, lit at its corners as shaders/surface.vert lights the head. Most of it lies beyond
// the light's grid.
#include "params"
#include "frame.glsl"
#include "light.glsl"

in vec3 position; // m, in the world as long as the head has not leapt
in vec3 color;     // linear, where it is worked out before

uniform int worked_out;
uniform vec3 moved;  // m: from there to the head's origin
uniform vec3 albedo; // linear
uniform float rim;   // m from its middle, where it has wholly faded into the backdrop

out vec3 lit;
out float seen; // share of it that hides the backdrop

// What the way to the light meets of the grid, from where it comes in.
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

void main()
{
    vec3 p = position + moved, l = params.look_light_direction.xyz;
    seen = 1.0 - smoothstep(0.35, 1.0, length(position.xz) / rim);
    gl_Position = frame.view_projection * vec4(p, 1.0);
    if (worked_out == 1)
    {
        lit = color;
        return;
    }
    // Corners lie about two voxels apart: without the mean, edges of shadows would have teeth.
    float light = 0.0;
    for (int i = 0; i < 4; ++i)
        light += 0.25 * light_beyond(p + frame.grid_corner.w * vec3(i % 2 == 0 ? -1.0 : 1.0, 0.0, i < 2 ? -1.0 : 1.0), l);
    vec3 sky = vec3(0.42, 0.44, 0.48), sun = params.look_light_color.rgb * light;
    lit = albedo * (sky * mix(0.35, 1.0, sqrt(light)) + 0.95 * max(0.0, l.y) * sun);
}

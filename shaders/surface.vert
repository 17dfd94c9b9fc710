#version 150
// The head and other solid things.
#include "frame.glsl"

in vec3 position; // in the thing's own frame, m
in vec3 normal;
in float roots; // 1 on the scalp, 0 away from it

uniform vec4 place; // m; w: scale
uniform int on_head;

out SurfaceData {
    vec3 position; // relative to the head's origin, m
    vec3 normal;
    float roots;
} surface;

vec3 turned(vec3 v)
{
    if (on_head == 0)
        return v;
    return vec3(dot(frame.head_row0.xyz, v), dot(frame.head_row1.xyz, v), dot(frame.head_row2.xyz, v));
}

void main()
{
    surface.position = turned(position * place.w + place.xyz);
    surface.normal = turned(normal);
    surface.roots = roots;
    gl_Position = frame.view_projection * vec4(surface.position, 1.0);
}

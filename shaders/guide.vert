#version 150
// Guides as plain lines.
#include "frame.glsl"
in vec3 position; // relative to the head's origin, m
in float along;
out float share;
void main()
{
    share = along;
    gl_Position = frame.view_projection * vec4(position, 1.0);
}

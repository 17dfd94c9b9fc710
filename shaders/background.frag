#version 150
// A quiet backdrop: a little lighter behind the head than towards the corners.
#include "params"
in vec2 at;
uniform vec4 part; // of the whole picture that this drawing shows: offset and size, 0 to 1
out vec4 color;
void main()
{
    vec2 p = part.xy + at * part.zw - vec2(0.5, 0.55);
    float glow = mix(1.25, 0.6, smoothstep(0.0, 0.8, length(p * vec2(1.2, 1.0))));
    color = vec4(params.look_background.rgb * glow, 1.0);
}

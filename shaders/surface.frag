#version 150
// What the vertices have been lit with.
in vec3 lit;
in float seen;
out vec4 color; // linear, premultiplied
void main() { color = vec4(lit, 1.0) * seen; }

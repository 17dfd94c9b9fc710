#version 150
// What the vertices have been lit with.
in vec3 lit;
out vec4 color; // linear
void main() { color = vec4(lit, 1.0); }

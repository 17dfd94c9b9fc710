#version 150
in vec3 lit;
in float seen;
out vec4 color; // linear, premultiplied
void main() { color = vec4(lit, 1.0) * seen; }

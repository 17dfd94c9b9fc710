#version 150
in float share;
out vec4 color;
void main() { color = vec4(mix(vec3(0.05, 0.35, 0.9), vec3(0.9, 0.6, 0.05), share), 1.0); }

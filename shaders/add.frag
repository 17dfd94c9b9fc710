#version 150
// Adds one sample of the picture, at its share, to the others.
uniform sampler2D picture;
uniform float share;
out vec4 color;
void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0) * share; }

// Linear, premultiplied light to sRGB bytes, with plain alpha where the picture is transparent. One program for each
// choice of display: a software renderer computes every branch, whichever it takes.
#define DISPLAY_FUNCTION
#include "display.h"
uniform sampler2D picture;
uniform int left; // pixel of the window that the picture begins at
uniform float gain;
out vec4 color;
void main()
{
    vec4 sum = texelFetch(picture, ivec2(gl_FragCoord.xy) - ivec2(left, 0), 0);
    color = vec4(shown(sum.rgb / max(sum.a, 1e-4), gain, DISPLAY), sum.a);
}

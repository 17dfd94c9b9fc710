#version 150
// Linear, premultiplied light to sRGB bytes (IEC 61966-2-1), with plain alpha where the picture is transparent.
uniform sampler2D picture;
uniform int left; // pixel of the window that the picture begins at
out vec4 color;
void main()
{
    vec4 sum = texelFetch(picture, ivec2(gl_FragCoord.xy) - ivec2(left, 0), 0);
    vec3 c = clamp(sum.rgb / max(sum.a, 1e-4), 0.0, 1.0);
    // 1.055 c^(1/2.4) - 0.055 by square roots, which are far cheaper than a power on a processor; within a quarter of a byte.
    vec3 root2 = sqrt(c), root4 = sqrt(root2), root8 = sqrt(root4);
    vec3 high = 0.662002687 * root2 + 0.684122060 * root4 - 0.323583601 * root8 - 0.0225411470 * c;
    vec3 low = 12.92 * c;
    color = vec4(mix(high, low, lessThanEqual(c, vec3(0.0031308))), sum.a);
}

#version 150
// Linear, premultiplied light to sRGB bytes (IEC 61966-2-1), with plain alpha where the picture is transparent.
uniform sampler2D picture;
out vec4 color;
void main()
{
    vec4 sum = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
    vec3 c = clamp(sum.rgb / max(sum.a, 1e-4), 0.0, 1.0);
    vec3 low = 12.92 * c, high = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
    color = vec4(mix(high, low, lessThanEqual(c, vec3(0.0031308))), sum.a);
}

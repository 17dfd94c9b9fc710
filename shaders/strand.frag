#version 150
// Covers the ribbon's pixels, fading over the one at either edge. Light is the geometry shader's business.
in RibbonData {
    vec3 color;
    vec3 across;
} ribbon;

out vec4 color; // linear, premultiplied

void main()
{
    float alpha = clamp(ribbon.across.y - abs(ribbon.across.x), 0.0, 1.0) * ribbon.across.z;
    color = vec4(ribbon.color * alpha, alpha);
}

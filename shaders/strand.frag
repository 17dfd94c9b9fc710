#version 150
// Covers the ribbon's pixels, fading over the one at either edge. Light is the geometry shader's business, but for what
// is seen to differ from side to side where strands are wide (kernels/look_across.cl).
in RibbonData {
    vec3 color;
    vec3 across;
    float along;
    flat int strand;
} ribbon;

out vec4 color; // linear, premultiplied

#define NEAR_CELLS 16         // of kernels/raster.h
#define PLACES_IN_ROW 85      // of app/renderer_look.cpp
uniform sampler2D near_light; // strand after strand, place after place: red of each cell, green, blue; in rows
uniform int near_places;      // of a strand; 0: none are

vec3 light_in(int place, int cell)
{
    ivec2 at = ivec2(place % PLACES_IN_ROW * 3 * NEAR_CELLS + cell, place / PLACES_IN_ROW);
    return vec3(texelFetch(near_light, at, 0).r, texelFetch(near_light, at + ivec2(NEAR_CELLS, 0), 0).r,
                texelFetch(near_light, at + ivec2(2 * NEAR_CELLS, 0), 0).r);
}

// The mean over as much of the width as the pixel shares with it, and no less than a cell: kernels/raster_across.h.
vec3 light_across()
{
    float cells = float(NEAR_CELLS), per_pixel = cells / max(2.0 * ribbon.across.y - 1.0, 1e-3);
    float middle = 0.5 * cells - ribbon.across.x * per_pixel, half_length = max(0.5 * per_pixel, 0.5);
    float from = clamp(middle - half_length, 0.0, cells), to = clamp(middle + half_length, 0.0, cells);
    float at = clamp(ribbon.along, 0.0, 1.0) * float(near_places - 1);
    int below = min(int(at), near_places - 2), place = ribbon.strand * near_places + below;
    vec3 sum = vec3(0.0);
    for (int cell = int(from); cell < min(int(to) + 1, NEAR_CELLS); ++cell)
    {
        float share = max(min(to, float(cell + 1)) - max(from, float(cell)), 0.0);
        sum += share * mix(light_in(place, cell), light_in(place + 1, cell), at - float(below));
    }
    return sum / max(to - from, 1e-3);
}

void main()
{
    float alpha = clamp(ribbon.across.y - abs(ribbon.across.x), 0.0, 1.0) * ribbon.across.z;
    vec3 light = ribbon.color;
    if (near_places > 0)
        light += light_across();
    color = vec4(light * alpha, alpha);
}

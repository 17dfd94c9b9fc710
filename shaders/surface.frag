#version 150
// Plain light for solid things: Lambert from the light through the hair's grid, softened where it turns away as skin is,
// sky and floor from above and below, and a broad, weak highlight (Blinn, 1977). Under the roots the skin takes their
// colour, so that no bald gaps shine through.
#include "params"
#include "frame.glsl"
#include "light.glsl"

in SurfaceData {
    vec3 position;
    vec3 normal;
    float roots;
} surface;

uniform vec4 albedo; // linear; w: how far the roots tint it

out vec4 color;

void main()
{
    vec3 n = normalize(surface.normal), l = params.look_light_direction.xyz;
    vec3 e = normalize(frame.camera_position.xyz - surface.position);
    vec3 h = normalize(l + e + vec3(0.0, 1e-6, 0.0));
    // A voxel and a half off the surface: the grid holds the body itself.
    float light = light_at(surface.position + n * 1.5 * frame.grid_corner.w);
    vec3 wrap = vec3(0.35, 0.18, 0.12); // red light travels furthest under the skin
    vec3 lambert = max(vec3(0.0), (dot(n, l) + wrap) / (1.0 + wrap));
    vec3 sky = mix(vec3(0.22, 0.19, 0.18), vec3(0.42, 0.44, 0.48), 0.5 + 0.5 * n.y);
    float sheen = 0.12 * pow(max(0.0, dot(n, h)), 24.0);

    vec3 base = mix(albedo.rgb, params.look_root_color.rgb * 0.6, albedo.w * surface.roots);
    sheen *= 1.0 - surface.roots;
    vec3 lit = params.look_light_color.rgb * light;
    color = vec4(base * (sky * mix(0.35, 1.0, sqrt(light)) + 0.95 * lambert * lit) + sheen * lit, 1.0);
}

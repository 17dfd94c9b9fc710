#version 150
// The head and other solid things, lit at their vertices: the light's grid is coarser than any mesh worth drawing, and the
// triangles are so small that a fragment shader would run over each several times.
//
// Lambert from the light through the hair's grid, softened where it turns away as skin is, sky and floor from above and
// below, and a broad, weak highlight (Blinn, 1977). Under the roots the skin takes their colour, so that no bald gaps
// shine through.
#include "params"
#include "frame.glsl"
#include "light.glsl"

in vec3 position; // in the thing's own frame, m
in vec3 normal;
in float roots; // 1 on the scalp, 0 away from it
in vec3 color;  // linear, where it is worked out before

uniform vec4 place; // m; w: scale
uniform vec3 stretch; // m: the half of a sphere that looks this way moves by so much, which makes a capsule
uniform int on_head;
uniform int worked_out;
uniform vec4 albedo; // linear; w: how far the roots tint it

out vec3 lit;

vec3 turned(vec3 v)
{
    if (on_head == 0)
        return v;
    return vec3(dot(frame.head_row0.xyz, v), dot(frame.head_row1.xyz, v), dot(frame.head_row2.xyz, v));
}

void main()
{
    vec3 p = turned(position * place.w + place.xyz + (dot(position, stretch) > 0.0 ? stretch : vec3(0.0)));
    gl_Position = frame.view_projection * vec4(p, 1.0);
    if (worked_out == 1)
    {
        lit = color;
        return;
    }
    vec3 n = normalize(turned(normal));
    vec3 l = params.look_light_direction.xyz, e = normalize(frame.camera_position.xyz - p);
    vec3 h = normalize(l + e + vec3(0.0, 1e-6, 0.0));
    // A voxel and a half off the surface: the grid holds the body itself.
    float light = light_at(p + n * 1.5 * frame.grid_corner.w);
    vec3 wrap = vec3(0.35, 0.18, 0.12); // red light travels furthest under the skin
    vec3 lambert = max(vec3(0.0), (dot(n, l) + wrap) / (1.0 + wrap));
    vec3 sky = mix(vec3(0.22, 0.19, 0.18), vec3(0.42, 0.44, 0.48), 0.5 + 0.5 * n.y);
    float sheen = 0.12 * pow(max(0.0, dot(n, h)), 24.0) * (1.0 - roots);

    vec3 base = mix(albedo.rgb, params.look_root_color.rgb * 0.6, albedo.w * roots);
    vec3 sun = params.look_light_color.rgb * light;
    lit = base * (sky * mix(0.35, 1.0, sqrt(light)) + 0.95 * lambert * sun) + sheen * sun;
}

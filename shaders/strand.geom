#version 150
// Draws the piece of a strand between two nodes as a ribbon that faces the camera (thesis 5.2.1 and 5.2.2).
//
//   in   lines_adjacency   four neighbouring nodes; the piece runs between the middle two
//   out  triangle_strip    two vertices for each end of a subdivision
//
// The curve is smoothed as smoothing.curve says, waves, curls and frizz are laid on along the strand's frame, and it is cut into as many
// pieces as its bend on screen asks for, up to smoothing.subdivisions. A ribbon is never thinner than a pixel: below that
// its coverage shrinks instead, and half a pixel on either side lets the edges fade. Light is computed here, once a point
// of the curve and not once a pixel: it changes with the tangent, and where that turns the pieces are short.
layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 62) out;

#include "params"
#include "frame.glsl"
#include "curve.glsl"

uniform sampler1D wave; // both perpendiculars' waves, sim/wave.cpp
#include "ribbon.glsl"
#include "look.glsl"
#include "braid.glsl"

uniform float widening;         // of strands, for those that are left out
uniform sampler1D ramp;         // colours that tell a value, app/strand_colors.h
uniform sampler2D shades;       // colours worked out before, strand after strand, in rows: app/renderer_look.cpp
uniform int shaded_pieces;      // places on a segment that they are of; 0: none are
uniform int nodes;
uniform isamplerBuffer leaders; // the strand that leads each strand's clump, where there are clumps

in NodeData {
    vec4 normal;
    float light;
    float along;
    int strand;
    float value;
} node[4];

// 8 components and gl_Position's four, times 62 vertices: below the 1024 that GL 3.2 promises.
out RibbonData {
    vec3 color;  // lit
    vec3 across; // position across the ribbon and half its drawn width, both in pixels; opacity
    float along;
    flat int strand;
} ribbon;

Look look; // of this strand

vec3 curve_at(float t)
{
    vec4 w = curve_weights(params.smoothing_curve, t);
    return w.x * gl_in[0].gl_Position.xyz + w.y * gl_in[1].gl_Position.xyz + w.z * gl_in[2].gl_Position.xyz +
           w.w * gl_in[3].gl_Position.xyz;
}

// The tangent that both neighbours give at a node is the same, so waves and plaits join there.
void frame_at(float t, out vec3 tangent, out vec3 normal)
{
    tangent = mix(gl_in[2].gl_Position.xyz - gl_in[0].gl_Position.xyz,
                  gl_in[3].gl_Position.xyz - gl_in[1].gl_Position.xyz, t);
    tangent *= inversesqrt(max(dot(tangent, tangent), 1e-20));
    normal = mix(node[1].normal.xyz, node[2].normal.xyz, t);
    normal -= tangent * dot(normal, tangent);
    normal *= inversesqrt(max(dot(normal, normal), 1e-20));
}

Waves waves_of(int strand)
{
    Waves laid = Waves(look.normal_amplitude, look.normal_frequency, look.binormal_amplitude,
                       look.binormal_frequency, look.curl, look.frizz, look.seed, look.seed, 0.0);
    if (look.curl > 0.0)
    {
        laid.curl_begin = params.curl_phase * strand_random(laid.own, RANDOM_CURL_PHASE);
        if (params.clump_strength > 0.0)
        {
            laid.together = texelFetch(leaders, strand).r + 7919 * params.interpolation_seed;
            laid.curl_begin += strand_random(laid.together, RANDOM_CURL_TOGETHER);
        }
    }
    return laid;
}

vec3 laid_on(float t, Waves laid)
{
    float along = mix(node[1].along, node[2].along, t);
    vec3 tangent, normal;
    frame_at(t, tangent, normal);
    vec2 across = laid_across(laid, along, mix(node[1].normal.w, node[2].normal.w, t)).xy;
    return profile_at(params.wave_along, along) * (normal * across.x + cross(tangent, normal) * across.y);
}

vec3 plaited(float t, out float open)
{
    vec3 tangent, normal;
    frame_at(t, tangent, normal);
    vec4 by = braid_at(braid, mix(node[1].along, node[2].along, t));
    open = by.w;
    return by.x * normal + by.y * cross(tangent, normal) + by.z * tangent;
}

vec3 shade_of(int place)
{
    int row = textureSize(shades, 0).x;
    return texelFetch(shades, ivec2(place % row, place / row), 0).rgb;
}

vec3 shade_at(int strand, float along)
{
    int last = (nodes - 2) * shaded_pieces;
    float at = clamp(along, 0.0, 1.0) * float(last);
    int below = min(int(at), last - 1);
    return mix(shade_of(strand * (last + 1) + below), shade_of(strand * (last + 1) + below + 1), at - float(below));
}

int pieces(float pixel, Waves laid)
{
    vec3 bend1 = gl_in[0].gl_Position.xyz - 2.0 * gl_in[1].gl_Position.xyz + gl_in[2].gl_Position.xyz;
    vec3 bend2 = gl_in[1].gl_Position.xyz - 2.0 * gl_in[2].gl_Position.xyz + gl_in[3].gl_Position.xyz;
    // A chord strays from an arc by an eighth of the second difference, and with the square of the piece's length. What
    // it strays along the eye's ray is not seen.
    vec3 ray = normalize(0.5 * (gl_in[1].gl_Position.xyz + gl_in[2].gl_Position.xyz) - frame.camera_position.xyz);
    float bend = max(length(cross(bend1, ray)), length(cross(bend2, ray)));
    float stray = params.smoothing_curve == CURVE_LINEAR ? 0.0 : 0.125 * bend / pixel;
    float segment = node[2].normal.w - node[1].normal.w;
    stray += waves_stray(laid, segment, 0.5 * (node[1].along + node[2].along)) / pixel;
    if (braid.pitch > 0.0)
        stray += braid_stray(braid, segment, node[2].along) / pixel;
    return clamp(int(ceil(sqrt(stray / BEND_TOLERANCE))), 1, params.smoothing_subdivisions);
}

void main()
{
    vec3 start = gl_in[1].gl_Position.xyz, end = gl_in[2].gl_Position.xyz;
    if (!(distance(start, end) > 1e-7))
        return;
    float pixel = frame.camera_position.w * distance(frame.camera_position.xyz, 0.5 * (start + end));
    look = look_of(node[1].strand);
    find_braid(node[1].strand);
    Waves laid = waves_of(node[1].strand);
    int count = pieces(pixel, laid);
    bool adorned = has_waves(laid);
    float brightness = brightness_of(look.seed);

    float piece = 1.0 / float(count);
    vec3 before = curve_at(-piece), here = curve_at(0.0);
    if (adorned)
    {
        before += laid_on(-piece, laid);
        here += laid_on(0.0, laid);
    }
    float open = 1.0; // to the light
    if (braid.pitch > 0.0)
    {
        before += plaited(-piece, open);
        here += plaited(0.0, open);
    }
    for (int i = 0; i <= count; ++i)
    {
        float t = float(i) * piece;
        vec3 after = curve_at(t + piece);
        if (adorned)
            after += laid_on(t + piece, laid);
        float open_after = 1.0;
        if (braid.pitch > 0.0)
            after += plaited(t + piece, open_after);
        float along = mix(node[1].along, node[2].along, t);

        vec3 tangent = normalize(after - before + vec3(0.0, 1e-12, 0.0));
        vec3 to_camera = frame.camera_position.xyz - here;
        float size = frame.camera_position.w * length(to_camera); // of a pixel, here
        vec3 side = cross(tangent, to_camera);
        side *= inversesqrt(max(dot(side, side), 1e-20));
        float width = widening * ribbon_width(look.width, along) / size;
        float half_drawn = 0.5 * max(width, 1.0) + 0.5;

        vec3 hair = mix(look.root_color, look.tip_color, profile_at(params.look_color_along, along)) * brightness;
        float opacity = look.opacity * profile_at(params.look_opacity_along, along);
        float light = open * mix(node[1].light, node[2].light, t);
        if (node[1].value < 0.0 && shaded_pieces > 0)
            ribbon.color = shade_at(node[1].strand, along);
        else if (node[1].value < 0.0)
        {
            vec4 fibre = kajiya_kay(dot(tangent, params.look_light_direction.xyz),
                                    dot(tangent, normalize(to_camera)), light);
            vec3 lit = light * params.look_light_color.rgb;
            ribbon.color = vec3(scattered(fibre, hair.r, lit.r), scattered(fibre, hair.g, lit.g),
                                scattered(fibre, hair.b, lit.b));
        }
        else // lit little, so that a colour is the legend's
            ribbon.color = texture(ramp, mix(node[1].value, node[2].value, t)).rgb * mix(0.65, 1.0, light);
        for (float s = -1.0; s <= 1.0; s += 2.0)
        {
            ribbon.across = vec3(s * half_drawn, half_drawn, opacity * min(width, 1.0));
            ribbon.along = along;
            ribbon.strand = node[1].strand;
            gl_Position = frame.view_projection * vec4(here + side * (s * half_drawn * size), 1.0);
            EmitVertex();
        }
        before = here;
        here = after;
        open = open_after;
    }
    EndPrimitive();
}

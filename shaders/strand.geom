#version 150
// Draws the piece of a strand between two nodes as a ribbon that faces the camera (thesis 5.2.1 and 5.2.2).
//
//   in   lines_adjacency   four neighbouring nodes; the piece runs between the middle two
//   out  triangle_strip    two vertices for each end of a subdivision
//
// The curve is smoothed as smoothing.curve says, waves are laid on along the strand's frame, and it is cut into as many
// pieces as its bend on screen asks for, up to smoothing.subdivisions. A ribbon is never thinner than a pixel: below that
// its coverage shrinks instead, and half a pixel on either side lets the edges fade. Light is computed here, once a point
// of the curve and not once a pixel: it changes with the tangent, and where that turns the pieces are short.
layout(lines_adjacency) in;
layout(triangle_strip, max_vertices = 62) out;

#include "params"
#include "frame.glsl"
#include "curve.glsl"
#include "kajiya_kay.glsl"

uniform sampler1D wave; // both perpendiculars' waves, sim/wave.cpp
uniform samplerBuffer braids; // three values a strand that may be braided: app/renderer_upload.cpp
uniform int braided;          // strands that may be; they come first

in NodeData {
    vec4 normal;
    float light;
    float along;
    int strand;
} node[4];

// 6 components and gl_Position's four, times 62 vertices: well below the 1024 that GL 3.2 promises.
out RibbonData {
    vec3 color;  // lit
    vec3 across; // position across the ribbon and half its drawn width, both in pixels; opacity
} ribbon;

const float kBendTolerance = 0.5; // pixels that a piece may stray from the curve

vec3 curve_at(float t)
{
    vec4 w = curve_weights(params.smoothing_curve, t);
    return w.x * gl_in[0].gl_Position.xyz + w.y * gl_in[1].gl_Position.xyz + w.z * gl_in[2].gl_Position.xyz +
           w.w * gl_in[3].gl_Position.xyz;
}

vec3 wave_at(float t, int seed)
{
    float along = mix(node[1].along, node[2].along, t);
    float distance_from_root = mix(node[1].normal.w, node[2].normal.w, t);
    // The tangent that both neighbours give at a node is the same, so waves join there.
    vec3 tangent = mix(gl_in[2].gl_Position.xyz - gl_in[0].gl_Position.xyz,
                       gl_in[3].gl_Position.xyz - gl_in[1].gl_Position.xyz, t);
    tangent *= inversesqrt(max(dot(tangent, tangent), 1e-20));
    vec3 normal = mix(node[1].normal.xyz, node[2].normal.xyz, t);
    normal -= tangent * dot(normal, tangent);
    normal *= inversesqrt(max(dot(normal, normal), 1e-20));
    float first = texture(wave, wave_place(seed, distance_from_root, params.wave_normal_frequency,
                                           params.wave_normal_randomness)).r;
    float second = texture(wave, wave_place(seed, distance_from_root, params.wave_binormal_frequency,
                                            params.wave_binormal_randomness)).g;
    return normal * (first * params.wave_normal_amplitude * wave_onset(along, params.wave_normal_begin)) +
           cross(tangent, normal) *
               (second * params.wave_binormal_amplitude * wave_onset(along, params.wave_binormal_begin));
}

// The braid that this strand is plaited into, if any.
struct Braid
{
    vec4 place;                // in its plait
    float behind, per_along;   // m behind the ring at the root (negative), and for all of the strand
    float pitch, swing, depth, plait, bound;
} braid;

void find_braid(int strand)
{
    braid.pitch = 0.0;
    if (strand >= braided)
        return;
    vec4 a = texelFetch(braids, 3 * strand), b = texelFetch(braids, 3 * strand + 1),
         c = texelFetch(braids, 3 * strand + 2);
    braid.place = vec4(a.xyz, 0.0);
    braid.behind = a.w;
    braid.per_along = b.x;
    braid.pitch = b.y;
    braid.swing = b.z;
    braid.depth = b.w;
    braid.plait = c.x;
    braid.bound = c.y;
}

// What the braid moves the strand by; w: how much of the light comes there, less between the plaits.
vec4 braid_at(float t)
{
    float along = mix(node[1].along, node[2].along, t), behind = braid.behind + along * braid.per_along;
    vec3 tangent = mix(gl_in[2].gl_Position.xyz - gl_in[0].gl_Position.xyz,
                       gl_in[3].gl_Position.xyz - gl_in[1].gl_Position.xyz, t);
    tangent *= inversesqrt(max(dot(tangent, tangent), 1e-20));
    vec3 normal = mix(node[1].normal.xyz, node[2].normal.xyz, t);
    normal -= tangent * dot(normal, tangent);
    normal *= inversesqrt(max(dot(normal, normal), 1e-20));
    float share = braid_share(behind, braid.pitch);
    vec3 by = share * braid_offset(behind, braid.place, braid.pitch, braid.swing, braid.depth, braid.plait,
                                   braid.bound).xyz;
    vec2 out_of_middle = by.xy / vec2(braid.swing + braid.plait, braid.depth + BRAID_FLAT * braid.plait);
    float open = mix(1.0, 0.35 + 0.65 * smoothstep(0.25, 0.95, length(out_of_middle)), share);
    return vec4(by.x * normal + by.y * cross(tangent, normal) + by.z * tangent, open);
}

int pieces(float pixel)
{
    vec3 bend1 = gl_in[0].gl_Position.xyz - 2.0 * gl_in[1].gl_Position.xyz + gl_in[2].gl_Position.xyz;
    vec3 bend2 = gl_in[1].gl_Position.xyz - 2.0 * gl_in[2].gl_Position.xyz + gl_in[3].gl_Position.xyz;
    // A chord strays from an arc by an eighth of the second difference, and with the square of the piece's length.
    float stray = params.smoothing_curve == CURVE_LINEAR ? 0.0 : 0.125 * max(length(bend1), length(bend2)) / pixel;
    float segment = node[2].normal.w - node[1].normal.w;
    float waves_n = segment * params.wave_normal_frequency, waves_b = segment * params.wave_binormal_frequency;
    // A sine of height a and length l strays by a (pi / n)^2 / 2 when a wave is cut in n.
    stray += 4.93 * (params.wave_normal_amplitude * waves_n * waves_n +
                     params.wave_binormal_amplitude * waves_b * waves_b) / pixel;
    if (braid.pitch > 0.0 && braid.behind + node[2].along * braid.per_along > 0.0)
    {
        float turns = segment / braid.pitch;
        stray += 4.93 * (braid.swing + 4.0 * braid.depth) * turns * turns / pixel;
    }
    return clamp(int(ceil(sqrt(stray / kBendTolerance))), 1, params.smoothing_subdivisions);
}

void main()
{
    vec3 start = gl_in[1].gl_Position.xyz, end = gl_in[2].gl_Position.xyz;
    if (!(distance(start, end) > 1e-7))
        return;
    float pixel = frame.camera_position.w * distance(frame.camera_position.xyz, 0.5 * (start + end));
    find_braid(node[1].strand);
    int count = pieces(pixel);
    bool plaited = braid.pitch > 0.0;
    bool waves = params.wave_normal_amplitude > 0.0 || params.wave_binormal_amplitude > 0.0;
    int seed = node[1].strand + 7919 * params.interpolation_seed;
    float brightness = exp(params.look_variation * 2.0 * (strand_random(seed, RANDOM_BRIGHTNESS) - 0.5));

    float piece = 1.0 / float(count);
    vec3 before = curve_at(-piece), here = curve_at(0.0);
    if (waves)
    {
        before += wave_at(-piece, seed);
        here += wave_at(0.0, seed);
    }
    float open = 1.0;
    if (plaited)
    {
        vec4 by = braid_at(0.0);
        before += braid_at(-piece).xyz;
        here += by.xyz;
        open = by.w;
    }
    for (int i = 0; i <= count; ++i)
    {
        float t = float(i) * piece;
        vec3 after = curve_at(t + piece);
        if (waves)
            after += wave_at(t + piece, seed);
        float open_after = 1.0;
        if (plaited)
        {
            vec4 by = braid_at(t + piece);
            after += by.xyz;
            open_after = by.w;
        }
        float along = mix(node[1].along, node[2].along, t);

        vec3 tangent = normalize(after - before + vec3(0.0, 1e-12, 0.0));
        vec3 to_camera = frame.camera_position.xyz - here;
        float size = frame.camera_position.w * length(to_camera); // of a pixel, here
        vec3 side = cross(tangent, to_camera);
        side *= inversesqrt(max(dot(side, side), 1e-20));
        float width = params.look_width * (1.0 - params.look_taper * along * along) / size;
        float half_drawn = 0.5 * max(width, 1.0) + 0.5;

        vec3 hair = mix(params.look_root_color.rgb, params.look_tip_color.rgb, along) * brightness;
        ribbon.color = kajiya_kay(tangent, normalize(to_camera), hair, open * mix(node[1].light, node[2].light, t));
        for (float s = -1.0; s <= 1.0; s += 2.0)
        {
            ribbon.across = vec3(s * half_drawn, half_drawn, params.look_opacity * min(width, 1.0));
            gl_Position = frame.view_projection * vec4(here + side * (s * half_drawn * size), 1.0);
            EmitVertex();
        }
        before = here;
        here = after;
        open = open_after;
    }
    EndPrimitive();
}

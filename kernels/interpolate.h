// What both ways of making drawn strands share: reading a guide, cutting the strand at its own length, keeping it out
// of colliders, and its light.
#ifndef COIF_INTERPOLATE_H
#define COIF_INTERPOLATE_H
#include "lanes.h"

#define CURVE_FUNCTION static inline
#define FLOAT4(x, y, z, w) ((float4)(x, y, z, w))
#define UINT uint
#define TO_UINT(v) ((uint)(v))
#define TO_FLOAT(v) ((float)(v))
#include "strand_curve.h"

#define LIGHT_FUNCTION static inline
#include "light_grid.h"

static inline float3 guide_node(global const float* position, int guide, int node)
{
    const int at = strand_value(guide, node, 0, NODES);
    return (float3)(position[at], position[at + LANES], position[at + 2 * LANES]);
}

static inline float3 turn_by(float4 row0, float4 row1, float4 row2, float3 v)
{
    return (float3)(dot(row0.xyz, v), dot(row1.xyz, v), dot(row2.xyz, v));
}

// Optical depth between a point and the light. Half a voxel towards the light, so that a strand does not shade itself.
static inline float light_depth(global const float* depth, float3 p, constant HairParams* params,
                                constant StepInfo* info)
{
    const float4 corner = info->grid_corner;
    const float3 g = (p - corner.xyz) / corner.w + params->look_light_direction.xyz * 0.5f - 0.5f;
    const float last = (float)(RESOLUTION - 1);
    if (!(g.x >= 0.0f && g.y >= 0.0f && g.z >= 0.0f && g.x < last && g.y < last && g.z < last))
        return 0.0f;
    const float u = info->sweep_axis == 0 ? g.y : g.x, v = info->sweep_axis == 2 ? g.y : g.z;
    const float along = info->sweep_axis == 0 ? g.x : info->sweep_axis == 1 ? g.y : g.z;
    const float passed = (along - (float)info->sweep_from) * (float)info->sweep_sign;
    const int slice0 = clamp((int)passed, 0, RESOLUTION - 2);
    const float between = passed - (float)slice0;
    float tau[2];
    for (int s = 0; s < 2; ++s)
    {
        const float ru = light_ray(u, info->sweep.x, (float)(slice0 + s), (float)RESOLUTION);
        const float rv = light_ray(v, info->sweep.y, (float)(slice0 + s), (float)RESOLUTION);
        const int u0 = min((int)ru, RESOLUTION - 1), v0 = min((int)rv, RESOLUTION - 1);
        const int u1 = u0 + 1 < RESOLUTION ? u0 + 1 : 0, v1 = v0 + 1 < RESOLUTION ? v0 + 1 : 0;
        global const float* slice = depth + (slice0 + s) * RESOLUTION * RESOLUTION;
        tau[s] = mix(mix(slice[v0 * RESOLUTION + u0], slice[v0 * RESOLUTION + u1], ru - (float)u0),
                     mix(slice[v1 * RESOLUTION + u0], slice[v1 * RESOLUTION + u1], ru - (float)u0), rv - (float)v0);
    }
    return mix(tau[0], tau[1], between);
}

// Out of the union of all spheres with `room` to spare: straight away from the centre of the sphere that the point is
// deepest in, as far as it takes to leave every sphere on the way. Pushing out of one sphere at a time would go to and
// fro where they overlap. `which` numbers the spheres that matter.
static inline float3 out_of(constant float4* spheres, const short* which, int count, float3 p, float room)
{
    float deepest = 0.0f;
    float3 direction = (float3)(0.0f);
    for (int c = 0; c < count; ++c)
    {
        const float4 sphere = spheres[which[c]];
        const float3 out = p - sphere.xyz;
        const float radius = sphere.w + room, squared = dot(out, out);
        if (!(squared < radius * radius))
            continue;
        const float length_out = sqrt(squared);
        if (radius - length_out > deepest)
        {
            deepest = radius - length_out;
            direction = length_out > 1e-6f * radius ? out / length_out : (float3)(0.0f, 1.0f, 0.0f);
        }
    }
    if (deepest == 0.0f)
        return p;
    float t = 0.0f;
    for (int round = 0; round < 16; ++round)
    {
        float further = t;
        for (int c = 0; c < count; ++c)
        {
            // Where the ray p + t direction leaves the sphere.
            const float4 sphere = spheres[which[c]];
            const float3 out = p - sphere.xyz;
            const float radius = sphere.w + room, b = dot(out, direction);
            const float discriminant = b * b - dot(out, out) + radius * radius;
            if (discriminant <= 0.0f)
                continue;
            const float half_chord = sqrt(discriminant);
            if (-b - half_chord <= t && -b + half_chord > further)
                further = -b + half_chord;
        }
        if (further == t)
            break;
        t = further;
    }
    return p + t * direction;
}

#define NEAR_MARGIN 0.01f // m
#define PADDED ((NODES + WIDTH - 1) / WIDTH * WIDTH)

// Finishes a drawn strand whose nodes follow the guides at full length: cuts it to its own length, pushes it out of the
// colliders with room for its waves, and stores positions with the share of the light that reaches them in w.
static inline void finish_strand(const float3* node, DrawnStrand strand, global float4* drawn_position, int index,
                                 global const float* depth, constant float4* colliders, constant HairParams* params,
                                 constant StepInfo* info)
{
    const float cut = strand.root.w;
    float x[PADDED], y[PADDED], z[PADDED];
    float3 low = node[1], high = node[1];
    for (int k = 0; k < PADDED; ++k)
    {
        float3 p = node[min(k, NODES - 1)];
        if (k > 1 && k < NODES && cut < 1.0f)
        {
            const float at = 1.0f + (float)(k - 1) * cut;
            const int i = min((int)at, NODES - 2);
            const float4 w = curve_weights(CURVE_CATMULL_ROM, at - (float)i);
            p = w.x * node[i - 1] + w.y * node[i] + w.z * node[i + 1] + w.w * node[min(i + 2, NODES - 1)];
        }
        x[k] = p.x;
        y[k] = p.y;
        z[k] = p.z;
        if (k > 0)
        {
            low = fmin(low, p);
            high = fmax(high, p);
        }
    }

    // Which nodes touch a collider? Few do, so this is asked of many at once, and only of colliders near the strand.
    const float wave_n = params->wave_normal_amplitude, wave_b = params->wave_binormal_amplitude;
    const float layer = params->interpolation_layer * strand_random(strand.seed, RANDOM_LAYER);
    const float most_room = info->clearance + layer + wave_n + wave_b;
    whole touching[PADDED / WIDTH];
    for (int k = 0; k < PADDED / WIDTH; ++k)
        touching[k] = (whole)(0);
    short near[MOST_COLLIDERS];
    int near_count = 0;
    for (int c = 0; c < info->colliders; ++c)
    {
        const float4 sphere = colliders[c];
        const float3 away = sphere.xyz - clamp(sphere.xyz, low, high);
        const float reach = sphere.w + most_room;
        if (dot(away, away) >= (reach + NEAR_MARGIN) * (reach + NEAR_MARGIN))
            continue;
        near[near_count++] = (short)c;
        for (int k = 0; k < PADDED; k += WIDTH)
        {
            const real dx = LANES_LOAD(x + k) - sphere.x, dy = LANES_LOAD(y + k) - sphere.y,
                       dz = LANES_LOAD(z + k) - sphere.z;
            touching[k / WIDTH] |= dx * dx + dy * dy + dz * dz < reach * reach;
        }
    }
    int touches[PADDED];
    for (int k = 0; k < PADDED; k += WIDTH)
        LANES_STORE(touching[k / WIDTH], touches + k);

    for (int k = 0; k < NODES; ++k)
    {
        float3 p = (float3)(x[k], y[k], z[k]);
        if (k > 1 && touches[k])
        {
            const float along = (float)(k - 1) / (float)(NODES - 2);
            const float onset_n = wave_n * wave_onset(along, params->wave_normal_begin);
            const float onset_b = wave_b * wave_onset(along, params->wave_binormal_begin);
            const float room =
                info->clearance + layer * min(1.0f, 4.0f * along) + sqrt(onset_n * onset_n + onset_b * onset_b);
            const float3 inside = p;
            p = out_of(colliders, near, near_count, p, room);
            // Pushed so far that it may have come into a collider that was not near.
            if (dot(p - inside, p - inside) > NEAR_MARGIN * NEAR_MARGIN)
            {
                for (int c = 0; c < info->colliders; ++c)
                    near[c] = (short)c;
                near_count = info->colliders;
                p = out_of(colliders, near, near_count, inside, room);
            }
        }
        float light = 1.0f;
#ifdef SHADOW
        light = exp(-light_depth(depth, p, params, info));
#endif
        drawn_position[index * NODES + k] = (float4)(p, light);
    }
}

#endif

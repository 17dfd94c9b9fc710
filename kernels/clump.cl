// Draws strands towards those that lead their clumps, from root to tip as clump.along says, and keeps them their length
// and out of bodies. Leaders stay as they are, so that others may read them in any order. Work-item: WIDTH strands.
#include "drawn_room.h"
#include "flyaway.h"

// A strand's node at `at`, in nodes from its beginning, along the curve through them and straight on beyond its tip.
static inline float4 on_strand(global const float4* node, float at)
{
    const int i = min((int)at, NODES - 2);
    const float t = at - (float)i, beyond = fmax(t - 1.0f, 0.0f);
    const float4 w = curve_weights(CURVE_CATMULL_ROM, fmin(t, 1.0f));
    const float4 on = w.x * node[i - 1] + w.y * node[i] + w.z * node[i + 1] + w.w * node[min(i + 2, NODES - 1)];
    return on + beyond * (node[NODES - 1] - node[NODES - 2]);
}

kernel void clump(global float4* drawn_position, global const DrawnStrand* strands, global const StrandLook* looks,
                  global const float* body_distance, global const float4* body_way, constant Capsule* colliders,
                  constant HairParams* params, constant StepInfo* info)
{
    const int first = get_global_id(0) * WIDTH;
    if (first >= info->drawn)
        return;
    int strand[WIDTH], leader[WIDTH];
    float strengths[WIDTH], pace[WIDTH], begin[WIDTH];
    number_lanes(first, info->drawn, strand);
    int count = 0;
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const DrawnStrand own = strands[strand[lane]];
        leader[lane] = own.leader * NODES;
        // As far along its leader as along itself, though one may be cut shorter.
        pace[lane] = own.root.w / strands[own.leader].root.w;
        // What begins higher up the way comes by later.
        global const float4* led = drawn_position + leader[lane];
        begin[lane] = 1.0f + own.weights.w / fmax(distance(led[1].xyz, led[2].xyz), 1e-6f);
        const bool follows = own.leader != strand[lane] && !flies_away(strand[lane], own, params);
        count += follows;
        const float less = params->clump_variation * strand_random(own.seed, RANDOM_CLUMP);
        strengths[lane] = follows ? params->clump_strength * (1.0f - less) : 0.0f;
    }
    if (count == 0)
        return;

    // Strands that part from their leader, to either side of the face or of a shoulder, let go of it as they do.
    float parted[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        global const float4* own = drawn_position + strand[lane] * NODES;
        global const float4* led = drawn_position + leader[lane];
        const float4 at_root = own[1] - led[1];
        float farthest = 0.0f;
        for (int check = 0; check < 2; ++check)
        {
            const int k = check ? (NODES + 1) / 2 : NODES - 1;
            const float4 apart = own[k] - on_strand(led, fmax(1.0f, begin[lane] + (float)(k - 1) * pace[lane]));
            farthest = fmax(farthest, dot(apart.xyz, apart.xyz));
        }
        parted[lane] = sqrt(farthest) - sqrt(dot(at_root.xyz, at_root.xyz));
    }
    const real strength = LANES_LOAD(strengths) * (1.0f - smoothstep((real)(2.0f * info->parting),
                                                                     (real)(6.0f * info->parting), LANES_LOAD(parted)));
    const whole follows = strength > 0.0f;

    Points node[NODES];
    real light[NODES];
    node[0] = load_node(drawn_position, strand, 0);
    node[1] = load_node(drawn_position, strand, 1);
    Points before = node[1];
    for (int k = 2; k < NODES; ++k)
    {
        float x[WIDTH], y[WIDTH], z[WIDTH], w[WIDTH], own_light[WIDTH];
        for (int lane = 0; lane < WIDTH; ++lane)
        {
            const float4 led =
                on_strand(drawn_position + leader[lane], fmax(1.0f, begin[lane] + (float)(k - 1) * pace[lane]));
            x[lane] = led.x;
            y[lane] = led.y;
            z[lane] = led.z;
            w[lane] = fmin(fmax(led.w, 0.0f), 1.0f);
            own_light[lane] = drawn_position[strand[lane] * NODES + k].w;
        }
        const Points own = load_node(drawn_position, strand, k), last = node[k - 1];
        const real share = strength * profile_at(params->clump_along, (float)(k - 1) / (float)(NODES - 2));
        light[k] = LANES_LOAD(own_light) + share * (LANES_LOAD(w) - LANES_LOAD(own_light));
        const Points go =
            points(own.x + share * (LANES_LOAD(x) - own.x) - last.x, own.y + share * (LANES_LOAD(y) - own.y) - last.y,
                   own.z + share * (LANES_LOAD(z) - own.z) - last.z);
        // As far as the segment is long, or a little less.
        const Points d = points(own.x - before.x, own.y - before.y, own.z - before.z);
        before = own;
        const real length_now = sqrt(fmax(dot_lanes(go, go), (real)(1e-12f))), length_own = sqrt(dot_lanes(d, d));
        const real scale = fmin(fmax(length_now, 0.8f * length_own), length_own) / length_now;
        node[k] =
            select_points(own, points(last.x + scale * go.x, last.y + scale * go.y, last.z + scale * go.z), follows);
    }
    keep_out(node, layers_of(strand, strands, params), adornment_of(strand, looks, params), body_distance, body_way, colliders, params, info);
    for (int k = 2; k < NODES; ++k)
        store_node(drawn_position, strand, k, select_points(load_node(drawn_position, strand, k), node[k], follows),
                   light[k]);
}

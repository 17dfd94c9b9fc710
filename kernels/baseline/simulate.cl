// The thesis' own update kernel, kept to be measured against: listing A.1 and section 5.1.2 with one work-group a
// strand and one work-item a node, previous positions instead of velocities, and barriers between batches of
// constraints.
//
// The listing's mistakes are mended: the odd batch ends before the last node, segments below the scalp never move,
// equal points have no direction, drag is exact for any strength, and NODES is a build option. The strengths per sweep
// and node come from the host, which has them only once: the listing's powers would cost more than eight of its sweeps.
// Wind, turbulence, the forces between hairs and the density are left out: what is measured is motion and constraints.
#include "settings.h"

// Moves `outer` and, by half then, `inner` towards a distance; an inner node below the scalp stays.
static void keep_distance(local float4* nodes, int inner, int outer, float rest, float strength, int inner_moves)
{
    const float4 along = nodes[outer] - nodes[inner];
    const float squared = dot(along, along);
    if (!(squared > 0.0f))
        return;
    const float4 move = strength * (1.0f - rest / sqrt(squared)) * along;
    if (inner_moves)
        nodes[inner] += 0.5f * move;
    nodes[outer] -= inner_moves ? 0.5f * move : move;
}

static float4 sphere_collision(float4 node, float4 center, float radius)
{
    const float4 out = node - center;
    const float squared = dot(out, out);
    return squared < radius * radius && squared > 0.0f ? center + radius / sqrt(squared) * out : node;
}

kernel __attribute__((reqd_work_group_size(NODES, 1, 1))) void
simulate(global float4* position, global float4* previous, global const float4* root, constant float* bending,
         constant float4* spheres, constant BaselineSettings* settings)
{
    local float4 nodes[NODES];
    const int node = get_local_id(0);
    const int at = get_global_id(0);
    const float4 here = position[at];

    // Root: place relative to the scalp's centre, and length of a segment. Nodes 0 and 1 follow the scalp.
    const float4 r = root[get_group_id(0)];
    const float4 place = (float4)(r.xyz, 0.0f);
    const float rest = r.w;
    if (node == 0)
        nodes[node] = settings->scalp + place - rest * normalize(place);
    else if (node == 1)
        nodes[node] = settings->scalp + place;
    else // eq. 5.1 and 5.3
        nodes[node] = here + settings->drag_keep * (here - previous[at]) +
                      (float4)(0.0f, settings->duration * settings->push, 0.0f, 0.0f);

    const float bend = bending[node]; // of a sweep, eq. 5.5 and 5.6; 0 of nodes 0 and 1
    for (int sweep = 0; sweep < settings->iterations; ++sweep)
    {
        if (node > 1)
            for (int s = 0; s < settings->spheres; ++s)
                nodes[node] = sphere_collision(nodes[node], settings->scalp + (float4)(spheres[s].xyz, 0.0f),
                                               spheres[s].w);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (node % 2 == 0 && node > 1 && node + 1 < NODES)
            keep_distance(nodes, node, node + 1, rest, settings->stretching, 1);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (node % 2 == 1 && node + 1 < NODES)
            keep_distance(nodes, node, node + 1, rest, settings->stretching, node > 1);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (bend > 0.0f)
            keep_distance(nodes, 0, node, settings->bending_scale * rest * (float)node, bend, 0);
    }

    position[at] = nodes[node];
    previous[at] = here;
}

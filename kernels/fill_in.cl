// All nodes of far blocks, of which a step has moved every other one (sim/far.h): on the cubics through these, at the
// segments' own lengths from root to tip, outside the bodies.
// Work-item: WIDTH strands. NODES, RESOLUTION and the features CONTACT, BODY_GRID (with CONTACT) and DENSITY are build
// options.
#include "bodies.h"
#include "direct.h"
#include "forces.h"
#include "sleep.h"
#include "thin.h"

// Of a segment, how deep nodes between may be left, from where on their neighbours are asked, and how far aside a node
// that was moved may be laid without a look.
#define ON_SURFACE 0.01f
#define DEEP 0.25f
#define ASIDE 0.03f
#define ROUNDS 3

#ifdef CONTACT
// The segment `d` to node i, turned out of the bodies as walk_out() of bodies_contact.h does. *room, where it is not
// known to be any, becomes the node's.
static inline Points laid_around(const Bodies* bodies, HeadPose head, int i, const Points* x, Points d, real rest,
                                 real* room)
{
    const Points parent = x[i - 1];
    real inside = (real)(0.0f);
    for (int turn = 0; turn < ROUNDS; ++turn)
    {
        const Nearest nearest = nearest_body(bodies, head, i, plus(parent, d), 1);
        if (turn == 0)
        {
            *room = select(*room, nearest.distance, *room < 0.0f);
            // Over a hump; or of hair that a body has come over and that is let out slowly, as its neighbours are.
            if (any_lane(nearest.distance < -DEEP * rest))
            {
                const real before = nearest_body(bodies, head, i - 1, parent, 1).distance;
                const real after = nearest_body(bodies, head, i + 1, x[min(i + 1, NODES - 1)], 1).distance;
                inside = fmax(-(i > 2 ? fmin(before, after) : after), (real)(0.0f));
            }
        }
        const real gap = nearest.distance + inside;
        const whole in = gap < -ON_SURFACE * rest;
        if (!any_lane(in))
            break;
        const Points n = away_in_world(head, nearest);
        const real along = dot_lanes(n, d), height = clamp(gap - along, -rest, rest);
        Points flat = minus(d, times(along, n));
        flat = select_points(flat, any_normal(n), dot_lanes(flat, flat) < 1e-8f * rest * rest);
        const real size = sqrt((rest - height) * (rest + height)) * INVERSE_SQRT(dot_lanes(flat, flat));
        d = select_points(d, minus(times(size, flat), times(height, n)), in);
    }
    return d;
}
#endif

kernel void fill_in(global float* position, global const float* thin_position, global const int* thinned,
                    global const float* still, global const float* segment_length, global int* density,
                    global int* touched, global const float* body_distance, constant Capsule* bodies,
                    constant StepPath* path, constant HairParams* params, constant StepInfo* info)
{
    const int strand = get_global_id(0) * WIDTH; // of the first lane
    if (strand >= (info->guides + LANES - 1) / LANES * LANES)
        return;
    const int block = strand / LANES;
    if (!(thinned[block] & THIN_NOW))
        return;
    if (!sleeps(still, block))
    {
        const real rest = fmax(LANES_LOAD(segment_length + strand) * params->strand_spacing, (real)(1e-9f));
        // Against where the head's origin was when the step began, as bodies are.
        const Points carried =
            points((real)(info->origin_move.x), (real)(info->origin_move.y), (real)(info->origin_move.z));
        Points x[NODES];
        lay_between(thin_position + strand_value(strand, 0, 0, THIN_NODES), x);
        for (int i = 0; i < NODES; ++i)
            x[i] = plus(x[i], carried);
#ifdef CONTACT
        const HeadPose end = head_pose(path, STEP_PARTS);
        Bodies near;
        bodies_near(&near, bodies, info, end, end, x[1], rest * (float)NODES);
#ifdef BODY_GRID
        near.grid = body_distance;
        near.info = info;
#endif
        real room = (real)(-1.0f); // that the node has about it, at least
#endif
        for (int i = 2; i < NODES; ++i)
        {
            Points d = minus(x[i], x[i - 1]);
            d = times(rest * INVERSE_SQRT(fmax(dot_lanes(d, d), 1e-12f * rest * rest)), d);
#ifdef CONTACT
            // What was moved is outside, unless the lengths before take it elsewhere. Of the nodes between those are
            // looked at that no other before keeps clear.
            room -= rest;
            const Points aside = minus(plus(x[i - 1], d), x[i]);
            const int look = i % 2 == 0 || any_lane(dot_lanes(aside, aside) > ASIDE * ASIDE * rest * rest);
            if (look && any_near(&near) && any_lane(room < 0.0f))
                d = laid_around(&near, end, i, x, d, rest, &room);
#endif
            x[i] = plus(x[i - 1], d);
        }
        for (int i = 0; i < NODES; ++i)
            store_lanes(minus(x[i], carried), position + strand_value(strand, i, 0, NODES));
    }
#ifdef DENSITY
    if (info->last_substep)
        add_strands_density(density, touched, position, strand, info);
#endif
}

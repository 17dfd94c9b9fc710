// All nodes of far blocks, of which a step has moved every other one (sim/far.h): on the cubics through these, at the
// segments' own lengths from root to tip, outside the bodies.
// Work-item: WIDTH strands. NODES, RESOLUTION and the features CONTACT, BODY_GRID (with CONTACT) and DENSITY are build
// options.
#include "bodies_contact.h"
#include "forces.h"
#include "sleep.h"
#include "thin.h"

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
        whole walked = (whole)(0);
#ifdef CONTACT
        const HeadPose end = head_pose(path, STEP_PARTS);
        Bodies near;
        bodies_near(&near, bodies, info, end, end, x[1], rest * (float)NODES);
#ifdef BODY_GRID
        near.grid = body_distance;
        near.info = info;
        find_planes(&near, end, x, x, x[1], 1);
#endif
        if (any_near(&near))
        {
            // What was moved may be inside, for it is let out slowly; what is between, no deeper than its neighbours.
            real inside[NODES];
            for (int i = 1; i < NODES; i += 2)
            {
                real gap = nearest_capsule(&near, end, x[i]).distance;
#ifdef BODY_GRID
                gap = fmin(gap, near.distance[i]);
#endif
                inside[i] = fmax(-gap, (real)(0.0f));
            }
            inside[2] = fmax(inside[1] - GROWS_OUT * rest, inside[3]);
            for (int i = 4; i < NODES; i += 2)
                inside[i] = fmax(inside[i - 1], inside[i + 1]);
            walk_out(&near, end, x, rest, 2, inside, 1);
            walked = (whole)(-1);
        }
#endif
        for (int i = 2; i < NODES && !any_lane(walked); ++i)
        {
            const Points d = minus(x[i], x[i - 1]);
            const real scale = rest * INVERSE_SQRT(fmax(dot_lanes(d, d), 1e-12f * rest * rest));
            x[i] = plus(x[i - 1], times(scale, d));
        }
        for (int i = 0; i < NODES; ++i)
            store_lanes(minus(x[i], carried), position + strand_value(strand, i, 0, NODES));
    }
#ifdef DENSITY
    if (info->last_substep)
        add_strands_density(density, touched, position, strand, info);
#endif
}

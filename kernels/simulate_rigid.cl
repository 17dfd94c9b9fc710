// Guides too stiff to bend (a droop number under 0.1 droops by 1.3 % of the length at most): the rest shape, carried by
// the head. Work-item: WIDTH strands.
#include "bodies.h"
#include "forces.h"

kernel void simulate_rigid(global float* position, global float* velocity, global float* moved,
                           global const float* rest_position, global int* density, global int* touched, constant StepPath* path,
                           constant StepInfo* info)
{
    const int strand = get_global_id(0) * WIDTH; // of the first lane
    if (strand >= (info->guides + LANES - 1) / LANES * LANES)
        return;
    const HeadPose begin = head_pose(path, 0), end = head_pose(path, STEP_PARTS);
    const float per_second = 1.0f / info->substep;
    real farthest2 = (real)(0.0f);
    for (int i = 0; i < NODES; ++i)
    {
        const int at = strand_value(strand, i, 0, NODES);
        const Points rest = load_lanes(rest_position + at);
        const Points x = turn_by(end.row0, end.row1, end.row2, rest), was = out_of_head(begin, rest);
        const Points by = points(x.x + info->origin_move.x - was.x, x.y + info->origin_move.y - was.y,
                                 x.z + info->origin_move.z - was.z);
        farthest2 = fmax(farthest2, dot_lanes(by, by));
        store_lanes(x, position + at);
        store_lanes(points(by.x * per_second, by.y * per_second, by.z * per_second), velocity + at);
    }
    LANES_STORE(fmax(LANES_LOAD(moved + strand), sqrt(farthest2)), moved + strand);
#ifdef DENSITY
    if (info->last_substep)
        add_strands_density(density, touched, position, strand, info);
#endif
}

// One step of the guides by direct solves: roots follow the head, forces, implicit bending, lengths along start-of-step
// directions, contact. Cut into 1 to 16 substeps, as many as the tension of the block's strands asks for.
//
//   V  <- keep V + gain f                 mean velocity of a substep; drag exactly (sim/step_info.cpp)
//   (M + h gain K) move = h M V + ...     bending implicitly, the last substep's multipliers as a force: without them
//                                         bending and lengths, one after the other, leave a droop that hangs on h
//   |a + move| = l, corrections along a   second order, no numerical damping
//
// Each strand has its own share of the stiffness, bend_factor.
//
// A block of strands that has been at rest for a while sleeps: it stays where it is until the host, by setting `still`
// to zero, or other hair by its density wakes it.
//
// What is decided is decided for each block of 16 strands alike, whatever WIDTH is, or for each lane alone.
// Work-item: WIDTH strands. NODES, RESOLUTION and the features BENDING, CURLED, WIND, REPULSION, CONTACT, BODY_GRID
// (with CONTACT), DENSITY and HELD are build options. Where some blocks are far, two kernels share them: with THIN=0
// this is the one for the others, with THIN=1 that of thin chains, whose nodes, lengths and rest its arguments are then.
#include "bodies_contact.h"
#include "direct.h"
#include "faults.h"
#include "forces.h"
#include "sleep.h"
#include "thin.h"

#define MOST_NEWTON 3
#define LENGTH_TOLERANCE 5e-4f // of | |d|^2 - l^2 | / l^2
// Of a strand's length, how much nearer to the surface it comes where its root lies inside a body, for nobody moves a
// root: were it asked for more than it can do, it would never come to rest.
#define GROWS_OUT 0.6667f

// The pace that the tension in this block asks for: h w_max <= courant with w_max^2 = 4 times the largest multiplier
// (transverse waves of a chain). Faster at once, slower only when well below: order two lives from equal substeps.
static inline int pace_for(global const float* tension, global const float* segment_length, int block, int before,
                           constant HairParams* params, constant StepInfo* info)
{
    float most = 0.0f, shortest = segment_length[block * LANES];
    for (int lane = 0; lane < LANES; ++lane)
    {
        most = fmax(most, tension[block * LANES + lane]);
        shortest = fmin(shortest, segment_length[block * LANES + lane]);
    }
    // Hanging from its root in what accelerates it, it will be at least as tense as this.
    const float length_least = fmax(shortest * params->strand_spacing, 1e-9f);
    most = fmax(most, (float)(NODES - 2) * info->acceleration / length_least);
    const float waves = info->substep * 2.0f * sqrt(fmin(most, 1e30f)) / params->solver_courant;
    const float need = fmax(waves, info->substep * info->turning_rate);
    int up = 0, down = 0;
    while (up < PACES - 1 && (float)substeps_of(up) < fmax(need, (float)params->solver_substeps))
        ++up;
    while (down < PACES - 1 && (float)substeps_of(down) < fmax(1.4f * need, (float)params->solver_substeps))
        ++down;
    return max(up, min(before, down));
}

#ifdef REPULSION
// What the other hair does to all nodes together, m/s^2.
static inline Points push_along(global const float* gradient, global const float* position, constant StepInfo* info)
{
    Points sum = points((real)(0.0f), (real)(0.0f), (real)(0.0f));
    for (int i = 2; i < NODES; ++i)
        sum = plus(sum, repulsion_at(gradient, load_lanes(position + i * 3 * LANES), info));
    return sum;
}
#endif

// The strands in `which` to their rest shape at this pose of the head, moving with it.
static inline void start_again(whole which, HeadPose head, global const float* rest_position, Points velocity,
                               Points* x, Points* v, real* pull)
{
    for (int i = 0; i < NODES; ++i)
    {
        const Points at = out_of_head(head, load_lanes(rest_position + i * 3 * LANES));
        x[i] = select_points(x[i], at, which);
        v[i] = select_points(v[i], velocity, which);
        pull[i] = select(pull[i], (real)(0.0f), which);
    }
}

kernel void simulate_direct(global float* position, global float* velocity, global float* multiplier,
                            global const float* tension, global float* tension_next, global const int* pace,
                            global int* pace_next, global const float* root_position,
                            global const float* root_direction, global const float* segment_length,
                            global const float* rest_position, global const float* rest_bend,
#ifdef HELD
                            global const int* held_nodes,
#endif
#ifdef THIN
                            global const int* thinned,
#endif
                            global const float* root_normal, global const float* bend_factor,
                            global const float* gradient, global int* density, global int* touched,
                            global const float* still, global float* still_next, global float* pushed,
                            global float* moved, global int* resets, global int* faults,
                            global const float* body_distance, constant Capsule* bodies, constant StepPath* path,
                            constant HairParams* params, constant StepInfo* info)
{
    const int strand = get_global_id(0) * WIDTH; // of the first lane
    if (strand >= (info->guides + LANES - 1) / LANES * LANES)
        return;
    const int block = strand / LANES;
#ifdef THIN
    if ((thinned[block] & THIN_NOW) != THIN)
        return;
#endif
    const int first = strand_value(strand, 0, 0, NODES), root = strand_value(strand, 0, 0, 1);
    const int first_scalar = block * NODES * LANES + strand % LANES;
    const real rest = fmax(LANES_LOAD(segment_length + strand) * params->strand_spacing, (real)(1e-9f));

    if (sleeps(still, block))
    {
        LANES_STORE(LANES_LOAD(tension + strand), tension_next + strand);
        if (strand % LANES == 0)
            pace_next[block] = pace[block];
        real since = LANES_LOAD(still + strand);
#ifdef REPULSION
        Points change = minus(push_along(gradient, position + first, info), load_lanes(pushed + root));
        const float woken_by = WOKEN_BY * (float)(NODES - 2);
        since = select(since, (real)(0.0f), dot_lanes(change, change) > woken_by * woken_by);
#endif
        LANES_STORE(since, still_next + strand);
#ifdef DENSITY
        if (info->last_substep)
            add_strands_density(density, touched, position, strand, info);
#endif
        return;
    }

    // pace: 0 at the start, else 1 + that of the last step.
    const int before = pace[block];
    const int pace_now = pace_for(tension, segment_length, block, max(before - 1, 0), params, info);
    const int substeps = substeps_of(pace_now);
    const float h = info->substep / (float)substeps;

#ifdef HELD
    const held_count held = LANES_LOAD(held_nodes + strand);
    int most_held = 2;
    while (most_held < NODES && any_lane(most_held < held))
        ++most_held;
#else
    const held_count held = 2;
#endif
    const Points root_local = load_lanes(root_position + root), direction_local = load_lanes(root_direction + root);
    const HeadPose begin = head_pose(path, 0), end = head_pose(path, STEP_PARTS);

    // Where the strand was, carried along rigidly if the head has just jumped.
    Points x[NODES], v[NODES], move[NODES], a[NODES];
    real pull[NODES];
    whole bad_position = (whole)(0), bad_motion = (whole)(0);
    const Points head_velocity =
        points((real)(info->head_velocity.x), (real)(info->head_velocity.y), (real)(info->head_velocity.z));
    for (int i = 0; i < NODES; ++i)
    {
        x[i] = turn_by(info->turn_row0, info->turn_row1, info->turn_row2, load_lanes(position + first + i * 3 * LANES));
        v[i] = minus(load_lanes(velocity + first + i * 3 * LANES), head_velocity);
        v[i] = plus(turn_by(info->turn_row0, info->turn_row1, info->turn_row2, v[i]), head_velocity);
        pull[i] = LANES_LOAD(multiplier + first_scalar + i * LANES);
        bad_position |= !(fabs(x[i].x) + fabs(x[i].y) + fabs(x[i].z) < 1e6f);
        bad_motion |= !(fabs(v[i].x) + fabs(v[i].y) + fabs(v[i].z) + fabs(pull[i]) < 1e30f);
    }
    // A strand that came in bad starts again from its rest shape; its neighbours do not notice.
    const whole came_bad = bad_position | bad_motion;
    if (any_lane(came_bad))
        start_again(came_bad, begin, rest_position + first, head_velocity, x, v, pull);
    // From here on what a node moves in a substep at its velocity: to and fro each substep, h times the float nearest
    // to 1 / h would be a drag of its own, 6e-5 1/s with 16 substeps.
    for (int i = 0; i < NODES; ++i)
        v[i] = times((real)(h), v[i]);

    const float tip_mass = info->tip_mass;
#ifdef BENDING
    // Stiffness over mass, 1/s^2: from the droop number, E I / (rho S) = g L^3 / Gamma, or from the modulus.
    const real per_length = 1.0f / rest;
    const real stiffness =
        fmin(per_length * (info->bend_droop + info->bend_modulus * per_length * per_length * per_length) *
                 LANES_LOAD(bend_factor + strand),
             (real)(info->bend_most));
    lane_share weight[NODES];
    element_weights(params->bending_attenuation, params->bending_along, held, weight);
    Factor factor;
    factor_bending(&factor, weight, stiffness * (h * path->drag[PACES * DRAG_WITHIN + pace_now].y), tip_mass, held);
#endif
#ifdef CONTACT
    Bodies near;
    bodies_near(&near, bodies, info, begin, end, x[1], rest * (float)NODES);
#ifdef BODY_GRID
    near.grid = body_distance;
    near.info = info;
    const Points carried = points((real)(info->origin_move.x), (real)(info->origin_move.y), (real)(info->origin_move.z));
    find_planes(&near, begin, x, v, times((real)(1.0f / (float)substeps), carried), substeps);
#endif
    // Hair that starts inside a body is let out at a bounded speed; where its root lies inside, along its length.
    real inside[NODES];
    for (int i = 1; i < NODES && any_near(&near); ++i)
    {
        real gap = nearest_capsule(&near, begin, x[i]).distance;
#ifdef BODY_GRID
        gap = fmin(gap, near.distance[i]);
#endif
        inside[i] = fmax(-gap, (real)(0.0f));
    }
#endif
#ifdef WIND
    Points wind[NODES];
    for (int i = 2; i < NODES; ++i)
        wind[i] = wind_at(x[i], info);
#endif
#ifdef REPULSION
    Points push[NODES], pushed_by = points((real)(0.0f), (real)(0.0f), (real)(0.0f));
    for (int i = 2; i < NODES; ++i)
    {
        push[i] = repulsion_at(gradient, x[i], info);
        pushed_by = plus(pushed_by, push[i]);
    }
    store_lanes(pushed_by, pushed + root);
#endif

    real tensest = (real)(0.0f);
    whole bad = (whole)(0);
    for (int substep = 0; substep < substeps; ++substep)
    {
        const int parts = STEP_PARTS / substeps;
        const HeadPose last = head_pose(path, substep * parts), now = head_pose(path, (substep + 1) * parts);
        const float4 drag = path->drag[PACES * (substep ? DRAG_WITHIN : before) + pace_now];
        const float keep = drag.x, hg = h * drag.y;
        for (int line = substep; line < 3 * NODES; line += substeps) // of the next block
        {
            FETCH_SOON(position + first + (3 * NODES + line) * LANES);
            FETCH_SOON(velocity + first + (3 * NODES + line) * LANES);
            if (line < NODES)
                FETCH_SOON(multiplier + first_scalar + (NODES + line) * LANES);
        }

        // Nodes 0 and 1: the segment under the scalp.
        const Points root_now = out_of_head(now, root_local);
        const Points along = turn_by(now.row0, now.row1, now.row2, direction_local);
        for (int i = 1; i < NODES; ++i)
            a[i] = minus(x[i], x[i - 1]);
        move[1] = minus(root_now, x[1]);
        move[0] = minus(minus(root_now, times(rest, along)), x[0]);

        for (int i = 2; i < NODES; ++i)
        {
            Points f = points((real)(0.0f), (real)(info->gravity), (real)(0.0f));
#ifdef WIND
            f = plus(f, across_wind(wind[i], i + 1 < NODES ? plus(a[i], a[i + 1]) : a[i]));
#endif
#ifdef REPULSION
            f = plus(f, push[i]);
#endif
            const float mass = i + 1 < NODES ? 1.0f : tip_mass;
            move[i] = times((real)(mass), plus(times((real)(keep), v[i]), times((real)(hg), f)));
            move[i] = minus(move[i], times(hg * pull[i], a[i]));
            if (i + 1 < NODES)
                move[i] = plus(move[i], times(hg * pull[i + 1], a[i + 1]));
        }
        if (isinf(tip_mass)) // held where it is: its inverse mass is 0
            move[NODES - 1] = points((real)(0.0f), (real)(0.0f), (real)(0.0f));
#ifdef HELD
        for (int i = 2; i < most_held; ++i)
        {
            const Points carried = out_of_head(now, load_lanes(rest_position + first + i * 3 * LANES));
            move[i] = select_points(move[i], minus(carried, x[i]), i < held);
        }
#endif
#ifdef BENDING
        add_bending(x, move, along, rest, hg * stiffness, weight, held
#ifdef CURLED
                    ,
                    turn_by(now.row0, now.row1, now.row2, load_lanes(root_normal + root)), rest_bend + first
#endif
        );
        solve_bending(&factor, move);
#else
        move[NODES - 1] = times((real)(1.0f / tip_mass), move[NODES - 1]);
#endif

#ifdef CONTACT
        for (int i = 2; i < NODES && any_near(&near); ++i)
        {
            const real still = inside[1] - GROWS_OUT * (float)(i - 1) * rest;
            inside[i] = fmax(inside[i] - info->push_out * h, fmax(still, (real)(0.0f)));
            Points pushed = move[i];
#ifdef BODY_GRID
            push_off_plane(&near, last, now, i, x[i], &pushed, inside[i], params->forces_friction);
#endif
            if (near.near_count > 0)
                push_off_capsules(&near, last, now, x[i], &pushed, inside[i], params->forces_friction);
            move[i] = POINTS_UNLESS_HELD(i, held, move[i], pushed);
        }
#endif

        Points predicted[NODES];
        for (int i = 2; i < NODES; ++i)
            predicted[i] = move[i];
        real kept = (real)(1.0f);
        whole open = (whole)(-1);
        real residual = (real)(0.0f);
        for (int newton = 0; newton < MOST_NEWTON && any_lane(open); ++newton)
        {
            keep_lengths_direct(a, move, pull, rest, (real)(hg), tip_mass, held, open);
            residual = length_residual(a, move, rest, held);
            open &= residual >= LENGTH_TOLERANCE;
        }
        const whole failed = open & (residual >= 4.0f * LENGTH_TOLERANCE);
        const int any_rescued = any_lane(failed);
        if (any_rescued)
            kept = rescue(x, predicted, move, pull, rest, tip_mass, held, failed, &bad);

#ifdef CONTACT
        const int exact = substep + 1 == substeps;
        const whole meets = exact ? (whole)(-1) : pulled_in(&near, now, x, move, rest, held, inside);
        if (any_near(&near) && any_lane(meets))
        {
            Points walked[NODES];
            for (int i = 1; i < NODES; ++i)
                walked[i] = plus(x[i], move[i]);
            const whole touched = walk_out(&near, now, walked, rest, held, inside, exact) & meets;
            if (any_lane(touched))
                for (int i = 2; i < NODES; ++i)
                    move[i] = select_points(move[i], minus(walked[i], x[i]), touched);
        }
#endif

        for (int i = 0; i < NODES; ++i)
        {
            v[i] = move[i];
            if (i > 1 && any_rescued)
            {
                const Points spared = plus(move[1], times(kept, minus(move[i], move[1])));
                v[i] = POINTS_UNLESS_HELD(i, held, move[i], select_points(v[i], spared, failed));
            }
            x[i] = plus(x[i], move[i]);
            tensest = fmax(tensest, fabs(pull[i]));
        }
    }

    const float per_second = 1.0f / h;
    for (int i = 0; i < NODES; ++i)
        v[i] = times((real)(per_second), v[i]);
    for (int i = 2; i < NODES; ++i)
        bad |= !(fabs(x[i].x) + fabs(x[i].y) + fabs(x[i].z) < 1e6f);
    if (any_lane(bad))
        start_again(bad, end, rest_position + first, head_velocity, x, v, pull);

    real farthest2 = (real)(0.0f);
    for (int i = 0; i < NODES; ++i)
    {
        const Points by = minus(x[i], load_lanes(position + first + i * 3 * LANES));
        farthest2 = fmax(farthest2, dot_lanes(by, by));
        x[i] = points(x[i].x - info->origin_move.x, x[i].y - info->origin_move.y, x[i].z - info->origin_move.z);
        store_lanes(x[i], position + first + i * 3 * LANES);
        store_lanes(v[i], velocity + first + i * 3 * LANES);
        LANES_STORE(pull[i], multiplier + first_scalar + i * LANES);
    }
    const real farthest = sqrt(farthest2);
    LANES_STORE(fmax(LANES_LOAD(moved + strand), farthest), moved + strand);
    const whole calm = farthest < SLEEP_SPEED * info->substep * (float)(NODES - 2) * rest;
    LANES_STORE(select((real)(0.0f), LANES_LOAD(still + strand) + info->substep, calm), still_next + strand);
    LANES_STORE(select(tensest, (real)(0.0f), bad | !(tensest < 1e30f)), tension_next + strand);
    if (strand % LANES == 0)
        pace_next[block] = 1 + pace_now;

    note_faults(resets, faults, strand, info->guides, bad_position, bad_motion, came_bad | bad);

#ifdef DENSITY
    if (info->last_substep)
        add_strands_density(density, touched, position, strand, info);
#endif
}

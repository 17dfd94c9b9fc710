// One substep of the guides: roots follow the head, forces, prediction, constraints, velocities (thesis 5.1.2, listing
// A.1, with velocities kept instead of previous positions: position Verlet loses gravity in float at small steps).
//
//   v  <- v e^(-b h) + a (1 - e^(-b h)) / b          drag exactly, any b h
//   x* <- x + h v,  constraints on x*,  v <- (x* - x) / h
//
// Work-item: WIDTH strands. NODES, RESOLUTION and the features WIND, REPULSION, DENSITY, BODY_GRID and HELD are
// build options.
#include "contact.h"
#include "distance_grid.h"
#include "faults.h"
#include "forces.h"
#include "lanes.h"
#include "pbd.h"

#ifdef BODY_GRID
// Where the head's surface is about a node: body[0..2] its normal, body[3] the level of its plane.
static inline void find_body(real x, real y, real z, real* body, global const float* body_distance,
                             constant StepInfo* info)
{
    const BodyPlane plane = body_plane(body_distance, x, y, z, info);
    body[0] = plane.nx;
    body[1] = plane.ny;
    body[2] = plane.nz;
    body[3] = plane.nx * x + plane.ny * y + plane.nz * z - plane.distance;
}
#endif

#define CLOSING_TURNS 8
#define MOST_STRETCH 1.005f // of a segment whose stretching is 1
#define MOST_RUBBER 4.0f    // of one whose stretching is less: without any constraint hair would fall for ever

static inline void turn(real* x, real* y, real* z, constant StepInfo* info)
{
    const real a = *x, b = *y, c = *z;
    *x = info->turn_row0.x * a + info->turn_row0.y * b + info->turn_row0.z * c;
    *y = info->turn_row1.x * a + info->turn_row1.y * b + info->turn_row1.z * c;
    *z = info->turn_row2.x * a + info->turn_row2.y * b + info->turn_row2.z * c;
}

// Puts the held nodes of those from `begin` to `end` where the head has them at rest.
#ifdef HELD
static inline void hold_nodes(real* x, real* y, real* z, int begin, int end, global const float* rest_position,
                              whole held, constant StepInfo* info)
{
    for (int i = begin; i < end && any_lane(i < held); ++i)
    {
        const Points at =
            turn_by(info->head_row0, info->head_row1, info->head_row2, load_lanes(rest_position + i * 3 * LANES));
        x[i] = select(x[i], at.x, i < held);
        y[i] = select(y[i], at.y, i < held);
        z[i] = select(z[i], at.z, i < held);
    }
}
#define HOLD_NODES(begin, end) hold_nodes(x, y, z, begin, end, rest_position + first, held, info)
#else
#define HOLD_NODES(begin, end)
#endif

kernel void simulate_pbd(global float* position, global float* velocity, global const float* root_position,
                         global const float* root_direction, global const float* segment_length,
#ifdef HELD
                         global const float* rest_position, global const int* held_nodes,
#endif
                         global const float* gradient, global int* density, global int* touched, global int* resets, global int* faults,
                         global const float* body_distance, constant Capsule* colliders, constant HairParams* params,
                         constant StepInfo* info)
{
    const int strand = get_global_id(0) * WIDTH; // of the first lane
    if (strand >= (info->guides + LANES - 1) / LANES * LANES)
        return;
    const int first = strand_value(strand, 0, 0, NODES);
    const int root = strand_value(strand, 0, 0, 1);
    const real rest = LANES_LOAD(segment_length + strand) * params->strand_spacing;
    const float h = info->substep;
#ifdef HELD
    const held_count held = LANES_LOAD(held_nodes + strand);
#else
    const held_count held = 2;
#endif

    // Where the strand was, carried along rigidly if the head has just jumped.
    real ox[NODES], oy[NODES], oz[NODES];
    whole bad_position = (whole)(0), bad_motion = (whole)(0); // before the step
    for (int i = 0; i < NODES; ++i)
    {
        ox[i] = LANES_LOAD(position + first + i * 3 * LANES);
        oy[i] = LANES_LOAD(position + first + (i * 3 + 1) * LANES);
        oz[i] = LANES_LOAD(position + first + (i * 3 + 2) * LANES);
        turn(&ox[i], &oy[i], &oz[i], info);
        bad_position |= !(fabs(ox[i]) + fabs(oy[i]) + fabs(oz[i]) < 1e6f);
    }

    // Nodes 0 and 1: the segment under the scalp.
    real x[NODES], y[NODES], z[NODES];
    const real rx = LANES_LOAD(root_position + root), dx = LANES_LOAD(root_direction + root);
    const real ry = LANES_LOAD(root_position + root + LANES), dy = LANES_LOAD(root_direction + root + LANES);
    const real rz = LANES_LOAD(root_position + root + 2 * LANES), dz = LANES_LOAD(root_direction + root + 2 * LANES);
    const float4 r0 = info->head_row0, r1 = info->head_row1, r2 = info->head_row2;
    const real wx = r0.x * dx + r0.y * dy + r0.z * dz;
    const real wy = r1.x * dx + r1.y * dy + r1.z * dz;
    const real wz = r2.x * dx + r2.y * dy + r2.z * dz;
    x[1] = r0.x * rx + r0.y * ry + r0.z * rz;
    y[1] = r1.x * rx + r1.y * ry + r1.z * rz;
    z[1] = r2.x * rx + r2.y * ry + r2.z * rz;
    x[0] = x[1] - rest * wx;
    y[0] = y[1] - rest * wy;
    z[0] = z[1] - rest * wz;

    for (int i = 2; i < NODES; ++i)
    {
        real vx = LANES_LOAD(velocity + first + i * 3 * LANES) - info->head_velocity.x;
        real vy = LANES_LOAD(velocity + first + (i * 3 + 1) * LANES) - info->head_velocity.y;
        real vz = LANES_LOAD(velocity + first + (i * 3 + 2) * LANES) - info->head_velocity.z;
        turn(&vx, &vy, &vz, info);
        bad_motion |= !(fabs(vx) + fabs(vy) + fabs(vz) < 1e30f);
        Points f = points((real)(0.0f), (real)(info->gravity), (real)(0.0f));
        const Points at = points(ox[i], oy[i], oz[i]);
#ifdef WIND
        const int next = min(i + 1, NODES - 1);
        const Points pushed =
            across_wind(wind_at(at, info), points(ox[next] - ox[i - 1], oy[next] - oy[i - 1], oz[next] - oz[i - 1]));
        f = points(f.x + pushed.x, f.y + pushed.y, f.z + pushed.z);
#endif
#ifdef REPULSION
        const Points push = repulsion_at(gradient, at, info);
        f = points(f.x + push.x, f.y + push.y, f.z + push.z);
#endif
        vx = (vx + info->head_velocity.x) * info->drag_keep + f.x * info->drag_gain;
        vy = (vy + info->head_velocity.y) * info->drag_keep + f.y * info->drag_gain;
        vz = (vz + info->head_velocity.z) * info->drag_keep + f.z * info->drag_gain;
        x[i] = ox[i] + h * vx - info->origin_move.x;
        y[i] = oy[i] + h * vy - info->origin_move.y;
        z[i] = oz[i] + h * vz - info->origin_move.z;
    }
    HOLD_NODES(2, NODES);

    // Eq. 5.6, a lane a node: powers are dear.
    float bend[NODES + WIDTH];
    for (int i = 0; i < NODES; i += WIDTH)
    {
        float beyond[WIDTH];
        for (int lane = 0; lane < WIDTH; ++lane)
            beyond[lane] = (float)max(i + lane - 1, 1);
        const real attenuated = info->bend * exp(-params->solver_bending_attenuation * log(LANES_LOAD(beyond)));
        LANES_STORE(fmin(fmax(attenuated, (real)(0.0f)), (real)(1.0f)), bend + i);
    }

    // The colliders that these strands can reach.
    const float reach = (float)NODES * 1.2f; // segments, stretched ones too
    short near[MOST_COLLIDERS];
    int near_count = 0;
    for (int c = 0; c < info->colliders; ++c)
    {
        real ax, ay, az;
        nearest_on_axis(colliders[c], x[1], y[1], z[1], &ax, &ay, &az);
        ax = x[1] - ax;
        ay = y[1] - ay;
        az = z[1] - az;
        const real far = colliders[c].center.w + reach * rest;
        if (any_lane(ax * ax + ay * ay + az * az < far * far))
            near[near_count++] = (short)c;
    }

#ifdef BODY_GRID
    // A plane stands for the head in the sweeps: fetched once, from where the node would go.
    real body[NODES][4];
    for (int i = 2; i < NODES; ++i)
        find_body(x[i], y[i], z[i], body[i], body_distance, info);
#endif

    for (int sweep = 0; sweep < params->solver_iterations; ++sweep)
    {
        // Over-relaxed but for the last sweep, which leaves no overshoot (Young 1950; make_step_info has the factor).
        const float strength = sweep + 1 < params->solver_iterations ? info->stretch * info->relax : info->stretch;
        for (int line = sweep; line < 3 * NODES; line += params->solver_iterations) // of the next block
        {
            FETCH_SOON(position + first + (3 * NODES + line) * LANES);
            FETCH_SOON(velocity + first + (3 * NODES + line) * LANES);
        }
#ifdef BODY_GRID
        for (int i = 2; i < NODES; ++i)
            push_above(&x[i], &y[i], &z[i], body[i][0], body[i][1], body[i][2], body[i][3]);
#endif
        for (int c = 0; c < near_count; ++c)
            for (int i = 2; i < NODES; ++i)
                push_out(&x[i], &y[i], &z[i], colliders[near[c]]);
        HOLD_NODES(2, NODES);
        keep_lengths(x, y, z, rest, strength, held, 2);
        keep_lengths(x, y, z, rest, strength, held, 1);
        if (info->bend > 0.0f)
            straighten(x, y, z, rest, params->solver_bending_scale, bend, held);
    }

    // The last word, in one walk from root to tip: hair that shall not stretch is taken back to its length, and hair
    // leaves the colliders, in turns, because either may undo a little of the other, and so may leaving one of two
    // spheres that overlap; colliders have the second half of the turns to themselves. Each node's parent is done by
    // then. A strand that the colliders have not pushed is done with its node, however often its neighbours come again,
    // for their need must not change its bits.
    const real most = rest * (params->solver_stretching >= 1.0f ? MOST_STRETCH : MOST_RUBBER);
    for (int i = 2; i < NODES; ++i)
    {
        whole loose = (whole)(-1);
        for (int turns = 0; turns < CLOSING_TURNS; ++turns)
        {
#ifdef BODY_GRID
            const int looks = turns % 3 == 0; // at the head: when the walk comes, when lengths are done, and last
#else
            const int looks = 1;
#endif
            Points to = points(x[i], y[i], z[i]);
            if (turns < CLOSING_TURNS / 2)
                limit_length(&to.x, &to.y, &to.z, x[i - 1], y[i - 1], z[i - 1], most);
            const Points kept = to;
#ifdef BODY_GRID
            if (looks)
                find_body(to.x, to.y, to.z, body[i], body_distance, info);
            push_above(&to.x, &to.y, &to.z, body[i][0], body[i][1], body[i][2], body[i][3]);
#endif
            for (int c = 0; c < near_count; ++c)
                push_out(&to.x, &to.y, &to.z, colliders[near[c]]);
            x[i] = select(x[i], to.x, loose);
            y[i] = select(y[i], to.y, loose);
            z[i] = select(z[i], to.z, loose);
            HOLD_NODES(i, i + 1);
            if (looks)
                loose &= (x[i] != kept.x) | (y[i] != kept.y) | (z[i] != kept.z);
            if (!any_lane(loose))
                break;
        }
    }

    // A strand that is not finite, or came in so, starts again from its rest shape; its neighbours do not notice.
    whole bad = bad_position | bad_motion;
    for (int i = 2; i < NODES; ++i)
        bad |= !(fabs(x[i]) + fabs(y[i]) + fabs(z[i]) < 1e6f);
    for (int i = 2; i < NODES; ++i)
    {
        x[i] = select(x[i], x[1] + rest * (float)(i - 1) * wx, bad != 0);
        y[i] = select(y[i], y[1] + rest * (float)(i - 1) * wy, bad != 0);
        z[i] = select(z[i], z[1] + rest * (float)(i - 1) * wz, bad != 0);
    }
#ifdef HELD // one that a tie holds, from where it rests in it
    hold_nodes(x, y, z, 2, NODES, rest_position + first, select(held, (whole)(NODES), bad & (held > 2)), info);
#endif

    const float per_second = 1.0f / h;
    for (int i = 0; i < NODES; ++i)
    {
        LANES_STORE(x[i], position + first + i * 3 * LANES);
        LANES_STORE(y[i], position + first + (i * 3 + 1) * LANES);
        LANES_STORE(z[i], position + first + (i * 3 + 2) * LANES);
        const real moved_x = x[i] - ox[i] + info->origin_move.x;
        const real moved_y = y[i] - oy[i] + info->origin_move.y;
        const real moved_z = z[i] - oz[i] + info->origin_move.z;
        LANES_STORE(select(moved_x * per_second, (real)(info->head_velocity.x), bad != 0),
                    velocity + first + i * 3 * LANES);
        LANES_STORE(select(moved_y * per_second, (real)(info->head_velocity.y), bad != 0),
                    velocity + first + (i * 3 + 1) * LANES);
        LANES_STORE(select(moved_z * per_second, (real)(info->head_velocity.z), bad != 0),
                    velocity + first + (i * 3 + 2) * LANES);
    }

    note_faults(resets, faults, strand, info->guides, bad_position, bad_motion, bad);

#ifdef DENSITY
    if (info->last_substep)
        add_strands_density(density, touched, position, strand, info);
#endif
}

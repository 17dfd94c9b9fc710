// The direct solver's two banded solves, and what happens where they do not do.
//
// Masses are those of the nodes: 1 inside, info->tip_mass at the tip, none movable before node 2 or, with HELD, before
// the node that each lane's `held` says: those go where the head takes them, move[k] says where. a[k] is the segment
// from node k - 1 to node k when the substep began; move[k] is how far node k goes in it. Increments, not positions:
// a float holds the small difference, not the large sum.
#ifndef COIF_DIRECT_H
#define COIF_DIRECT_H
#include "curve.h"
#include "drawn_lanes.h"
#include "held.h"

static inline lane_share inverse_mass(int node, float tip_mass, held_count held)
{
    return HELD_SHARE(node < held, 0.0f, node == NODES - 1 ? 1.0f / tip_mass : 1.0f);
}

// Newton's equation for the length constraints |a + change|^2 = l^2 with corrections along a, the directions at the
// start of the step (SHAKE: Ryckaert, Ciccotti, Berendsen 1977), one tridiagonal solve (Thomas). Moves the nodes of the
// strands in `which` and adds what it took to `multiplier` (times hg, so that multipliers are 1/s^2).
static inline void keep_lengths_direct(const Points* a, Points* move, real* multiplier, real rest, real hg,
                                       float tip_mass, held_count held, whole which)
{
    real upper[NODES], right[NODES];
    real last_upper = (real)(0.0f), last_right = (real)(0.0f);
    const real rest2 = rest * rest, least_pivot = 1e-3f * rest2;
    for (int k = 2; k < NODES; ++k)
    {
        const Points d = plus(a[k], minus(move[k], move[k - 1]));
        const lane_share w_before = inverse_mass(k - 1, tip_mass, held), w = inverse_mass(k, tip_mass, held);
        // Nothing can be done about a segment of which both ends are held.
        const real excess2 = UNLESS_HELD(k, held, (real)(0.0f), 0.5f * (dot_lanes(d, d) - rest2));
        const real lower = k > 2 ? -w_before * dot_lanes(d, a[k - 1]) : (real)(0.0f);
        const real above = k + 1 < NODES ? -w * dot_lanes(d, a[k + 1]) : (real)(0.0f);
        real pivot = (w_before + w) * dot_lanes(d, a[k]) - lower * last_upper;
        pivot = select(pivot, least_pivot, fabs(pivot) < least_pivot); // a segment that turns by a right angle
        const real inverse = 1.0f / pivot;
        last_upper = upper[k] = above * inverse;
        last_right = right[k] = (excess2 - lower * last_right) * inverse;
    }
    real pull = (real)(0.0f);
    Points after = points(pull, pull, pull); // what the constraint beyond this node does
    const real per_hg = 1.0f / hg;
    for (int k = NODES - 1; k > 1; --k)
    {
        pull = right[k] - (k + 1 < NODES ? upper[k] * pull : (real)(0.0f));
        const real taken = select((real)(0.0f), pull, which);
        const Points along = times(taken, a[k]);
        move[k] = plus(move[k], times((real)(inverse_mass(k, tip_mass, held)), minus(after, along)));
        multiplier[k] += taken * per_hg;
        after = along;
    }
}

// The largest of | |d|^2 - l^2 | / l^2 along each strand; not below any bound where it is not a number.
static inline real length_residual(const Points* a, const Points* move, real rest, held_count held)
{
    const real rest2 = rest * rest;
    real worst = (real)(0.0f);
    whole lost = (whole)(0);
    for (int k = 2; k < NODES; ++k)
    {
        const Points d = plus(a[k], minus(move[k], move[k - 1]));
        const real off = UNLESS_HELD(k, held, (real)(0.0f), fabs(dot_lanes(d, d) - rest2));
        lost |= !(off < 1e30f);
        worst = fmax(worst, off);
    }
    return select(worst / rest2, (real)(1e30f), lost);
}

static inline Points cross_lanes(Points a, Points b)
{
    return points(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// Some unit vector across the unit vector t.
static inline Points any_normal(Points t)
{
    const Points side =
        select_points(points((real)(0.0f), t.z, -t.y), points(-t.z, (real)(0.0f), t.x), fabs(t.x) > 0.6f);
    return times(INVERSE_SQRT(dot_lanes(side, side)), side);
}

#ifdef BENDING
// Bending energy k/2 sum_e w_e |x[e-1] - 2 x[e] + x[e+1] - rest bend|^2, twice at the clamp (accuracy.md: half a cell);
// its matrix is constant (quadratic bending: Bergou, Wardetzky, Harmon, Zorin, Grinspun 2006), so one LDL^T of
// M + stiffness K serves the whole step.
typedef struct Factor
{
    real inverse_pivot[NODES], lower1[NODES], lower2[NODES];
} Factor;

// Share of the stiffness at the element about node e: it fades by exp(-attenuation) from root to tip, and follows a
// profile.
static inline void element_weights(float attenuation, float4 profile, held_count held, lane_share* weight)
{
    weight[0] = 0.0f;
    for (int e = 1; e + 1 < NODES; ++e)
        weight[e] = HELD_SHARE(e == held - 1, 2.0f, 1.0f) * exp(-attenuation * (float)(e - 1) / (float)(NODES - 2)) *
                    profile_at(profile, (float)(e - 1) / (float)(NODES - 2));
    weight[NODES - 1] = 0.0f;
}

// Rows of held nodes are their own: what they do to others is known, and stands on the right (add_bending).
static inline void factor_bending(Factor* f, const lane_share* weight, real stiffness, float tip_mass, held_count held)
{
    real pivot[NODES];
    for (int i = 0; i < NODES; ++i)
        f->lower1[i] = f->lower2[i] = (real)(0.0f);
    for (int i = 2; i < NODES; ++i)
    {
        const float mass = i + 1 < NODES ? 1.0f : tip_mass;
        const lane_share beyond = i + 1 < NODES ? weight[i + 1] : (lane_share)(0.0f);
        real p = mass + stiffness * (weight[i - 1] + 4.0f * weight[i] + beyond);
        if (i > 2)
            p -= f->lower1[i] * f->lower1[i] * pivot[i - 1];
        if (i > 3)
            p -= f->lower2[i] * f->lower2[i] * pivot[i - 2];
        p = UNLESS_HELD(i, held, (real)(1.0f), p);
        pivot[i] = p;
        const real inverse = f->inverse_pivot[i] = 1.0f / p; // at least the mass
        if (i + 1 < NODES)
        {
            real s = stiffness * (-2.0f * (weight[i] + beyond));
            if (i > 2)
                s -= f->lower2[i + 1] * f->lower1[i] * pivot[i - 1];
            f->lower1[i + 1] = UNLESS_HELD(i, held, (real)(0.0f), s * inverse);
        }
        if (i + 2 < NODES)
            f->lower2[i + 2] = UNLESS_HELD(i, held, (real)(0.0f), stiffness * beyond * inverse);
    }
}

// Adds the bending forces, times `scale`, to `move`. x holds the nodes when the substep began; the prescribed ones are
// taken as they will be when it ends, so that the implicit step sees the clamp turn: their moves are known.
// With CURLED each element bends towards rest_bend[e], which lies in a frame that is carried from the root along the
// strand by the smallest rotations (Bergou et al. 2008, section 4.2.2).
static inline void add_bending(const Points* x, Points* move, Points along, real rest, real scale,
                               const lane_share* weight, held_count held
#ifdef CURLED
                               ,
                               Points normal, global const float* rest_bend
#endif
)
{
    Points before = times(rest, along);
    Points node = plus(x[1], move[1]);
#ifdef CURLED
    Points tangent = along, tangents[NODES], torque[NODES];
    real per_length[NODES];
    tangents[1] = along;
    torque[NODES - 1] = points((real)(0.0f), (real)(0.0f), (real)(0.0f));
#endif
    for (int e = 1; e + 1 < NODES; ++e)
    {
        const Points next_node = POINTS_UNLESS_HELD(e + 1, held, plus(x[e + 1], move[e + 1]), x[e + 1]);
        const Points after = minus(next_node, node);
        Points off = minus(after, before);
#ifdef CURLED
        const Points bend = load_lanes(rest_bend + e * 3 * LANES);
        const Points binormal = cross_lanes(tangent, normal);
        const Points towards = plus(plus(times(bend.x, tangent), times(bend.y, normal)), times(bend.z, binormal));
        off = minus(off, towards);
        torque[e] = times(scale * weight[e], cross_lanes(towards, off));
        const real squared = dot_lanes(after, after);
        const Points next = select_points(tangent, times(INVERSE_SQRT(fmax(squared, 1e-12f * rest * rest)), after),
                                          squared > 1e-12f * rest * rest);
        const real turn = 1.0f + dot_lanes(tangent, next);
        const real by = select((real)(0.0f), dot_lanes(normal, next) / fmax(turn, (real)(1e-4f)), turn > 1e-4f);
        normal = minus(normal, times(by, plus(tangent, next)));
        normal = minus(normal, times(dot_lanes(normal, next), next)); // rounding; and where the strand folds back
        const real size = dot_lanes(normal, normal);
        normal = select_points(any_normal(next), times(INVERSE_SQRT(fmax(size, (real)(1e-12f))), normal), size > 1e-6f);
        tangent = tangents[e + 1] = next;
        per_length[e + 1] = INVERSE_SQRT(fmax(squared, 0.1f * rest * rest)); // no segment is as short as that for long
#endif
        off = times(scale * weight[e], off);
        if (e > 2)
            move[e - 1] = POINTS_UNLESS_HELD(e - 1, held, move[e - 1], minus(move[e - 1], off));
        if (e > 1)
            move[e] = POINTS_UNLESS_HELD(e, held, move[e], plus(move[e], times((real)(2.0f), off)));
        move[e + 1] = POINTS_UNLESS_HELD(e + 1, held, move[e + 1], minus(move[e + 1], off));
        before = after;
        node = next_node;
    }
#ifdef CURLED
    // What turns an element's target turns the frame that it lies in: its segment, and by the twist that goes with the
    // turning of all segments before it. Without this the forces have no energy, and tight ringlets flap.
    real twist = (real)(0.0f);
    Points beyond = torque[NODES - 1];
    for (int e = NODES - 2; e > 1; --e)
    {
        const Points t = tangents[e], previous = tangents[e - 1];
        twist += dot_lanes(torque[e], t);
        const Points here = times(twist / fmax(1.0f + dot_lanes(previous, t), (real)(0.05f)), cross_lanes(previous, t));
        Points push = minus(cross_lanes(torque[e], t), plus(here, beyond));
        push = times(per_length[e], minus(push, times(dot_lanes(push, t), t)));
        move[e] = POINTS_UNLESS_HELD(e, held, move[e], plus(move[e], push));
        if (e > 2)
            move[e - 1] = POINTS_UNLESS_HELD(e - 1, held, move[e - 1], minus(move[e - 1], push));
        beyond = here;
    }
#endif
}

static inline void solve_bending(const Factor* f, Points* move)
{
    for (int i = 3; i < NODES; ++i)
    {
        move[i] = minus(move[i], times(f->lower1[i], move[i - 1]));
        if (i > 3)
            move[i] = minus(move[i], times(f->lower2[i], move[i - 2]));
    }
    for (int i = NODES - 1; i > 1; --i)
    {
        move[i] = times(f->inverse_pivot[i], move[i]);
        if (i + 1 < NODES)
            move[i] = minus(move[i], times(f->lower1[i + 1], move[i + 1]));
        if (i + 2 < NODES)
            move[i] = minus(move[i], times(f->lower2[i + 2], move[i + 2]));
    }
}
#endif

// For strands whose length solve failed: over-relaxed sweeps from the prediction, then each node at its length from its
// parent (Mueller, Kim, Chentanez 2012). Cannot fail: whatever comes in, what goes out is a chain of that length.
// Not from where the failed solve has left them: that may be anywhere. `predicted` begins with node 2; move holds the
// prescribed nodes. Returns the share of what `move` gives the nodes for velocity, against the root, that they may
// keep: a projection takes kinetic energy from the prediction and never adds any, but the walk along the strand would,
// as it throws the outer nodes about. Strands whose prediction was no number join `bad`.
#define RESCUE_SWEEPS 8
static inline real rescue(const Points* x, const Points* predicted, Points* move, real* multiplier, real rest,
                          float tip_mass, held_count held, whole which, whole* bad)
{
    Points q[NODES];
    const Points root = plus(x[1], move[1]);
    real energy_before = (real)(0.0f), energy = (real)(0.0f);
    q[0] = plus(x[0], move[0]);
    q[1] = root;
    const Points along = minus(q[1], q[0]); // of rest length
    whole astray = (whole)(0);
    for (int k = 2; k < NODES; ++k)
    {
        // A prediction farther than two strand lengths from the root says no more than its direction.
        q[k] = plus(x[k], predicted[k]);
        const Points d = minus(q[k], root), u = minus(predicted[k], move[1]);
        const lane_share mass = HELD_SHARE(k < held, 0.0f, k + 1 < NODES ? 1.0f : tip_mass);
        energy_before += mass * dot_lanes(u, u);
        const real far2 = dot_lanes(d, d), most = 2.0f * (float)(k - 1) * rest;
        const whole far = !(far2 <= most * most), lost = !(far2 < 1e30f);
        const real shorten = most * INVERSE_SQRT(fmax(far2, 1e-12f * rest * rest));
        q[k] = select_points(q[k], plus(root, times(shorten, d)), far);
        q[k] = select_points(q[k], plus(root, times((real)((float)(k - 1)), along)), lost);
        astray |= lost;
    }
    for (int sweep = 0; sweep < 2 * RESCUE_SWEEPS; ++sweep)
        for (int k = 2 + (sweep & 1); k < NODES; k += 2)
        {
            const Points d = minus(q[k], q[k - 1]);
            const real off = 1.8f * (1.0f - rest * INVERSE_SQRT(fmax(dot_lanes(d, d), 1e-12f * rest * rest)));
            const lane_share share = HELD_SHARE(k > held, 0.5f, 1.0f);
            q[k] = POINTS_UNLESS_HELD(k, held, q[k], minus(q[k], times(share * off, d)));
            if (k > 2)
                q[k - 1] = POINTS_UNLESS_HELD(k - 1, held, q[k - 1], plus(q[k - 1], times(0.5f * off, d)));
        }
    for (int k = 2; k < NODES; ++k)
    {
        const Points d = minus(q[k], q[k - 1]);
        const real squared = dot_lanes(d, d);
        const whole none = !(squared > 1e-12f * rest * rest);
        const real scale = rest * INVERSE_SQRT(fmax(squared, 1e-12f * rest * rest));
        const Points put = plus(q[k - 1], select_points(times(scale, d), along, none));
        q[k] = POINTS_UNLESS_HELD(k, held, q[k], put);
        const Points moved = minus(q[k], x[k]), u = minus(moved, move[1]);
        const lane_share mass = HELD_SHARE(k < held, 0.0f, k + 1 < NODES ? 1.0f : tip_mass);
        energy += mass * dot_lanes(u, u);
        move[k] = select_points(move[k], moved, which);
        multiplier[k] = select(multiplier[k], (real)(0.0f), which);
    }
    *bad |= astray & which;
    const whole grown = which & !(energy <= energy_before);
    return select((real)(1.0f), select((real)(0.0f), sqrt(energy_before / energy), energy_before < energy), grown);
}

#endif

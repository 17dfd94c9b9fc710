#include "tests/oracle_direct.h"

#include "tests/oracle_strand.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace coif::oracle
{

// ---- drag ----------------------------------------------------------------------------------------------------------

// Velocity goes as u + c exp(-b t) with u = f / b. Its means over [-before, 0] and [0, now] have c in common.
Drag drag_over(double b, double before, double now)
{
    if (b < 1e-7)
        return {1.0, 0.5 * (before + now)};
    const double mean_now = -std::expm1(-b * now) / (b * now);
    const double mean_before = before > 0.0 ? std::expm1(b * before) / (b * before) : 1.0;
    const double keep = mean_now / mean_before;
    return {keep, (1.0 - keep) / b};
}

// ---- the head's way ------------------------------------------------------------------------------------------------

namespace
{
// A pose against the head's origin when the step began.
struct Place
{
    glm::dmat3 turn{1.0};
    Vec origin{0.0};

    Vec out(Vec local) const { return turn * local + origin; }
    Vec into(Vec p) const { return glm::transpose(turn) * (p - origin); }
};
} // namespace

static Place place_at(const DirectStep& step, double share)
{
    if (step.teleport)
        return {glm::mat3_cast(step.now.head.turn), Vec(0.0)};
    Pose pose = step.now.head;
    if (step.now.way && share < 1.0)
        pose = step.now.way(share);
    else if (share < 1.0)
    {
        pose.origin = glm::mix(step.before.origin, step.now.head.origin, share);
        pose.turn = glm::slerp(step.before.turn, step.now.head.turn, share);
    }
    return {glm::mat3_cast(pose.turn), pose.origin - step.before.origin};
}

// What a root is accelerated by at most: second differences over quarters of the step.
static double root_acceleration(const DirectStep& step)
{
    double most = 0.0;
    const double quarter = double(step.now.seconds) / 4.0;
    for (int i = 1; i <= 3; ++i)
    {
        const Place a = place_at(step, (i - 1) / 4.0), b = place_at(step, i / 4.0), c = place_at(step, (i + 1) / 4.0);
        const glm::dmat3 turning = a.turn - 2.0 * b.turn + c.turn;
        double turning2 = 0.0;
        for (int column = 0; column < 3; ++column)
            turning2 += glm::dot(turning[column], turning[column]);
        const double moving = glm::length(a.origin - 2.0 * b.origin + c.origin);
        most = std::max(most, (moving + step.reach * std::sqrt(turning2)) / (quarter * quarter));
    }
    return most;
}

// ---- substeps ------------------------------------------------------------------------------------------------------

// The numbers of substeps there are.
static const std::vector<int> kCounts = {1, 2, 3, 4, 6, 8, 12, 16};

// Which of them, so that h w_max <= courant, w_max^2 four times the largest multiplier among the sixteen; fewer than
// before only where four tenths more would fit too. `closeness` takes the smallest distance to another choice.
static int pace_for(const DirectStrands& strands, const DirectStep& step, int block, double& closeness)
{
    const HairParams& params = step.params;
    double most = 0.0, shortest = INFINITY;
    for (int lane = 0; lane < 16; ++lane)
    {
        const int s = 16 * block + lane;
        const size_t of = size_t(s < strands.count() ? s : 0); // what fills the last block copies the first strand
        most = std::max(most, strands.tension[of]);
        shortest = std::min(shortest, strands.segment_length[of] * params.strand_spacing);
    }
    const double hung = 9.81 * std::abs(double(params.forces_gravity)) +
                        double(step.info.wind.w) * (1.0 + params.forces_turbulence) + root_acceleration(step);
    most = std::max(most, (strands.nodes - 2) * hung / shortest);
    const double waves = 2.0 * std::sqrt(most) / params.solver_courant;
    const double need = double(step.now.seconds) * std::max(waves, double(step.info.turning_rate));
    const auto for_need = [&](double wanted)
    {
        int pace = 0;
        while (pace < 7 && kCounts[size_t(pace)] < std::max(wanted, double(params.solver_substeps)))
            ++pace;
        for (const int count : kCounts)
            closeness = std::min(closeness, std::abs(wanted / count - 1.0));
        return pace;
    };
    const int least = for_need(need), calm = for_need(1.4 * need);
    const int before = std::max(strands.pace[size_t(block)] - 1, 0);
    return before > calm ? std::max(calm, least) : std::max(before, least);
}

// ---- bodies --------------------------------------------------------------------------------------------------------

namespace
{
struct Nearest
{
    double distance = INFINITY; // negative inside
    Vec away{0.0, 1.0, 0.0};
    bool on_head = false;
};
} // namespace

static Nearest nearest_capsule(const DirectStep& step, const Place& head, Vec p)
{
    Nearest nearest;
    const Vec origin = step.teleport ? step.now.head.origin : step.before.origin;
    for (const Round& body : step.bodies)
    {
        const Vec center = body.on_head ? head.out(body.center) : body.center - origin;
        const Vec axis = body.on_head ? head.turn * body.axis : body.axis;
        const double squared = glm::dot(axis, axis);
        const double share = squared > 0.0 ? std::clamp(glm::dot(p - center, axis) / squared, 0.0, 1.0) : 0.0;
        const Vec d = p - center - share * axis;
        const double from_axis = glm::length(d);
        if (from_axis - body.radius < nearest.distance)
            nearest = {from_axis - body.radius, from_axis > 1e-6 * body.radius ? d / from_axis : Vec(0, 1, 0),
                       body.on_head};
    }
    return nearest;
}

// The head's grid at a point of its frame: distance, and the normal there.
static Plane head_at(const DirectStep& step, Vec local, const Rounder& round)
{
    StepInfo in_head = step.info;
    in_head.head_row0 = F4(1.0f, 0.0f, 0.0f, 0.0f);
    in_head.head_row1 = F4(0.0f, 1.0f, 0.0f, 0.0f);
    in_head.head_row2 = F4(0.0f, 0.0f, 1.0f, 0.0f);
    // Places count from the grid's corner.
    const Vec off =
        round(4.0 * glm::distance(local, Vec(in_head.body_corner.x, in_head.body_corner.y, in_head.body_corner.z)));
    Plane plane = plane_at(step.grid, local + off, in_head);
    // And slopes are differences of distances, which count in voxels.
    const double deep = std::abs(plane.distance) / double(in_head.body_corner.w);
    plane.normal = glm::normalize(plane.normal + round(6.0 * deep));
    return plane;
}

namespace
{
// What a node knows of the head all through a step, in the head's frame.
struct Ground
{
    Vec start{0.0}, normal{0.0, 1.0, 0.0};
    double distance = INFINITY, level = -INFINITY; // of the start from the surface; of the plane
    bool may_meet = false;
};
} // namespace

// A node at x that goes `way` against the head's origin in the step.
static Ground ground_of(const DirectStep& step, const Place& begin, Vec x, Vec way, const Rounder& round)
{
    if (!step.on_grid)
        return {};
    const Vec start = begin.into(x) + round(6.0 * glm::length(x));
    const Plane plane = head_at(step, start, round);
    const double room = plane.distance - 0.005;
    return {start, plane.normal, plane.distance, glm::dot(plane.normal, start) - plane.distance,
            room < 0.0 || 2.0 * glm::length(way) >= room};
}

// To a node that has come to p: by its plane where that was found within a sample of the grid, unless `exact`.
static Nearest nearest_body(const DirectStep& step, const Place& head, const Ground& ground, Vec p, bool exact,
                            const Rounder& round)
{
    const Nearest nearest = nearest_capsule(step, head, p);
    if (!step.on_grid)
        return nearest;
    const Vec local = head.into(p) + round(6.0 * glm::length(p));
    Plane plane = {glm::dot(ground.normal, local) - ground.level, ground.normal};
    if (exact || glm::distance(local, ground.start) >= double(step.info.body_corner.w))
        plane = head_at(step, head.into(p), round);
    return plane.distance <= nearest.distance ? Nearest{plane.distance, head.turn * plane.normal, true} : nearest;
}

// ---- one strand ----------------------------------------------------------------------------------------------------

// A node that would end inside a body goes to its surface; friction takes up to its coefficient times that push from
// how far the node slid over the body (Coulomb).
static void push_off(const DirectStep& step, const Place& last, const Place& now, Vec x, const Nearest& body, Vec at,
                     Vec& move, double inside, const Rounder& round)
{
    const double pushed = -(body.distance + inside);
    if (!(pushed > 0.0))
        return;
    const Vec n = body.away + round(8.0);
    Vec slid = at - (body.on_head ? now.out(last.into(x)) : x) + round(12.0 * glm::length(x));
    slid -= glm::dot(slid, n) * n;
    const double way = glm::length(slid), rubbed = std::min(step.params.forces_friction * pushed, way);
    move += pushed * n - (way > 0.0 ? slid * (rubbed / way) : Vec(0.0));
}

// First off the plane that the head is near it, then off whatever capsule is nearest.
static void push_and_rub(const DirectStep& step, const Place& last, const Place& now, Vec x, const Ground& ground,
                         Vec& move, double inside, const Rounder& round)
{
    const auto at = [&] { return x + move + round(6.0 * (glm::length(x) + glm::length(move))); };
    if (ground.may_meet)
    {
        const Vec to = at();
        const Nearest head = {glm::dot(ground.normal, now.into(to)) - ground.level, now.turn * ground.normal, true};
        push_off(step, last, now, x, head, to, move, inside, round);
    }
    const Vec to = at();
    push_off(step, last, now, x, nearest_capsule(step, now, to), to, move, inside, round);
}

// Whether lengths have pulled the strand in, by more than what counts as on the surface before the step's end.
static bool pulled_in(const DirectStep& step, const Place& now, const Strand& strand, const std::vector<Vec>& move,
                      const std::vector<double>& inside, const std::vector<Ground>& ground, const Rounder& round)
{
    double least = 0.0;
    for (size_t k = size_t(strand.held); k < size_t(strand.n); ++k)
    {
        const Vec at = strand.x[k] + move[k] + round(6.0 * (glm::length(strand.x[k]) + glm::length(move[k])));
        least = std::min(least, nearest_capsule(step, now, at).distance + inside[k]);
        if (ground[k].may_meet)
            least = std::min(least, glm::dot(ground[k].normal, now.into(at)) - ground[k].level + inside[k]);
    }
    return least < -3e-4 * strand.rest;
}

// From root to tip: each node at its length from its parent and, if inside a body, where that length meets the plane
// that touches the body under it, in the plane of its direction; found again six times.
static bool walk_out(const DirectStep& step, const Place& now, const Strand& strand, const std::vector<double>& inside,
                     const std::vector<Ground>& ground, std::vector<Vec>& x, bool exact, const Rounder& round)
{
    bool touched = false;
    const double rest = strand.rest;
    for (int k = strand.held; k < strand.n; ++k)
    {
        const Vec parent = x[size_t(k - 1)];
        Vec d = x[size_t(k)] - parent;
        d *= rest / std::max(glm::length(d), 1e-6 * rest);
        Vec n_before(0.0);
        double level_before = 0.0;
        for (int turn = 0; turn < 6; ++turn)
        {
            const Vec at = parent + d + round(6.0 * (glm::length(parent) + rest));
            const Nearest body = nearest_body(step, now, ground[size_t(k)], at, exact, round);
            const double gap = body.distance + inside[size_t(k)];
            if (!(gap < (exact ? 0.0 : -3e-4 * rest)))
                break;
            touched = true;
            const Vec n = glm::normalize(body.away + round(8.0));
            // Over the plane the parent is this high; the node is to be on it, and a trifle out.
            const double height = std::clamp(gap - glm::dot(n, d) - 1e-5 * rest, -rest, rest);
            Vec flat = d - glm::dot(n, d) * n;
            if (glm::length(flat) < 1e-4 * rest)
                flat = std::abs(n.x) > 0.6 ? Vec(-n.z, 0.0, n.x) : Vec(0.0, n.z, -n.y);
            const double level = glm::dot(n, d) - gap;
            d = std::sqrt(std::max(rest * rest - height * height, 0.0)) * glm::normalize(flat) - height * n;
            // Below the last plane again: on the edge of both, or towards it where it is farther away than that.
            const double both = glm::dot(n, n_before);
            if (turn > 0 && glm::dot(n_before, d) < level_before && 1.0 - both * both > 1e-3)
            {
                const Vec edge = glm::normalize(glm::cross(n_before, n));
                const Vec base =
                    glm::inverse(glm::transpose(glm::dmat3(n_before, n, edge))) * Vec(level_before, level, 0.0);
                const double left = rest * rest - glm::dot(base, base);
                d = left > 0.0 ? base + std::copysign(std::sqrt(left), glm::dot(edge, d)) * edge
                               : rest * glm::normalize(base);
            }
            n_before = n;
            level_before = level;
        }
        x[size_t(k)] = parent + d + round(2.0 * (glm::length(parent) + rest));
    }
    return touched;
}

// Returns whether the forces were numbers.
static bool substep(Strand& strand, const DirectStep& step, const Place& last, const Place& now, double h, Drag drag,
                    double gain_steady, Vec root, Vec direction, Vec normal, const Vec* at_rest,
                    const std::vector<Vec>& rest_bend, const std::vector<Vec>& wind, const std::vector<Vec>& push,
                    const std::vector<Ground>& ground, std::vector<double>& inside, bool exact, const Rounder& round)
{
    const int n = strand.n;
    const Vec along = now.turn * direction + round(6.0);
    const Vec root_now = now.out(root) + round(6.0 * (glm::length(root) + glm::length(now.origin)));
    std::vector<Vec> a(size_t(n), Vec(0.0)), move(size_t(n), Vec(0.0));
    for (size_t i = 1; i < size_t(n); ++i)
        a[i] = strand.x[i] - strand.x[i - 1];
    move[1] = root_now - strand.x[1];
    move[0] = root_now - strand.rest * along - strand.x[0];
    for (size_t i = 2; i < size_t(n); ++i)
    {
        const bool tip = i + 1 == size_t(n);
        Vec f(0.0, -9.81 * step.params.forces_gravity, 0.0);
        if (step.wind)
            f += across_wind(wind[i], tip ? a[i] : a[i] + a[i + 1]) + round(8.0 * glm::length(wind[i]));
        if (step.repulsion)
            f += push[i];
        const double m = mass(int(i), n, step.tip_mass);
        const Vec tension = (tip ? Vec(0.0) : strand.pull[i + 1] * a[i + 1]) - strand.pull[i] * a[i];
        move[i] = m * (h * drag.keep * strand.v[i] + h * drag.gain * f) + h * drag.gain * tension;
        move[i] += round(
            4.0 * h *
            (drag.keep * glm::length(strand.v[i]) +
             drag.gain * (glm::length(f) + (std::abs(strand.pull[i]) + (tip ? 0.0 : std::abs(strand.pull[i + 1]))) *
                                               glm::length(a[i]))));
    }
    for (size_t i = 2; i < size_t(strand.held); ++i)
        move[i] = now.out(at_rest[i]) - strand.x[i] + round(6.0 * (glm::length(at_rest[i]) + glm::length(now.origin)));
    if (step.bending)
        bend(strand, step, rest_bend, along, now.turn * normal, h, drag.gain, gain_steady, move, round);
    else
        move.back() /= step.tip_mass;
    if (step.on_grid || !step.bodies.empty())
        for (size_t i = size_t(strand.held); i < size_t(n); ++i)
        {
            const double still = inside[1] - 0.6667 * double(i - 1) * strand.rest;
            inside[i] = std::max({inside[i] - double(step.info.push_out) * h, still, 0.0});
            push_and_rub(step, last, now, strand.x[i], ground[i], move[i], inside[i], round);
        }

    constexpr double kTolerance = 5e-4;
    const std::vector<Vec> predicted = move;
    bool sound = true;
    double residual = INFINITY, kept = 1.0;
    for (int newton = 0; newton < 3 && residual >= kTolerance; ++newton)
    {
        shake(strand, a, move, h * drag.gain, step.tip_mass, round);
        residual = worst_residual(strand, a, move);
    }
    if (residual >= 4.0 * kTolerance)
    {
        move = predicted;
        sound = rescue(strand, move, step.tip_mass, kept, round);
    }
    if ((step.on_grid || !step.bodies.empty()) && (exact || pulled_in(step, now, strand, move, inside, ground, round)))
    {
        std::vector<Vec> walked;
        for (size_t i = 0; i < size_t(n); ++i)
            walked.push_back(strand.x[i] + move[i]);
        if (walk_out(step, now, strand, inside, ground, walked, exact, round))
            for (size_t i = 2; i < size_t(n); ++i)
                move[i] = walked[i] - strand.x[i];
    }
    for (size_t i = 0; i < size_t(n); ++i)
    {
        strand.v[i] = (move[1] + (int(i) >= strand.held ? kept : 1.0) * (move[i] - move[1])) / h +
                      round(2.0 * glm::length(move[i]) / h);
        strand.x[i] += move[i] + round(glm::length(strand.x[i]) + glm::length(move[i]));
    }
    return sound;
}

static bool within(Vec v, double most) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z) < most; }

static void start_again(Strand& strand, const Place& head, const Vec* rest_position, Vec velocity)
{
    for (int i = 0; i < strand.n; ++i)
    {
        strand.x[size_t(i)] = head.out(rest_position[i]);
        strand.v[size_t(i)] = velocity;
        strand.pull[size_t(i)] = 0.0;
    }
}

double simulate_direct(DirectStrands& strands, const DirectStep& step, const Rounding& rounding)
{
    const Rounder round{rounding};
    const int n = strands.nodes;
    const glm::dmat3 carried =
        step.teleport ? glm::mat3_cast(step.now.head.turn) * glm::transpose(glm::mat3_cast(step.before.turn))
                      : glm::dmat3(1.0);
    const Place begin = place_at(step, 0.0), end = place_at(step, 1.0);
    double steepest = 0.0; // of the gradient, for its rounding
    for (const Vec& g : step.gradient)
        steepest = std::max(steepest, glm::length(g));
    double closeness = INFINITY;
    std::vector<int> paces;
    for (size_t block = 0; block < strands.pace.size(); ++block)
        paces.push_back(pace_for(strands, step, int(block), closeness));

    for (int s = 0; s < strands.count(); ++s)
    {
        const size_t first = size_t(s * n);
        const int held = strands.held.empty() ? 2 : strands.held[size_t(s)];
        Strand strand{n, held, strands.segment_length[size_t(s)] * step.params.strand_spacing, {}, {}, {}};
        int fault = 0;
        for (size_t i = first; i < first + size_t(n); ++i)
        {
            strand.x.push_back(carried * strands.position[i]);
            strand.v.push_back(carried * (strands.velocity[i] - step.head_velocity) + step.head_velocity);
            if (step.teleport)
            {
                strand.x.back() += round(4.0 * glm::length(strand.x.back()));
                strand.v.back() += round(6.0 * (glm::length(strand.v.back()) + glm::length(step.head_velocity)));
            }
            strand.pull.push_back(strands.multiplier[i]);
            if (!within(strand.x.back(), 1e6))
                fault = FAULT_POSITION;
            else if (fault == 0 && !within(strand.v.back() + Vec(strand.pull.back(), 0, 0), 1e30))
                fault = FAULT_VELOCITY;
        }
        if (fault)
            start_again(strand, begin, &strands.rest_position[first], step.head_velocity);

        const int before = strands.pace[size_t(s / 16)], substeps = kCounts[size_t(paces[size_t(s / 16)])];
        const double h = double(step.now.seconds) / substeps, b = step.params.forces_drag;
        std::vector<Vec> wind(size_t(n), Vec(0.0)), push(size_t(n), Vec(0.0));
        std::vector<double> inside(size_t(n), 0.0);
        std::vector<Ground> ground(static_cast<size_t>(n));
        const Vec carry(step.info.origin_move.x, step.info.origin_move.y, step.info.origin_move.z);
        for (size_t i = 1; i < size_t(n); ++i)
        {
            ground[i] = ground_of(step, begin, strand.x[i], double(step.now.seconds) * strand.v[i] - carry, round);
            const double gap = std::min(ground[i].distance, nearest_capsule(step, begin, strand.x[i]).distance);
            inside[i] = std::max(0.0, -gap) + std::abs(round.one(8.0 * glm::length(strand.x[i])));
            if (step.wind) // places are up to 256 cells
                wind[i] = wind_at(strand.x[i], step.info) +
                          round(1000.0 * step.info.wind.w * step.info.gust_origin.w + 4.0 * step.info.wind.w);
            if (step.repulsion) // places are up to as many voxels
                push[i] = repulsion_force(strand.x[i], step.gradient, step.params.grid_resolution, step.info) +
                          round(8.0 * step.params.grid_resolution * step.info.repulsion * steepest);
        }
        const double steady = drag_over(b, h, h).gain;
        double tensest = 0.0;
        bool lost = false;
        for (int i = 0; i < substeps; ++i)
        {
            const double h_before = i > 0 ? h : before > 0 ? step.seconds_before / kCounts[size_t(before - 1)] : 0.0;
            lost |= !substep(strand, step, place_at(step, double(i) / substeps),
                             place_at(step, double(i + 1) / substeps), h, drag_over(b, h_before, h), steady,
                             strands.root_position[size_t(s)], strands.root_direction[size_t(s)],
                             strands.root_normal[size_t(s)], &strands.rest_position[first],
                             {strands.rest_bend.begin() + long(first), strands.rest_bend.begin() + long(first) + n},
                             wind, push, ground, inside, i + 1 == substeps, round);
            for (const double pull : strand.pull)
                tensest = std::max(tensest, std::abs(pull));
        }
        for (int i = 2; i < n; ++i)
            lost |= !within(strand.x[size_t(i)], 1e6);
        if (lost)
            start_again(strand, end, &strands.rest_position[first], step.head_velocity);
        strands.tension[size_t(s)] = lost ? 0.0 : tensest;
        for (int i = 0; i < n; ++i)
        {
            strands.position[first + size_t(i)] =
                strand.x[size_t(i)] - end.origin + round(glm::length(strand.x[size_t(i)]));
            strands.velocity[first + size_t(i)] = strand.v[size_t(i)];
            strands.multiplier[first + size_t(i)] = strand.pull[size_t(i)];
        }
        if (fault || lost)
        {
            ++strands.resets[size_t(s)];
            strands.faults[size_t(s)] = fault ? fault : FAULT_FORCES;
        }
    }
    for (size_t block = 0; block < strands.pace.size(); ++block)
        strands.pace[block] = 1 + paces[block];
    return closeness;
}

} // namespace coif::oracle

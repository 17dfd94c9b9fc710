#include "tests/oracle_direct.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace coif::oracle
{

// ---- linear algebra ------------------------------------------------------------------------------------------------

using Matrix = std::vector<std::vector<double>>;

static Matrix zeros(int rows, int columns) { return Matrix(size_t(rows), std::vector<double>(size_t(columns))); }

// Gaussian elimination with row exchanges. T: double or Vec.
template <typename T> static std::vector<T> solved(Matrix a, std::vector<T> right)
{
    const size_t n = right.size();
    for (size_t column = 0; column < n; ++column)
    {
        size_t best = column;
        for (size_t row = column + 1; row < n; ++row)
            if (std::abs(a[row][column]) > std::abs(a[best][column]))
                best = row;
        std::swap(a[column], a[best]);
        std::swap(right[column], right[best]);
        for (size_t row = column + 1; row < n; ++row)
        {
            const double factor = a[row][column] / a[column][column];
            if (factor == 0.0)
                continue;
            for (size_t k = column; k < n; ++k)
                a[row][k] -= factor * a[column][k];
            right[row] -= factor * right[column];
        }
    }
    for (size_t row = n; row-- > 0;)
    {
        for (size_t k = row + 1; k < n; ++k)
            right[row] -= a[row][k] * right[k];
        right[row] /= a[row][row];
    }
    return right;
}

// ---- rounding ------------------------------------------------------------------------------------------------------

namespace
{
// `of` floats of this size, rounded at random: each by up to a part in 2^24.
struct Rounder
{
    const Rounding& draw;
    double one(double of) const { return draw ? of * draw() / 16777216.0 : 0.0; }
    Vec operator()(double of) const { return draw ? Vec(one(of), one(of), one(of)) : Vec(0.0); }
};
} // namespace

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

// Halvings so that h w_max <= courant, w_max^2 four times the largest multiplier among the sixteen; fewer than before
// only where four tenths more would fit too. `closeness` takes the smallest distance to another choice.
static int halvings(const DirectStrands& strands, const DirectStep& step, int block, double& closeness)
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
    const auto level_for = [&](double wanted)
    {
        int level = 0;
        while (level < 4 && std::ldexp(1.0, level) < std::max(wanted, double(params.solver_substeps)))
            ++level;
        for (int i = 0; i <= 4; ++i)
            closeness = std::min(closeness, std::abs(wanted / std::ldexp(1.0, i) - 1.0));
        return level;
    };
    const int least = level_for(need), calm = level_for(1.4 * need);
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

static Nearest nearest_body(const DirectStep& step, const Place& head, Vec p)
{
    Nearest nearest;
    const Vec origin = step.teleport ? step.now.head.origin : step.before.origin;
    for (const Sphere& sphere : step.bodies)
    {
        const Vec d = p - (sphere.on_head ? head.out(sphere.center) : sphere.center - origin);
        const double from_center = glm::length(d);
        if (from_center - sphere.radius < nearest.distance)
            nearest = {from_center - sphere.radius, from_center > 1e-6 * sphere.radius ? d / from_center : Vec(0, 1, 0),
                       sphere.on_head};
    }
    return nearest;
}

// ---- one strand ----------------------------------------------------------------------------------------------------

namespace
{
struct Strand
{
    int n;
    double rest;
    std::vector<Vec> x, v;
    std::vector<double> pull; // of the segment that ends at the node
};
} // namespace

static double mass(int node, int nodes, double tip_mass) { return node == nodes - 1 ? tip_mass : 1.0; }
static double mobility(int node, int nodes, double tip_mass)
{
    return node < 2 ? 0.0 : 1.0 / mass(node, nodes, tip_mass);
}

static Vec some_normal(Vec t)
{
    return glm::normalize(std::abs(t.x) > 0.6 ? Vec(-t.z, 0.0, t.x) : Vec(0.0, t.z, -t.y));
}

// The smallest rotation that takes the unit vector t to the unit vector next, done to a normal of t (Rodrigues).
static Vec transported(Vec normal, Vec t, Vec next)
{
    const Vec axis = glm::cross(t, next);
    const double sine = glm::length(axis), cosine = glm::dot(t, next);
    if (cosine < -1.0 + 1e-4)
        return some_normal(next);
    if (sine > 1e-14)
    {
        const Vec k = axis / sine;
        normal = normal * cosine + glm::cross(k, normal) * sine + k * glm::dot(k, normal) * (1.0 - cosine);
    }
    return glm::normalize(normal - glm::dot(normal, next) * next);
}

// Bending stiffness over mass, 1/s^2: E I / (rho S l^4), from the modulus of a round fibre or from the droop number.
static double stiffness_of(const HairParams& params, int nodes, double rest)
{
    const double length = rest * (nodes - 2), radius = 0.5e-6 * params.bending_diameter;
    const double of_material = params.bending_modulus > 0.0f
                                   ? 1e9 * params.bending_modulus * radius * radius / (4.0 * 1300.0)
                                   : 9.81 * std::pow(length, 3) / params.bending_droop;
    return of_material / std::pow(rest, 4);
}

// Where the bend of each element is to be: parts along a frame that is carried from the root along the strand.
static std::vector<Vec> bend_targets(const std::vector<Vec>& x, double rest, const std::vector<Vec>& rest_bend,
                                     Vec along, Vec normal)
{
    std::vector<Vec> target(x.size(), Vec(0.0));
    Vec t = along;
    for (size_t e = 1; e + 1 < x.size(); ++e)
    {
        const Vec part = rest_bend[e], segment = x[e + 1] - x[e];
        target[e] = part.x * t + part.y * normal + part.z * glm::cross(t, normal);
        const Vec next = glm::length(segment) > 1e-6 * rest ? glm::normalize(segment) : t;
        normal = transported(normal, t, next);
        t = next;
    }
    return target;
}

// What bending takes off h gain times the forces on the nodes, over the stiffness: the slope of
//   1/2 sum of w |second difference - target|^2
// with all that hangs on the nodes; for curls by central differences.
static std::vector<Vec> bending_slope(const std::vector<Vec>& x, const std::vector<double>& w, double rest, bool curled,
                                      const std::vector<Vec>& rest_bend, Vec along, Vec normal, const Rounder& round)
{
    const size_t n = x.size();
    std::vector<Vec> slope(n, Vec(0.0));
    const std::vector<Vec> target =
        curled ? bend_targets(x, rest, rest_bend, along, normal) : std::vector<Vec>(n, Vec(0.0));
    double turning = 0.0; // what may be summed up in a twist
    for (size_t e = 1; e + 1 < n; ++e)
    {
        const Vec off = x[e - 1] - 2.0 * x[e] + x[e + 1] - target[e];
        slope[e - 1] += w[e] * off;
        slope[e] -= 2.0 * w[e] * off;
        slope[e + 1] += w[e] * off;
        turning += w[e] * glm::length(target[e]) * glm::length(off) / rest;
    }
    if (!curled)
        return slope;
    const auto energy = [&](const std::vector<Vec>& at)
    {
        const std::vector<Vec> there = bend_targets(at, rest, rest_bend, along, normal);
        double sum = 0.0;
        for (size_t e = 1; e + 1 < n; ++e)
        {
            const Vec off = at[e - 1] - 2.0 * at[e] + at[e + 1] - there[e];
            sum += 0.5 * w[e] * glm::dot(off, off);
        }
        return sum;
    };
    std::vector<Vec> at = x;
    const double step = 1e-5 * rest;
    for (size_t i = 2; i < n; ++i)
        for (int axis = 0; axis < 3; ++axis)
        {
            at[i][axis] = x[i][axis] + step;
            const double above = energy(at);
            at[i][axis] = x[i][axis] - step;
            slope[i][axis] = (above - energy(at)) / (2.0 * step) + round.one(8.0 * turning);
            at[i][axis] = x[i][axis];
        }
    return slope;
}

// The implicit bending step: (M + h gain K) move = momentum - h gain times the slope of the energy at x*, the
// prescribed nodes where they end and the others where they begin. K is of straight hair (Bergou et al. 2006), with the
// element at the clamp counted twice.
static void bend(const Strand& strand, const DirectStep& step, const std::vector<Vec>& rest_bend, Vec along, Vec normal,
                 double h, double gain_now, double gain_steady, std::vector<Vec>& move, const Rounder& round)
{
    const int n = strand.n;
    const double k = std::min(stiffness_of(step.params, n, strand.rest), double(step.info.bend_most));
    std::vector<Vec> x = strand.x;
    x[0] += move[0];
    x[1] += move[1] + round(2.0 * glm::length(x[1]));
    for (size_t i = 2; i < size_t(n); ++i)
        x[i] += round(6.0 * strand.rest);
    Matrix d = zeros(n, n); // second differences of all nodes
    std::vector<double> w(size_t(n), 0.0);
    for (int e = 1; e + 1 < n; ++e)
    {
        d[size_t(e)][size_t(e - 1)] = d[size_t(e)][size_t(e + 1)] = 1.0;
        d[size_t(e)][size_t(e)] = -2.0;
        w[size_t(e)] =
            (e == 1 ? 2.0 : 1.0) * std::exp(-double(step.params.bending_attenuation) * (e - 1) / double(n - 2));
    }
    const std::vector<Vec> slope =
        bending_slope(x, w, strand.rest, step.curled, rest_bend, along, glm::normalize(normal + round(8.0)), round);
    Matrix a = zeros(n - 2, n - 2);
    std::vector<Vec> right(size_t(n - 2));
    for (int i = 2; i < n; ++i)
    {
        right[size_t(i - 2)] = move[size_t(i)] - h * gain_now * k * slope[size_t(i)];
        right[size_t(i - 2)] +=
            round(4.0 * (glm::length(move[size_t(i)]) + h * gain_now * k * glm::length(slope[size_t(i)])));
        a[size_t(i - 2)][size_t(i - 2)] = mass(i, n, step.tip_mass);
        for (int e = 1; e + 1 < n; ++e)
            for (int j = 2; j < n; ++j)
            {
                const double entry =
                    h * gain_steady * k * w[size_t(e)] * d[size_t(e)][size_t(i)] * d[size_t(e)][size_t(j)];
                a[size_t(i - 2)][size_t(j - 2)] += entry + round.one(8.0 * entry);
            }
    }
    const std::vector<Vec> solution = solved(a, right);
    for (int i = 2; i < n; ++i)
        move[size_t(i)] = solution[size_t(i - 2)] + round(4.0 * glm::length(solution[size_t(i - 2)]));
}

static double worst_residual(const std::vector<Vec>& a, const std::vector<Vec>& move, double rest)
{
    double worst = 0.0;
    for (size_t k = 2; k < move.size(); ++k)
    {
        const Vec d = a[k] + move[k] - move[k - 1];
        const double off = std::abs(glm::dot(d, d) / (rest * rest) - 1.0);
        worst = std::isfinite(off) ? std::max(worst, off) : INFINITY;
    }
    return worst;
}

// A round of Newton's method for |a + change| = l with corrections along a (SHAKE, Ryckaert et al. 1977).
static void shake(Strand& strand, const std::vector<Vec>& a, std::vector<Vec>& move, double hg, double tip_mass,
                  const Rounder& round)
{
    const int n = strand.n, links = n - 2;
    const double rest = strand.rest;
    Matrix jacobian = zeros(links, links);
    std::vector<double> excess(size_t(links), 0.0);
    for (int k = 2; k < n; ++k)
    {
        const size_t row = size_t(k - 2);
        const Vec d = a[size_t(k)] + move[size_t(k)] - move[size_t(k - 1)];
        const double parts =
            glm::length(a[size_t(k)]) + glm::length(move[size_t(k)]) + glm::length(move[size_t(k - 1)]);
        excess[row] = 0.5 * (glm::dot(d, d) - rest * rest) +
                      round.one(2.0 * (glm::dot(d, d) + rest * rest) + 2.0 * glm::length(d) * parts);
        // Lambda of segment j pulls node j back along a[j] and node j - 1 forth.
        const auto entry = [&](int j, double weight)
        {
            const double product = weight * glm::dot(d, a[size_t(j)]);
            jacobian[row][size_t(j - 2)] =
                product + round.one(6.0 * weight * glm::length(d) * glm::length(a[size_t(j)]));
        };
        const double before = mobility(k - 1, n, tip_mass), own = mobility(k, n, tip_mass);
        if (k > 2)
            entry(k - 1, -before);
        entry(k, before + own);
        if (k + 1 < n)
            entry(k + 1, -own);
    }
    const std::vector<double> lambda = solved(jacobian, excess);
    for (int k = 2; k < n; ++k)
    {
        const Vec forth = k + 1 < n ? lambda[size_t(k - 1)] * a[size_t(k + 1)] : Vec(0.0);
        const Vec back = lambda[size_t(k - 2)] * a[size_t(k)];
        move[size_t(k)] += mobility(k, n, tip_mass) * (forth - back) +
                           round(3.0 * (glm::length(forth) + glm::length(back)) + glm::length(move[size_t(k)]));
        strand.pull[size_t(k)] +=
            lambda[size_t(k - 2)] / hg + round.one(3.0 * std::abs(lambda[size_t(k - 2)] / hg) + strand.pull[size_t(k)]);
    }
}

// From the prediction: nodes farther than twice their place along the strand are fetched to there, over-relaxed sweeps
// with every second segment at once, then each node at its length from its parent (Mueller, Kim, Chentanez 2012).
// Returns whether the prediction was a number.
static bool rescue(Strand& strand, std::vector<Vec>& move, const Rounder& round)
{
    const int n = strand.n;
    std::vector<Vec> q;
    for (int k = 0; k < n; ++k)
        q.push_back(strand.x[size_t(k)] + move[size_t(k)]);
    const Vec along = q[1] - q[0];
    bool sound = true;
    for (int k = 2; k < n; ++k)
    {
        const double most = 2.0 * (k - 1) * strand.rest, is = glm::length(q[size_t(k)] - q[1]);
        sound &= is < 1e15;
        if (!(is < 1e15))
            q[size_t(k)] = q[1] + double(k - 1) * along;
        else if (is > most)
            q[size_t(k)] = q[1] + (q[size_t(k)] - q[1]) * (most / is);
        q[size_t(k)] += round(4.0 * glm::length(q[size_t(k)]));
    }
    for (int half = 0; half < 16; ++half)
        for (int k = 2 + half % 2; k < n; k += 2)
        {
            const Vec d = q[size_t(k)] - q[size_t(k - 1)];
            const double is = glm::length(d), before = k > 2 ? 1.0 : 0.0;
            const Vec correction =
                is > 1e-6 * strand.rest ? 1.8 * (1.0 - strand.rest / is) / (1.0 + before) * d : Vec(0.0);
            q[size_t(k)] -= correction + round(4.0 * glm::length(q[size_t(k)]));
            q[size_t(k - 1)] += before * correction;
        }
    for (int k = 2; k < n; ++k)
    {
        const Vec d = q[size_t(k)] - q[size_t(k - 1)];
        const double is = glm::length(d);
        q[size_t(k)] = q[size_t(k - 1)] + (is > 1e-6 * strand.rest ? d * (strand.rest / is) : along);
        q[size_t(k)] += round(2.0 * glm::length(q[size_t(k)]));
        move[size_t(k)] = q[size_t(k)] - strand.x[size_t(k)];
        strand.pull[size_t(k)] = 0.0;
    }
    return sound;
}

// A node that would end inside a body goes to its surface; friction takes up to its coefficient times that push from
// how far the node slid over the body (Coulomb).
static void push_and_rub(const DirectStep& step, const Place& last, const Place& now, Vec x, Vec& move, double inside,
                         const Rounder& round)
{
    const Vec at = x + move + round(6.0 * (glm::length(x) + glm::length(move)));
    const Nearest body = nearest_body(step, now, at);
    const double pushed = -(body.distance + inside);
    if (!(pushed > 0.0))
        return;
    const Vec n = body.away + round(8.0);
    Vec slid = at - (body.on_head ? now.out(last.into(x)) : x) + round(12.0 * glm::length(x));
    slid -= glm::dot(slid, n) * n;
    const double way = glm::length(slid), rubbed = std::min(step.params.forces_friction * pushed, way);
    move += pushed * n - (way > 0.0 ? slid * (rubbed / way) : Vec(0.0));
}

// From root to tip: each node at its length from its parent and, if inside a body, where that length meets the plane
// that touches the body under it, in the plane of its direction; found again four times.
static bool walk_out(const DirectStep& step, const Place& now, const Strand& strand, const std::vector<double>& inside,
                     std::vector<Vec>& x, const Rounder& round)
{
    bool touched = false;
    const double rest = strand.rest;
    for (int k = 2; k < strand.n; ++k)
    {
        const Vec parent = x[size_t(k - 1)];
        Vec d = x[size_t(k)] - parent;
        d *= rest / std::max(glm::length(d), 1e-6 * rest);
        for (int turn = 0; turn < 4; ++turn)
        {
            const Vec at = parent + d + round(6.0 * (glm::length(parent) + rest));
            const Nearest body = nearest_body(step, now, at);
            const double gap = body.distance + inside[size_t(k)];
            if (!(gap < 0.0))
                break;
            touched = true;
            const Vec n = glm::normalize(body.away + round(8.0));
            // Over the plane the parent is this high; the node is to be on it.
            const double height = std::clamp(gap - glm::dot(n, d), -rest, rest);
            Vec flat = d - glm::dot(n, d) * n;
            if (glm::length(flat) < 1e-4 * rest)
                flat = std::abs(n.x) > 0.6 ? Vec(-n.z, 0.0, n.x) : Vec(0.0, n.z, -n.y);
            d = std::sqrt(std::max(rest * rest - height * height, 0.0)) * glm::normalize(flat) - height * n;
        }
        x[size_t(k)] = parent + d + round(2.0 * (glm::length(parent) + rest));
    }
    return touched;
}

// Returns whether the forces were numbers.
static bool substep(Strand& strand, const DirectStep& step, const Place& last, const Place& now, double h, Drag drag,
                    double gain_steady, Vec root, Vec direction, Vec normal, const std::vector<Vec>& rest_bend,
                    const std::vector<Vec>& wind, const std::vector<Vec>& push, std::vector<double>& inside,
                    const Rounder& round)
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
    if (step.bending)
        bend(strand, step, rest_bend, along, now.turn * normal, h, drag.gain, gain_steady, move, round);
    else
        move.back() /= step.tip_mass;
    if (!step.bodies.empty())
        for (size_t i = 2; i < size_t(n); ++i)
        {
            inside[i] = std::max(inside[i] - double(step.info.push_out) * h, 0.0);
            push_and_rub(step, last, now, strand.x[i], move[i], inside[i], round);
        }

    constexpr double kTolerance = 5e-4;
    const std::vector<Vec> predicted = move;
    bool sound = true;
    double residual = INFINITY;
    for (int newton = 0; newton < 3 && residual >= kTolerance; ++newton)
    {
        shake(strand, a, move, h * drag.gain, step.tip_mass, round);
        residual = worst_residual(a, move, strand.rest);
    }
    if (residual >= 4.0 * kTolerance)
    {
        move = predicted;
        sound = rescue(strand, move, round);
    }
    if (!step.bodies.empty())
    {
        std::vector<Vec> walked;
        for (size_t i = 0; i < size_t(n); ++i)
            walked.push_back(strand.x[i] + move[i]);
        if (walk_out(step, now, strand, inside, walked, round))
            for (size_t i = 2; i < size_t(n); ++i)
                move[i] = walked[i] - strand.x[i];
    }
    for (size_t i = 0; i < size_t(n); ++i)
    {
        strand.v[i] = move[i] / h + round(2.0 * glm::length(move[i]) / h);
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
    std::vector<int> levels;
    for (size_t block = 0; block < strands.pace.size(); ++block)
        levels.push_back(halvings(strands, step, int(block), closeness));

    for (int s = 0; s < strands.count(); ++s)
    {
        const size_t first = size_t(s * n);
        Strand strand{n, strands.segment_length[size_t(s)] * step.params.strand_spacing, {}, {}, {}};
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

        const int before = strands.pace[size_t(s / 16)], level = levels[size_t(s / 16)], substeps = 1 << level;
        const double h = double(step.now.seconds) / substeps, b = step.params.forces_drag;
        std::vector<Vec> wind(size_t(n), Vec(0.0)), push(size_t(n), Vec(0.0));
        std::vector<double> inside(size_t(n), 0.0);
        for (size_t i = 2; i < size_t(n); ++i)
        {
            inside[i] = std::max(0.0, -nearest_body(step, begin, strand.x[i]).distance) +
                        std::abs(round.one(8.0 * glm::length(strand.x[i])));
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
            const double h_before = i > 0 ? h : before > 0 ? std::ldexp(step.seconds_before, 1 - before) : 0.0;
            lost |=
                !substep(strand, step, place_at(step, double(i) / substeps), place_at(step, double(i + 1) / substeps),
                         h, drag_over(b, h_before, h), steady, strands.root_position[size_t(s)],
                         strands.root_direction[size_t(s)], strands.root_normal[size_t(s)],
                         {strands.rest_bend.begin() + long(first), strands.rest_bend.begin() + long(first) + n}, wind,
                         push, inside, round);
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
        strands.pace[block] = 1 + levels[block];
    return closeness;
}

} // namespace coif::oracle

#include "tests/oracle_strand.h"

#include <glm/geometric.hpp>

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

// ---- bending and lengths

double mass(int node, int nodes, double tip_mass) { return node == nodes - 1 ? tip_mass : 1.0; }
double mobility(int node, const Strand& strand, double tip_mass)
{
    return node < strand.held ? 0.0 : 1.0 / mass(node, strand.n, tip_mass);
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
void bend(const Strand& strand, const DirectStep& step, const std::vector<Vec>& rest_bend, Vec along, Vec normal,
          double h, double gain_now, double gain_steady, std::vector<Vec>& move, const Rounder& round)
{
    const int n = strand.n;
    const double k = std::min(stiffness_of(step.params, n, strand.rest), double(step.info.bend_most));
    std::vector<Vec> x = strand.x;
    const int held = strand.held;
    x[0] += move[0];
    for (size_t i = 1; i < size_t(held); ++i)
        x[i] += move[i] + round(2.0 * glm::length(x[i]));
    for (size_t i = 2; i < size_t(n); ++i)
        x[i] += round(6.0 * strand.rest);
    Matrix d = zeros(n, n); // second differences of all nodes
    std::vector<double> w(size_t(n), 0.0);
    for (int e = 1; e + 1 < n; ++e)
    {
        d[size_t(e)][size_t(e - 1)] = d[size_t(e)][size_t(e + 1)] = 1.0;
        d[size_t(e)][size_t(e)] = -2.0;
        w[size_t(e)] = (e == held - 1 ? 2.0 : 1.0) *
                       std::exp(-double(step.params.bending_attenuation) * (e - 1) / double(n - 2)) *
                       oracle::profile_at(step.params.bending_along, (e - 1) / double(n - 2));
    }
    const std::vector<Vec> slope =
        bending_slope(x, w, strand.rest, step.curled, rest_bend, along, glm::normalize(normal + round(8.0)), round);
    Matrix a = zeros(n - held, n - held);
    std::vector<Vec> right(size_t(n - held));
    for (int i = held; i < n; ++i)
    {
        right[size_t(i - held)] = move[size_t(i)] - h * gain_now * k * slope[size_t(i)];
        right[size_t(i - held)] +=
            round(4.0 * (glm::length(move[size_t(i)]) + h * gain_now * k * glm::length(slope[size_t(i)])));
        a[size_t(i - held)][size_t(i - held)] = mass(i, n, step.tip_mass);
        for (int e = 1; e + 1 < n; ++e)
            for (int j = held; j < n; ++j)
            {
                const double entry =
                    h * gain_steady * k * w[size_t(e)] * d[size_t(e)][size_t(i)] * d[size_t(e)][size_t(j)];
                a[size_t(i - held)][size_t(j - held)] += entry + round.one(8.0 * entry);
            }
    }
    const std::vector<Vec> solution = solved(a, right);
    for (int i = held; i < n; ++i)
        move[size_t(i)] = solution[size_t(i - held)] + round(4.0 * glm::length(solution[size_t(i - held)]));
}

double worst_residual(const Strand& strand, const std::vector<Vec>& a, const std::vector<Vec>& move)
{
    const double rest = strand.rest;
    double worst = 0.0;
    for (size_t k = size_t(strand.held); k < move.size(); ++k)
    {
        const Vec d = a[k] + move[k] - move[k - 1];
        const double off = std::abs(glm::dot(d, d) / (rest * rest) - 1.0);
        worst = std::isfinite(off) ? std::max(worst, off) : INFINITY;
    }
    return worst;
}

void shake(Strand& strand, const std::vector<Vec>& a, std::vector<Vec>& move, double hg, double tip_mass,
           const Rounder& round)
{
    const int n = strand.n, held = strand.held, links = n - held;
    const double rest = strand.rest;
    Matrix jacobian = zeros(links, links);
    std::vector<double> excess(size_t(links), 0.0);
    for (int k = held; k < n; ++k)
    {
        const size_t row = size_t(k - held);
        const Vec d = a[size_t(k)] + move[size_t(k)] - move[size_t(k - 1)];
        const double parts =
            glm::length(a[size_t(k)]) + glm::length(move[size_t(k)]) + glm::length(move[size_t(k - 1)]);
        excess[row] = 0.5 * (glm::dot(d, d) - rest * rest) +
                      round.one(2.0 * (glm::dot(d, d) + rest * rest) + 2.0 * glm::length(d) * parts);
        // Lambda of segment j pulls node j back along a[j] and node j - 1 forth.
        const auto entry = [&](int j, double weight)
        {
            const double product = weight * glm::dot(d, a[size_t(j)]);
            jacobian[row][size_t(j - held)] =
                product + round.one(6.0 * weight * glm::length(d) * glm::length(a[size_t(j)]));
        };
        const double before = mobility(k - 1, strand, tip_mass), own = mobility(k, strand, tip_mass);
        if (k > held)
            entry(k - 1, -before);
        entry(k, before + own);
        if (k + 1 < n)
            entry(k + 1, -own);
    }
    const std::vector<double> lambda = solved(jacobian, excess);
    for (int k = held; k < n; ++k)
    {
        const Vec forth = k + 1 < n ? lambda[size_t(k + 1 - held)] * a[size_t(k + 1)] : Vec(0.0);
        const Vec back = lambda[size_t(k - held)] * a[size_t(k)];
        move[size_t(k)] += mobility(k, strand, tip_mass) * (forth - back) +
                           round(3.0 * (glm::length(forth) + glm::length(back)) + glm::length(move[size_t(k)]));
        strand.pull[size_t(k)] += lambda[size_t(k - held)] / hg +
                                  round.one(3.0 * std::abs(lambda[size_t(k - held)] / hg) + strand.pull[size_t(k)]);
    }
}

bool rescue(Strand& strand, std::vector<Vec>& move, double tip_mass, double& kept, const Rounder& round)
{
    const int n = strand.n;
    const auto energy = [&]
    {
        double sum = 0.0;
        for (int k = strand.held; k < n; ++k)
            sum += (k + 1 < n ? 1.0 : tip_mass) * glm::dot(move[size_t(k)] - move[1], move[size_t(k)] - move[1]);
        return sum;
    };
    const double predicted = energy();
    std::vector<Vec> q;
    for (int k = 0; k < n; ++k)
        q.push_back(strand.x[size_t(k)] + move[size_t(k)]);
    const Vec along = q[1] - q[0];
    bool sound = true;
    for (int k = strand.held; k < n; ++k)
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
            if (k < strand.held)
                continue;
            const Vec d = q[size_t(k)] - q[size_t(k - 1)];
            const double is = glm::length(d), before = k > strand.held ? 1.0 : 0.0;
            const Vec correction =
                is > 1e-6 * strand.rest ? 1.8 * (1.0 - strand.rest / is) / (1.0 + before) * d : Vec(0.0);
            q[size_t(k)] -= correction + round(4.0 * glm::length(q[size_t(k)]));
            q[size_t(k - 1)] += before * correction;
        }
    for (int k = strand.held; k < n; ++k)
    {
        const Vec d = q[size_t(k)] - q[size_t(k - 1)];
        const double is = glm::length(d);
        q[size_t(k)] = q[size_t(k - 1)] + (is > 1e-6 * strand.rest ? d * (strand.rest / is) : along);
        q[size_t(k)] += round(2.0 * glm::length(q[size_t(k)]));
        move[size_t(k)] = q[size_t(k)] - strand.x[size_t(k)];
        strand.pull[size_t(k)] = 0.0;
    }
    // Of the velocity against the root: a projection adds no kinetic energy.
    const double now = energy();
    kept = now <= predicted ? 1.0 : predicted < now ? std::sqrt(predicted / now) : 0.0;
    return sound;
}

} // namespace coif::oracle

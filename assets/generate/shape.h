// Vectors and signed distance fields, after Inigo Quilez: https://iquilezles.org/articles/distfunctions and /smin.
// Metres; +y is up, the face looks to +z and +x is the head's left.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

struct Vec
{
    double x = 0, y = 0, z = 0;
};

inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec operator/(Vec a, Vec b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec normalize(Vec a) { return a * (1 / length(a)); }

constexpr double kDegree = std::numbers::pi / 180;

// Signed distance in metres, about true near where it is 0.
using Field = std::function<double(Vec)>;

struct Mesh
{
    std::vector<Vec> points;
    std::vector<std::array<int, 3>> triangles; // counterclockwise from outside
};

// k is how far, in metres, a blend reaches.
inline double smooth_min(double a, double b, double k)
{
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k / 4;
}
inline double smooth_max(double a, double b, double k) { return -smooth_min(-a, -b, k); }

inline double ellipsoid(Vec p, Vec centre, Vec radii)
{
    const Vec q = (p - centre) / radii;
    return length(q) * (length(q) - 1) / std::max(length(q / radii), 1e-9);
}

// From a, where its radius is ra, to b.
inline double capsule(Vec p, Vec a, double ra, Vec b, double rb)
{
    const Vec ab = b - a;
    const double t = std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0);
    return length(p - a - ab * t) - (ra + (rb - ra) * t);
}

// From 0 to 1, flat at both ends.
inline double ramp(double from, double to, double value)
{
    const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// Through the knots {at, value} in order, smooth; constant beyond the ends (cubic Hermite, the slopes of the
// neighbours' chords, flat at the ends).
template <size_t N> double curve(const std::array<std::array<double, 2>, N>& knots, double at)
{
    size_t i = 0;
    while (i + 2 < N && at > knots[i + 1][0])
        ++i;
    const auto slope = [&](size_t k)
    {
        const bool end = k == 0 || k + 1 == N;
        return end ? 0.0 : (knots[k + 1][1] - knots[k - 1][1]) / (knots[k + 1][0] - knots[k - 1][0]);
    };
    const double width = knots[i + 1][0] - knots[i][0], t = std::clamp((at - knots[i][0]) / width, 0.0, 1.0);
    return std::lerp(knots[i][1], knots[i + 1][1], (3 - 2 * t) * t * t) +
           width * t * (1 - t) * (slope(i) * (1 - t) - slope(i + 1) * t);
}

// The convex shape |x/rx|^n + |y/ry|^n + |z/rz|^n = 1 about the origin, n 2 or a little more: squarer than an
// ellipsoid. A radius of 0 leaves that axis out.
inline double superellipsoid(Vec p, Vec radii, double n)
{
    double sum = 0;
    Vec slope;
    const auto axis = [&](double v, double radius, double& g)
    {
        if (radius == 0)
            return;
        const double q = v / radius, power = std::pow(q * q + 1e-4, n / 2 - 1);
        sum += power * q * q;
        g = power * q / radius;
    };
    axis(p.x, radii.x, slope.x);
    axis(p.y, radii.y, slope.y);
    axis(p.z, radii.z, slope.z);
    const double r = std::max(std::pow(sum, 1 / n), 0.1);
    return (r - 1) * std::pow(r, n - 1) / std::max(length(slope), 1e-3);
}

// 1 at the centre, nothing two radii away: what is pressed in or raised by the thumb.
inline double bump(Vec p, Vec centre, Vec radii)
{
    const Vec q = (p - centre) / radii;
    return std::exp(-dot(q, q));
}
inline double bump(double t) { return std::exp(-t * t); }

// By differences along the diagonals of a cube with sides of 2 h metres.
inline Vec gradient(const Field& field, Vec p, double h = 2e-5)
{
    Vec sum;
    for (const Vec corner : {Vec{1, -1, -1}, Vec{-1, -1, 1}, Vec{-1, 1, -1}, Vec{1, 1, 1}})
        sum = sum + corner * field(p + corner * h);
    return sum * (0.25 / h);
}

// One Newton step towards field = 0; at most `limit` metres, since a field may have creases.
inline Vec step_to_zero(const Field& field, Vec p, double limit)
{
    const Vec g = gradient(field, p);
    const Vec step = g * (field(p) / std::max(dot(g, g), 1e-6));
    return p - step * std::min(1.0, limit / std::max(length(step), 1e-12));
}

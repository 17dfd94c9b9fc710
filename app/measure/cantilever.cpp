#include "app/measure/cantilever.h"

#include <array>
#include <cmath>
#include <numbers>

namespace coif
{

namespace
{
using State = std::array<double, 4>; // angle from straight down, its slope, sums of its cosine and sine along the rod
}

// With u the way from the tip and d the angle from straight down, d2 d / du2 = Gamma u sin d, d'(0) = 0. In
// v = Gamma^(1/3) u no Gamma is left: the rod is followed from the tip until it is level, and where that happens says
// which Gamma it was. So there is nothing to shoot for, and nothing ill-conditioned about large Gammas.
static State slope(double v, const State& s) { return {s[1], v * std::sin(s[0]), std::cos(s[0]), std::sin(s[0])}; }

// One step of the classical Runge-Kutta method.
static State moved(double v, const State& s, double h)
{
    const auto along = [&](const State& by, double far)
    {
        State to;
        for (size_t i = 0; i < to.size(); ++i)
            to[i] = s[i] + far * by[i];
        return to;
    };
    const State a = slope(v, s), b = slope(v + h / 2, along(a, h / 2)), c = slope(v + h / 2, along(b, h / 2)),
                d = slope(v + h, along(c, h));
    State to;
    for (size_t i = 0; i < to.size(); ++i)
        to[i] = s[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    return to;
}

Droop droop_of_tip(double angle)
{
    const double level = std::numbers::pi / 2, h = 0.01;
    State now = {angle, 0.0, 0.0, 0.0};
    double v = 0.0;
    for (State next = moved(v, now, h); next[0] < level; next = moved(v, now, h))
    {
        now = next;
        v += h;
    }
    double rest = h / 2; // of the last step, by Newton's method
    for (int i = 0; i < 8; ++i)
    {
        const State there = moved(v, now, rest);
        rest -= (there[0] - level) / there[1];
    }
    now = moved(v, now, rest);
    v += rest;
    return {v * v * v, now[2] / v, now[3] / v};
}

Droop droop_at(double gamma)
{
    // For large Gammas the angle is next to nothing, so its logarithm is halved down to.
    double low = -250.0, high = std::log(std::numbers::pi / 2 - 1e-4);
    for (int i = 0; i < 60; ++i)
    {
        const double middle = 0.5 * (low + high);
        (droop_of_tip(std::exp(middle)).gamma > gamma ? low : high) = middle;
    }
    return droop_of_tip(std::exp(0.5 * (low + high)));
}

std::vector<Droop> master_curve(double from, double to, int points)
{
    std::vector<Droop> curve;
    for (int i = 0; i < points; ++i)
        curve.push_back(droop_at(from * std::pow(to / from, double(i) / (points - 1))));
    return curve;
}

} // namespace coif

#include "app/fibre_shares.h"

#include "kernels/look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr double kPi = std::numbers::pi;
static constexpr size_t kValues = 6; // of Crossed
static_assert(3 * kValues <= SHARE_TERMS);

double lobe_variance(double roughness)
{
    const double b = std::clamp(roughness, kLeastRoughness, 1.0);
    const double width = 0.726 * b + 0.812 * b * b + 3.7 * std::pow(b, 20);
    return width * width;
}

double lobe_logistic(double azimuthal)
{
    const double n = std::clamp(azimuthal, kLeastRoughness, 1.0);
    return std::sqrt(kPi / 8.0) * (0.265 * n + 1.194 * n * n + 5.372 * std::pow(n, 22));
}

double mean_on_cone(double roughness)
{
    const double v = lobe_variance(roughness);
    return 1.0 / std::tanh(1.0 / v) - v;
}

static double dielectric(double cosine, double ior)
{
    const double t = std::sqrt(std::max(0.0, 1.0 - (1.0 - cosine * cosine) / (ior * ior)));
    const double s = (cosine - ior * t) / (cosine + ior * t), p = (ior * cosine - t) / (ior * cosine + t);
    return 0.5 * (s * s + p * p);
}

// The share of a trimmed logistic about `middle` that lies within 90 degrees of 0.
static double about_zero(double middle, double scale)
{
    const auto below = [&](double x) { return 1.0 / (1.0 + std::exp(-x / scale)); };
    const double whole = below(kPi) - below(-kPi);
    double share = 0.0;
    for (const double turn : {-2.0 * kPi, 0.0, 2.0 * kPi})
    {
        const double from = std::clamp(-0.5 * kPi - middle + turn, -kPi, kPi);
        const double to = std::clamp(0.5 * kPi - middle + turn, -kPi, kPi);
        share += below(to) - below(from);
    }
    return share / whole;
}

double stack_albedo(double forward, double backward, double fibres)
{
    // Without a little loss both what comes back of an endless stack and what gets on through it were 1, and their
    // quotient below nothing by nothing.
    const double on = std::min(forward, 0.9999 - backward);
    const double q = 1.0 + backward * backward - on * on;
    const double endless =
        2.0 * backward / std::max(q + std::sqrt(std::max(q * q - 4.0 * backward * backward, 0.0)), 1e-9);
    const double through = std::clamp(on / std::max(1.0 - backward * endless, 1e-9), 1e-6, 0.99999);
    const double left = std::pow(through, 2.0 * fibres);
    return std::max(endless * (1.0 - left) / std::max(1.0 - endless * endless * left, 1e-9) - backward, 0.0);
}

double back_variance(double forward, double backward, double forward_variance, double backward_variance)
{
    const double once = std::sqrt(2.0 * forward_variance + backward_variance);
    const double thrice = std::sqrt(2.0 * forward_variance + 3.0 * backward_variance), b2 = backward * backward;
    const double width = (1.0 + 0.7 * forward * forward) * (once + b2 * thrice) / (1.0 + b2);
    return width * width;
}

Crossed crossed(double absorption, double sine, double roughness, double azimuthal, double ior)
{
    constexpr int kPlaces = 64;
    const double variance = lobe_variance(roughness), scale = lobe_logistic(azimuthal);
    const double cosine = std::sqrt(std::max(1e-6, 1.0 - sine * sine));
    const double bent = std::sqrt(ior * ior - sine * sine) / cosine;
    const double inner = std::sqrt(1.0 - sine * sine / (ior * ior));
    Crossed sum = {};
    for (int i = 0; i < kPlaces; ++i)
    {
        const double h = (i + 0.5) / kPlaces, outer = std::asin(h), turn = std::asin(h / bent);
        const double mirrored = dielectric(cosine * std::cos(outer), ior);
        const double passed = std::exp(-2.0 * absorption * std::cos(turn) / inner);
        const double entered = (1.0 - mirrored) * (1.0 - mirrored);
        const double lobes[4] = {mirrored, entered * passed, entered * passed * passed * mirrored,
                                 entered * std::pow(passed, 3) * mirrored * mirrored / (1.0 - passed * mirrored)};
        const double variances[4] = {variance, 0.25 * variance, 4.0 * variance, 4.0 * variance};
        for (int p = 0; p < 4; ++p)
        {
            const double middle = std::remainder(2.0 * p * turn - 2.0 * outer + p * kPi, 2.0 * kPi);
            const double back = p == 3 ? 0.5 : about_zero(middle, scale), lobe = lobes[p] / kPlaces;
            sum.forward += lobe * (1.0 - back);
            sum.backward += lobe * back;
            sum.forward_variance += lobe * (1.0 - back) * variances[p];
            sum.backward_variance += lobe * back * variances[p];
        }
    }
    sum.forward_variance /= std::max(sum.forward, 1e-12);
    sum.backward_variance /= std::max(sum.backward, 1e-12);
    sum.behind = stack_albedo(sum.forward, sum.backward, double(FIBRES_BEHIND));
    sum.behind_variance = back_variance(sum.forward, sum.backward, sum.forward_variance, sum.backward_variance);
    return sum;
}

// What hangs on the inclination: flat for most of it and steep where light grazes the fibre, as Fresnel's share is. To
// within 0.01 of what is fitted, which three even powers of the sine are not.
static std::array<double, 3> powers_of(double cosine)
{
    const double g = 1.0 - cosine;
    return {1.0, g * g, g * g * g * g * g};
}

// Least squares, weighed by the cosine: by how much of such light there is.
static std::array<double, 3> fitted(const std::vector<double>& cosines, const std::vector<double>& values)
{
    double m[3][4] = {};
    for (size_t k = 0; k < cosines.size(); ++k)
    {
        const std::array<double, 3> powers = powers_of(cosines[k]);
        for (size_t i = 0; i < 3; ++i)
        {
            for (size_t j = 0; j < 3; ++j)
                m[i][j] += cosines[k] * powers[i] * powers[j];
            m[i][3] += cosines[k] * powers[i] * values[k];
        }
    }
    for (int i = 0; i < 3; ++i) // well conditioned and symmetric: no pivots
        for (int j = 0; j < 3; ++j)
            if (j != i)
            {
                const double by = m[j][i] / m[i][i];
                for (int c = i; c < 4; ++c)
                    m[j][c] -= by * m[i][c];
            }
    return {m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]};
}

static double absorption_of_row(int row)
{
    const double r = std::min(double(row) / (SHARE_ROWS - 1), 0.99);
    return (r / (1.0 - r)) * (r / (1.0 - r));
}

std::vector<float> share_table(double roughness, double azimuthal, double ior)
{
    constexpr int kSines = 16;
    std::vector<float> table;
    for (int row = 0; row < SHARE_ROWS; ++row)
    {
        std::vector<double> cosines, values[kValues];
        for (int k = 0; k < kSines; ++k)
        {
            const double sine = std::sin(0.5 * kPi * (k + 0.5) / kSines);
            const Crossed c = crossed(absorption_of_row(row), sine, roughness, azimuthal, ior);
            cosines.push_back(std::sqrt(1.0 - sine * sine));
            values[0].push_back(c.forward);
            values[1].push_back(c.backward);
            values[2].push_back(c.forward_variance);
            values[3].push_back(c.backward_variance);
            values[4].push_back(c.behind);
            values[5].push_back(c.behind_variance);
        }
        for (const std::vector<double>& value : values)
            for (const double term : fitted(cosines, value))
                table.push_back(float(term));
        table.resize(size_t(row + 1) * SHARE_TERMS);
    }
    return table;
}

Crossed from_table(const std::vector<float>& table, double absorption, double sine)
{
    const double r = std::sqrt(std::max(absorption, 0.0));
    const std::array<double, 3> powers = powers_of(std::sqrt(std::max(0.0, 1.0 - sine * sine)));
    const double at = std::min(r / (1.0 + r) * (SHARE_ROWS - 1), SHARE_ROWS - 1 - 1e-3);
    const size_t below = size_t(at);
    const double on = at - double(below);
    double values[kValues];
    for (size_t v = 0; v < kValues; ++v)
    {
        double sum = 0.0;
        for (size_t i = 0; i < 3; ++i)
            sum += powers[i] * std::lerp(double(table[below * SHARE_TERMS + 3 * v + i]),
                                         double(table[(below + 1) * SHARE_TERMS + 3 * v + i]), on);
        values[v] = std::clamp(sum, 1e-5, 1.0);
    }
    return {values[0], values[1], values[2], values[3], values[4], values[5]};
}

} // namespace coif

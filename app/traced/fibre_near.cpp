#include "app/traced/fibre_near.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr double kPi = std::numbers::pi;

// Smoother than any fibre, and as smooth as this model is worked out with: a mirror's lobe has no width.
static constexpr double kLeastVariance = 1e-6, kLeastScale = 1e-3; // rad^2, rad

static double cosine_of(double sine) { return std::sqrt(std::max(0.0, 1.0 - sine * sine)); }

std::array<double, kLobes> longitudinal_variances(double roughness)
{
    const double b = std::clamp(roughness, 0.0, 1.0);
    const double root = 0.726 * b + 0.812 * b * b + 3.7 * std::pow(b, 20);
    const double v = root * root;
    std::array<double, kLobes> variances = {v, v / 4.0, 4.0 * v, 4.0 * v};
    for (double& one : variances)
        one = std::max(one, kLeastVariance);
    return variances;
}

double azimuthal_scale(double azimuthal)
{
    const double n = std::clamp(azimuthal, 0.0, 1.0);
    return std::max(kLeastScale, std::sqrt(kPi / 8.0) * (0.265 * n + 1.194 * n * n + 5.372 * std::pow(n, 22)));
}

double scaled_bessel_i0(double x)
{
    x = std::abs(x);
    if (x < 25.0)
    {
        double term = 1.0, sum = 1.0;
        for (int k = 1; term > 1e-17 * sum; ++k)
            sum += term *= 0.25 * x * x / (double(k) * k);
        return sum * std::exp(-x);
    }
    double term = 1.0, sum = 1.0;
    for (int k = 1; term > 1e-17 && k < 40; ++k) // falls until k is about 2 x
        sum += term *= (2.0 * k - 1.0) * (2.0 * k - 1.0) / (8.0 * x * k);
    return sum / std::sqrt(2.0 * kPi * x);
}

double longitudinal(double sin_i, double cos_i, double sin_o, double cos_o, double variance)
{
    const double across = cos_i * cos_o;
    return scaled_bessel_i0(across / variance) * std::exp((across - sin_i * sin_o - 1.0) / variance) /
           (variance * -std::expm1(-2.0 / variance));
}

std::array<double, 2> tilted(int lobe, double sin_o, double cos_o, double tilt)
{
    const double by = lobe == 0 ? 2.0 * tilt : lobe == 1 ? -tilt : lobe == 2 ? -4.0 * tilt : 0.0;
    return {sin_o * std::cos(by) + cos_o * std::sin(by), std::abs(cos_o * std::cos(by) - sin_o * std::sin(by))};
}

double fresnel(double cosine, double ior)
{
    const double c = std::clamp(cosine, 0.0, 1.0);
    const double within = cosine_of(std::sqrt(1.0 - c * c) / ior);
    const double across = (c - ior * within) / (c + ior * within), along = (ior * c - within) / (ior * c + within);
    return 0.5 * (across * across + along * along);
}

namespace
{
// Of the way into the fibre: in the plane across it, h = sin gamma_o outside and sin gamma_t within (Chiang, section
// 3.3; Marschner's Bravais index).
struct Refracted
{
    double gamma_o, gamma_t, cos_gamma_o, cos_gamma_t, cos_theta_t;
};
} // namespace

static Refracted refracted(const FibreNear& fibre, double sin_o)
{
    const double h = std::clamp(fibre.h, -1.0, 1.0), ior = fibre.look.ior;
    const double cos_o = std::max(cosine_of(sin_o), 1e-6);
    const double bravais = std::sqrt(std::max(ior * ior - sin_o * sin_o, 0.0)) / cos_o;
    const double sin_t = std::clamp(h / bravais, -1.0, 1.0);
    return {std::asin(h), std::asin(sin_t), cosine_of(h), cosine_of(sin_t), std::max(cosine_of(sin_o / ior), 1e-6)};
}

static std::array<glm::dvec3, kLobes> attenuation(const FibreNear& fibre, const Refracted& way, double sin_o)
{
    const double f = fresnel(cosine_of(sin_o) * way.cos_gamma_o, fibre.look.ior);
    std::array<glm::dvec3, kLobes> a;
    for (int c = 0; c < 3; ++c)
    {
        const double passed = std::exp(-std::max(0.0, fibre.absorption[c]) * 2.0 * way.cos_gamma_t / way.cos_theta_t);
        a[0][c] = f;
        a[1][c] = (1.0 - f) * (1.0 - f) * passed;
        a[2][c] = a[1][c] * passed * f;
        // The geometric series of all further reflections; where all is reflected nothing has come in.
        a[3][c] = a[2][c] * passed * f / std::max(1.0 - passed * f, 1e-12);
    }
    return a;
}

std::array<glm::dvec3, kLobes> attenuation(const FibreNear& fibre, double sin_o)
{
    return attenuation(fibre, refracted(fibre, sin_o), sin_o);
}

static double logistic_cdf(double x, double scale) { return 1.0 / (1.0 + std::exp(-x / scale)); }

// The logistic cut off at half a turn to either side, about the angle that lobe p leaves a smooth fibre at; eq. 8
// to 10.
static double azimuthal(int lobe, double phi, double scale, const Refracted& way)
{
    if (lobe == 3)
        return 0.5 / kPi;
    const double center = 2.0 * lobe * way.gamma_t - 2.0 * way.gamma_o + lobe * kPi;
    const double away = std::abs(std::remainder(phi - center, 2.0 * kPi));
    const double e = std::exp(-away / scale);
    return e / (scale * (1.0 + e) * (1.0 + e)) / (2.0 * logistic_cdf(kPi, scale) - 1.0);
}

// M_p N_p.
static double spread(const FibreNear& fibre, const Refracted& way, int lobe, double sin_o, double sin_i, double phi)
{
    const auto [sin_tilted, cos_tilted] = tilted(lobe, sin_o, cosine_of(sin_o), fibre.look.tilt);
    const double variance = longitudinal_variances(fibre.look.roughness)[size_t(lobe)];
    return longitudinal(sin_i, cosine_of(sin_i), sin_tilted, cos_tilted, variance) *
           azimuthal(lobe, phi, azimuthal_scale(fibre.look.azimuthal), way);
}

glm::dvec3 scatter_lobe(const FibreNear& fibre, int lobe, double sin_o, double sin_i, double phi)
{
    const Refracted way = refracted(fibre, sin_o);
    return attenuation(fibre, way, sin_o)[size_t(lobe)] * spread(fibre, way, lobe, sin_o, sin_i, phi);
}

namespace
{
struct Scattered
{
    glm::dvec3 light{0.0};
    double pdf = 0.0;
};
} // namespace

// Each lobe's share of the samples: that of the light in it, over all channels.
static std::array<double, kLobes> shares_of(const std::array<glm::dvec3, kLobes>& a)
{
    std::array<double, kLobes> shares;
    double sum = 0.0;
    for (size_t p = 0; p < kLobes; ++p)
        sum += shares[p] = a[p].x + a[p].y + a[p].z;
    for (double& share : shares)
        share = sum > 0.0 ? share / sum : 0.0;
    return shares;
}

static Scattered scattered(const FibreNear& fibre, const Refracted& way, const std::array<glm::dvec3, kLobes>& a,
                           double sin_o, double sin_i, double phi)
{
    const std::array<double, kLobes> shares = shares_of(a), variances = longitudinal_variances(fibre.look.roughness);
    const double scale = azimuthal_scale(fibre.look.azimuthal), cos_o = cosine_of(sin_o), cos_i = cosine_of(sin_i);
    Scattered sum;
    for (int p = 0; p < kLobes; ++p)
    {
        const auto [sin_tilted, cos_tilted] = tilted(p, sin_o, cos_o, fibre.look.tilt);
        const double m =
            longitudinal(sin_i, cos_i, sin_tilted, cos_tilted, variances[size_t(p)]) * azimuthal(p, phi, scale, way);
        sum.light += m * a[size_t(p)];
        sum.pdf += m * shares[size_t(p)];
    }
    return sum;
}

glm::dvec3 scatter(const FibreNear& fibre, double sin_o, double sin_i, double phi)
{
    const Refracted way = refracted(fibre, sin_o);
    return scattered(fibre, way, attenuation(fibre, way, sin_o), sin_o, sin_i, phi).light;
}

double sample_pdf(const FibreNear& fibre, double sin_o, double sin_i, double phi)
{
    const Refracted way = refracted(fibre, sin_o);
    return scattered(fibre, way, attenuation(fibre, way, sin_o), sin_o, sin_i, phi).pdf;
}

FibreSample sample(const FibreNear& fibre, double sin_o, const std::array<double, 4>& random)
{
    const Refracted way = refracted(fibre, sin_o);
    const std::array<glm::dvec3, kLobes> a = attenuation(fibre, way, sin_o);
    const std::array<double, kLobes> shares = shares_of(a);
    int lobe = 0;
    for (double left = random[0]; lobe < kLobes - 1 && left >= shares[size_t(lobe)]; ++lobe)
        left -= shares[size_t(lobe)];

    // d'Eon 2013, eq. 6 and 7: the cosine of the angle to the mirrored way, then a turn about that.
    const auto [sin_tilted, cos_tilted] = tilted(lobe, sin_o, cosine_of(sin_o), fibre.look.tilt);
    const double variance = longitudinal_variances(fibre.look.roughness)[size_t(lobe)];
    const double u = 1.0 - random[1]; // never 0
    const double cosine = std::clamp(1.0 + variance * std::log(u + (1.0 - u) * std::exp(-2.0 / variance)), -1.0, 1.0);
    FibreSample found;
    found.sin_i =
        std::clamp(-cosine * sin_tilted + cosine_of(cosine) * std::cos(2.0 * kPi * random[2]) * cos_tilted, -1.0, 1.0);
    if (lobe == 3)
        found.phi = 2.0 * kPi * random[3];
    else
    {
        const double scale = azimuthal_scale(fibre.look.azimuthal), most = logistic_cdf(kPi, scale);
        const double share = std::clamp(1.0 - most + random[3] * (2.0 * most - 1.0), 1e-300, 1.0 - 1e-16);
        const double away = std::clamp(-scale * std::log(1.0 / share - 1.0), -kPi, kPi);
        found.phi = 2.0 * lobe * way.gamma_t - 2.0 * way.gamma_o + lobe * kPi + away;
    }
    const Scattered there = scattered(fibre, way, a, sin_o, found.sin_i, found.phi);
    found.pdf = there.pdf;
    if (there.pdf > 0.0)
        found.weight = there.light / there.pdf;
    return found;
}

} // namespace coif

// One fibre of hair: kernels/fibre.h and the table of shares against quadratures, sums and a twin of their own.
#include "app/fibre_shares.h"
#include "kernels/look.h"
#include "tests/fibre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace coif
{
namespace
{

using in_floats::Fibre, in_floats::FibreAngles, in_floats::LobeHeights, in_floats::Rgb;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
const double kTilt = 2.0 * kDegree, kIndex = 1.55;

// Absorption of 8, 1.3 and 0.3 of eumelanin (d'Eon et al. 2011).
const Rgb kBlack = {3.352f, 5.576f, 10.96f}, kBrown = {0.5447f, 0.9061f, 1.781f}, kBlond = {0.1257f, 0.2091f, 0.411f};
const Rgb kWhite = {0.0f, 0.0f, 0.0f};

Fibre fibre_of(double roughness, double azimuthal, double tilt = kTilt, double ior = kIndex)
{
    const auto f = [](double v) { return float(v); };
    return {f(lobe_variance(roughness)), f(lobe_logistic(azimuthal)), f(ior),
            f(std::sin(tilt)),           f(std::cos(tilt)),           f(std::sin(2.0 * tilt)),
            f(std::cos(2.0 * tilt)),     f(std::sin(4.0 * tilt)),     f(std::cos(4.0 * tilt))};
}

FibreAngles angles(double light, double eye, double phi) // rad
{
    return in_floats::fibre_angles(
        float(std::sin(light)), float(std::sin(eye)),
        float(std::sin(light) * std::sin(eye) + std::cos(light) * std::cos(eye) * std::cos(phi)));
}

using Scatter = std::function<Rgb(const FibreAngles&)>;

Scatter far_field(const Fibre& fibre, const Rgb& absorb, int nodes, bool around = false)
{
    return [=](const FibreAngles& a)
    { return in_floats::far_field(fibre, a, in_floats::lobe_heights(fibre, a, 0.0f), absorb, nodes, around); };
}

// What of a white surrounding the fibre sends to an eye at this inclination, in green: the mean over the sphere of what
// it scatters. The lobe's inclinations are narrow beside its azimuths.
double albedo(const Scatter& scatter, double sine_eye, int inclinations = 240, int azimuths = 90)
{
    double sum = 0.0;
    for (int i = 0; i < inclinations; ++i)
    {
        const double sine = -1.0 + 2.0 * (i + 0.5) / inclinations; // equal steps have equal areas
        for (int k = 0; k < azimuths; ++k)
            sum += double(scatter(angles(std::asin(sine), std::asin(sine_eye), kPi * (k + 0.5) / azimuths)).g);
    }
    return sum * 2.0 / inclinations * 2.0 * kPi / azimuths;
}

// ---- the twin: the near field of Chiang et al. 2016 in doubles -----------------------------------------------------

double near_dielectric(double cosine)
{
    const double inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (kIndex * kIndex));
    const double s = (cosine - kIndex * inside) / (cosine + kIndex * inside);
    const double p = (kIndex * cosine - inside) / (kIndex * cosine + inside);
    return 0.5 * (s * s + p * p);
}

double near_scale(double n) { return std::sqrt(kPi / 8.0) * (0.265 * n + 1.194 * n * n + 5.372 * std::pow(n, 22)); }

double near_variance(double b, int lobe)
{
    const double r = std::pow(0.726 * b + 0.812 * b * b + 3.7 * std::pow(b, 20), 2);
    return r * (lobe == 0 ? 1.0 : lobe == 1 ? 0.25 : 4.0);
}

double near_logistic(double x, double s)
{
    const auto below = [&](double at) { return 1.0 / (1.0 + std::exp(-at / s)); };
    const double e = std::exp(-std::abs(x) / s);
    return e / (s * (1.0 + e) * (1.0 + e)) / (below(kPi) - below(-kPi));
}

// Mean over the width of each lobe's attenuation times what it has at an azimuth.
std::array<double, 4> near_azimuth(double eye, double phi, double absorb, double scale, int places)
{
    std::array<double, 4> sum = {};
    const double bent = std::sqrt(kIndex * kIndex - std::pow(std::sin(eye), 2)) / std::cos(eye);
    const double inner = std::cos(std::asin(std::sin(eye) / kIndex));
    for (int i = 0; i < places; ++i)
    {
        const double h = -1.0 + 2.0 * (i + 0.5) / places, outer = std::asin(h), turn = std::asin(h / bent);
        const double f = near_dielectric(std::cos(eye) * std::cos(outer));
        const double t = std::exp(-2.0 * absorb * std::cos(turn) / inner);
        const double attenuation[] = {f, (1 - f) * (1 - f) * t, (1 - f) * (1 - f) * t * t * f,
                                      (1 - f) * (1 - f) * t * t * t * f * f / (1 - t * f)};
        for (int p = 0; p < 3; ++p)
            sum[size_t(p)] += attenuation[p] / places *
                              near_logistic(std::remainder(phi - (2 * p * turn - 2 * outer + p * kPi), 2 * kPi), scale);
        sum[3] += attenuation[3] / places / (2.0 * kPi);
    }
    return sum;
}

// d'Eon et al. 2011, eq. 7, as it is printed; the light leans by `tilt` on the eye's side.
double near_longitudinal(double light, double eye, double v)
{
    return std::exp(-std::sin(light) * std::sin(eye) / v) *
           std::cyl_bessel_i(0.0, std::cos(light) * std::cos(eye) / v) / (2.0 * v * std::sinh(1.0 / v));
}

// ---- numbers -------------------------------------------------------------------------------------------------------

TEST(Fibre, ArcCosineAndArcSineAreThoseOfTheStandardLibrary)
{
    double worst = 0.0;
    for (int i = -100000; i <= 100000; ++i)
    {
        const float x = float(i) / 100000.0f;
        worst = std::max(worst, std::abs(double(in_floats::arc_cosine(x)) - std::acos(double(x))));
        worst = std::max(worst, std::abs(double(in_floats::arc_sine(x)) - std::asin(double(x))));
    }
    EXPECT_LT(worst, 6e-7); // the polynomial's 2e-8, and roundings of numbers up to pi
    EXPECT_TRUE(std::isfinite(in_floats::arc_cosine(1.0000001f) + in_floats::arc_cosine(-1.0000001f)));
}

TEST(Fibre, ScaledBesselIsThatOfTheStandardLibrary)
{
    double worst = 0.0;
    for (double x = 0.0; x < 600.0; x += x < 5.0 ? 0.001 : 0.5)
    {
        const double exact = std::cyl_bessel_i(0.0, x) * std::exp(-x);
        worst = std::max(worst, std::abs(double(in_floats::scaled_bessel(float(x))) / exact - 1.0));
    }
    EXPECT_LT(worst, 1e-6);
    for (const double x : {1e4, 1e6, 1e12}) // I0(x) exp(-x) goes to 1 / sqrt(2 pi x) (1 + 1 / 8x)
        EXPECT_NEAR(double(in_floats::scaled_bessel(float(x))) * std::sqrt(2.0 * kPi * x), 1.0 + 0.125 / x, 1e-6);
}

TEST(Fibre, LongitudinalLobesHoldAllLightWhateverTheirWidth)
{
    for (const double v : {5e-5, 1e-4, 1e-3, 0.01, 0.1, 0.5, 2.0, 10.0})
        for (const double sine : {0.0, 0.5, -0.9, 0.999})
        {
            const double cosine = std::sqrt(1.0 - sine * sine);
            constexpr int kSteps = 40000;
            double sum = 0.0;
            for (int i = 0; i < kSteps; ++i)
            {
                const double so = -1.0 + 2.0 * (i + 0.5) / kSteps;
                const float m = in_floats::longitudinal(float(sine), float(cosine), float(so),
                                                        float(std::sqrt(1.0 - so * so)), float(v));
                ASSERT_TRUE(std::isfinite(m) && m >= 0.0f) << v << ' ' << sine << ' ' << so;
                sum += double(m) * 2.0 / kSteps;
            }
            // A float's rounding in cos(light + eye) - 1 is divided by the variance.
            EXPECT_NEAR(sum, 1.0, 1e-5 + 6e-8 / v) << "variance " << v << ", sine " << sine;
        }
    for (const double v : {0.01, 0.05, 0.3, 2.0})
        for (const double light : {-1.2, -0.3, 0.0, 0.8})
            for (const double eye : {-1.0, 0.0, 0.4, 1.4})
            {
                const double exact = near_longitudinal(light, eye, v);
                EXPECT_NEAR(double(in_floats::longitudinal(float(std::sin(light)), float(std::cos(light)),
                                                           float(std::sin(eye)), float(std::cos(eye)), float(v))),
                            exact, 1e-6 / v * exact + 1e-6);
            }
}

TEST(Fibre, ShareOfALogisticIsItsIntegral)
{
    for (const double s : {0.004, 0.05, 0.3, 1.0, 4.0})
        for (double middle = -kPi; middle <= kPi; middle += 0.37)
        {
            double half = 0.0;
            constexpr int kSteps = 20000;
            for (int i = 0; i < kSteps; ++i)
            {
                const double x = -kPi + 2.0 * kPi * (i + 0.5) / kSteps;
                const double weight = near_logistic(x, s) * 2.0 * kPi / kSteps;
                half += std::cos(x - middle) > 0.0 ? weight : 0.0;
            }
            const double step = near_logistic(0.0, s) * 2.0 * kPi / kSteps;
            EXPECT_NEAR(double(in_floats::logistic_half(float(middle), float(s))), half, 2.0 * step + 1e-6);
        }
}

// ---- lobes ---------------------------------------------------------------------------------------------------------

TEST(Fibre, WhiteFurnace)
{
    for (const double roughness : {0.1, 0.3, 0.6, 0.9})
        for (const double sine : {0.0, 0.5, 0.9})
        {
            const Fibre fibre = fibre_of(roughness, roughness);
            for (const int nodes : {4, 8})
            {
                const double straight = albedo(far_field(fibre, kWhite, nodes), sine);
                const double around = albedo(far_field(fibre, kWhite, nodes, true), sine);
                EXPECT_NEAR(straight, 1.0, 0.03) << roughness << ' ' << sine << ' ' << nodes;
                EXPECT_NEAR(around, 1.0, 0.03) << roughness << ' ' << sine << ' ' << nodes;
            }
            // Two places are enough for light that other fibres have handed on, but where it grazes.
            EXPECT_NEAR(albedo(far_field(fibre, kWhite, 2, true), sine), 1.0, sine < 0.6 ? 0.03 : 0.06) << roughness;
        }
    for (const double roughness : {0.1, 0.3, 0.9})
        for (const double sine : {0.0, 0.9})
        {
            const Fibre fibre = fibre_of(roughness, roughness);
            const double karis = albedo(
                [&](const FibreAngles& a) { return in_floats::karis(fibre, a, kWhite, float(roughness)); }, sine, 1000);
            std::printf("white furnace, Karis' fit, roughness %.1f, sine %.1f: %.3f\n", roughness, sine, karis);
            EXPECT_TRUE(karis > 0.3 && karis < 1.5); // it is not of one piece, but it is near
        }
}

struct LobeShape
{
    double peak, spread; // deg
};

// Along the fibre, for a light in the normal plane. The spread is that of half the sum of both angles, as Marschner et
// al. 2003 measure it.
LobeShape lobe_shape(double roughness, float LobeHeights::*lobe)
{
    const Fibre fibre = fibre_of(roughness, 0.3);
    double best = -1.0, peak = 0.0, sum = 0.0, mean = 0.0, square = 0.0;
    for (double degrees = -89.99; degrees < 90.0; degrees += 0.01)
    {
        const double height = double(in_floats::lobe_heights(fibre, angles(0.0, degrees * kDegree, 0.0), 0.0f).*lobe);
        if (height > best)
            best = height, peak = degrees;
        const double weight = height * std::cos(degrees * kDegree), half = 0.5 * degrees;
        sum += weight;
        mean += weight * half;
        square += weight * half * half;
    }
    mean /= sum;
    return {peak, std::sqrt(square / sum - mean * mean)};
}

TEST(Fibre, LobesLeanAsTheScalesDo)
{
    EXPECT_NEAR(lobe_shape(0.3, &LobeHeights::r).peak, -4.0, 0.1) << "to the root";
    EXPECT_NEAR(lobe_shape(0.3, &LobeHeights::tt).peak, 2.0, 0.1);
    EXPECT_NEAR(lobe_shape(0.3, &LobeHeights::trt).peak, 8.0, 0.1) << "to the tip";
}

TEST(Fibre, LobesAreAsWideAsMeasured)
{
    for (const double roughness : {0.2, 0.35})
    {
        const LobeShape r = lobe_shape(roughness, &LobeHeights::r), tt = lobe_shape(roughness, &LobeHeights::tt),
                        trt = lobe_shape(roughness, &LobeHeights::trt);
        EXPECT_NEAR(r.spread, roughness < 0.3 ? 5.1 : 10.1, 0.2);
        EXPECT_NEAR(tt.spread / r.spread, 0.5, 0.02);
        if (roughness < 0.3) // at 0.35 it is 40 degrees wide in its own angle, and the sphere ends before it does
        {
            EXPECT_NEAR(trt.spread / r.spread, 2.0, 0.1);
        }
    }
}

// The glint of light that is reflected inside once: a caustic, for an index of 1.55 at 18.6 degrees to either side of
// where it came from, which the lobe's own width draws inwards.
TEST(Fibre, GlintsStandBesideTheLight)
{
    const Fibre fibre = fibre_of(0.3, 0.05);
    double best = -1.0, at = 0.0;
    for (double degrees = 0.0; degrees <= 180.0; degrees += 0.1)
    {
        const double trt = double(
            in_floats::far_field(fibre, angles(0.0, 0.0, degrees * kDegree), {0, 0, 1, 0}, kWhite, 256, false).g);
        if (trt > best)
            best = trt, at = degrees;
    }
    EXPECT_GT(at, 17.0);
    EXPECT_LT(at, 19.0);
}

TEST(Fibre, FewPlacesAcrossItSeeWhatManyDo)
{
    const struct
    {
        const char* name;
        Rgb absorb;
        double most_of_4;
    } hairs[] = {{"black", kBlack, 0.13}, {"brown", kBrown, 0.16}, {"blond", kBlond, 0.18}};
    constexpr int kInclinations = 17, kAzimuths = 37, kPlaces = 512;
    const double tilts[] = {2.0 * kTilt, -kTilt, -4.0 * kTilt, 0.0};
    const double leans = 10.0 * kDegree, roughness = 0.3;
    const Fibre fibre = fibre_of(roughness, roughness);
    double heights[kInclinations][kInclinations][4]; // light, eye
    for (int l = 0; l < kInclinations; ++l)
        for (int e = 0; e < kInclinations; ++e)
            for (int p = 0; p < 4; ++p)
                heights[l][e][p] =
                    near_longitudinal((l - 8) * leans, (e - 8) * leans + tilts[p], near_variance(roughness, p));
    for (const auto& hair : hairs)
    {
        double error[2] = {}, whole = 0.0;
        // How much it goes up and down about the fibre, but for R, whose closed form is sharper than a lobe: of 4
        // places, of 8, of the truth.
        double swings[3] = {};
        const float Rgb::*channels[] = {&Rgb::r, &Rgb::g, &Rgb::b};
        for (int e = 0; e < kInclinations; ++e)
            for (const auto channel : channels)
            {
                double before[kInclinations][3] = {};
                for (int k = 0; k < kAzimuths; ++k)
                {
                    const double eye = (e - 8) * leans, phi = k * kPi / (kAzimuths - 1);
                    const std::array<double, 4> azimuth =
                        near_azimuth(eye, phi, double(hair.absorb.*channel), near_scale(roughness), kPlaces);
                    for (int l = 0; l < kInclinations; ++l)
                    {
                        const FibreAngles a = angles((l - 8) * leans, eye, phi);
                        const LobeHeights m = in_floats::lobe_heights(fibre, a, 0.0f);
                        double inside[3] = {};
                        for (size_t p = 1; p < 4; ++p)
                            inside[2] += heights[l][e][p] * azimuth[p];
                        const double truth = heights[l][e][0] * azimuth[0] + inside[2];
                        whole += truth * truth;
                        for (int i = 0; i < 2; ++i)
                        {
                            const int nodes = i == 0 ? 4 : 8;
                            const Rgb few = in_floats::far_field(fibre, a, m, hair.absorb, nodes, false);
                            error[i] += std::pow(double(few.*channel) - truth, 2);
                            LobeHeights without_r = m;
                            without_r.r = 0.0f;
                            inside[i] =
                                double(in_floats::far_field(fibre, a, without_r, hair.absorb, nodes, false).*channel);
                        }
                        for (int i = 0; i < 3; ++i)
                        {
                            swings[i] += k > 0 ? std::abs(inside[i] - before[l][i]) : 0.0;
                            before[l][i] = inside[i];
                        }
                    }
                }
            }
        EXPECT_LT(std::sqrt(error[0] / whole), hair.most_of_4) << hair.name;
        EXPECT_LT(std::sqrt(error[1] / whole), 0.11) << hair.name;
        EXPECT_LT(swings[0] / swings[2], 1.5) << hair.name << ": four places show through";
        EXPECT_NEAR(swings[1] / swings[2], 1.0, 0.2) << hair.name << ": eight do not";
    }
}

TEST(Fibre, PigmentTakesLightAwayButNotFromTheHighlight)
{
    for (const bool around : {false, true})
        for (const double sine : {0.0, 0.7})
        {
            double before = 2.0;
            for (const float absorb : {0.0f, 0.01f, 0.1f, 0.5f, 2.0f, 8.0f})
            {
                const double now =
                    albedo(far_field(fibre_of(0.3, 0.3), {absorb, absorb, absorb}, 4, around), sine, 120, 60);
                EXPECT_LT(now, before) << absorb;
                before = now;
            }
        }
    for (const double phi : {0.0, 0.6, 1.7, kPi})
    {
        const FibreAngles a = angles(0.2, -0.3, phi);
        const LobeHeights only_r = {1.0f, 0.0f, 0.0f, 0.0f};
        const Rgb white = in_floats::far_field(fibre_of(0.3, 0.3), a, only_r, kWhite, 4, false);
        const Rgb black = in_floats::far_field(fibre_of(0.3, 0.3), a, only_r, {0.1f, 5.0f, 100.0f}, 4, false);
        for (const float channel : {black.r, black.g, black.b})
            EXPECT_NEAR(channel, white.g, 1e-6f * white.g);
        EXPECT_NEAR(double(white.g), 0.25 * std::cos(0.5 * phi) * near_dielectric(std::cos(0.3) * std::cos(0.5 * phi)),
                    1e-4)
            << "a rounding of cos phi is its root in cos phi / 2";
    }
}

// ---- many fibres
// -----------------------------------------------------------------------------------------------------

TEST(Fibre, ACrossingSendsOnAndThrowsBackWhatTheNearFieldDoes)
{
    for (const double azimuthal : {0.1, 0.3, 0.8})
        for (const double absorb : {0.0, 0.3, 3.0})
            for (const double sine : {0.0, 0.6, 0.95})
            {
                double forward = 0.0, backward = 0.0;
                constexpr int kSteps = 360; // from -180 to 180 degrees
                for (int k = 0; k < kSteps; ++k)
                {
                    const double phi = -kPi + 2.0 * kPi * (k + 0.5) / kSteps;
                    const std::array<double, 4> at =
                        near_azimuth(std::asin(sine), phi, absorb, near_scale(azimuthal), 400);
                    (std::cos(phi) > 0.0 ? backward : forward) += (at[0] + at[1] + at[2] + at[3]) * 2.0 * kPi / kSteps;
                }
                const Crossed c = crossed(absorb, sine, 0.3, azimuthal, kIndex);
                EXPECT_NEAR(c.forward, forward, 2e-3) << azimuthal << ' ' << absorb << ' ' << sine;
                EXPECT_NEAR(c.backward, backward, 2e-3) << azimuthal << ' ' << absorb << ' ' << sine;
            }
}

TEST(Fibre, NothingIsLostWhereNothingIsAbsorbed)
{
    for (const double roughness : {0.02, 0.3, 1.0})
        for (const double ior : {1.05, 1.55, 3.0})
            for (const double sine : {0.0, 0.5, 0.9, 0.999})
            {
                const Crossed c = crossed(0.0, sine, roughness, roughness, ior);
                EXPECT_NEAR(c.forward + c.backward, 1.0, 1e-4) << roughness << ' ' << ior << ' ' << sine;
                const double thrown = double(in_floats::back_albedo(float(c.forward), float(c.backward)));
                // The stack of them is a white wall; but a rounding of forward + backward counts as absorption a, of
                // which an endless stack takes sqrt(2 a / backward).
                EXPECT_NEAR(thrown + c.backward, 1.0, 4e-4 / std::sqrt(c.backward)) << roughness << ' ' << ior;
            }
}

TEST(Fibre, TheTableOfSharesHoldsWhatItIsOf)
{
    std::mt19937 engine(4);
    for (const double azimuthal : {0.1, 0.3, 0.7})
        for (const double ior : {1.33, 1.55})
        {
            const std::vector<float> table = share_table(0.3, azimuthal, ior);
            ASSERT_EQ(table.size(), size_t(SHARE_ROWS * SHARE_TERMS));
            double worst = 0.0, worst_width = 0.0, worst_behind = 0.0;
            for (int i = 0; i < 600; ++i)
            {
                const double absorb = std::pow(10.0, -4.0 + 5.5 * double(engine()) / 4294967296.0);
                const double sine = std::sin(0.5 * kPi * double(engine()) / 4294967296.0);
                const Crossed exact = crossed(absorb, sine, 0.3, azimuthal, ior);
                const Crossed found = from_table(table, absorb, sine);
                // Half of all such light comes at more than 30 degrees, and a fiftieth at more than 80.
                const double weight = std::min(1.0, 6.0 * std::sqrt(1.0 - sine * sine));
                worst = std::max({worst, weight * std::abs(found.forward - exact.forward),
                                  weight * std::abs(found.backward - exact.backward)});
                // These are what many fibres make of the others, and errors of those grow in them.
                worst_behind =
                    std::max({worst_behind, weight * std::abs(found.behind - exact.behind),
                              weight * std::abs(std::sqrt(found.behind_variance) - std::sqrt(exact.behind_variance))});
                worst_width = std::max(
                    {worst_width,
                     weight * std::abs(std::sqrt(found.forward_variance) - std::sqrt(exact.forward_variance)),
                     weight * std::abs(std::sqrt(found.backward_variance) - std::sqrt(exact.backward_variance))});
            }
            EXPECT_LT(worst, ior > 1.5 ? 0.012 : 0.019) << azimuthal;
            EXPECT_LT(worst_width, 0.016) << azimuthal;
            EXPECT_LT(worst_behind, 0.027) << azimuthal;
        }
}

// Light between fibre and fibre, followed back and forth: two stacks of 2^n layers make one of 2^(n+1).
double thrown_back(double forward, double backward)
{
    double t = forward, r = backward;
    for (int n = 0; n < 40; ++n)
    {
        const double again = 1.0 / std::max(1.0 - r * r, 1e-15);
        r += t * t * r * again;
        t *= t * again;
    }
    return r - backward;
}

TEST(Fibre, AStackOfFibresThrowsBackTheSumOfAllOrders)
{
    for (const double forward : {0.0, 0.05, 0.3, 0.6, 0.8})
        for (const double backward : {1e-5, 0.01, 0.1, 0.19})
        {
            const double exact = thrown_back(forward, backward);
            EXPECT_NEAR(double(in_floats::back_albedo(float(forward), float(backward))), exact, 2e-6 + 2e-5 * exact)
                << forward << ' ' << backward;
            // Zinke et al. 2008, eq. 12 and 13: one and three times back, the start of that sum.
            const double f2 = forward * forward, b3 = std::pow(backward, 3);
            if (forward <= 0.3 && backward <= 0.1)
            {
                EXPECT_NEAR(exact, backward * f2 / (1 - f2) + b3 * f2 / std::pow(1 - f2, 3), 0.02 * exact);
            }
        }
}

TEST(Fibre, AStackThatEndsThrowsBackWhatItsFibresDoOneByOne)
{
    for (const double backward : {1e-3, 0.05, 0.2, 0.4})
        for (const double lost : {0.0, 1e-3, 0.1, 0.5})
        {
            const double forward = 1.0 - backward - lost;
            double thrown = backward; // of one fibre, then of one more before those that there are
            for (int fibres = 1; fibres <= 16; ++fibres)
            {
                const double found = stack_albedo(forward, backward, double(fibres));
                EXPECT_NEAR(found, thrown - backward, 2e-3) << backward << ' ' << lost << ' ' << fibres;
                thrown = backward + forward * forward * thrown / (1.0 - backward * thrown);
            }
            if (lost >= 0.1) // sixteen are as good as endlessly many
            {
                EXPECT_NEAR(double(in_floats::back_albedo(float(forward), float(backward))), thrown - backward, 1e-3)
                    << backward << ' ' << lost;
            }
        }
}

TEST(Fibre, HandedOnLightIsThatOfAPoissonNumberOfCrossings)
{
    for (const double forward : {0.0, 0.04, 0.5, 0.9, 1.0})
        for (const double tau : {0.0, 1e-6, 0.01, 0.5, 3.0, 20.0, 60.0})
        {
            double sum = 0.0, crossings = 0.0;
            double chance = std::exp(-tau); // of n crossings, times what n hand on
            for (int n = 1; n < 400; ++n)
            {
                chance *= tau / n * forward;
                sum += chance;
                crossings += n * chance;
            }
            EXPECT_NEAR(double(in_floats::forwarded(float(forward), float(tau))), sum, 2e-7) << forward << ' ' << tau;
            const double mean = sum > 1e-300 ? crossings / sum : 1.0;
            EXPECT_NEAR(double(in_floats::fibres_crossed(float(forward), float(tau))), mean, 3e-4 * mean)
                << forward << ' ' << tau;
        }
    EXPECT_EQ(in_floats::forwarded(0.7f, 0.0f), 0.0f);
}

TEST(Fibre, WhatIsThrownBackIsWiderTheMoreItWandered)
{
    EXPECT_NEAR(back_variance(0.0, 0.0, 0.1, 0.2), 0.4, 1e-12) << "twice through, once back";
    const double once = back_variance(0.5, 0.1, 0.05, 0.2);
    EXPECT_GT(back_variance(0.8, 0.1, 0.05, 0.2), once);
    EXPECT_GT(back_variance(0.5, 0.4, 0.05, 0.2), once);
    EXPECT_GT(back_variance(0.5, 0.1, 0.1, 0.2), once);
}

TEST(Fibre, ADyesColourIsBlackerTheMoreItAbsorbs)
{
    double before = 1e9;
    for (const float color : {0.0f, 0.001f, 0.1f, 0.5f, 0.9f, 1.0f, 5.0f})
    {
        const double absorb = double(in_floats::absorption_of(color, 0.0281f));
        EXPECT_LE(absorb, before);
        EXPECT_TRUE(std::isfinite(absorb));
        before = absorb;
    }
    EXPECT_LT(before, 1e-8) << "white hair has no pigment";
}

TEST(Fibre, AllIsFiniteAtTheEnds)
{
    int bad = 0;
    const auto look_at = [&](float v) { bad += !(std::isfinite(v) && v >= 0.0f); };
    for (const double roughness : {0.0, 0.3, 1.0})
        for (const double azimuthal : {0.0, 0.3, 1.0})
            for (const double ior : {1.05, 1.55, 3.0})
                for (const double tilt : {-10.0, 2.0, 10.0})
                {
                    const Fibre fibre = fibre_of(roughness, azimuthal, tilt * kDegree, ior);
                    for (const float light : {-1.0f, -0.7f, 0.0f, 0.3f, 1.0f})
                        for (const float eye : {-1.0f, 0.0f, 0.7f, 1.0f})
                            for (const float between : {-1.0f, -0.3f, 0.0f, 1.0f})
                            {
                                const FibreAngles a = in_floats::fibre_angles(light, eye, between);
                                for (const float further : {0.0f, 1.0f, 60.0f})
                                    for (const float absorb : {0.0f, 1.0f, 100.0f})
                                        for (const bool around : {false, true})
                                        {
                                            const Rgb c = in_floats::far_field(
                                                fibre, a, in_floats::lobe_heights(fibre, a, further),
                                                {absorb, 0.0f, absorb}, 4, around);
                                            look_at(c.r);
                                            look_at(c.g);
                                        }
                                const Rgb k = in_floats::karis(fibre, a, {0.0f, 1.0f, 100.0f},
                                                               float(std::max(roughness, kLeastRoughness)));
                                look_at(k.r);
                                look_at(k.g);
                                look_at(k.b);
                            }
                }
    EXPECT_EQ(bad, 0);
    for (const double roughness : {0.0, 0.3, 1.0})
        for (const double ior : {1.05, 3.0})
        {
            const std::vector<float> table = share_table(roughness, roughness, ior);
            for (const float term : table)
                ASSERT_TRUE(std::isfinite(term)) << roughness << ' ' << ior;
            for (const double absorb : {0.0, 1.0, 100.0, 1e9})
                for (const double sine : {0.0, 0.7, 1.0})
                {
                    const Crossed c = from_table(table, absorb, sine);
                    const float f = float(c.forward), b = float(c.backward);
                    look_at(in_floats::back_albedo(f, b));
                    look_at(float(stack_albedo(f, b, 7.0)));
                    look_at(float(back_variance(f, b, c.forward_variance, c.backward_variance)));
                    for (const float tau : {0.0f, 1e-6f, 60.0f, 1e6f})
                    {
                        look_at(in_floats::fibres_crossed(f, tau));
                        look_at(in_floats::forwarded(f, tau) + 1e-7f); // a difference of what is rounded
                    }
                }
        }
    EXPECT_EQ(bad, 0);
}

} // namespace
} // namespace coif

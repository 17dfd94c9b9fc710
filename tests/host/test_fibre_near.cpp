// One fibre's light (app/traced/fibre_near.h).
#include "app/traced/fibre_near.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace coif
{
namespace
{

constexpr double kPi = std::numbers::pi, kDegree = kPi / 180.0;

FibreNear fibre_of(double roughness, double azimuthal, double tilt_degrees, double h, double absorption = 0.0)
{
    return {{roughness, azimuthal, tilt_degrees * kDegree, 1.55}, h, glm::dvec3(absorption)};
}

// Over all ways that light may come, midpoints of equal steps.
template <typename Value> double integral(int thetas, int phis, Value value)
{
    double sum = 0.0;
    for (int i = 0; i < thetas; ++i)
    {
        const double theta = kPi * ((i + 0.5) / thetas - 0.5);
        for (int k = 0; k < phis; ++k)
            sum += value(std::sin(theta), 2.0 * kPi * (k + 0.5) / phis) * std::cos(theta);
    }
    return sum * kPi / thetas * 2.0 * kPi / phis;
}

TEST(FibreNear, bessel_function_against_its_integral)
{
    // I_0(x) is the mean of exp(x cos t) over a turn (Abramowitz, Stegun 9.6.16).
    for (const double x : {0.0, 0.3, 2.0, 12.0, 24.9, 25.1, 60.0, 700.0, 20000.0})
    {
        double mean = 0.0;
        constexpr int kSteps = 4000;
        for (int i = 0; i < kSteps; ++i)
            mean += std::exp(x * (std::cos(2.0 * kPi * i / kSteps) - 1.0)) / kSteps;
        EXPECT_NEAR(scaled_bessel_i0(x) / mean, 1.0, 1e-12) << x;
    }
}

TEST(FibreNear, a_white_fibre_gives_all_light_back)
{
    for (const double beta : {0.1, 0.3, 0.5, 0.7, 0.9})
        for (const double sin_o : {0.0, 0.5, 0.9})
            for (const double h : {0.0, -0.85})
            {
                const FibreNear fibre = fibre_of(beta, beta, 2.0, h);
                const double all =
                    integral(400, 240, [&](double sin_i, double phi) { return scatter(fibre, sin_o, sin_i, phi).x; });
                EXPECT_NEAR(all, 1.0, 1e-3) << beta << " " << sin_o << " " << h;
            }
}

// Where lobe p of light from straight across peaks, and how far it spreads about that, deg.
struct LobeShape
{
    double peak = 0.0, spread = 0.0;
};

LobeShape shape_of(int lobe, double roughness, double tilt_degrees)
{
    const double variance = longitudinal_variances(roughness)[size_t(lobe)];
    double most = 0.0, sum = 0.0, first = 0.0, second = 0.0;
    LobeShape shape;
    for (int i = -8999; i < 9000; ++i)
    {
        const double theta = 0.01 * i, sin_o = std::sin(theta * kDegree), cos_o = std::cos(theta * kDegree);
        const auto [sin_tilted, cos_tilted] = tilted(lobe, sin_o, cos_o, tilt_degrees * kDegree);
        const double m = longitudinal(0.0, 1.0, sin_tilted, cos_tilted, variance);
        if (m > most)
        {
            most = m;
            shape.peak = theta;
        }
        const double light = m * cos_o; // M is a density over sin theta
        sum += light;
        first += light * theta;
        second += light * theta * theta;
    }
    shape.spread = std::sqrt(second / sum - first * first / (sum * sum));
    return shape;
}

TEST(FibreNear, lobes_lean_as_marschner_measured)
{
    const double wanted[] = {-4.0, 2.0, 8.0};
    for (int p = 0; p < 3; ++p)
        EXPECT_NEAR(shape_of(p, 0.3, 2.0).peak, wanted[p], 0.1) << p;
    for (int p = 0; p < 3; ++p)
        EXPECT_NEAR(shape_of(p, 0.3, -3.0).peak, -1.5 * wanted[p], 0.1) << "tilted the other way, " << p;
}

TEST(FibreNear, the_reflection_itself_leans_to_the_root)
{
    FibreNear fibre = fibre_of(0.1, 0.2, 2.0, 0.0);
    for (const double theta_i : {-30.0, 0.0, 20.0})
    {
        double most = 0.0, peak = 0.0;
        for (double theta = -60.0; theta <= 60.0; theta += 0.05)
            if (const double light =
                    scatter_lobe(fibre, 0, std::sin(theta * kDegree), std::sin(theta_i * kDegree), 0.0).x;
                light > most)
            {
                most = light;
                peak = theta;
            }
        EXPECT_NEAR(peak, -theta_i - 4.0, 1.5) << "Fresnel's reflectance pulls it a little outwards";
    }
}

TEST(FibreNear, lobes_are_as_wide_as_hair)
{
    // Half the angle between light and eye: theta_h.
    EXPECT_NEAR(0.5 * shape_of(0, 0.2, 0.0).spread, 5.1, 0.2);
    EXPECT_NEAR(0.5 * shape_of(0, 0.35, 0.0).spread, 10.1, 0.2);
    for (const double roughness : {0.1, 0.2})
    {
        const double r = shape_of(0, roughness, 0.0).spread;
        EXPECT_NEAR(shape_of(1, roughness, 0.0).spread / r, 0.5, 0.02);
        EXPECT_NEAR(shape_of(2, roughness, 0.0).spread / r, 2.0, 0.1);
    }
}

TEST(FibreNear, samples_fall_where_the_density_says)
{
    // Chi-squared over cells of sin theta_i and phi, that hold equal solid angles.
    constexpr int kThetas = 10, kPhis = 16, kSamples = 40000, kFine = 24;
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (const double beta : {0.2, 0.5, 0.9})
        for (const double sin_o : {-0.6, 0.0, 0.85})
        {
            const FibreNear fibre = {{beta, beta, 0.035, 1.55}, 0.4, {0.2, 0.5, 1.0}};
            std::vector<double> expected(kThetas * kPhis), found(kThetas * kPhis);
            double total = 0.0;
            for (int i = 0; i < kThetas * kFine; ++i)
                for (int k = 0; k < kPhis * kFine; ++k)
                {
                    const double sin_i = 2.0 * (i + 0.5) / (kThetas * kFine) - 1.0;
                    const double phi = 2.0 * kPi * (k + 0.5) / (kPhis * kFine);
                    const double share =
                        sample_pdf(fibre, sin_o, sin_i, phi) * 2.0 / (kThetas * kFine) * 2.0 * kPi / (kPhis * kFine);
                    expected[size_t(i / kFine * kPhis + k / kFine)] += share * kSamples;
                    total += share;
                }
            EXPECT_NEAR(total, 1.0, 2e-3);
            for (int n = 0; n < kSamples; ++n)
            {
                const FibreSample s = sample(
                    fibre, sin_o, {uniform(generator), uniform(generator), uniform(generator), uniform(generator)});
                const double turn = s.phi / (2.0 * kPi), whole = turn - std::floor(turn);
                const int i = std::min(kThetas - 1, int(0.5 * (s.sin_i + 1.0) * kThetas));
                ++found[size_t(i * kPhis + std::min(kPhis - 1, int(whole * kPhis)))];
            }
            double chi = 0.0, rest_expected = 0.0, rest_found = 0.0;
            int cells = 0;
            for (size_t c = 0; c < expected.size(); ++c)
                if (expected[c] < 10.0)
                {
                    rest_expected += expected[c];
                    rest_found += found[c];
                }
                else
                {
                    chi += (found[c] - expected[c]) * (found[c] - expected[c]) / expected[c];
                    ++cells;
                }
            chi += (rest_found - rest_expected) * (rest_found - rest_expected) / std::max(rest_expected, 10.0);
            // Wilson, Hilferty 1931: beyond this lies one in 10,000.
            const double d = cells, bound = d * std::pow(1.0 - 2.0 / (9.0 * d) + 3.72 * std::sqrt(2.0 / (9.0 * d)), 3);
            EXPECT_LT(chi, bound) << beta << " " << sin_o << ", " << cells << " cells";
        }
}

TEST(FibreNear, samples_bring_the_light_that_the_integral_has)
{
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const FibreNear fibre = {{0.3, 0.3, 0.035, 1.55}, -0.3, {0.1, 0.6, 3.0}};
    for (const double sin_o : {0.0, 0.7})
    {
        glm::dvec3 mean(0.0);
        constexpr int kSamples = 40000;
        for (int n = 0; n < kSamples; ++n)
            mean +=
                sample(fibre, sin_o, {uniform(generator), uniform(generator), uniform(generator), uniform(generator)})
                    .weight /
                double(kSamples);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(
                mean[c],
                integral(600, 300, [&](double sin_i, double phi) { return scatter(fibre, sin_o, sin_i, phi)[c]; }),
                0.01);
    }
}

TEST(FibreNear, pigment_takes_light_and_leaves_the_reflection)
{
    for (const double h : {-0.9, 0.0, 0.5})
    {
        const auto clear = attenuation(fibre_of(0.3, 0.3, 2.0, h), 0.3);
        glm::dvec3 before[kLobes] = {clear[0], clear[1], clear[2], clear[3]};
        for (const double sigma : {0.05, 0.3, 1.3, 8.0})
        {
            const auto now = attenuation(fibre_of(0.3, 0.3, 2.0, h, sigma), 0.3);
            EXPECT_NEAR(now[0].x, clear[0].x, 1e-12);
            for (int p = 1; p < kLobes; ++p)
            {
                EXPECT_LT(now[size_t(p)].x, before[p].x) << p << " " << sigma;
                before[p] = now[size_t(p)];
            }
        }
    }
}

TEST(FibreNear, extremes_stay_numbers)
{
    for (const double roughness : {0.0, 1e-6, 0.3, 1.0})
        for (const double h : {-1.0, -0.5, 0.0, 1.0})
            for (const double sin_o : {-1.0, -0.999999, 0.0, 1.0})
                for (const double ior : {1.05, 1.55, 3.0})
                    for (const double absorption : {0.0, 1.0, 1e4, 1e300})
                    {
                        const FibreNear fibre = {
                            {roughness, roughness, -0.17, ior}, h, glm::dvec3(0.0, 0.5 * absorption, absorption)};
                        double sum = 0.0;
                        for (const glm::dvec3& a : attenuation(fibre, sin_o))
                            sum += a.x;
                        EXPECT_NEAR(sum, 1.0, 1e-9) << "white in the first channel";
                        for (const double sin_i : {-1.0, 0.0, 0.7, 1.0})
                            for (const double phi : {-kPi, 0.0, 1.0, 50.0})
                            {
                                const glm::dvec3 light = scatter(fibre, sin_o, sin_i, phi);
                                for (int c = 0; c < 3; ++c)
                                    ASSERT_TRUE(std::isfinite(light[c]) && light[c] >= 0.0)
                                        << roughness << " " << h << " " << sin_o << " " << ior << " " << absorption;
                            }
                        for (const double u : {0.0, 0.5, 0.999999999})
                        {
                            const FibreSample s = sample(fibre, sin_o, {u, u, 1.0 - u, u});
                            ASSERT_TRUE(std::isfinite(s.sin_i) && std::isfinite(s.phi) && std::isfinite(s.pdf));
                            for (int c = 0; c < 3; ++c)
                                ASSERT_TRUE(s.weight[c] >= 0.0 && s.weight[c] <= 4.0);
                        }
                    }
}

} // namespace
} // namespace coif

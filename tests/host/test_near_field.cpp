// One place across a fibre: kernels/near_field.h against the path tracer's fibre, and against the mean that is drawn
// where strands are thin.
#include "app/fibre_shares.h"
#include "app/traced/fibre_near.h"
#include "tests/fibre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{
namespace
{

using in_doubles::Fibre, in_doubles::FibreAngles, in_doubles::LobeHeights, in_doubles::NearPlace, in_doubles::Rgb;

constexpr double kPi = std::numbers::pi;
const FibreLook kLook = {0.3, 0.3, 0.035, 1.55};
const Rgb kBrown = {0.5447, 0.9061, 1.781};

Fibre fibre_of(const FibreLook& look)
{
    const auto f = [](double v) { return float(v); };
    const double tilt = look.tilt;
    return {f(lobe_variance(look.roughness)),
            f(lobe_logistic(look.azimuthal)),
            f(look.ior),
            f(std::sin(tilt)),
            f(std::cos(tilt)),
            f(std::sin(2.0 * tilt)),
            f(std::cos(2.0 * tilt)),
            f(std::sin(4.0 * tilt)),
            f(std::cos(4.0 * tilt))};
}

// phi is signed.
FibreAngles angles(double light, double eye, double phi)
{
    FibreAngles a =
        in_doubles::fibre_angles(std::sin(light), std::sin(eye),
                                 std::sin(light) * std::sin(eye) + std::cos(light) * std::cos(eye) * std::cos(phi));
    a.phi = std::copysign(a.phi, std::remainder(phi, 2.0 * kPi));
    return a;
}

template <typename Visit> void for_some_angles(const Visit& visit)
{
    for (const double light : {-1.1, -0.3, 0.0, 0.5, 1.2})
        for (const double eye : {-0.9, 0.0, 0.2, 1.3})
            for (const double phi : {-3.1, -2.0, -0.7, 0.0, 0.4, 1.5, 2.6})
                visit(light, eye, phi);
}

TEST(NearField, APlaceScattersAsTheTracersFibreDoes)
{
    const Fibre fibre = fibre_of(kLook);
    double worst = 0.0, most = 0.0;
    for_some_angles(
        [&](double light, double eye, double phi)
        {
            const FibreAngles a = angles(light, eye, phi);
            const LobeHeights m = in_doubles::lobe_heights(fibre, a, 0.0);
            for (const double h : {-0.95, -0.4, 0.0, 0.3, 0.8})
            {
                // No slice: lobes as wide as they are.
                const NearPlace place = in_doubles::near_place(fibre, a, kBrown, float(h), 0.0f);
                const Rgb found = in_doubles::near_field(place, m, a.phi, double(fibre.logistic));
                const FibreNear traced = {kLook, h, {kBrown.r, kBrown.g, kBrown.b}};
                const glm::dvec3 truth = scatter(traced, std::sin(eye), std::sin(light), phi);
                const glm::dvec3 is(found.r, found.g, found.b);
                for (int c = 0; c < 3; ++c)
                {
                    worst = std::max(worst, std::abs(is[c] - truth[c]));
                    most = std::max(most, truth[c]);
                }
            }
        });
    EXPECT_GT(most, 1.0);
    EXPECT_LT(worst, 3e-6 * most); // its angles and widths are floats
}

TEST(NearField, TheMeanOverTheWidthIsTheFarField)
{
    constexpr int kPlaces = 256;
    const Fibre fibre = fibre_of(kLook);
    double inside = 0.0, inside_off = 0.0;
    for_some_angles(
        [&](double light, double eye, double phi)
        {
            const FibreAngles a = angles(light, eye, phi);
            LobeHeights m = in_doubles::lobe_heights(fibre, a, 0.0);
            m.r = 0.0;
            double mean = 0.0;
            for (int i = 0; i < kPlaces; ++i)
            {
                const float slice = 2.0f / kPlaces, h = -1.0f + (float(i) + 0.5f) * slice;
                mean += in_doubles::near_field(in_doubles::near_place(fibre, a, kBrown, h, slice), m, a.phi,
                                               double(fibre.logistic))
                            .g /
                        kPlaces;
            }
            const double far = in_doubles::far_field(fibre, a, m, kBrown, kPlaces, false).g;
            inside = std::max(inside, far);
            inside_off = std::max(inside_off, std::abs(mean - far));
        });
    EXPECT_GT(inside, 0.1);
    EXPECT_LT(inside_off, 1e-6 * inside);
}

// Its own lobe widens R, which far_field() has in closed form: they are one where there is hardly a lobe.
TEST(NearField, TheMeanOfTheReflectionIsTheClosedForm)
{
    constexpr int kPlaces = 20000;
    FibreLook smooth = kLook;
    smooth.azimuthal = 0.05;
    const Fibre fibre = fibre_of(smooth);
    const LobeHeights only_r = {1.0, 0.0, 0.0, 0.0};
    for (const double phi : {-2.6, -1.0, 0.0, 0.5, 2.0})
    {
        const FibreAngles a = angles(0.2, -0.3, phi);
        double mean = 0.0;
        for (int i = 0; i < kPlaces; ++i)
        {
            const float slice = 2.0f / kPlaces, h = -1.0f + (float(i) + 0.5f) * slice;
            mean += in_doubles::near_field(in_doubles::near_place(fibre, a, kBrown, h, slice), only_r, a.phi,
                                           double(fibre.logistic))
                        .r /
                    kPlaces;
        }
        EXPECT_NEAR(mean, in_doubles::far_field(fibre, a, only_r, kBrown, 4, false).r, 0.003 * mean) << phi;
    }
}

// Reflected light shows on the side that the light is on, whatever has come through on the other.
TEST(NearField, SidesAreMirrored)
{
    const Fibre fibre = fibre_of(kLook);
    for_some_angles(
        [&](double light, double eye, double phi)
        {
            const FibreAngles a = angles(light, eye, phi);
            const LobeHeights m = in_doubles::lobe_heights(fibre, a, 0.0);
            for (const float h : {0.2f, 0.7f})
            {
                const auto at = [&](float place, double azimuth)
                {
                    return in_doubles::near_field(in_doubles::near_place(fibre, a, kBrown, place, 0.1f), m, azimuth,
                                                  double(fibre.logistic));
                };
                const Rgb one = at(h, phi), other = at(-h, -phi);
                EXPECT_NEAR(one.g, other.g, 1e-6 * one.g + 1e-9);
            }
        });
    const LobeHeights only_r = {1.0, 0.0, 0.0, 0.0};
    const FibreAngles a = angles(0.0, 0.0, 1.2);
    const auto reflected = [&](float h)
    {
        return in_doubles::near_field(in_doubles::near_place(fibre, a, kBrown, h, 0.1f), only_r, a.phi,
                                      double(fibre.logistic))
            .g;
    };
    EXPECT_GT(reflected(-0.55f), 10.0 * reflected(0.55f));
}

TEST(NearField, NothingIsNoNumber)
{
    using in_floats::near_field, in_floats::near_place;
    for (const double roughness : {0.0, 0.3, 1.0})
        for (const double azimuthal : {0.0, 0.3, 1.0})
            for (const double ior : {1.0001, 1.55, 3.0})
                for (const float along : {-1.0f, 0.0f, 1.0f})
                    for (const float eye : {-1.0f, 0.3f, 1.0f})
                        for (const float absorb : {0.0f, 1.0f, 1e4f})
                            for (int cell = 0; cell < 16; ++cell)
                            {
                                const Fibre d = fibre_of({roughness, azimuthal, 0.17, ior});
                                const in_floats::Fibre f = {d.variance,       d.logistic,      d.ior,
                                                            d.sin_tilt,       d.cos_tilt,      d.sin_twice_tilt,
                                                            d.cos_twice_tilt, d.sin_four_tilt, d.cos_four_tilt};
                                const in_floats::FibreAngles a = in_floats::fibre_angles(along, eye, 0.4f);
                                const float s = in_floats::logistic_of(f, a, 0.2f);
                                const in_floats::Rgb found = near_field(
                                    near_place(f, a, {absorb, absorb, absorb}, (float(cell) - 7.5f) / 8.0f, 0.125f),
                                    in_floats::lobe_heights(f, a, 0.2f), a.phi, s);
                                ASSERT_TRUE(std::isfinite(found.r + found.g + found.b) && found.r >= 0.0f)
                                    << roughness << ' ' << azimuthal << ' ' << ior << ' ' << along << ' ' << eye;
                            }
}

// A wide light's disc widens lobes by its own width: as many suns in it do.
TEST(NearField, AWideLightIsManyNarrowOnes)
{
    const Fibre fibre = fibre_of({0.3, 0.1, 0.0, 1.55});
    const double radius = 0.22;
    constexpr int kRings = 40;
    for (const double phi : {0.3, 0.8, 2.2})
    {
        const FibreAngles a = angles(0.0, 0.0, phi);
        const LobeHeights only_r = {1.0, 0.0, 0.0, 0.0};
        const NearPlace place = in_doubles::near_place(fibre, a, kBrown, float(-std::sin(0.5 * phi)), 0.0f);
        double many = 0.0, weights = 0.0;
        for (int i = 0; i < kRings; ++i)
            for (int k = 0; k < kRings; ++k)
            {
                const double x = -1.0 + 2.0 * (i + 0.5) / kRings, y = -1.0 + 2.0 * (k + 0.5) / kRings;
                if (x * x + y * y > 1.0)
                    continue;
                many += in_doubles::near_field(place, only_r, phi + radius * x, double(fibre.logistic)).r;
                weights += 1.0;
            }
        const double one =
            in_doubles::near_field(place, only_r, phi, in_doubles::logistic_of(fibre, a, float(radius * radius))).r;
        const double narrow = in_doubles::near_field(place, only_r, phi, double(fibre.logistic)).r;
        EXPECT_NEAR(one, many / weights, 0.25 * many / weights) << phi;
        EXPECT_GT(narrow, 2.0 * one) << "it matters";
    }
}

} // namespace
} // namespace coif

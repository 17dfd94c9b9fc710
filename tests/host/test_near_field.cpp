// One place across a fibre: kernels/near_field.h against the path tracer's fibre, and against the mean that is drawn
// where strands are thin.
#include "app/fibre_shares.h"
#include "app/traced/fibre_near.h"
#include "kernels/raster.h"
#include "tests/fibre.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace coif
{
namespace
{

using in_doubles::Fibre, in_doubles::FibreAngles, in_doubles::NearLight, in_doubles::Rgb, in_doubles::near_light;

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

NearLight without_r(NearLight light)
{
    light.reflected = 0.0;
    return light;
}

NearLight only_r(NearLight light)
{
    light.tt = light.trt = light.rest = 0.0;
    return light;
}

// What a slice about h scatters, of brown hair.
Rgb near_at(const Fibre& fibre, const FibreAngles& a, float h, float slice, const NearLight& light)
{
    const double r = in_doubles::reflected_beyond(light, in_doubles::reflected_at(h + 0.5f * slice)) -
                     in_doubles::reflected_beyond(light, in_doubles::reflected_at(h - 0.5f * slice));
    return in_doubles::near_field(in_doubles::near_place(fibre, a, kBrown, h, slice), light, r * 2.0 / double(slice));
}

struct Angle
{
    double light, eye, phi;
};

std::vector<Angle> some_angles()
{
    std::vector<Angle> some;
    for (const double light : {-1.1, -0.3, 0.0, 0.5, 1.2})
        for (const double eye : {-0.9, 0.0, 0.2, 1.3})
            for (const double phi : {-3.1, -2.0, -0.7, 0.0, 0.4, 1.5, 2.6})
                some.push_back({light, eye, phi});
    return some;
}

TEST(NearField, APlaceScattersAsTheTracersFibreDoes)
{
    const Fibre fibre = fibre_of(kLook);
    double worst = 0.0, most = 0.0, off_r = 0.0, size_r = 0.0;
    for (const auto& [light, eye, phi] : some_angles())
    {
        const FibreAngles a = angles(light, eye, phi);
        const NearLight l = near_light(fibre, a, 0.0f);
        for (const double h : {-0.95, -0.7, -0.4, 0.0, 0.2, 0.3, 0.8})
        {
            constexpr float kThin = 0.004f; // lobes as wide as they are
            const FibreNear traced = {kLook, double(float(h)), {kBrown.r, kBrown.g, kBrown.b}};
            const glm::dvec3 r = scatter_lobe(traced, 0, std::sin(eye), std::sin(light), phi);
            const glm::dvec3 rest = scatter(traced, std::sin(eye), std::sin(light), phi) - r;
            const Rgb found = near_at(fibre, a, float(h), kThin, without_r(l));
            const glm::dvec3 is(found.r, found.g, found.b);
            for (int c = 0; c < 3; ++c)
            {
                worst = std::max(worst, std::abs(is[c] - rest[c]));
                most = std::max(most, rest[c]);
            }
            off_r += std::pow(near_at(fibre, a, float(h), kThin, only_r(l)).g - r.y, 2);
            size_r += r.y * r.y;
        }
    }
    EXPECT_GT(most, 1.0);
    EXPECT_LT(worst, 3e-6 * most); // its angles and widths are floats
    // Fresnel's share is that in the middle of its lobe, not that of the place.
    EXPECT_GT(size_r, 0.1);
    EXPECT_LT(std::sqrt(off_r / size_r), 0.1);
}

TEST(NearField, TheMeanOverTheWidthIsTheFarField)
{
    constexpr int kPlaces = 256;
    constexpr float kSlice = 2.0f / kPlaces;
    const Fibre fibre = fibre_of(kLook);
    double most = 0.0, worst = 0.0;
    for (const auto& [light, eye, phi] : some_angles())
    {
        if (std::abs(phi) > 2.8) // where R grazes
            continue;
        const FibreAngles a = angles(light, eye, phi);
        double mean = 0.0;
        for (int i = 0; i < kPlaces; ++i)
            mean +=
                near_at(fibre, a, -1.0f + (float(i) + 0.5f) * kSlice, kSlice, near_light(fibre, a, 0.0f)).g / kPlaces;
        const double far =
            in_doubles::far_field(fibre, a, in_doubles::lobe_heights(fibre, a, 0.0), kBrown, kPlaces, false).g;
        most = std::max(most, far);
        worst = std::max(worst, std::abs(mean - far));
    }
    EXPECT_GT(most, 0.1);
    EXPECT_LT(worst, 1e-5 * most);
}

// As many cells as the rasteriser has, whatever a pixel sees of them (kernels/raster_across.h), against places without
// end.
TEST(NearField, CellsAreEnoughForPixels)
{
    constexpr int kFine = 64; // places to a cell
    constexpr float kSlice = 2.0f / NEAR_CELLS;
    const Fibre fibre = fibre_of(kLook);
    for (const int pixels : {1, 3, 5, 8, 16})
    {
        double off = 0.0, size = 0.0;
        for (const auto& [light, eye, phi] : some_angles())
        {
            const FibreAngles a = angles(light, eye, phi);
            const NearLight l = near_light(fibre, a, 0.0f);
            std::vector<double> found(size_t(pixels), 0.0), truth(size_t(pixels), 0.0);
            for (int i = 0; i < NEAR_CELLS * kFine; ++i)
            {
                const double h = -1.0 + 2.0 * (i + 0.5) / (NEAR_CELLS * kFine);
                const size_t pixel = size_t(0.5 * (h + 1.0) * pixels);
                const FibreNear traced = {kLook, h, {kBrown.r, kBrown.g, kBrown.b}};
                truth[pixel] += scatter(traced, std::sin(eye), std::sin(light), phi).y;
                const float middle = -1.0f + (float(i / kFine) + 0.5f) * kSlice;
                found[pixel] += near_at(fibre, a, middle, kSlice, l).g;
            }
            for (size_t i = 0; i < found.size(); ++i)
            {
                off += std::pow(found[i] - truth[i], 2);
                size += truth[i] * truth[i];
            }
        }
        std::printf("%d pixels across: %.3f off\n", pixels, std::sqrt(off / size));
        EXPECT_LT(std::sqrt(off / size), pixels == 1 ? 0.03 : 0.06) << pixels;
    }
}

// Reflected light shows on the side that the light is on, whatever has come through on the other.
TEST(NearField, SidesAreMirrored)
{
    const Fibre fibre = fibre_of(kLook);
    for (const auto& [light, eye, phi] : some_angles())
    {
        const FibreAngles a = angles(light, eye, phi);
        FibreAngles mirrored = a;
        mirrored.phi = -a.phi;
        for (const float h : {0.2f, 0.7f})
        {
            const double one = near_at(fibre, a, h, 0.1f, near_light(fibre, a, 0.0f)).g;
            const double other = near_at(fibre, a, -h, 0.1f, near_light(fibre, mirrored, 0.0f)).g;
            EXPECT_NEAR(one, other, 1e-6 * one + 1e-9);
        }
    }
    const FibreAngles a = angles(0.0, 0.0, 1.2);
    const auto reflected = [&](float h) { return near_at(fibre, a, h, 0.1f, only_r(near_light(fibre, a, 0.0f))).g; };
    EXPECT_GT(reflected(-0.55f), 10.0 * reflected(0.55f));
}

TEST(NearField, NothingIsNoNumber)
{
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
                                const float h = (float(cell) - 7.5f) / 8.0f;
                                const in_floats::NearLight l = in_floats::near_light(f, a, 0.2f);
                                const float r = in_floats::reflected_beyond(l, in_floats::reflected_at(h + 0.0625f)) -
                                                in_floats::reflected_beyond(l, in_floats::reflected_at(h - 0.0625f));
                                const in_floats::Rgb found = in_floats::near_field(
                                    in_floats::near_place(f, a, {absorb, absorb, absorb}, h, 0.125f), l, r);
                                ASSERT_TRUE(std::isfinite(found.r + found.g + found.b) && found.r > -1e-4f)
                                    << roughness << ' ' << azimuthal << ' ' << ior << ' ' << along << ' ' << eye;
                            }
}

// A wide light's disc widens lobes by its own width: as many suns in it do.
TEST(NearField, AWideLightIsManyNarrowOnes)
{
    const Fibre fibre = fibre_of({0.3, 0.1, 0.0, 1.55});
    const double radius = 0.22;
    constexpr int kAcross = 40;
    for (const double phi : {0.3, 0.8, 2.2})
    {
        const FibreAngles a = angles(0.0, 0.0, phi);
        const float h = float(-std::sin(0.5 * phi));
        const NearLight narrow = only_r(near_light(fibre, a, 0.0f));
        double many = 0.0, weights = 0.0;
        for (int i = 0; i < kAcross; ++i)
            for (int k = 0; k < kAcross; ++k)
            {
                const double x = -1.0 + 2.0 * (i + 0.5) / kAcross, y = -1.0 + 2.0 * (k + 0.5) / kAcross;
                if (x * x + y * y > 1.0)
                    continue;
                NearLight there = narrow;
                there.phi += radius * x;
                many += near_at(fibre, a, h, 0.004f, there).r;
                weights += 1.0;
            }
        NearLight wide = only_r(near_light(fibre, a, float(radius * radius)));
        wide.reflected = narrow.reflected; // but for its width along the fibre
        const double one = near_at(fibre, a, h, 0.004f, wide).r;
        EXPECT_NEAR(one, many / weights, 0.1 * many / weights) << phi;
        EXPECT_GT(near_at(fibre, a, h, 0.004f, narrow).r, 2.0 * one) << "it matters";
    }
}

} // namespace
} // namespace coif

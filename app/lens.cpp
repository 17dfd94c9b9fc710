#include "app/lens.h"

#include <cmath>
#include <numbers>

namespace coif
{

// The R2 sequence (Roberts 2018).
glm::vec2 place_in_pixel(int n)
{
    const double a = 0.7548776662466927, b = 0.5698402909980532;
    const double x = 0.5 + a * n, y = 0.5 + b * n;
    return glm::vec2(float(x - std::floor(x) - 0.5), float(y - std::floor(y) - 0.5));
}

// Digits of n mirrored about the point (van der Corput 1935).
static double mirrored(int n, int base)
{
    double value = 0.0, digit = 1.0 / base;
    for (; n > 0; n /= base, digit /= base)
        value += digit * (n % base);
    return value;
}

// Halton's sequence, squares about the middle laid on circles (Shirley, Chiu. A low distortion map between disk and
// square. 1997). It shares no base with R2, so that a place in the pixel meets all of the lens.
glm::vec2 place_on_disc(int n)
{
    const double x = 2.0 * mirrored(n + 1, 2) - 1.0, y = 2.0 * mirrored(n + 1, 3) - 1.0;
    if (x == 0.0 && y == 0.0)
        return {0.0f, 0.0f};
    const bool steep = std::abs(y) > std::abs(x);
    const double radius = steep ? y : x;
    const double turn = std::numbers::pi / 4.0 * (steep ? 2.0 - x / y : y / x);
    return {float(radius * std::cos(turn)), float(radius * std::sin(turn))};
}

double lens_radius(const HairParams& params) { return 0.5e-3 * double(params.camera_aperture); }

double open_seconds(const HairParams& params) { return double(params.camera_shutter) / 24.0; }

bool is_blurred(const HairParams& params) { return lens_radius(params) > 0.0 || open_seconds(params) > 0.0; }

int good_samples(const HairParams& params) { return is_blurred(params) ? 64 : 16; }

} // namespace coif

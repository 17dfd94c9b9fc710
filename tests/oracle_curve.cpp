// The twin of kernels/strand_curve.h.
#include "tests/oracle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace coif::oracle
{

void curve_weights(int curve, double t, double weights[4])
{
    // Rows: the factors of 1, t, t^2, t^3 for each of the four nodes (Catmull and Rom 1974; Bourke 1999 for "cubic").
    static const double catmull_rom[4][4] = {
        {0, -0.5, 1, -0.5}, {1, 0, -2.5, 1.5}, {0, 0.5, 2, -1.5}, {0, 0, -0.5, 0.5}};
    static const double cubic[4][4] = {{0, -1, 2, -1}, {1, 0, -2, 1}, {0, 1, 1, -1}, {0, 0, -1, 1}};
    const double s = curve == 1 ? 0.5 * (1.0 - std::cos(std::numbers::pi * t)) : t;
    const double straight[4] = {0.0, 1.0 - s, s, 0.0};
    for (int i = 0; i < 4; ++i)
    {
        const double* c = curve == 2 ? cubic[i] : catmull_rom[i];
        weights[i] = curve < 2 ? straight[i] : c[0] + c[1] * t + c[2] * t * t + c[3] * t * t * t;
    }
}

double wave_onset(double along, double begin)
{
    const double t = std::clamp((along - begin) / 0.25, 0.0, 1.0);
    return 3.0 * t * t - 2.0 * t * t * t;
}

double strand_random(int seed, int purpose)
{
    // O'Neill 2014: a linear congruential state, and the RXS-M-XS output of 32 bits, of which 24 are used.
    const uint32_t state =
        uint32_t(uint64_t(uint32_t(seed)) * 747796405u + uint64_t(uint32_t(purpose)) * 2891336453u + 277803737u);
    const uint32_t word = (state ^ (state >> (4 + state / (1u << 28)))) * 277803737u;
    return double((word ^ (word >> 22)) >> 8) / 16777216.0;
}

double wave_place(int seed, double distance, double frequency, double randomness)
{
    const double shift = randomness * strand_random(seed, 2);
    const double table = randomness > 0.0 ? std::floor(32.0 * strand_random(seed, 3)) : 0.0;
    return (distance * frequency + shift + table) / 32.0;
}

double profile_at(const float4& profile, double along)
{
    const double of[4] = {profile.x, profile.y, profile.z, profile.w};
    const int piece = std::clamp(int(3.0 * along), 0, 2);
    const double t = 3.0 * along - piece;
    return of[piece] * (1.0 - t) + of[piece + 1] * t;
}

Across curl_at(int together, double begin, double distance, double pitch, double variation, int hand)
{
    const double less = variation * strand_random(together, 7);
    const bool left = hand == 2 ? strand_random(together, 8) < 0.5 : hand == 1;
    const double angle =
        2.0 * std::numbers::pi * (begin + (left ? -1.0 : 1.0) * distance / (pitch * (1.0 - less / 2.0)));
    return {(1.0 - less) * std::cos(angle), (1.0 - less) * std::sin(angle)};
}

Across frizz_at(int seed, double distance, double frequency)
{
    const double most = strand_random(seed, 9), place = distance * frequency + strand_random(seed, 10);
    const auto noise = [&](int side, double at)
    {
        const int cell = int(std::floor(at));
        const double t = at - cell, s = 3.0 * t * t - 2.0 * t * t * t;
        return 2.0 * ((1.0 - s) * strand_random(seed, 256 + 2 * cell + side) +
                      s * strand_random(seed, 258 + 2 * cell + side)) -
               1.0;
    };
    const double own = (0.2 + 0.8 * most * most) / std::sqrt(2.0);
    return {own * noise(0, place), own * noise(1, place + 0.5)};
}

double braid_share(double behind, double pitch)
{
    const double t = std::clamp(3.0 * behind / pitch, 0.0, 1.0);
    return 3.0 * t * t - 2.0 * t * t * t;
}

Vec braid_offset(double behind, Vec place, double pitch, double swing, double depth, double plait, double bound)
{
    // The plait's middle runs along (swing sin a, depth sin 2a, behind); u and v span the plane across it, u level.
    const double rate = 2.0 * std::numbers::pi / pitch, a = rate * behind + place.z;
    const Vec along = glm::normalize(Vec(swing * rate * std::cos(a), 2.0 * depth * rate * std::cos(2.0 * a), 1.0));
    const Vec u = glm::normalize(glm::cross(Vec(0, 1, 0), along)), v = glm::cross(along, u);
    const Vec woven =
        Vec(swing * std::sin(a), depth * std::sin(2.0 * a), 0.0) + plait * (place.x * u + 0.7 * place.y * v);
    // Half a turn before it is bound it begins to be a tassel, which widens over a turn.
    const double beyond = (behind - bound) / pitch, t = std::clamp(1.0 + 2.0 * beyond, 0.0, 1.0);
    const Vec tassel = plait * (0.75 + 0.5 * std::clamp(beyond, 0.0, 1.0)) *
                       Vec(0.6 * std::sin(place.z) + 0.5 * place.x, 0.9 * place.y, 0.0);
    return glm::mix(woven, tassel, 3.0 * t * t - 2.0 * t * t * t);
}

} // namespace coif::oracle

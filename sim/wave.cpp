#include "sim/wave.h"

#include "sim/groom.h"

#include <cmath>
#include <numbers>

namespace coif
{

static constexpr int kPeriods = 32; // WAVE_PERIODS of kernels/strand_curve.h

// A value that wanders between -1 and 1 from wave to wave, smooth and periodic over the table.
static double wander(int seed, double wave, int channel)
{
    const int i = int(std::floor(wave));
    const double t = wave - i, s = t * t * (3.0 - 2.0 * t);
    const double a = 2.0 * double(random01(seed, i % kPeriods, channel)) - 1.0;
    const double b = 2.0 * double(random01(seed, (i + 1) % kPeriods, channel)) - 1.0;
    return a + (b - a) * s;
}

std::vector<float> wave_table(const HairParams& params)
{
    const double randomness[2] = {params.wave_normal_randomness, params.wave_binormal_randomness};
    std::vector<float> table;
    for (int i = 0; i < kWaveSamples; ++i)
        for (int side = 0; side < 2; ++side)
        {
            const double wave = double(i) / kWaveSamples * kPeriods;
            const int channel = 1000 + 2 * side;
            const double height =
                1.0 - 0.5 * randomness[side] * (1.0 + wander(params.interpolation_seed, wave, channel));
            const double lead = 0.4 * randomness[side] * wander(params.interpolation_seed, wave, channel + 1);
            table.push_back(float(height * std::sin(2.0 * std::numbers::pi * (wave + lead + 0.25 * side))));
        }
    return table;
}

} // namespace coif

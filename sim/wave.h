#pragma once
#include "kernels/shared.h"

#include <vector>

namespace coif
{

// The waves of a style as the 1-D texture that the geometry shader reads (thesis, chapter 7): 32 waves in 1024 pairs of
// values in [-1, 1], one for each perpendicular of the strand, the second a quarter wave ahead. Without randomness all
// waves are sines; with it their height and length differ, yet the table still closes on itself.
constexpr int kWaveSamples = 1024;
std::vector<float> wave_table(const HairParams& params); // 2 * kWaveSamples

} // namespace coif

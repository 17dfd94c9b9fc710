// Randomness that hangs on nothing but its arguments, and the waves made of it.
#include "sim/groom.h"
#include "sim/wave.h"
#include "tests/host/scratch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace coif
{
namespace
{

double chi_square(const std::vector<int>& counts, int samples)
{
    const double expected = double(samples) / double(counts.size());
    double sum = 0.0;
    for (const int count : counts)
        sum += (count - expected) * (count - expected) / expected;
    return sum;
}

TEST(Random, is_uniform_over_index_seed_and_channel)
{
    constexpr int kSamples = 1 << 15, kBins = 64;
    for (int walked = 0; walked < 3; ++walked)
        for (const int fixed : {0, 1, 77, 1000000})
        {
            std::vector<int> counts(kBins);
            double mean = 0.0;
            for (int i = 0; i < kSamples; ++i)
            {
                const float x = walked == 0   ? random01(fixed, i, 2)
                                : walked == 1 ? random01(i, fixed, 2)
                                              : random01(2, fixed, i);
                ASSERT_GE(x, 0.0f);
                ASSERT_LT(x, 1.0f);
                mean += double(x) / kSamples;
                ++counts[size_t(x * kBins)];
            }
            EXPECT_NEAR(mean, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kSamples)) << walked << " " << fixed;
            // 63 degrees of freedom: outside these once in some 10,000 fair trials.
            EXPECT_LT(chi_square(counts, kSamples), 112.0) << walked << " " << fixed;
            EXPECT_GT(chi_square(counts, kSamples), 28.0) << walked << " " << fixed;
        }
}

TEST(Random, neighbours_and_channels_do_not_follow_each_other)
{
    constexpr int kSamples = 1 << 15;
    double next = 0.0, channel = 0.0, seed = 0.0;
    for (int i = 0; i < kSamples; ++i)
    {
        const double here = random01(1, i, 0) - 0.5;
        next += here * (random01(1, i + 1, 0) - 0.5);
        channel += here * (random01(1, i, 1) - 0.5);
        seed += here * (random01(2, i, 0) - 0.5);
    }
    const double bound = 5.0 / 12.0 / std::sqrt(double(kSamples));
    EXPECT_NEAR(next / kSamples, 0.0, bound);
    EXPECT_NEAR(channel / kSamples, 0.0, bound);
    EXPECT_NEAR(seed / kSamples, 0.0, bound);
}

TEST(Random, gives_the_same_number_for_the_same_arguments)
{
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(random01(3, i, 5), random01(3, i, 5));
    EXPECT_NE(random01(3, 1, 5), random01(4, 1, 5));
    EXPECT_NE(random01(3, 1, 5), random01(3, 2, 5));
    EXPECT_NE(random01(3, 1, 5), random01(3, 1, 6));
}

HairParams with_randomness(float normal, float binormal, int seed = 1)
{
    HairParams params;
    params.wave_normal_randomness = normal;
    params.wave_binormal_randomness = binormal;
    params.interpolation_seed = seed;
    return params;
}

TEST(Wave, without_randomness_the_two_sides_are_sine_and_cosine)
{
    const std::vector<float> table = wave_table(with_randomness(0.0f, 0.0f));
    ASSERT_EQ(table.size(), 2048u);
    for (int i = 0; i < kWaveSamples; ++i)
    {
        const double turn = 2.0 * std::numbers::pi * 32.0 * i / kWaveSamples;
        EXPECT_NEAR(table[size_t(2 * i)], std::sin(turn), 1e-6) << i;
        EXPECT_NEAR(table[size_t(2 * i + 1)], std::cos(turn), 1e-6) << i;
    }
}

TEST(Wave, values_stay_within_one_and_the_table_closes_on_itself)
{
    for (const float randomness : {0.0f, 0.3f, 1.0f})
        for (int seed = 0; seed < 20; ++seed)
        {
            const std::vector<float> table = wave_table(with_randomness(randomness, randomness, seed));
            for (size_t side = 0; side < 2; ++side)
            {
                // No step is longer than the steepest wave allows, and neither is the one from the end to the
                // beginning: d/dwave of height * sin(2 pi (wave + lead)), with lead <= 0.4 and its slope <= 0.4 * 2
                // * 1.5.
                const double steepest = 2.0 * std::numbers::pi * (1.0 + 1.2 * randomness) + 1.5 * randomness;
                for (size_t i = 0; i < kWaveSamples; ++i)
                {
                    ASSERT_LE(std::abs(table[2 * i + side]), 1.0f);
                    const float next = table[2 * ((i + 1) % kWaveSamples) + side];
                    ASSERT_LE(std::abs(next - table[2 * i + side]), steepest / 32.0 + 1e-6)
                        << "seed " << seed << " side " << side << " at " << i;
                }
            }
        }
}

TEST(Wave, randomness_changes_only_its_own_side_and_hangs_on_the_seed)
{
    const std::vector<float> calm = wave_table(with_randomness(0.0f, 0.0f)),
                             half = wave_table(with_randomness(0.0f, 0.5f));
    int differing = 0;
    for (size_t i = 0; i < kWaveSamples; ++i)
    {
        EXPECT_EQ(calm[2 * i], half[2 * i]);
        differing += calm[2 * i + 1] != half[2 * i + 1];
    }
    EXPECT_GT(differing, 900);
    EXPECT_EQ(half, wave_table(with_randomness(0.0f, 0.5f)));
    EXPECT_NE(half, wave_table(with_randomness(0.0f, 0.5f, 2)));
}

} // namespace
} // namespace coif

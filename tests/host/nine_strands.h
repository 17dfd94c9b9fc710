// The hair of tests/exchange: nine strands of 5 to 9 points on a ball of 9 cm, as the samples there hold them.
#pragma once
#include "sim/exchange/curves.h"

#include <cmath>
#include <numbers>

namespace coif::test
{

// `sway` (m) bends the tips.
inline Curves nine_strands(double sway = 0.0)
{
    Curves curves;
    const double head = 0.09, length = 0.2;
    for (int i = 0; i < 9; ++i)
    {
        const double turn = 2.0 * std::numbers::pi * i / 9.0;
        const int points = 5 + i % 5;
        const double out[3] = {0.5 * std::cos(turn), std::sqrt(0.75), 0.5 * std::sin(turn)};
        for (int j = 0; j < points; ++j)
        {
            const double s = double(j) / (points - 1), r = head + length * s * (1.0 - 0.5 * s);
            curves.position.push_back(glm::vec3(float(out[0] * r + sway * s * s),
                                                float(out[1] * r - 0.6 * length * s * s),
                                                float(out[2] * r + 0.004 * std::sin(9.0 * s + i))));
            curves.width.push_back(float(8e-5 * (1.0 - 0.7 * s)));
            curves.color.push_back({float(0.20 + 0.02 * i), 0.10f, 0.05f});
        }
        curves.count.push_back(uint32_t(points));
        curves.root_uv.push_back({float(0.5 + 0.4 * std::cos(turn)), float(0.5 + 0.4 * std::sin(turn))});
        curves.guide.push_back(i % 3 == 0);
    }
    return curves;
}

} // namespace coif::test

// Mitsuba 3, linearcurve: x y z radius a line, an empty line between strands. A bsplinecurve would not pass the points.
#include "sim/exchange/write.h"

#include <glm/common.hpp>

namespace coif
{

static constexpr int kPieces = 4; // of a segment of a Catmull-Rom curve

void write_mitsuba(NewFile& file, const Curves& curves, const FileWords& words)
{
    const auto line = [&](const glm::vec3& at, float width)
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            file.number(at[axis]);
            file.add(" ");
        }
        file.number(0.5f * width);
        file.add("\n");
    };
    const std::vector<size_t> first = first_points(curves);
    const int pieces = words.through == Through::LINES ? 1 : kPieces;
    for (size_t s = 0; s < curves.strands(); ++s)
    {
        const glm::vec3* p = &curves.position[first[s]];
        const float* width = &curves.width[first[s]];
        const size_t last = curves.count[s] - 1;
        line(p[0], width[0]);
        for (size_t k = 0; k < last; ++k)
        {
            const glm::vec3 before = k == 0 ? 2.0f * p[0] - p[1] : p[k - 1];
            const glm::vec3 after = k + 1 == last ? 2.0f * p[last] - p[last - 1] : p[k + 2];
            for (int i = 1; i < pieces; ++i)
            {
                const float t = float(i) / float(pieces), t2 = t * t, t3 = t2 * t;
                line(0.5f * ((2.0f * t2 - t3 - t) * before + (3.0f * t3 - 5.0f * t2 + 2.0f) * p[k] +
                             (4.0f * t2 - 3.0f * t3 + t) * p[k + 1] + (t3 - t2) * after),
                     glm::mix(width[k], width[k + 1], t));
            }
            line(p[k + 1], width[k + 1]);
        }
        file.add("\n");
    }
}

} // namespace coif

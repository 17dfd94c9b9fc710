// Each node follows its leader at the link's length, in one walk from root to tip: never any stretch. Mueller, Kim,
// Chentanez. Fast simulation of inextensible hair and fur. 2012. The walk moves only the outer node, as if each were
// infinitely heavier than the next; part of what the next one was moved by is given back to the velocity for it
// (dynamic follow-the-leader), which is what keeps the hair from whipping, and damps it.
#include "sim/models/all.h"
#include "sim/models/strand.h"

namespace coif::study
{

constexpr double kCorrection = 0.9; // 1 is stable and lame, less is livelier

Result run_ftl(const Scene& scene, double fps, double seconds, int substeps)
{
    Strand strand(scene);
    const int links = strand.links;
    std::vector<glm::dvec3> to(links + 1), moved(links + 1);
    const auto step = [&](double t, double h)
    {
        predict(strand, t, h, to);
        push_out(strand, to);
        for (int i = 1; i <= links; ++i)
        {
            const glm::dvec3 along = to[i] - to[i - 1];
            const double length = glm::length(along);
            const glm::dvec3 direction = length > 0.0 ? along / length : glm::dvec3(0.0, -1.0, 0.0);
            const glm::dvec3 follow = to[i - 1] + strand.rest * direction;
            moved[i] = follow - to[i];
            to[i] = follow;
        }
        arrive(strand, h, to);
        for (int i = 1; i < links; ++i)
            strand.v[i] -= kCorrection / h * moved[i + 1];
    };
    return play(strand, fps, seconds, substeps, step);
}

} // namespace coif::study

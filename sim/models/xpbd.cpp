// Position based dynamics with its sweeps turned into substeps, and constraints with a compliance, so that bending is a
// material. Macklin, Mueller, Chentanez. XPBD: position-based simulation of compliant constrained dynamics. 2016;
// Macklin et al. Small steps in physics simulation. 2019: one sweep a substep beats many sweeps of one step, because
// what a sweep leaves over shrinks with the square of the step.
#include "sim/models/all.h"
#include "sim/models/strand.h"

namespace coif::study
{
namespace
{

// Second differences are the constraint, the reciprocal of their energy's factor the compliance,
// by the time that a force's impulse takes effect over (h^2 but for drag). The multiplier starts
// at zero with each substep (Macklin et al. 2019), so equation 18 of 2016 has no term of it. Every third
// hinge at a time, as a device would: none of them share a node.
void bend(const Strand& strand, double impulse, std::vector<glm::dvec3>& to)
{
    glm::dvec3 clamp = strand.clamp(to[0]);
    for (int first = 0; first < 3; ++first)
        for (int i = first; i < strand.links; i += 3)
        {
            glm::dvec3& before = i > 0 ? to[i - 1] : clamp;
            const double w_before = i > 0 ? strand.w[i - 1] : 0.0;
            const double compliance = 1.0 / (strand.hinge(i) * impulse);
            const glm::dvec3 push =
                (before - 2.0 * to[i] + to[i + 1]) / (w_before + 4.0 * strand.w[i] + strand.w[i + 1] + compliance);
            before -= w_before * push;
            to[i] += 2.0 * strand.w[i] * push;
            to[i + 1] -= strand.w[i + 1] * push;
        }
}

void keep_lengths(const Strand& strand, std::vector<glm::dvec3>& to)
{
    for (const int first : {1, 2})
        for (int i = first; i <= strand.links; i += 2)
        {
            const glm::dvec3 along = to[i] - to[i - 1];
            const double length = glm::length(along), weights = strand.w[i - 1] + strand.w[i];
            if (!(length > 0.0 && weights > 0.0))
                continue;
            const glm::dvec3 pull = (1.0 - strand.rest / length) / weights * along;
            to[i - 1] += strand.w[i - 1] * pull;
            to[i] -= strand.w[i] * pull;
        }
}

} // namespace

Result run_xpbd(const Scene& scene, double fps, double seconds, int substeps)
{
    Strand strand(scene);
    std::vector<glm::dvec3> to(strand.links + 1);
    const auto step = [&](double t, double h)
    {
        predict(strand, t, h, to);
        push_out(strand, to);
        if (strand.stiffness > 0.0)
            bend(strand, h * Drag(scene.drag, h).gain, to);
        keep_lengths(strand, to);
        arrive(strand, h, to);
    };
    return play(strand, fps, seconds, substeps, step);
}

} // namespace coif::study

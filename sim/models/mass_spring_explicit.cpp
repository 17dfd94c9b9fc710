// Masses, springs and hinges, stepped explicitly: the first hair dynamics there was. Rosenblum, Carlson, Tripp.
// Simulating the structure and dynamics of human hair. 1991; thesis 2.1.1.
//
// The spring's constant is ours, because the paper's is tuned by eye: such that the whole strand's weight stretches the
// root's link by kGive. Its fastest waves want h < 2 / w_max = h < sqrt(m / k), w_max^2 = 4 k / m (Courant, Friedrichs,
// Lewy 1928), so stiffer springs cost substeps and nothing else sets their number.
#include "sim/models/all.h"
#include "sim/models/strand.h"

namespace coif::study
{

static void add_springs(const Strand& strand, double stiffness, std::vector<glm::dvec3>& force)
{
    for (int i = 1; i <= strand.links; ++i)
    {
        const glm::dvec3 along = strand.x[i] - strand.x[i - 1];
        const double length = glm::length(along);
        if (!(length > 0.0))
            continue; // no direction to push along
        const glm::dvec3 pull = stiffness * (1.0 - strand.rest / length) * along;
        force[i] -= pull;
        force[i - 1] += pull;
    }
}

Result run_mass_spring_explicit(const Scene& scene, double fps, double seconds, int substeps)
{
    Strand strand(scene);
    const double stiffness = spring_stiffness(strand);
    std::vector<glm::dvec3> to(strand.links + 1), force(strand.links + 1);
    const auto step = [&](double t, double h)
    {
        std::fill(force.begin(), force.end(), glm::dvec3(0.0));
        add_springs(strand, stiffness, force);
        add_hinges(strand, strand.x, force);
        const double gain = strand.kick * Drag(scene.drag, h).gain; // before predict() ends the first substep's half
        predict(strand, t, h, to);
        for (int i = 1; i <= strand.links; ++i)
            to[i] += h * gain * strand.w[i] * force[i];
        push_out(strand, to);
        arrive(strand, h, to);
    };
    return play(strand, fps, seconds, substeps, step);
}

} // namespace coif::study

// The thesis' own solver: one prediction a frame, then sweeps over constraints on positions. Mueller, Heidelberger,
// Hennix, Ratcliff. Position based dynamics. 2007; thesis 5.1.2 and listing A.1, its mistakes mended. More sweeps
// approach implicit Euler at the frame's step and no further, whatever their number.
//
// The strength of bending is no material: what it does depends on the sweeps and on the frame (thesis eq. 5.5 and 5.6).
#include "sim/models/all.h"
#include "sim/models/strand.h"

#include <numbers>

namespace coif::study
{
namespace
{

// Moves two nodes along their difference towards a distance, each by its share of their inverse masses.
void keep_distance(glm::dvec3& a, glm::dvec3& b, double wa, double wb, double distance, double strength)
{
    const glm::dvec3 along = b - a;
    const double length = glm::length(along);
    if (!(length > 0.0 && wa + wb > 0.0))
        return;
    const glm::dvec3 move = strength * (1.0 - distance / length) / (wa + wb) * along;
    a += wa * move;
    b -= wb * move;
}

// Every other link, none of which share a node, then the rest (Tariq, Bavoil. Real time hair simulation. 2008). The
// listing's even links come first; there node 0 is the clamp, so the root's own link is an odd one.
void keep_lengths(const Strand& strand, std::vector<glm::dvec3>& nodes, double strength)
{
    for (const int first : {2, 1})
        for (int i = first; i <= strand.links; i += 2)
            keep_distance(nodes[i - 1], nodes[i], strand.w[i - 1], strand.w[i], strand.rest, strength);
}

// As far from the clamp as on a straight strand, weaker with each node (attenuation 1); only the outer node moves.
void straighten(const Strand& strand, std::vector<glm::dvec3>& nodes, double strength)
{
    glm::dvec3 clamp = strand.clamp(nodes[0]);
    for (int i = 1; i <= strand.links; ++i)
        keep_distance(clamp, nodes[i], 0.0, strand.w[i], (i + 1) * strand.rest, strength / i);
}

Result run(const Scene& scene, double fps, double seconds, int iterations, double over_relaxation)
{
    Strand strand(scene);
    std::vector<glm::dvec3> to(strand.links + 1);
    const double strength = 1.0 - std::pow(1.0 - std::clamp(scene.bending, 0.0, 1.0), 1.0 / iterations); // eq. 5.5
    const auto step = [&](double t, double h)
    {
        predict(strand, t, h, to);
        for (int sweep = 1; sweep <= iterations; ++sweep)
        {
            push_out(strand, to);
            // The last sweep leaves no overshoot.
            keep_lengths(strand, to, sweep < iterations ? over_relaxation : 1.0);
            if (scene.gamma > 0.0)
                straighten(strand, to, strength);
        }
        arrive(strand, h, to);
    };
    return play(strand, fps, seconds, 1, step);
}

} // namespace

Result run_pbd(const Scene& scene, double fps, double seconds, int iterations)
{
    return run(scene, fps, seconds, iterations, 1.0);
}

// Sweeps that overshoot converge in about N of them instead of N^2. The best factor is that of a straight chain of N
// links with one end held, whose sweeps' error modes are known (Young 1954).
Result run_pbd_over_relaxed(const Scene& scene, double fps, double seconds, int iterations)
{
    const double best = 2.0 / (1.0 + std::sin(std::numbers::pi / (2.0 * scene.links + 1.0)));
    return run(scene, fps, seconds, iterations, best);
}

} // namespace coif::study

// Links of fixed length by one tridiagonal solve a substep, pushed apart and together along the directions that they
// had at its start: then the scheme is Verlet's with exact constraint forces, of second order and without damping of
// its own. Ryckaert, Ciccotti, Berendsen. Numerical integration of the cartesian equations of motion of a system with
// constraints. 1977 (SHAKE); as a direct solve along a strand: Han, Harada. Tridiagonal matrix formulation for
// inextensible hair strand simulation. 2013.
//
// Nothing guards it here: where a link turns by more than a right angle in a substep, or h is longer than the fastest
// wave across the strand allows (2 / w_max), the links fly apart. With many substeps it is the reference for
// scenes that have none.
//
// Bending is implicit, of second differences, whose matrix is constant: (M + h g K) d = M h v - h g K x, where g is h
// but for drag. A prediction that ignores the links' forces is bent against the wrong ones, and the droop would depend
// on h; so the forces of the last substep's solve act in it, and the solve adds what they lack.
#include "sim/models/all.h"
#include "sim/models/banded.h"
#include "sim/models/strand.h"

namespace coif::study
{
namespace
{

using Vectors = std::vector<glm::dvec3>;

// The solves' unknowns, kept from substep to substep so that nothing is allocated in one.
struct Work
{
    explicit Work(int links) : multipliers(links + 1), above(links + 1), step(links + 1), side(links) {}

    std::vector<double> multipliers; // of links 1 and up: the last substep's, which bending starts from
    std::vector<double> above, step; // the elimination's upper diagonal, and what a Newton step adds to multipliers
    Vectors side;                    // of nodes 1 and up
};

// M + `impulse` K of nodes 1 to links.
Banded<2> bending_matrix(const Strand& strand, double impulse)
{
    Banded<2> matrix(strand.links);
    for (int i = 1; i <= strand.links; ++i)
        matrix.at(i - 1, i - 1) = i == strand.links ? strand.scene.tip_mass : 1.0;
    const double share[] = {1.0, -2.0, 1.0};
    for (int i = 0; i < strand.links; ++i)
        for (int p = 0; p < 3; ++p)
            for (int q = 0; q <= p; ++q)
                if (i - 1 + q >= 1)
                    matrix.at(i - 2 + p, i - 2 + q) += impulse * strand.hinge(i) * share[p] * share[q];
    if (strand.scene.tip)
        matrix.hold(strand.links - 1);
    matrix.factor();
    return matrix;
}

// Bends the prediction `to`. `links` are those at the start.
void bend(const Strand& strand, Banded<2>& matrix, double impulse, const Vectors& links, Work& work, Vectors& to)
{
    const int count = strand.links;
    Vectors& side = work.side;
    const std::vector<double>& carried = work.multipliers;
    for (int i = 1; i <= count; ++i)
    {
        const double mass = i == count ? strand.scene.tip_mass : 1.0;
        side[i - 1] = mass * (to[i] - strand.x[i]) - carried[i] * links[i];
        if (i < count)
            side[i - 1] += carried[i + 1] * links[i + 1];
    }
    for (int i = 0; i < count; ++i)
    {
        // Node 0 and the clamp are already where they go.
        const glm::dvec3 here = i == 0 ? to[0] : strand.x[i];
        const glm::dvec3 before = i == 0 ? strand.clamp(to[0]) : i == 1 ? to[0] : strand.x[i - 1];
        const glm::dvec3 push = impulse * strand.hinge(i) * ((strand.x[i + 1] - here) - (here - before));
        side[i] -= push;
        if (i >= 1)
            side[i - 1] += 2.0 * push;
        if (i >= 2)
            side[i - 2] -= push;
    }
    if (strand.scene.tip)
        side[count - 1] = to[count] - strand.x[count];
    matrix.solve(side);
    for (int i = 1; i <= count; ++i)
        to[i] = strand.x[i] + side[i - 1];
}

// One Newton step on |to[i] - to[i-1]|^2 = rest^2, moving nodes along `links`. Adds to the multipliers.
void keep_lengths(const Strand& strand, const Vectors& links, Work& work, Vectors& to)
{
    const int count = strand.links;
    const std::vector<double>& w = strand.w;
    std::vector<double>& above = work.above;
    std::vector<double>& step = work.step;
    for (int i = 1; i <= count; ++i)
    {
        const glm::dvec3 now = to[i] - to[i - 1];
        const double below = i > 1 ? -w[i - 1] * glm::dot(now, links[i - 1]) : 0.0;
        const double pivot = (w[i - 1] + w[i]) * glm::dot(now, links[i]) - below * above[i - 1];
        above[i] = i < count ? -w[i] * glm::dot(now, links[i + 1]) / pivot : 0.0;
        step[i] = ((glm::dot(now, now) - strand.rest * strand.rest) / 2.0 - below * step[i - 1]) / pivot;
    }
    for (int i = count - 1; i >= 1; --i)
        step[i] -= above[i] * step[i + 1];
    for (int i = 1; i <= count; ++i)
    {
        work.multipliers[i] += step[i];
        to[i] -= w[i] * step[i] * links[i];
        to[i - 1] += w[i - 1] * step[i] * links[i];
    }
}

} // namespace

Result run_shake(const Scene& scene, double fps, double seconds, int substeps)
{
    Strand strand(scene);
    const int count = strand.links;
    const double substep = 1.0 / (fps * substeps), impulse = substep * Drag(scene.drag, substep).gain;
    Banded<2> matrix = bending_matrix(strand, impulse);
    Vectors to(count + 1), links(count + 1);
    Work work(count);
    const auto step = [&](double t, double h)
    {
        for (int i = 1; i <= count; ++i)
            links[i] = strand.x[i] - strand.x[i - 1];
        predict(strand, t, h, to);
        if (strand.stiffness > 0.0)
            bend(strand, matrix, impulse, links, work, to);
        keep_lengths(strand, links, work, to);
        push_out(strand, to);
        arrive(strand, h, to);
    };
    return play(strand, fps, seconds, substeps, step);
}

} // namespace coif::study

// The same masses and springs, stepped implicitly: stable at any step, at the price of damping that is the step's and
// not the hair's. Baraff, Witkin. Large steps in cloth simulation. 1998, equation 6, one linear solve a step:
//
//   (M + h g K) dv = g (f - h K v)     K = -df/dx at the start of the step; g: h but for drag
//
// A strand's K has bands, so the solve is direct where cloth needs conjugate gradients. Hinges are the quadratic ones
// of second differences, whose K is constant and never indefinite.
#include "sim/models/all.h"
#include "sim/models/banded.h"
#include "sim/models/strand.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace coif::study
{
namespace
{

// Three unknowns a node, coupled to the two nodes on either side: the farthest are 2 * 3 + 2 apart.
using Matrix = Banded<8>;

// Adds to the entries that couple two nodes; node 0 and the clamp are prescribed and have none.
void add(Matrix& matrix, int node, int other, const glm::dmat3& entry)
{
    if (other > node)
        std::swap(node, other);
    if (other < 1)
        return;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            if (node != other || column <= row)
                matrix.at(3 * (node - 1) + row, 3 * (other - 1) + column) += entry[column][row];
}

void add(std::vector<double>& side, int node, glm::dvec3 value)
{
    for (int axis = 0; node >= 1 && axis < 3; ++axis)
        side[3 * (node - 1) + axis] += value[axis];
}

} // namespace

Result run_mass_spring_implicit(const Scene& scene, double fps, double seconds, int substeps)
{
    Strand strand(scene);
    const int links = strand.links;
    const double stiffness = spring_stiffness(strand);
    std::vector<glm::dvec3> to(links + 1);
    Matrix matrix(3 * links);
    std::vector<double> side(3 * links);
    const auto step = [&](double t, double h)
    {
        const Drag drag(scene.drag, h);
        std::vector<glm::dvec3>& v = strand.v;
        for (int i = 1; i <= links; ++i)
            v[i] *= drag.keep;
        v[0] = (scene.root(t) - strand.x[0]) / h;

        matrix.clear();
        std::fill(side.begin(), side.end(), 0.0);
        for (int i = 1; i <= links; ++i)
        {
            const double mass = i == links ? scene.tip_mass : 1.0;
            add(matrix, i, i, glm::dmat3(mass));
            add(side, i, mass * drag.gain * strand.acceleration(i));
        }
        for (int i = 1; i <= links; ++i)
        {
            const glm::dvec3 along = strand.x[i] - strand.x[i - 1];
            const double length = glm::length(along);
            if (!(length > 0.0))
                continue; // no direction to push along
            const glm::dvec3 unit = along / length;
            // Across the spring only what tension adds: a compressed one would make the matrix indefinite.
            const double across = std::max(0.0, 1.0 - strand.rest / length);
            const glm::dmat3 k =
                stiffness * (across * glm::dmat3(1.0) + (1.0 - across) * glm::outerProduct(unit, unit));
            const glm::dvec3 pull = stiffness * (length - strand.rest) * unit + h * k * (v[i] - v[i - 1]);
            add(side, i, -drag.gain * pull);
            add(side, i - 1, drag.gain * pull);
            add(matrix, i, i, h * drag.gain * k);
            add(matrix, i - 1, i - 1, h * drag.gain * k);
            add(matrix, i, i - 1, -h * drag.gain * k);
        }
        for (int i = 0; i < links && strand.stiffness > 0.0; ++i)
        {
            const glm::dvec3 before = i > 0 ? strand.x[i - 1] : strand.clamp(strand.x[0]);
            const glm::dvec3 difference = before - 2.0 * strand.x[i] + strand.x[i + 1];
            const glm::dvec3 rate = v[std::max(i - 1, 0)] - 2.0 * v[i] + v[i + 1]; // the clamp moves with node 0
            const double share[] = {1.0, -2.0, 1.0};
            for (int p = 0; p < 3; ++p)
            {
                add(side, i - 1 + p, -drag.gain * strand.hinge(i) * share[p] * (difference + h * rate));
                for (int q = 0; q <= p; ++q)
                    add(matrix, i - 1 + p, i - 1 + q,
                        glm::dmat3(h * drag.gain * strand.hinge(i) * share[p] * share[q]));
            }
        }
        for (int axis = 0; scene.tip && axis < 3; ++axis)
        {
            matrix.hold(3 * (links - 1) + axis);
            side[3 * (links - 1) + axis] = 0.0;
        }
        matrix.factor();
        matrix.solve(side);

        to[0] = scene.root(t);
        for (int i = 1; i <= links; ++i)
            to[i] = strand.x[i] + h * (v[i] + glm::dvec3(side[3 * i - 3], side[3 * i - 2], side[3 * i - 1]));
        if (scene.tip)
            to[links] = *scene.tip;
        push_out(strand, to);
        arrive(strand, h, to);
    };
    return play(strand, fps, seconds, substeps, step);
}

} // namespace coif::study

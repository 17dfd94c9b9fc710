// A serial chain of rigid links on ball joints, in the joints' own coordinates: what can change is each link's
// direction, so nothing can stretch. Hadap, Magnenat-Thalmann. Modeling dynamic hair as a continuum. 2001, whose
// articulated bodies are those of Featherstone. The calculation of robot dynamics using articulated-body inertias.
// 1983; thesis 2.1.1.
//
// With its mass in a point at the outer end, a link hands on only what lies along it. So the outer part of the strand,
// felt from node i - 1, weighs as much as the rank-one matrix s u u^T, and Featherstone's sweep from tip to root
// becomes
//
//   A_i = m_i + s u u^T,  p_i = -f_i + s c u         of the link outside node i: force = A a + p
//   s = 1 / (u . A^-1 u),  c = u . A^-1 p - |du/dt|^2 l
//
// and the sweep from root to tip  T = s (u . a_(i-1) + c),  a_i = A^-1 (T u - p).
#include "sim/models/all.h"
#include "sim/models/strand.h"

namespace coif::study
{
namespace
{

using Vectors = std::vector<glm::dvec3>;

// A = mass + scale u u^T, whose inverse is closed (Sherman, Morrison 1950).
struct Inertia
{
    double mass = 1.0, scale = 0.0;
    glm::dvec3 u{0.0};

    glm::dvec3 solve(glm::dvec3 force) const
    {
        return (force - scale / (mass + scale) * glm::dot(u, force) * u) / mass;
    }
};

struct Chain
{
    explicit Chain(const Scene& scene)
        : strand(scene), u(strand.links), rate(strand.links), inertia(strand.links + 1), bias(strand.links + 1),
          force(strand.links + 1), scale(strand.links), offset(strand.links)
    {
        for (int i = 0; i < strand.links; ++i)
            u[i] = (strand.x[i + 1] - strand.x[i]) / strand.rest;
    }

    Strand strand;
    Vectors u, rate; // link i's direction, from node i to node i + 1, and its change, 1/s
    // Of the sweeps.
    std::vector<Inertia> inertia;
    Vectors bias, force;
    std::vector<double> scale, offset;
};

void place_nodes(Chain& c, glm::dvec3 root, const Vectors& u)
{
    c.strand.x[0] = root;
    for (int i = 0; i < c.strand.links; ++i)
        c.strand.x[i + 1] = c.strand.x[i] + c.strand.rest * u[i];
}

// d^2 u / dt^2 without drag on the nodes' motion about the root, which the integrator knows exactly.
void bend(Chain& c, double t, const Vectors& u, const Vectors& rate, Vectors& out)
{
    Strand& strand = c.strand;
    const Scene& scene = strand.scene;
    const int links = strand.links;
    // The root's velocity and acceleration by central differences: at a thousandth of a frame of 60 Hz, rounding and
    // truncation are both below 1e-6 of what hair moves by.
    const double e = 1.0 / 60000.0;
    const glm::dvec3 before = scene.root(t - e), now = scene.root(t), after = scene.root(t + e);
    const glm::dvec3 root_velocity = (after - before) / (2.0 * e);
    glm::dvec3 a = (after - 2.0 * now + before) / (e * e);

    place_nodes(c, now, u);
    c.force[0] = {};
    for (int i = 1; i <= links; ++i)
        c.force[i] = (i == links ? scene.tip_mass : 1.0) * (strand.acceleration(i) - scene.drag * root_velocity);
    add_hinges(strand, strand.x, c.force);

    c.inertia[links] = {scene.tip_mass, 0.0, {}};
    c.bias[links] = -c.force[links];
    for (int i = links - 1; i >= 0; --i)
    {
        c.scale[i] = 1.0 / glm::dot(u[i], c.inertia[i + 1].solve(u[i]));
        c.offset[i] = glm::dot(u[i], c.inertia[i + 1].solve(c.bias[i + 1])) - strand.rest * glm::dot(rate[i], rate[i]);
        c.inertia[i] = {1.0, c.scale[i], u[i]};
        c.bias[i] = c.scale[i] * c.offset[i] * u[i] - c.force[i];
    }
    for (int i = 0; i < links; ++i)
    {
        const double tension = c.scale[i] * (glm::dot(u[i], a) + c.offset[i]);
        const glm::dvec3 next = c.inertia[i + 1].solve(tension * u[i] - c.bias[i + 1]);
        out[i] = (next - a) / strand.rest;
        a = next;
    }
}

} // namespace

// Runge-Kutta of fourth order, with drag inside it exactly: Lawson. Generalized Runge-Kutta processes for stable
// systems with large Lipschitz constants. 1967. Drag against the moving root is a force like gravity, because it is the
// same on all masses; drag against the rest is a factor on every rate.
Result run_articulated(const Scene& scene, double fps, double seconds, int substeps)
{
    Chain c(scene);
    const int links = scene.links;
    Vectors u(links), r2(links), r3(links), r4(links), k1(links), k2(links), k3(links), k4(links);
    const auto step = [&](double t, double h)
    {
        const double half = std::exp(-scene.drag * h / 2.0), full = half * half;
        const Vectors& r1 = c.rate;
        bend(c, t - h, c.u, r1, k1);
        for (int i = 0; i < links; ++i)
        {
            u[i] = c.u[i] + h / 2.0 * r1[i];
            r2[i] = half * (r1[i] + h / 2.0 * k1[i]);
        }
        bend(c, t - h / 2.0, u, r2, k2);
        for (int i = 0; i < links; ++i)
        {
            u[i] = c.u[i] + h / 2.0 * r2[i];
            r3[i] = half * r1[i] + h / 2.0 * k2[i];
        }
        bend(c, t - h / 2.0, u, r3, k3);
        for (int i = 0; i < links; ++i)
        {
            u[i] = c.u[i] + h * r3[i];
            r4[i] = full * r1[i] + h * half * k3[i];
        }
        bend(c, t, u, r4, k4);
        for (int i = 0; i < links; ++i)
        {
            // Back to a direction and a change across it, which the stages leave by as much as their error.
            c.u[i] = glm::normalize(c.u[i] + h / 6.0 * (r1[i] + 2.0 * r2[i] + 2.0 * r3[i] + r4[i]));
            c.rate[i] = full * r1[i] + h / 6.0 * (full * k1[i] + 2.0 * half * (k2[i] + k3[i]) + k4[i]);
            c.rate[i] -= glm::dot(c.rate[i], c.u[i]) * c.u[i];
        }
        place_nodes(c, scene.root(t), c.u);
    };
    return play(c.strand, fps, seconds, substeps, step);
}

} // namespace coif::study

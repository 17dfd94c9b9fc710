// Each link a stick that hangs on its own upper end and turns by two angles, each with an equation of its own. Anjyo,
// Usami, Kurihara. A simple method for extracting the natural beauty of hair. 1992 (one-dimensional projective
// equations); thesis 2.1.1. Links keep their length, but no link feels another's weight or motion.
//
//   d^2 theta / dt^2 = c u F_theta,   d^2 phi / dt^2 = c v F_phi
//
// c: reciprocal of the stick's moment of inertia, u: half its length, v: half that of its projection across the axis.
// Two things are ours: the axis is horizontal, because hair hangs along the paper's vertical one, where phi says
// nothing; and F is the force in the frame of the pore, so that the sticks notice when the head moves.
#include "sim/models/all.h"
#include "sim/models/strand.h"

namespace coif::study
{
namespace
{

struct Stick
{
    double theta, phi; // from the z axis; about it, from straight down
    double theta_rate = 0.0, phi_rate = 0.0;
};

glm::dvec3 direction(const Stick& s)
{
    return {std::sin(s.theta) * std::sin(s.phi), -std::sin(s.theta) * std::cos(s.phi), std::cos(s.theta)};
}

Stick stick_along(glm::dvec3 d) { return {std::atan2(std::hypot(d.x, d.y), d.z), std::atan2(d.x, -d.y)}; }

} // namespace

Result run_anjyo(const Scene& scene, double fps, double seconds, int substeps)
{
    Strand strand(scene);
    const Stick clamp = stick_along(scene.direction);
    std::vector<Stick> sticks;
    for (int i = 1; i <= strand.links; ++i)
        sticks.push_back(stick_along(strand.x[i] - strand.x[i - 1]));
    glm::dvec3 pore_velocity(0.0);

    // Half the length by the moment of inertia of a rod about its end, both for a mass of 1.
    const double leverage = (strand.rest / 2.0) / (strand.rest * strand.rest / 3.0);
    const auto step = [&](double t, double h)
    {
        const Drag drag(scene.drag, h);
        const glm::dvec3 velocity = (scene.root(t) - strand.x[0]) / h;
        const glm::dvec3 frame = (velocity - pore_velocity) / h + scene.drag * velocity;
        pore_velocity = velocity;
        for (int i = 0; i < strand.links; ++i)
        {
            Stick& s = sticks[i];
            const Stick old = s;
            const glm::dvec3 force = strand.acceleration(i + 1) - frame;
            const double st = std::sin(s.theta), ct = std::cos(s.theta), sp = std::sin(s.phi), cp = std::cos(s.phi);
            const double gain = strand.kick * drag.gain * leverage;
            s.theta_rate = drag.keep * s.theta_rate + gain * glm::dot(force, {ct * sp, -ct * cp, -st});
            s.phi_rate = drag.keep * s.phi_rate + gain * st * glm::dot(force, {cp, sp, 0.0});
            s.theta += h * s.theta_rate;
            s.phi += h * s.phi_rate;
            if (scene.gamma > 0.0)
            {
                // Stiffness is a readjustment of the angles towards those of the stick before.
                const Stick& before = i > 0 ? sticks[i - 1] : clamp;
                s.theta += scene.bending * (before.theta - s.theta);
                s.phi += scene.bending * (before.phi - s.phi);
                s.theta_rate = (s.theta - old.theta) / h;
                s.phi_rate = (s.phi - old.phi) / h;
            }
        }
        strand.kick = 1.0;
        strand.x[0] = scene.root(t);
        for (int i = 1; i <= strand.links; ++i)
            strand.x[i] = strand.x[i - 1] + strand.rest * direction(sticks[i - 1]);
    };
    return play(strand, fps, seconds, substeps, step);
}

} // namespace coif::study

#include "sim/models/strand.h"

#include <cassert>

namespace coif::study
{

Strand::Strand(const Scene& of)
    : scene(of), links(of.links), rest(of.length / of.links), x(of.start), v(of.links + 1), w(of.links + 1, 1.0)
{
    assert(links >= 1 && rest > 0.0 && scene.tip_mass > 0.0);
    assert(x.empty() || int(x.size()) == links + 1);
    if (x.empty())
        for (int i = 0; i <= links; ++i)
            x.push_back(scene.root(0.0) + double(i) * rest * glm::normalize(scene.direction));
    w[0] = 0.0;
    w[links] = scene.tip ? 0.0 : 1.0 / scene.tip_mass;
    // gamma = weight L^2 / (E I), of links equal cells: half a tip mass leaves the other half cell to the clamp.
    stiffness = scene.gamma > 0.0 ? links * scene.gravity * scene.length * scene.length / scene.gamma : 0.0;
}

glm::dvec3 Strand::acceleration(int i) const
{
    glm::dvec3 a(0.0, -scene.gravity, 0.0);
    if (scene.wind)
    {
        const glm::dvec3 along = x[std::min(i + 1, links)] - x[i - 1];
        const double size = glm::length(*scene.wind) * glm::length(along);
        if (size > 0.0)
            a += glm::length(glm::cross(*scene.wind, along)) / size * *scene.wind;
    }
    return a;
}

void predict(Strand& strand, double t, double h, std::vector<glm::dvec3>& to)
{
    const Drag drag(strand.scene.drag, h);
    to[0] = strand.scene.root(t);
    for (int i = 1; i <= strand.links; ++i)
    {
        strand.v[i] = drag.keep * strand.v[i] + strand.kick * drag.gain * strand.acceleration(i);
        to[i] = strand.x[i] + h * strand.v[i];
    }
    if (strand.scene.tip)
        to[strand.links] = *strand.scene.tip;
    strand.kick = 1.0;
}

void arrive(Strand& strand, double h, const std::vector<glm::dvec3>& to)
{
    for (int i = 1; i <= strand.links; ++i)
        strand.v[i] = (to[i] - strand.x[i]) / h;
    strand.x = to;
}

void push_out(const Strand& strand, std::vector<glm::dvec3>& nodes)
{
    if (!strand.scene.sphere)
        return;
    const glm::dvec3 center(*strand.scene.sphere);
    const double radius = strand.scene.sphere->w;
    for (int i = 1; i <= strand.links; ++i)
    {
        const glm::dvec3 out = nodes[i] - center;
        const double distance = glm::length(out);
        if (strand.w[i] > 0.0 && distance < radius)
            nodes[i] = center + radius * (distance > 0.0 ? out / distance : glm::dvec3(0.0, 1.0, 0.0));
    }
}

void add_hinges(const Strand& strand, const std::vector<glm::dvec3>& nodes, std::vector<glm::dvec3>& force)
{
    if (strand.stiffness == 0.0)
        return;
    for (int i = 0; i < strand.links; ++i)
    {
        const glm::dvec3 before = nodes[i] - (i > 0 ? nodes[i - 1] : strand.clamp(nodes[0]));
        const glm::dvec3 after = nodes[i + 1] - nodes[i];
        const glm::dvec3 axis = glm::cross(before, after);
        const double sine = glm::length(axis), cosine = glm::dot(before, after); // times both lengths
        if (!(sine > 0.0))
            continue; // in line: no torque, and the axis is no direction
        const double per_axis = std::atan2(sine, cosine) / sine;
        const glm::dvec3 torque = strand.hinge(i) * strand.rest * strand.rest * per_axis * axis;
        const glm::dvec3 inner = glm::cross(torque, before) / glm::dot(before, before);
        const glm::dvec3 outer = glm::cross(torque, after) / glm::dot(after, after);
        if (i > 0)
            force[i - 1] -= inner;
        force[i] += inner + outer;
        force[i + 1] -= outer;
    }
}

double spring_stiffness(const Strand& strand)
{
    const double weight = strand.links * (strand.scene.gravity > 0.0 ? strand.scene.gravity : 9.81);
    return weight / (kGive * strand.rest);
}

} // namespace coif::study

#include "sim/rest_shape.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

using Vec = glm::dvec3;

static constexpr double kGravity = 9.81;      // m/s^2
static constexpr double kFibreDensity = 1300; // kg/m^3
static constexpr double kMostBend = 0.5;      // of a segment, that gravity is compensated by at one node
static constexpr double kFinest = 1.0 / 60.0 / MOST_SUBSTEPS; // s

static Vec any_normal(Vec t) { return glm::normalize(std::abs(t.x) > 0.6 ? Vec(-t.z, 0.0, t.x) : Vec(0.0, t.z, -t.y)); }

// The normal carried over from the unit tangent t to the unit tangent next, as kernels/direct.h does.
static Vec carried(Vec normal, Vec t, Vec next)
{
    const double turn = 1.0 + glm::dot(t, next);
    if (turn > 1e-4)
        normal -= glm::dot(normal, next) / turn * (t + next);
    normal -= glm::dot(normal, next) * next;
    return glm::dot(normal, normal) > 1e-6 ? glm::normalize(normal) : any_normal(next);
}

static std::vector<Vec> straight(Vec root, Vec direction, double rest, int nodes)
{
    std::vector<Vec> x;
    for (int k = 0; k < nodes; ++k)
        x.push_back(root + direction * (rest * (k - 1)));
    return x;
}

// How far each element's second difference must be off its natural one for the strand to carry its own weight: force
// balance of each node, from the tip, across the segment that leads to it; what is along it is tension.
//   gravity + stiffness (-off[i-1] + 2 off[i] - off[i+1]) - pull[i] a[i] + pull[i+1] a[i+1] = 0
static void hold_up(const std::vector<Vec>& x, const std::vector<double>& stiffness, double tip_mass, Vec gravity,
                    std::vector<Vec>& off, std::vector<double>& pull)
{
    const int last = int(x.size()) - 1;
    off.assign(x.size() + 1, Vec(0.0));
    pull.assign(x.size() + 1, 0.0);
    std::vector<Vec> force(x.size() + 2, Vec(0.0)), push(x.size() + 2, Vec(0.0));
    double twist = 0.0;
    Vec beyond(0.0);
    const auto segment = [&](int i) { return x[size_t(i)] - x[size_t(i - 1)]; };
    for (int i = last; i > 1; --i)
    {
        const Vec a = segment(i), t = glm::normalize(a), before = glm::normalize(segment(i - 1));
        if (i < last)
        {
            // What the element about node i turns its frame by, as kernels/direct.h does.
            const Vec torque = glm::cross(segment(i + 1) - a, force[size_t(i)]);
            twist += glm::dot(torque, t);
            const Vec here = twist / std::max(1.0 + glm::dot(before, t), 0.05) * glm::cross(before, t);
            const Vec turning = glm::cross(torque, t) - here - beyond;
            push[size_t(i)] = (turning - glm::dot(turning, t) * t) / glm::length(a);
            beyond = here;
        }
        Vec load = (i == last ? tip_mass : 1.0) * gravity + 2.0 * force[size_t(i)] - force[size_t(i + 1)] +
                   push[size_t(i)] - push[size_t(i + 1)];
        if (i < last)
            load += pull[size_t(i + 1)] * segment(i + 1);
        pull[size_t(i)] = glm::dot(load, a) / glm::dot(a, a);
        force[size_t(i - 1)] = load - pull[size_t(i)] * a;
        const double k = stiffness[size_t(i - 1)];
        off[size_t(i - 1)] = k > 0.0 ? force[size_t(i - 1)] / k : Vec(0.0);
    }
}

static double stiffness_over_mass(const HairParams& params, int links, double rest)
{
    const double radius = 0.5e-6 * params.bending_diameter, modulus = 1e9 * params.bending_modulus;
    return modulus > 0.0 ? modulus * radius * radius / (4.0 * kFibreDensity * std::pow(rest, 4))
                         : kGravity * links * links * links / (double(params.bending_droop) * rest);
}

// The implicit step holds what bending resists to, but not what frames do that turn with the strand: kernels/direct.h
// adds that explicitly. It is stable while h^2 stiffness share < 1. The bound, with some room, is of the eigenvalues of
// helices of 5 to 20 segments a turn and 14 to 62 in all; `bend` is the largest second difference, in segments.
static double explicit_share(double bend) { return 0.35 * bend * bend + std::pow(bend, 5); }

RestShape make_rest_shape(const HairParams& params, const Groom& groom)
{
    RestShape shape;
    const int nodes = groom.nodes, links = nodes - 2;
    const size_t strands = size_t(groom.blocks) * LANES;
    shape.position.resize(strands * size_t(nodes) * 3);
    shape.bend.resize(shape.position.size());
    shape.multiplier.resize(strands * size_t(nodes));
    shape.normal.resize(strands * 3);
    double tightest = 0.0;
    for (int s = 0; s < groom.blocks * LANES && !groom.rest_position.empty(); ++s)
    {
        const auto axis_of = [&](int node, int axis)
        { return double(groom.rest_position[size_t(strand_value(s, node, axis, nodes))]); };
        for (int e = 2; e + 1 < nodes; ++e)
        {
            Vec a, b;
            for (int axis = 0; axis < 3; ++axis)
            {
                a[axis] = axis_of(e, axis) - axis_of(e - 1, axis);
                b[axis] = axis_of(e + 1, axis) - axis_of(e, axis);
            }
            if (glm::length(a) > 1e-12 && glm::length(b) > 1e-12)
                tightest = std::max(tightest, glm::distance(glm::normalize(a), glm::normalize(b)));
        }
    }
    const double share = explicit_share(tightest);
    if (tightest > 1e-5)
        shape.bend_most = 1.0 / (share * kFinest * kFinest);
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        const auto of = [&](const std::vector<float>& from, int node, int of_nodes)
        {
            Vec v;
            for (int axis = 0; axis < 3; ++axis)
                v[axis] = from[size_t(strand_value(s, node, axis, of_nodes))];
            return v;
        };
        const auto put = [&](std::vector<float>& to, int node, int of_nodes, Vec v)
        {
            for (int axis = 0; axis < 3; ++axis)
                to[size_t(strand_value(s, node, axis, of_nodes))] = float(v[axis]);
        };
        const Vec root = of(groom.root_position, 0, 1), direction = of(groom.root_direction, 0, 1);
        const double rest = std::max(1e-9, double(groom.segment_length[size_t(s)]) * params.strand_spacing);
        std::vector<Vec> x = straight(root, direction, rest, nodes);
        const bool shaped = !groom.rest_position.empty();
        for (int k = 2; shaped && k < nodes; ++k) // at this spacing
        {
            const Vec a = of(groom.rest_position, k, nodes) - of(groom.rest_position, k - 1, nodes);
            const double size = glm::length(a);
            x[size_t(k)] = x[size_t(k - 1)] + (size > 1e-12 ? a / size : direction) * rest;
        }
        for (int k = 0; k < nodes; ++k)
            put(shape.position, k, nodes, x[size_t(k)]);
        const Vec root_normal = any_normal(direction);
        put(shape.normal, 0, 1, root_normal);
        if (!shaped)
            continue;

        const double k0 = std::min(stiffness_over_mass(params, links, rest), shape.bend_most);
        shape.turning_rate = std::max(shape.turning_rate, std::sqrt(k0 * share));
        std::vector<double> stiffness(size_t(nodes), 0.0);
        for (int e = 1; e + 1 < nodes; ++e)
            stiffness[size_t(e)] =
                k0 * (e == 1 ? 2.0 : 1.0) * std::exp(-double(params.bending_attenuation) * (e - 1) / links);
        std::vector<Vec> off;
        std::vector<double> pull;
        hold_up(x, stiffness, groom.tip_mass, {0.0, -kGravity * params.forces_gravity, 0.0}, off, pull);
        Vec tangent = direction, normal = root_normal;
        for (int e = 1; e + 1 < nodes; ++e)
        {
            const Vec before = x[size_t(e)] - x[size_t(e - 1)], after = x[size_t(e + 1)] - x[size_t(e)];
            Vec held = off[size_t(e)];
            const double size = glm::length(held), most = kMostBend * rest;
            if (size > most)
                held *= most / size;
            const Vec bend = after - before - held;
            const Vec binormal = glm::cross(tangent, normal);
            put(shape.bend, e, nodes, {glm::dot(bend, tangent), glm::dot(bend, normal), glm::dot(bend, binormal)});
            shape.curled |= glm::length(bend) > 1e-5 * rest;
            const Vec next = after / rest;
            normal = carried(normal, tangent, next);
            tangent = next;
        }
        for (int k = 2; k < nodes; ++k)
            shape.multiplier[size_t((s / LANES * nodes + k) * LANES + s % LANES)] = float(pull[size_t(k)]);
    }
    return shape;
}

} // namespace coif

#include "sim/rest_shape.h"

#include "sim/material.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

using Vec = glm::dvec3;

static constexpr double kMostBend = 0.5; // of a segment, that gravity is compensated by at one node
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

static Vec vector_of(const std::vector<float>& from, int strand, int node, int nodes)
{
    return vector_at(from.data(), strand, node, nodes);
}

// The nodes of a strand with segments of length `rest` that go the way those of `shape` go; straight without one.
static std::vector<Vec> chain(const std::vector<float>& shape, int strand, int nodes, Vec root, Vec direction,
                              double rest)
{
    std::vector<Vec> x = {root - direction * rest, root};
    for (int k = 2; k < nodes; ++k)
    {
        Vec a = direction;
        if (!shape.empty())
            a = vector_of(shape, strand, k, nodes) - vector_of(shape, strand, k - 1, nodes);
        const double size = glm::length(a);
        x.push_back(x.back() + (size > 1e-12 ? a / size : direction) * rest);
    }
    return x;
}

// Second differences of the nodes in the frame carried along them: kernels/direct.h, add_bending.
static std::vector<Vec> bends(const std::vector<Vec>& x, const std::vector<Vec>& off, Vec normal)
{
    std::vector<Vec> of(x.size(), Vec(0.0));
    Vec tangent = glm::normalize(x[1] - x[0]);
    for (size_t e = 1; e + 1 < x.size(); ++e)
    {
        const Vec after = x[e + 1] - x[e], bend = after - (x[e] - x[e - 1]) - off[e];
        of[e] = {glm::dot(bend, tangent), glm::dot(bend, normal), glm::dot(bend, glm::cross(tangent, normal))};
        const Vec next = glm::normalize(after);
        normal = carried(normal, tangent, next);
        tangent = next;
    }
    return of;
}

// How far each element's second difference must be off its natural one for the strand to carry its own weight: force
// balance of each node, from the tip, across the segment that leads to it; what is along it is tension.
//   gravity + stiffness (-off[i-1] + 2 off[i] - off[i+1]) + push[i] - push[i+1] - pull[i] a[i] + pull[i+1] a[i+1] = 0
// where push[i] is what elements from i on, as they turn their frames, do to segment i: kernels/direct.h.
static void hold_up(const std::vector<Vec>& x, const std::vector<double>& stiffness, double tip_mass, Vec gravity,
                    std::vector<Vec>& off, std::vector<double>& pull)
{
    const int last = int(x.size()) - 1;
    off.assign(x.size() + 1, Vec(0.0));
    pull.assign(x.size() + 1, 0.0);
    std::vector<Vec> force(x.size() + 2, Vec(0.0)), push(x.size() + 2, Vec(0.0)); // stiffness times off
    double twist = 0.0;
    Vec beyond(0.0);
    const auto segment = [&](int i) { return x[size_t(i)] - x[size_t(i - 1)]; };
    for (int i = last; i > 1; --i)
    {
        const Vec a = segment(i), t = glm::normalize(a), before = glm::normalize(segment(i - 1));
        if (i < last)
        {
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

// The implicit step holds what bending resists to, but not what frames do that turn with the strand: kernels/direct.h
// adds that explicitly. It is stable while h^2 stiffness share < 1. The bound, with some room, is of the eigenvalues of
// helices of 5 to 20 segments a turn and 14 to 62 in all; `bend` is the largest second difference, in segments.
static double explicit_share(double bend) { return 0.35 * bend * bend + std::pow(bend, 5); }

// The largest second difference of a shape, in segments, from node 1 on.
static double tightest_of(const std::vector<float>& shape, const Groom& groom)
{
    double most = 0.0;
    for (int s = 0; s < groom.blocks * LANES && !shape.empty(); ++s)
        for (int e = held_nodes(groom, s); e + 1 < groom.nodes; ++e)
        {
            const Vec middle = vector_of(shape, s, e, groom.nodes);
            const Vec a = middle - vector_of(shape, s, e - 1, groom.nodes);
            const Vec b = vector_of(shape, s, e + 1, groom.nodes) - middle;
            if (glm::length(a) > 1e-12 && glm::length(b) > 1e-12)
                most = std::max(most, glm::distance(glm::normalize(a), glm::normalize(b)));
        }
    return most;
}

// Of each element, as kernels/direct.h has it, where that of all is `all`, 1/s^2.
static std::vector<double> stiffnesses(const HairParams& params, int nodes, int held, double all)
{
    const int links = nodes - 2;
    std::vector<double> of(size_t(nodes), 0.0);
    for (int e = 1; e + 1 < nodes; ++e)
    {
        const double along = double(e - 1) / links;
        of[size_t(e)] = all * (e == held - 1 ? 2.0 : 1.0) * std::exp(-double(params.bending_attenuation) * along) *
                        profile_at(params.bending_along, along);
    }
    return of;
}

RestShape make_rest_shape(const HairParams& params, const Groom& groom)
{
    RestShape shape;
    const int nodes = groom.nodes;
    const size_t strands = size_t(groom.blocks) * LANES;
    shape.position.resize(strands * size_t(nodes) * 3);
    shape.bend.resize(shape.position.size());
    shape.multiplier = groom.rest_multiplier;
    shape.multiplier.resize(strands * size_t(nodes));
    shape.normal.resize(strands * 3);
    const bool at_rest = !groom.rest_position.empty();
    const double hold = at_rest ? groom.hold : 0.0;
    const Vec gravity(0.0, -kGravity * params.forces_gravity, 0.0);
    const double tightest = std::max(tightest_of(groom.natural_position, groom),
                                     hold > 0.0 ? tightest_of(groom.rest_position, groom) : 0.0);
    // Where the profile makes it stiffer there is that much more to follow.
    const double share = explicit_share(tightest) * std::max(1.0, double(most_of(params.bending_along)));
    if (tightest > 1e-5)
        shape.bend_most = 1.0 / (share * kFinest * kFinest);
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        const Vec root = vector_of(groom.root_position, s, 0, 1);
        const Vec told = vector_of(groom.root_direction, s, 0, 1);
        const Vec direction = glm::length(told) > 1e-6 ? glm::normalize(told) : Vec(0.0, 1.0, 0.0); // any will do
        const double rest = std::max(1e-9, double(groom.segment_length[size_t(s)]) * params.strand_spacing);
        const double stiffness = std::min(stiffness_over_mass(params, nodes - 2, rest) *
                                              (groom.bend_factor.empty() ? 1.0 : double(groom.bend_factor[size_t(s)])),
                                          shape.bend_most);
        shape.turning_rate = std::max(shape.turning_rate, std::sqrt(stiffness * share));
        const std::vector<Vec> natural = chain(groom.natural_position, s, nodes, root, direction, rest);
        const std::vector<Vec> x = at_rest ? chain(groom.rest_position, s, nodes, root, direction, rest) : natural;
        const Vec normal = any_normal(direction);
        put_vector(shape.normal, s, 0, 1, normal);
        for (int k = 0; k < nodes; ++k)
            put_vector(shape.position, s, k, nodes, x[size_t(k)]);

        std::vector<Vec> off(x.size(), Vec(0.0));
        std::vector<Vec> bend = bends(natural, off, normal);
        if (at_rest)
        {
            std::vector<double> pull;
            hold_up(x, stiffnesses(params, nodes, held_nodes(groom, s), stiffness), groom.tip_mass, gravity, off, pull);
            for (Vec& held : off)
            {
                const double size = glm::length(held), most = kMostBend * rest;
                held *= size > most ? most / size : 1.0;
            }
            const std::vector<Vec> held = bends(x, off, normal);
            for (size_t e = 0; e < bend.size(); ++e)
                bend[e] = (1.0 - hold) * bend[e] + hold * held[e];
            for (int k = held_nodes(groom, s); k < nodes && groom.rest_multiplier.empty(); ++k)
                shape.multiplier[size_t((s / LANES * nodes + k) * LANES + s % LANES)] = float(pull[size_t(k)]);
        }
        for (int e = 1; e + 1 < nodes; ++e)
        {
            put_vector(shape.bend, s, e, nodes, bend[size_t(e)]);
            shape.curled |= glm::length(bend[size_t(e)]) > 1e-5 * rest;
        }
    }
    return shape;
}

std::vector<float> in_head_frame(const float* position, const Groom& groom, const glm::dquat& turn)
{
    std::vector<float> out(size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3);
    const glm::dquat back = glm::conjugate(turn);
    for (int s = 0; s < groom.blocks * LANES; ++s)
        for (int k = 0; k < groom.nodes; ++k)
            put_vector(out, s, k, groom.nodes, back * vector_at(position, s, k, groom.nodes));
    return out;
}

} // namespace coif

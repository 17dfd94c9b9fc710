// One groom on its own solver, stepped by hand: what the tests of whole steps share.
#pragma once
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

using Vec = glm::dvec3;
constexpr float kStep = 1.0f / 60.0f;

// Parameters without what couples strands: no grid is needed then.
inline HairParams uncoupled()
{
    HairParams params;
    params.forces_repulsion = 0.0f;
    params.look_self_shadow = 0.0f;
    params.interpolation_strands = 0;
    return params;
}

// The thesis' own solver: lengths and bending by sweeps.
inline HairParams pbd()
{
    HairParams params = uncoupled();
    params.solver_kind = 1;
    return params;
}

// For tests of what must hold whichever way strands are moved: the parameter is solver.kind.
class AnySolver : public testing::TestWithParam<int>
{
  protected:
    static HairParams uncoupled()
    {
        HairParams params = coif::uncoupled();
        params.solver_kind = GetParam();
        return params;
    }
    static bool direct() { return GetParam() == 0; }

  public:
    static std::string name(const testing::TestParamInfo<int>& test)
    {
        return param_labels(*find_param("solver.kind"))[size_t(test.param)];
    }
};

struct Rig
{
    HairParams params;
    Groom groom;
    Pose head;
    Solver solver;
    double time = 0.0;

    Rig(const HairParams& p, const Groom& g, const Pose& at = {})
        : params(p), groom(g), head(at), solver(test_device(), p, g, at)
    {
    }
    void step(const Pose& to)
    {
        head = to;
        time += kStep;
        solver.step({{head, time, kStep}});
    }
    void rest(int steps)
    {
        for (int i = 0; i < steps; ++i)
            step(head);
    }
    std::vector<Vec> values(const char* name) const
    {
        return nodes_in(test_device(), solver.buffers().at(name), groom);
    }
    std::vector<Vec> positions() const { return values("position"); }
    std::vector<Vec> velocities() const { return values("velocity"); }

    double worst_stretch() const
    {
        double worst = 0.0;
        const std::vector<Vec> x = positions();
        for (int s = 0; s < groom.guides; ++s)
            for (int k = 2; k < groom.nodes; ++k)
            {
                const size_t i = size_t(s * groom.nodes + k);
                const double rest = double(groom.segment_length[size_t(s)]) * params.strand_spacing;
                worst = std::max(worst, std::abs(glm::distance(x[i], x[i - 1]) / rest - 1.0));
            }
        return worst;
    }
};

inline Pose pose(Vec origin, double angle = 0.0, Vec axis = {0, 1, 0})
{
    return {origin, glm::angleAxis(angle, glm::normalize(axis)), Vec(0.0)};
}

inline double farthest(const std::vector<Vec>& a, const std::vector<Vec>& b)
{
    double most = a.size() == b.size() ? 0.0 : INFINITY;
    for (size_t i = 0; i < a.size() && i < b.size(); ++i)
    {
        const double d = glm::distance(a[i], b[i]);
        most = std::max(most, std::isfinite(d) ? d : INFINITY);
    }
    return most;
}

} // namespace coif

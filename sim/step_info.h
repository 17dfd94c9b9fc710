// What the kernels are told of a step: StepInfo and StepPath of kernels/shared.h, filled here and nowhere else.
#pragma once
#include "sim/distance_grid.h"
#include "sim/groom.h"
#include "sim/motion.h"
#include "sim/params.h"
#include "sim/rest_shape.h"

#include <functional>

namespace coif
{

// The head at the end of a substep.
struct Substep
{
    Pose head;
    double time = 0.0; // s, at its end
    float seconds = 1.0f / 60.0f;
    std::function<Pose(double)> way = {}; // its poses between, by the share of the substep; none: in a straight line
};

constexpr float kPushOut = 0.5f; // m/s at which hair that starts inside a body leaves it

// What the device reads in one substep, for `before` -> `now`. Thesis eq. 5.5 for strengths, accuracy of the sweeps'
// over-relaxation as Young 1950, optical depth as Bertails et al. 2005. `params` as the device reads them;
// `velocity_before` of the head's origin, m/s; `colliders`: how many; `last`: it is its step's last.
StepInfo make_step_info(const HairParams& params, const Groom& groom, const Pose& before, glm::dvec3 velocity_before,
                        const Substep& now, int colliders, bool last, const PlacedGrid& body = {});

// The head on its way through a substep, and what drag leaves of the velocities. `params` as above; `seconds_before`
// took the substep before.
StepPath make_step_path(const HairParams& params, const Pose& before, const Substep& now, bool teleport,
                        double seconds_before);

// What of StepInfo only the direct solver reads, and only the path and the rest shape tell: the acceleration that
// strands will hang in, how stiff curls may be.
void set_direct(StepInfo& info, const StepPath& path, const Groom& groom, const RestShape& rest, int head_colliders);

} // namespace coif

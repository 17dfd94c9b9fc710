#pragma once
#include "sim/groom.h"
#include "sim/params.h"

#include <glm/gtc/quaternion.hpp>

#include <vector>

namespace coif
{

// What the direct solver knows of the shape that strands are bent towards.
struct RestShape
{
    std::vector<float> position;   // [block][node][axis][lane], in the head's frame, m: where strands begin
    std::vector<float> normal;     // [block][axis][lane], across the root's direction, unit length
    std::vector<float> bend;       // [block][node][part][lane], m: second difference of the nodes at rest, along
                                   // tangent, normal and binormal of a frame carried along the strand from the root
    std::vector<float> multiplier; // [block][node][lane], 1/s^2: tensions that hold the shape up, per mass and length
    bool curled = false;           // some bend is not zero
    double bend_most = 1e30;       // 1/s^2, stiffness over mass: curls are taken to be no stiffer, so that the finest
                                   // substep of a sixtieth can follow them
    double turning_rate = 0.0;     // 1/s: longer substeps than its inverse are too long for the curls
};

// What strands are bent towards: groom.natural_position by 1 - groom.hold, and by groom.hold the shape for which
// groom.rest_position is at rest under gravity with the head upright, so that nothing sags at the start: inverse
// statics from tip to root. `params` as the device reads them. A strand too limp to be held up by half a segment's bend
// a node keeps what it can of it and sags by the rest.
RestShape make_rest_shape(const HairParams& params, const Groom& groom);

// Guides as the solver has them, relative to the head's origin, taken back into the head's frame: a groom's
// rest_position.
std::vector<float> in_head_frame(const float* position, const Groom& groom, const glm::dquat& turn);

} // namespace coif

#pragma once
#include "sim/groom.h"
#include "sim/params.h"

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

// The natural shape for which groom.rest_position is at rest under gravity with the head upright, so that nothing sags
// at the start: inverse statics from tip to root. `params` as the device reads them. A strand too limp to be held by
// less than `kMostBend` of a segment a node keeps what it can of it and sags by the rest.
RestShape make_rest_shape(const HairParams& params, const Groom& groom);

} // namespace coif

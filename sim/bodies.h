#pragma once
#include "sim/distance_grid.h"
#include "sim/params.h"

#include <glm/gtc/quaternion.hpp>

#include <vector>

namespace coif
{

// The point of a capsule's axis that is nearest to p, m. Ericson, Real-Time Collision Detection, 2005, 5.1.2.
glm::vec3 nearest_on_axis(const Capsule& capsule, glm::vec3 p);

// How deep p lies in the head's grid, turned so, or in the deepest of the colliders, m; 0 outside. p and colliders
// relative to the head's origin along the world's axes, as Solver::placed_colliders gives them.
double depth_in(const std::vector<Capsule>& colliders, const PlacedGrid& head, const glm::dquat& turn, glm::vec3 p);

} // namespace coif

#include "sim/bodies.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace coif
{

glm::vec3 nearest_on_axis(const Capsule& capsule, glm::vec3 p)
{
    const glm::vec3 center(capsule.center.x, capsule.center.y, capsule.center.z);
    const glm::vec3 axis(capsule.axis.x, capsule.axis.y, capsule.axis.z);
    return center + axis * std::clamp(glm::dot(p - center, axis) * capsule.axis.w, 0.0f, 1.0f);
}

double depth_in(const std::vector<Capsule>& colliders, const PlacedGrid& head, const glm::dquat& turn, glm::vec3 p)
{
    const glm::vec3 on_head(glm::conjugate(turn) * glm::dvec3(p));
    double deepest = std::max(0.0, double(-distance_to(head, on_head)));
    for (const Capsule& c : colliders)
        deepest = std::max(deepest, double(c.center.w - glm::distance(p, nearest_on_axis(c, p))));
    return deepest;
}

} // namespace coif

#include "app/light_globe.h"

#include "app/viewport.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

LightGlobe light_globe(const Camera& camera, glm::dvec3 head, int width, int height)
{
    LightGlobe globe;
    globe.radius = 0.235 * std::max(1, std::min(width, height));
    const glm::dvec2 view(width, height), room(2.0 * globe.radius);
    globe.center = glm::clamp(project(camera, head, width, height).value_or(0.5 * view), room, view - room);
    const glm::dvec3 back = glm::normalize(camera.position() - camera.target);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), back));
    globe.axes = {right, glm::cross(back, right), back};
    return globe;
}

glm::dvec2 place_of(const LightGlobe& globe, glm::dvec3 direction)
{
    const glm::dvec3 seen = glm::normalize(direction) * globe.axes; // the transposed: into the camera's frame
    const double aside = std::hypot(seen.x, seen.y);
    const glm::dvec2 way = aside > 1e-9 ? glm::dvec2(seen.x, -seen.y) / aside : glm::dvec2(1.0, 0.0);
    return globe.center + globe.radius * (seen.z >= 0.0 ? aside : 2.0 - aside) * way;
}

glm::dvec3 direction_at(const LightGlobe& globe, glm::dvec2 pixel)
{
    const glm::dvec2 from = (pixel - globe.center) / globe.radius;
    const double away = glm::length(from);
    if (!(away > 1e-9))
        return globe.axes[2];
    const double aside = away <= 1.0 ? away : std::max(2.0 - away, 0.0);
    const double depth = std::sqrt(std::max(0.0, 1.0 - aside * aside));
    const glm::dvec3 seen(from.x / away * aside, -from.y / away * aside, away <= 1.0 ? depth : -depth);
    return glm::normalize(globe.axes * seen);
}

} // namespace coif

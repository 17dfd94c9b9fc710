// Where lights are seen and taken in the view: about a circle round the head. A light that stands before the head, as
// the camera sees it, lies within the circle; one at its side on it; one behind the head outside, up to twice as far.
#pragma once
#include "app/renderer.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

namespace coif
{

struct LightGlobe
{
    glm::dvec2 center{0.0}; // pixels of the view
    double radius = 1.0;    // pixels
    glm::dmat3 axes{1.0};   // right, up, towards the camera, in the world
};

// Round a point of the world, or as near to it as the view has room for all of it.
LightGlobe light_globe(const Camera& camera, glm::dvec3 head, int width, int height);

// The pixel of a light in that direction, of any length but 0. Each direction has a pixel of its own, but for the one
// straight behind the head, which has a whole circle: it is given that to the right.
glm::dvec2 place_of(const LightGlobe& globe, glm::dvec3 direction);

// And back, of unit length.
glm::dvec3 direction_at(const LightGlobe& globe, glm::dvec2 pixel);

} // namespace coif

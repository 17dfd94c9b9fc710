// What tests of the rasteriser's pixels share: a view whose pixels are of a known size, and how halves are read.
#pragma once
#include "app/rasteriser.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstdint>

namespace coif
{

constexpr float kViewNear = 0.2f, kViewFar = 60.0f, kViewDistance = 10.0f; // m

// Looks at the origin from far along z, so that a pixel there covers `pixel` metres.
inline RasterView view_along_z(int width, int height, float pixel)
{
    RasterView view;
    view.eye = {0.0f, 0.0f, kViewDistance};
    view.pixel = pixel / kViewDistance;
    view.near = kViewNear;
    view.far = kViewFar;
    view.width = width;
    view.height = height;
    const float x = 0.5f * float(width) * view.pixel * kViewNear, y = 0.5f * float(height) * view.pixel * kViewNear;
    view.view_projection = glm::frustum(-x, x, -y, y, kViewNear, kViewFar) *
                           glm::lookAt(view.eye, glm::vec3(0.0f), glm::vec3(0.0f, 1.0f, 0.0f));
    return view;
}

inline float of_half(uint16_t half) // of a number that is not below 0
{
    const int exponent = half >> 10 & 31;
    return exponent ? std::ldexp(float(1024 + (half & 1023)), exponent - 25) : std::ldexp(float(half & 1023), -24);
}

} // namespace coif

#pragma once
#include "shape.h"

struct Sphere
{
    Vec centre;
    double radius;
};

// About `count` balls inside the body that fill it best, mirror-symmetric in x; the first holds the most. The deeper
// the skin of `mesh` is let stand out of them, the worse; `weight` says how much so at a place.
std::vector<Sphere> fill_with_spheres(const Mesh& mesh, const Field& body, const Field& weight, size_t count);

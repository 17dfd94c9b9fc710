#pragma once
#include "shape.h"

struct Sphere
{
    Vec centre;
    double radius;
};

// `count` balls that cover the body as closely as they can, mirror-symmetric in x (those off the middle stand for two),
// out of whose union the skin of `mesh` stands least; closest where roots(p) > 0, and there they stay under the skin.
// The best inscribed balls, one after the other, then improved together.
std::vector<Sphere> fill_with_spheres(const Mesh& mesh, const Field& body, const Field& roots, size_t count);

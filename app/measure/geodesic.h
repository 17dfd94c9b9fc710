#pragma once
#include "sim/groom.h"

#include <vector>

namespace coif
{

// A ball to grow hair on, and the strands that stand on it whichever guides they are made of: that is what lets one and
// the same strand be compared with itself.
struct Ball
{
    glm::vec3 center{0.0f};
    float radius = 0.1f; // m
};

// `count` roots (in the head's frame, m) spread evenly over the part of a ball between two angles from its pole, which
// is +y (rad). Neighbours in the list lie far apart.
std::vector<glm::vec3> even_roots(const Ball& ball, int count, float from, float to);

// The guides are vertices of a geodesic sphere (Fuller's; each edge of an icosahedron cut in `frequency`), as many of
// them as the roots lie among. Every root has a drawn strand, in this order, mixed of the three guides about it.
struct GeodesicGroom
{
    Groom groom;
    Scalp scalp;          // what the guides stand on
    double spacing = 0.0; // between neighbouring guides, mean, m
};
GeodesicGroom geodesic_groom(const HairParams& params, const Ball& ball, const std::vector<glm::vec3>& roots,
                             int frequency);

// Every root has a guide of its own, and the drawn strands are the guides: what interpolation is compared with.
Groom all_simulated(const HairParams& params, const Ball& ball, const std::vector<glm::vec3>& roots);

} // namespace coif

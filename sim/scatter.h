// The places on a scalp that strands are grown at.
#pragma once
#include "sim/mesh.h"
#include "sim/params.h"

#include <vector>

namespace coif
{

enum GuideChoice // interpolation.guides
{
    GUIDES_VERTICES,
    GUIDES_ALL
};

// Shares of a triangle's corners from two numbers in [0, 1), uniform over the triangle: points of the parallelogram's
// other half are folded back.
glm::vec3 shares_over_triangle(float b, float c);

// So many places spread over a mesh's triangles by area (thesis, listing 5.4). They hang on the mesh, their number and
// the seed alone.
std::vector<Between> spread_places(const Mesh& mesh, int count, int seed);

// The scalp whose vertices carry the guides: the authored one refined as interpolation.refine says or, where all drawn
// strands are simulated, with as many vertices strewn over it as there are strands; with hair of a file on it, with a
// vertex at each root of that hair that is simulated. Authored vertices come first. Throws Error as refined().
Scalp guide_scalp(const Scalp& authored, const HairParams& params);

} // namespace coif

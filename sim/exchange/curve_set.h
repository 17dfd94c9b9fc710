// Curves as USD and Alembic hold them, alike but for their words: control points of a basis, values at some of them,
// under transforms.
#pragma once
#include "sim/exchange/read.h"

#include <glm/mat4x4.hpp>

namespace coif
{

enum class CurveBasis
{
    LINEAR,
    BEZIER,
    BSPLINE,
    CATMULL_ROM
};

struct CurveSet
{
    std::vector<uint32_t> count; // [curve] control points
    std::vector<glm::vec3> position;
    CurveBasis basis = CurveBasis::LINEAR;
    bool pinned = true;    // the first and the last control point are the curve's ends, whatever the basis
    glm::dmat4 place{1.0}; // to the file's own frame
    std::string name;      // of the group of hair that they are
    // One value, one a curve or one a control point; where there are some fewer than those, one a point of the curve.
    std::vector<float> width;
    std::vector<glm::vec3> color;
    std::vector<glm::vec2> root_uv;
    std::vector<int32_t> id, guide;
};

// Appends them to the file's curves: transformed, as points that lie on the curves.
void add_curve_set(HairFile& file, const CurveSet& set);

// What only some of the sets had is dropped, with a remark.
void finish_curve_sets(HairFile& file);

} // namespace coif

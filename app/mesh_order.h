// How a mesh is best given to OpenGL: which triangles first, and whether those that look away can be left out.
#pragma once
#include <glm/vec3.hpp>

#include <vector>

namespace coif
{

// The same triangles along a Z-order curve through their middles (Morton. A computer oriented geodetic data base.
// 1966): those that share vertices come soon after each other, and these need be worked out but once. Positions of any
// unit; each corner must be one of them. What is not finite comes first.
std::vector<glm::uvec3> along_curve(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles);

// Which way the triangles of a closed mesh look: 1 outwards (counter-clockwise seen from there), -1 inwards, and 0 for
// one that is not closed, has edges of more than two triangles, or turns about at some: of that, any may be seen.
int facing(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles);

} // namespace coif

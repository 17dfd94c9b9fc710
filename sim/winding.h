#pragma once
#include "sim/mesh.h"

#include <vector>

namespace coif
{

// The mesh's triangles, each shape once, those that hang together by edges wound alike, and each such piece wound so
// that it points outwards, as far as that can be told: winding numbers need it, and files do not keep to it. Corners
// that lie in one place count as one. Triangles without area are left out unless there are no others.
std::vector<glm::uvec3> oriented_triangles(const Mesh& mesh);

// How often a surface winds about a point: 1 inside of a closed one, 0 outside, and in between smoothly about the edges
// of an open one (Jacobson, Kavan, Sorkine-Hornung. Robust inside-outside segmentation using generalized winding
// numbers. 2013). Far parts of the surface count as dipoles (Barill, Dickson, Schmidt, Levin, Jacobson. Fast winding
// numbers for soups and clouds. 2018).
class WindingTree
{
  public:
    // Of one triangle or more. Keeps references to both.
    WindingTree(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& triangles);
    float winding(glm::vec3 p) const;

  private:
    struct Node
    {
        glm::vec3 center; // of its triangles, weighed by area
        float radius;     // about it, that holds them all
        glm::vec3 area;   // sum of their normals, each as long as its triangle is large
        int first, count; // of order_; count 0: the node's children are at first and first + 1
    };
    void build(int node, int first, int count);

    const std::vector<glm::vec3>& positions_;
    const std::vector<glm::uvec3>& triangles_;
    std::vector<glm::vec3> centers_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

} // namespace coif

#pragma once
#include "sim/groom.h"
#include "sim/motion.h"

#include <vector>

namespace coif
{

// Hair that is seen from far away steps with half its nodes, block of 16 strands by block, where solver.far_tolerance
// says so. The thin chain is nodes 1, 3, 5, ... of the full one, which has an even number of them, and node 0 one of
// its own segments under the root: kernels/change_nodes.cl, kernels/fill_in.cl.

// Where hair is looked at from.
struct View
{
    glm::dvec3 eye{0.0}, forward{0.0, 0.0, -1.0}; // in the world, m; unit length
    double pixels = 0.0;                          // that a metre takes up a metre ahead
};

// Can it, by the form of its strands? Not where ties hold them, nor the tip.
bool may_thin(const Groom& groom);

inline int thin_nodes(int nodes) { return nodes / 2 + 1; }
Groom thinned(const Groom& groom); // guides alone

// From a thin chain's nodes, as kernels/fill_in.cl where there are no bodies: on the cubic through them, and each at
// length `rest` from the one before.
std::vector<glm::dvec3> filled_in(const std::vector<glm::dvec3>& thin, double rest);

// Some of a groom's blocks, evenly chosen: guides alone.
Groom some_blocks(const Groom& groom, int most);

// What is known of a block before it is looked at.
struct FarBlock
{
    glm::dvec3 middle{0.0}; // of its roots, in the head's frame, m
    double reach = 0.0;     // of a node from there at most, m
    double length = 0.0;    // of its longest strand, m
};
std::vector<FarBlock> far_blocks(const HairParams& params, const Groom& groom);

// Half the nodes move hair otherwise by `error` of its length: that in pixels, where the block is nearest; infinite
// where that is not ahead of the eye.
double far_error(const FarBlock& block, double error, const View& view, const Pose& head);
// Is the block far? One that was stays so up to the tolerance (pixels), one that was not must be well below it.
bool is_far(const FarBlock& block, double error, const View& view, const Pose& head, double tolerance, bool was);

} // namespace coif

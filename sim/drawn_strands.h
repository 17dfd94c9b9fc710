// Growing the strands that are drawn, once the guides are grown: sim/groom.cpp.
#pragma once
#include "sim/groom.h"
#include "sim/shaping.h"

#include <vector>

namespace coif
{

// What drawn strands are grown of.
struct StrandGround
{
    const Shaping& shaping;
    bool varied;                       // from place to place
    std::vector<glm::vec3> directions; // of the guides' roots
    std::vector<float> lengths;        // of the guides, m
    std::vector<Sides> sides;          // of the guides
    std::vector<Sides> drawn_sides;    // of the drawn strands so far; empty where nothing varies
};

// Adds the drawn strands to a groom that has its guides, mixed ones first: mixes and turned copies as the style says,
// the guides themselves where interpolation.guides is all, or those that a file's hair asks for.
void grow_drawn(Groom& groom, StrandGround& ground);

} // namespace coif

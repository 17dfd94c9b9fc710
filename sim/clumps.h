#pragma once
#include "sim/groom.h"
#include "sim/shaping.h"

#include <vector>

namespace coif
{

// Gives each drawn strand the leader of its clump: strands that are themselves drawn, about params.clump_size apart on
// the scalp, wherever interpolation.seed puts them; and how far along the leader's way it begins. No strand is led from
// beyond a parting or a hard edge. `directions` are all guides' root directions, `sides` those of the drawn strands or
// empty.
void gather_clumps(std::vector<DrawnStrand>& drawn, const HairParams& params, const std::vector<glm::vec3>& directions,
                   const std::vector<Sides>& sides = {});

} // namespace coif

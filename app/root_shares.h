#pragma once
#include "sim/simulation.h"

#include <vector>

namespace coif
{

// Of each vertex of the head's mesh the share that lies under the roots, whose colour it takes: within 4 mm of the
// scalp wholly, fading out at 14. Parameters as authored.
std::vector<float> shares_of_roots(const Assets& assets, const HairParams& params);

} // namespace coif

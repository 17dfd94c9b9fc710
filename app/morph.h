#pragma once
#include "sim/hairstyle.h"

namespace coif
{

// The hairstyle that lies `at` (0 to 1) on the way from one to another. Numbers and colours go over evenly, angles the
// shorter way round, maps and rest shapes vertex by vertex; what has nothing between two values (choices, files, lists)
// switches in the middle. It is the first one's file and text with other values, so 0 gives the first byte for byte; 1
// gives the hair of the second.
Hairstyle morphed(const Hairstyle& from, const Hairstyle& to, double at);

} // namespace coif

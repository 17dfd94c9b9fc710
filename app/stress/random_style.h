#pragma once
#include "sim/hairstyle.h"
#include "sim/motion.h"

#include <cstdint>
#include <string>

namespace coif::stress
{

// A scalp of 32 vertices, as OBJ: random styles grow on it.
std::string small_scalp();

// The style of this number: every parameter drawn from its whole range, the ends among them; evenly, or by its
// logarithm where the range is wide. Few node counts and grids, so that few kernels are built. Hangs on seed and number
// alone. Its scalp is `scalp`, a path beside the style.
Hairstyle random_style(int seed, int number, const std::string& scalp);

// Drags, spins, jolts, teleports and gusts for the first 0.6 s of a second.
Motion random_motion(int seed, int number);

// As load_motion() reads it, to the last bit but for angles.
std::string motion_text(const Motion& motion);

} // namespace coif::stress

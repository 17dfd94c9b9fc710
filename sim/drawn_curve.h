// The hair of a running style as curves for other tools: drawn strands as the renderer draws them, with waves, curls,
// frizz and braids laid on, or the guides under them.
#pragma once
#include "sim/exchange/curves.h"
#include "sim/simulation.h"

namespace coif
{

// Which strands, and how finely.
struct Taken
{
    bool guides = false; // the simulated strands; else those drawn
    int points = 0;      // of a strand, at equal lengths; 0: its nodes
    int pieces = 1;      // that each segment is cut into first, so that what is laid on it is not lost
};

// Fills in `pieces`: so many that a chord strays from the curve by 0.5 mm at most, as far as a strand has 128 points.
Taken taken(const Simulation& simulation, bool guides, int points);

// In the world, m; the solver must have drawn. Widths and colours are those of root, tip and profiles before any light,
// with each strand's own brightness; a group is the last region that a root belongs to more than not, "hair" if none.
//
// Scalps have no texture coordinates, so root UVs are a map of the head seen from above: the middle is straight above
// the scalp's centre, the face is at the lower edge, the left (+x) at the right one; the distance from the middle is
// the angle from the vertical, half a unit for half a turn (an azimuthal equidistant projection).
Curves curves_of(const Simulation& simulation, const Taken& taken);
// The positions alone: the same strands and points at any time.
void positions_of(const Simulation& simulation, const Taken& taken, std::vector<glm::vec3>& position);

} // namespace coif

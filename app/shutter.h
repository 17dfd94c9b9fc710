// What hair and head go through while the shutter is open, for pictures of what moves.
#pragma once
#include "sim/simulation.h"

#include <deque>
#include <utility>

namespace coif
{

// The last steps that it was open for, by number. What lies between two is where a straight line has it.
using Moments = std::deque<std::pair<long, Moment>>;

double open_steps(const Simulation& simulation); // that it is open for: it closes with the last; 0: it does not open

// Keeps what a picture at step `target` will be made of; to be called before the first step and after each.
void note_moment(Moments& moments, const Simulation& simulation, long target);

// At a share of the time that it is open, 0 to 1. There must be moments.
Moment moment_at(const Moments& moments, const Simulation& simulation, double share);

} // namespace coif

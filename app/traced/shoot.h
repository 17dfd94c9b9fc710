#pragma once
#include "app/shot.h"

namespace coif
{

constexpr int kMostTraced = 65536; // samples a pixel

// `coif shot --traced N`: the picture of a shot with its light followed through the hair, N samples a pixel, written to
// options.output with a record beside it: the same shot with more samples goes on from there. Ctrl-C ends it early with
// what there is. Returns the exit status: 1 if it was stopped. Throws Error.
int shoot_traced(const Options& options, const ShotOptions& shot, int samples, double turn);

} // namespace coif

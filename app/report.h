#pragma once
#include "app/options.h"

namespace coif
{

struct ReportOptions
{
    double fps = 60.0;
    double settle = 0.0; // s before the motion begins
    bool json = false, csv = false;
    bool row = false;     // one CSV line with a head
    bool untimed = false; // without times in it
};

// Plays a motion and says how the hair and the clock came through it. Returns the exit status: 1 if anything was not
// finite, which a row says itself.
int report(const Options& options, const ReportOptions& wanted);

} // namespace coif

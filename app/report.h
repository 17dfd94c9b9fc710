#pragma once
#include "app/options.h"

#include <optional>

namespace coif
{

struct ReportOptions
{
    double fps = 60.0;
    double settle = 0.0; // s before the motion begins
    bool json = false, csv = false;
    bool row = false;     // one CSV line with a head
    bool untimed = false; // without times in it
    // Samples a pixel of a small traced picture that the levels of the look are held against; 0: none. Unsaid: a few,
    // but none for a row or a CSV, or for hair that is lit as the thesis does it.
    std::optional<int> traced;
};

// Plays a motion and says how the hair and the clock came through it. Returns the exit status: 1 if anything was not
// finite, which a row says itself.
int report(const Options& options, const ReportOptions& wanted);

} // namespace coif

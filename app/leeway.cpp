#include "app/leeway.h"

#include <fmt/format.h>

#include <algorithm>

namespace coif
{

static constexpr int kFrames = 3;     // that a level is judged by
static constexpr int kStep = 2;       // frames between two levels on the way back
static constexpr double kWorth = 0.9; // of the time, at most, that a level must take to be kept

static void judge_anew(Leeway& leeway)
{
    leeway.frames = 0;
    leeway.fastest = 1e30;
}

static void go_to_level(Leeway& leeway, int level)
{
    leeway.before = leeway.fastest;
    leeway.level = level;
    judge_anew(leeway);
}

void note_frame(Leeway& leeway, double ms, bool dragging)
{
    ++leeway.frames;
    leeway.fastest = std::min(leeway.fastest, ms);
    if (!dragging || !leeway.allowed)
    {
        leeway.in_vain = false;
        if (leeway.level > 0 && leeway.frames >= kStep)
            go_to_level(leeway, leeway.level - 1);
        else if (leeway.level == 0)
            judge_anew(leeway);
        return;
    }
    if (leeway.frames != kFrames || leeway.in_vain)
        return;
    if (leeway.level > 0 && leeway.fastest > kWorth * leeway.before)
    {
        leeway.in_vain = true;
        go_to_level(leeway, leeway.level - 1);
        return;
    }
    leeway.before = 1e30; // it was worth it, whatever the frames take later
    if (leeway.fastest > kFrameWanted && leeway.level < kMostHalvings)
        go_to_level(leeway, leeway.level + 1);
    else
        judge_anew(leeway);
}

std::string leeway_text(const Leeway& leeway)
{
    if (leeway.level == 0)
        return {};
    return fmt::format("while dragging: 1/{} of the strands, to keep {:.0f} frames a second", 1 << leeway.level,
                       1e3 / kFrameWanted);
}

} // namespace coif

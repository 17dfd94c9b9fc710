#include "app/leeway.h"

#include <fmt/format.h>

#include <algorithm>

namespace coif
{

static constexpr int kFrames = 3;           // that a step is judged by
static constexpr int kStep = 2;             // frames between two steps on the way back
static constexpr double kWorth = 0.9;       // of the time, at most, that a step must take to be kept
static constexpr double kLight = 0.1;       // of the time, at least, that light must take to be given first
static constexpr double kLightWorth = 0.75; // of its own time, at most, that coarser light must take to be kept

static void judge_anew(Leeway& leeway)
{
    leeway.frames = 0;
    leeway.fastest = leeway.fastest_light = 1e30;
}

static void give(Leeway& leeway, bool light)
{
    light ? void(leeway.coarse_light = true) : void(++leeway.level);
    leeway.light_was_last = light;
    leeway.before = light ? leeway.fastest_light : leeway.fastest;
    judge_anew(leeway);
}

static void take_back(Leeway& leeway, bool light)
{
    light ? void(leeway.coarse_light = false) : void(--leeway.level);
    judge_anew(leeway);
}

void note_frame(Leeway& leeway, double ms, double light_ms, bool dragging)
{
    ++leeway.frames;
    leeway.fastest = std::min(leeway.fastest, ms);
    if (light_ms > 0.0) // else it was not followed anew
        leeway.fastest_light = std::min(leeway.fastest_light, light_ms);
    if (!dragging || !leeway.allowed)
    {
        leeway.in_vain = leeway.light_in_vain = false;
        if (!leeway.gives())
            judge_anew(leeway);
        else if (leeway.frames >= kStep)
            take_back(leeway, leeway.level == 0);
        leeway.before = 1e30;
        return;
    }
    if (leeway.frames != kFrames || leeway.in_vain)
        return;
    const bool worth = leeway.light_was_last ? leeway.fastest_light <= kLightWorth * leeway.before
                                             : leeway.fastest <= kWorth * leeway.before;
    if (!worth)
    {
        (leeway.light_was_last ? leeway.light_in_vain : leeway.in_vain) = true;
        leeway.before = 1e30;
        take_back(leeway, leeway.light_was_last);
        return;
    }
    leeway.before = 1e30; // it was worth it, whatever the frames take later
    const bool light = !leeway.coarse_light && !leeway.light_in_vain && light_ms > kLight * ms;
    const bool enough = leeway.level < kMostHalvings && leeway.strands >> (leeway.level + 1) >= kFewestStrands;
    if (leeway.fastest > kFrameWanted && (light || enough))
        give(leeway, light);
    else
        judge_anew(leeway);
}

std::string leeway_text(const Leeway& leeway)
{
    if (!leeway.gives())
        return {};
    const char* const light = leeway.coarse_light ? "light half as fine, " : "";
    const std::string strands = leeway.level > 0 ? fmt::format("1/{} of the strands, ", 1 << leeway.level) : "";
    return fmt::format("while dragging: {}{}to keep {:.0f} frames a second", light, strands, 1e3 / kFrameWanted);
}

} // namespace coif

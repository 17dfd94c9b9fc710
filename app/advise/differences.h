#pragma once
#include "app/renderer.h"
#include "sim/motion.h"

#include <functional>
#include <vector>

namespace coif
{

// What changes of a style are held against: the motion that is played and what takes the pictures.
struct Trial
{
    const Device& device;
    Renderer& renderer;
    Motion motion;
    double seconds = 2.0;
    double tolerance = 0.01; // a fraction of the longest strand
    std::function<void(const std::string&)> progress = [](const std::string&) {};
};

// How far a changed style is from the style as it is, over the whole motion.
struct Difference
{
    double motion = 0.0;     // of the guides' nodes, rms over nodes and time, as a fraction of the longest strand
    double picture = 0.0;    // 1 - SSIM over the pixels that hold hair, the most of the two pictures
    double step_ms = 0.0;    // that a frame's passes take less of the device's time
    double share = 0.0;      // of what they take of it in the style as it is, in the same play
    double picture_ms = 0.0; // that its picture takes less; 0 where the clock cannot tell
};

struct Comparison
{
    std::vector<Difference> changed;
    double step_ms = 0.0;    // of the style as it is: a frame of about 1/60 s, all passes, those of a picture too
    double picture_ms = 0.0; // its picture of kPictureSize pixels a side
    // `picture` of the style against itself with all hair aside by the trial's tolerance: as the eye cannot tell which
    // of two errors of one size it sees, a picture that differs by less is as good as motion that does.
    double moved = 0.0;
};
constexpr int kPictureSize = 480;

// Plays the style and the changed ones side by side, frame by frame in turns, so that a machine that slows down slows
// all of them; times are medians. They must have the same guides. Everything but times is the same every time. Throws
// Error as Simulation does.
Comparison compare(const Trial& trial, const Hairstyle& style, const std::vector<Hairstyle>& changed);

// Root mean square distance of two sets of guides at one moment, m: of the nodes of those with fewer nodes from the
// points of the others as far along the strand (straight between nodes). Layout as Solver::guide_positions(); the root
// segment, which the head moves, does not count.
double apart(const float* a, int nodes_a, const float* b, int nodes_b, int guides);

} // namespace coif

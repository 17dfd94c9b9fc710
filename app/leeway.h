#pragma once
#include <string>

namespace coif
{

// What of a picture the editor leaves out while a hand drags something, so that the hand is followed: light is followed
// through half as fine a volume, and of the strands ever fewer are drawn, and as much wider. When the hand rests all
// comes back in steps, strands first.
struct Leeway
{
    bool allowed = true;
    int strands = 1 << 20; // that there are
    int level = 0;         // halvings of the strands
    bool coarse_light = false;
    bool light_was_last = false; // to be given, else a halving
    int frames = 0;              // drawn so
    double fastest = 1e30;       // ms, of them
    double fastest_light = 1e30; // ms, of what light took of them
    double before = 1e30;        // ms, either before the last step, until it is known whether that was worth it
    bool light_in_vain = false;  // coarse light saved too little
    bool in_vain = false;        // so did the last halving: strands are not what takes the time
    float share() const { return 1.0f / float(1 << level); } // of the strands, that are drawn
    bool gives() const { return level > 0 || coarse_light; }
};

constexpr double kFrameWanted = 40.0; // ms: 25 frames a second
constexpr int kMostHalvings = 4;
constexpr int kFewestStrands = 1000; // that are left: fewer, as much wider, no longer look like hair

// Takes note of a frame that took so long to draw, ms, `light_ms` of them for following light. One step down where the
// fastest of three frames is slower than wanted while `dragging`, as long as the last step saved a tenth (of light
// a quarter): light where that takes a tenth, else strands. Up one every second frame while not.
void note_frame(Leeway& leeway, double ms, double light_ms, bool dragging);

// A line for the figures: "while dragging: light half as fine, 1/4 of the strands, to keep 25 frames a second"; empty
// at full quality.
std::string leeway_text(const Leeway& leeway);

} // namespace coif

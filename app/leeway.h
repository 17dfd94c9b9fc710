#pragma once
#include <string>

namespace coif
{

// What of a picture the editor leaves out while a hand drags something, so that the hand is followed: of the strands
// ever fewer are drawn, and as much wider. When the hand rests they come back in steps.
struct Leeway
{
    bool allowed = true;
    int level = 0;         // halvings of the strands
    int frames = 0;        // drawn at this level
    double fastest = 1e30; // ms, of them
    double before = 1e30;  // ms, the same one level up, until it is known whether that was worth it
    bool in_vain = false;  // the last halving saved too little: strands are not what takes the time
    float share() const { return 1.0f / float(1 << level); } // of the strands, that are drawn
};

constexpr double kFrameWanted = 40.0; // ms: 25 frames a second
constexpr int kMostHalvings = 4;

// Takes note of a frame that took so long to draw, ms. Down a level where the fastest of three frames is slower than
// wanted while `dragging`, as long as the last level saved a tenth; up one every second frame while not.
void note_frame(Leeway& leeway, double ms, bool dragging);

// A line for the figures: "while dragging: 1/4 of the strands, to keep 25 frames a second"; empty at full quality.
std::string leeway_text(const Leeway& leeway);

} // namespace coif

#pragma once
#include "app/shot.h"

namespace coif
{

// Many pictures of one style in one run: frames of a motion, views from all around, or both.
struct SequenceOptions
{
    std::string frames; // "A:B", both of them taken; frame n is n / fps seconds after the motion began
    double fps = 30.0;
    int turntable = 0; // views in a turn about the head; 0: the camera stands
    int view = -1;     // the only one of them; -1: all

    bool wanted() const { return !frames.empty() || turntable != 0; }
};

struct Frame
{
    int number;     // in the file's name
    double seconds; // of the motion
    double turn;    // of the camera, rad
};

// In the order of time. Without frames all views are of `time` (s) and numbered from 0; with them the camera goes on by
// one view a frame. Throws Error for what cannot be.
std::vector<Frame> frames_of(const SequenceOptions& wanted, double time);

// "a.png" -> "a_%04d.png"; what holds one %d or %04d stays. Throws Error for any other %.
std::string numbered_pattern(const std::string& output);
// "a_%04d.png", 7 -> "a_0007.png"
std::string numbered(const std::string& pattern, int number);

// "a" or "a.png" -> "a-001.png", "a.hdr" -> "a-001.hdr", or the first number of which there is no file yet.
std::filesystem::path unused_name(const std::string& name);

// Takes them into numbered pictures, or into a film where the output is called so and ffmpeg is there. Returns the exit
// status: 1 if the film had to be left as pictures. Throws Error.
int shoot_sequence(const Options& options, const ShotOptions& shot, const SequenceOptions& wanted);

} // namespace coif

#pragma once
#include "app/options.h"
#include "app/renderer.h"
#include "app/shutter.h"

#include <functional>
#include <optional>

namespace coif
{

constexpr double kLongestShot = 3600.0; // s of a motion

struct ShotOptions
{
    int width = 1280, height = 720;
    std::string camera;         // "front", "left", "right", "back", "top", or "yaw,pitch" or "yaw,pitch,distance"
    std::optional<int> samples; // none: as many as the picture asks for
    bool transparent = false;
};

// "1280x720" -> width and height. Throws Error.
void parse_size(const std::string& text, ShotOptions& shot);

// Throws Error for options that no picture can be taken with, before anything is opened for it.
void check_shot(const Options& options, const ShotOptions& shot);

// Simulates, without drawing, until `seconds` after the motion began, for pictures from where that camera stands.
// Time never goes back.
void play_to(Simulation& simulation, const ShotOptions& shot, double seconds,
             const std::function<void()>& after_step = {});

// The camera that is asked for, `turn` (rad) further round its target; with the head where teleports have carried it.
Camera shot_camera(const Simulation& simulation, const ShotOptions& shot, double turn);

// A style that plays a motion, and pictures of it as time goes on: equal styles, times and options give equal pictures,
// however many were taken before. Needs a current GL context; the device must outlive it.
class Studio
{
  public:
    Studio(const Device& device, const Hairstyle& style, const Motion& motion, const ShotOptions& shot);

    // Simulates, without drawing, until `seconds` after the motion began. Time never goes back.
    void play_to(double seconds);
    // Taken from `turn` (rad) further round the camera's target than the options say. Where the shutter is open for a
    // while, its samples are spread over that, to its end: what lies between two steps is where a straight line has it.
    Image picture(double turn = 0.0);
    LinearImage linear_picture(double turn = 0.0);
    // The same, written: its bytes as PNG, or where the file is called so its light as .hdr. Throws Error.
    void save(const std::filesystem::path& file, double turn = 0.0);

  private:
    FrameInput frame(double turn);
    LinearImage moving_picture(double turn);

    ShotOptions shot_;
    Simulation simulation_;
    Renderer renderer_;
    Moments moments_;
};

// Is it light that is written to a file of this name, rather than the bytes of a picture?
bool is_linear(const std::filesystem::path& file);

// Plays the motion for the given time without drawing, then draws once, `turn` (rad) further round: the same input
// gives the same picture. The second writes it to options.output.
Image take_shot(const Options& options, const ShotOptions& shot, double turn = 0.0);
void save_shot(const Options& options, const ShotOptions& shot, double turn = 0.0);

} // namespace coif

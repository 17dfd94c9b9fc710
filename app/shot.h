#pragma once
#include "app/options.h"
#include "app/renderer.h"

namespace coif
{

struct ShotOptions
{
    int width = 1280, height = 720;
    std::string camera; // "front", "left", "right", "back", "top", or "yaw,pitch" or "yaw,pitch,distance"
    int samples = 16;
    bool transparent = false;
};

// Plays the motion for the given time without drawing, then draws once: the same input gives the same picture.
Image take_shot(const Options& options, const ShotOptions& shot);

// "1280x720" -> width and height. Throws Error.
void parse_size(const std::string& text, ShotOptions& shot);

} // namespace coif

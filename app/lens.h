// Blur by the mean of many sharp pictures: each from another place within the pixel, on the lens and in time.
#pragma once
#include "sim/hairstyle.h"

#include <glm/vec2.hpp>

namespace coif
{

// The n-th place within a pixel, in [-1/2, 1/2], and on a disc of radius 1: however many are taken, they fill them
// evenly.
glm::vec2 place_in_pixel(int n);
glm::vec2 place_on_disc(int n);

// Parameters as authored.
double lens_radius(const HairParams& params);  // m
double open_seconds(const HairParams& params); // that the shutter is

bool is_blurred(const HairParams& params); // by lens or shutter, given the samples

// How many samples a picture asks for.
int good_samples(const HairParams& params);

} // namespace coif

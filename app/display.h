// How light becomes a picture: exposure, display transform, sRGB (kernels/display.h).
#pragma once
#include "app/image.h"
#include "sim/hairstyle.h"

#include <glm/vec3.hpp>

namespace coif
{

struct Display
{
    float gain; // that light is multiplied by
    int choice; // DISPLAY_NEUTRAL, DISPLAY_AGX or DISPLAY_NONE: 1, 2 or 3
};

// Of the parameters as authored. Left to itself, Kajiya-Kay is shown as it is, for its strengths were chosen on the
// screen, and all that reckons with the strength of light by PBR Neutral.
Display display_of(const HairParams& params);

// sRGB, 0 to 1, for linear light of any size, in doubt black.
glm::vec3 shown(const glm::vec3& light, const Display& display);

} // namespace coif

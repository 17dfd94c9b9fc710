#pragma once
#include "app/image.h"
#include "sim/hairstyle.h"

#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace coif
{

// How alike two pictures of the same hair are, over the pixels that show it, weighted by how much of it they show.
struct Likeness
{
    glm::dvec3 radiance{0.0}; // against the reference's, a channel
    double roughly = 0.0;     // root mean square of what is left after a blur of six pixels, against the reference's
    double locks = 0.0;       // SSIM, as shown, after a blur of two
};

// "has 0.97 1.00 1.01 of the light, 9 % off".
std::string likeness_text(const Likeness& like);

// `hair`: the share of each pixel that shows hair first. `params`: whose display transform both go through. Not a
// number where no hair is seen, or no light on it.
Likeness likeness(const LinearImage& image, const LinearImage& reference, const std::vector<float>& hair,
                  const HairParams& params);

} // namespace coif

#pragma once
#include "sim/light_file.h"

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace coif
{

// A light as it is reckoned with: so far away that it comes from one direction.
struct Sun
{
    glm::vec3 direction;  // towards it, in the world, of unit length
    glm::vec3 irradiance; // of a surface that faces it, linear
    float radius;         // of its disc in the sky, rad
};

// All the light there is: suns, and a sky that is as bright in all directions.
struct Lighting
{
    std::vector<Sun> suns;
    glm::vec3 sky{0.0f}; // radiance, linear: a white wall in it is as bright
};

// The style as it is lit: with the lights of a file that it shares, if it names one, for its own. What knows but one
// light, level kajiya_kay, has the strongest of several as look.light_*, its colour as bright as it goes.
Hairstyle lit(Hairstyle style, const std::optional<LightRig>& shared);

// Of what lit() gives: its [[light]], else the one of look.light_direction; with the sky of look.sky_*. What shines not
// is left out.
Lighting lighting_of(const HairParams& authored, const HostParams& host);

} // namespace coif

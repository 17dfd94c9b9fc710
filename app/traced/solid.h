// How solid things scatter light: Lambert under a glossy coat, the one that kernels/look_surface.cl lays on skin (GGX:
// Walter, Marschner, Li, Torrance. Microfacet models for refraction through rough surfaces. 2007; with the joint
// masking of Heitz. Understanding the masking-shadowing function. 2014).
//
// What the coat mirrors does not come to what lies under it, on its way in or out (Kelemen, Szirmay-Kalos. A
// microfacet based coupled specular-matte BRDF model with importance sampling. 2001): no more light leaves than has
// come. The faster levels leave that out, and bend light round to where skin faces away from a sun, which makes light:
// what goes under skin comes out elsewhere, and here it does not go under.
//
// Ways are of unit length, away from the surface, and in the frame whose z is its normal.
#pragma once
#include <glm/vec3.hpp>

#include <array>

namespace coif
{

struct SolidLook
{
    glm::dvec3 albedo{0.0}; // of what lies under the coat, linear, 0 to 1
    double gloss = 0.0;     // how much of a coat there is, 0 to 1
};

// Share of the light of an even sky that a whole coat mirrors to an eye at this cosine to the normal, to some 1e-4.
double mirrored_share(double cosine);

// Outgoing radiance per irradiance on a plane across the light.
glm::dvec3 scatter(const SolidLook& look, const glm::dvec3& to_eye, const glm::dvec3& to_light);

// A way for light to have come, chosen about as scatter() has it. `random` are three numbers in [0, 1); the last counts
// only where there is gloss.
struct SolidSample
{
    glm::dvec3 to_light{0.0};
    glm::dvec3 weight{0.0}; // scatter() / pdf; 0: no light
};
SolidSample sample(const SolidLook& look, const glm::dvec3& to_eye, const std::array<double, 3>& random);

} // namespace coif

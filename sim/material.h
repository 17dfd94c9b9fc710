// What pulls at hair, and what it is made of.
#pragma once
#include "sim/params.h"

#include <cmath>

namespace coif
{

constexpr double kGravity = 9.81;        // m/s^2, where forces.gravity is 1
constexpr double kFibreDensity = 1300.0; // kg/m^3

// Bending stiffness over mass, 1/s^2, of a strand of `links` segments of length `rest` (m): k = E I / (rho S l^4) for a
// round fibre of bending.modulus, or else from the droop number Gamma = rho g S L^3 / (E I), which is 4 rho g L^3 /
// (E r^2) for such a fibre, and is said for 1 g whatever gravity is. Goes with 1 / l^4, and with 1 / l.
inline double stiffness_over_mass(const HairParams& params, double links, double rest)
{
    const double radius = 0.5e-6 * params.bending_diameter, modulus = 1e9 * params.bending_modulus;
    return modulus > 0.0 ? modulus * radius * radius / (4.0 * kFibreDensity * std::pow(rest, 4))
                         : kGravity * links * links * links / (double(params.bending_droop) * rest);
}

} // namespace coif

// What absorbs light in a fibre, and the colour that hair has of it.
#pragma once
#include "kernels/shared.h"

#include <glm/vec3.hpp>

namespace coif
{

// Absorption in a fibre, per radius, of hair that looks `color` (linear, 0 to 1) once light has gone from fibre to
// fibre, and back. Chiang, Bitterli, Tappan, Burley. A practical and controllable hair and fur model for production
// path tracing. 2016, eq. 9; `azimuthal` is the azimuthal roughness, 0 to 1. Black absorbs up to 61 and not infinitely
// much.
glm::vec3 absorption_of_color(const glm::vec3& color, float azimuthal);
glm::vec3 color_of_absorption(const glm::vec3& absorption, float azimuthal);

// Its denominator, positive: the negative logarithm of the colour over the root of the absorption.
double color_per_root_absorption(float azimuthal);

// The same of amounts of melanin: d'Eon, Francois, Hill, Letteri, Aubry. An energy-conserving hair reflectance model.
// 2011, section 6.1.
glm::vec3 absorption_of_melanin(float eumelanin, float pheomelanin);

// With look.pigment = melanin, look.root_color and look.tip_color become the dye colours, linear, that come to the same
// absorption; otherwise nothing changes. Of parameters whose colours are linear already.
void take_pigment(HairParams& device);

} // namespace coif

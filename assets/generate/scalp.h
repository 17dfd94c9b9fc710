#pragma once
#include "shape.h"

// The part of the skin where inside > 0, about evenly covered with triangles: those of a geodesic sphere whose edges
// are cut into `frequency`. Its points lie on skin = 0, those of its rim on inside = 0 too.
Mesh scalp(int frequency, const Field& skin, const Field& inside);

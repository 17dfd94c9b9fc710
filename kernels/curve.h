// Gives strand_curve.h the names that it expects, as shaders/curve.glsl does for GLSL.
#ifndef COIF_CURVE_H
#define COIF_CURVE_H

#define CURVE_FUNCTION static inline
#define REAL float
#define REAL4 float4
#define WHOLE int
#define BITS uint
#define FLOAT4(x, y, z, w) ((float4)(x, y, z, w))
#define TO_INT(v) ((int)(v))
#define TO_UINT(v) ((uint)(v))
#define TO_FLOAT(v) ((float)(v))
#include "strand_curve.h"

#endif

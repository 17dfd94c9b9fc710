// Gives kernels/strand_curve.h the names that it expects.
#define CURVE_FUNCTION
#define float4 vec4
#define REAL float
#define REAL4 vec4
#define WHOLE int
#define BITS uint
#define FLOAT4(x, y, z, w) vec4(x, y, z, w)
#define TO_INT(v) int(v)
#define TO_UINT(v) uint(v)
#define TO_FLOAT(v) float(v)
#include "strand_curve.h"

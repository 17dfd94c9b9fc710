// kernels/fibre.h and near_field.h, the very text, for the tests: in floats, as kernels have it, and in doubles, to
// tell rounding from error.
#pragma once
#include <cmath>

#define CURVE_FUNCTION [[maybe_unused]] static inline
#define STRUCT(name) struct name
#define SELECT(no, yes, test) ((test) ? (yes) : (no))

namespace coif::in_floats
{
using std::asin, std::cos, std::exp, std::fabs, std::floor, std::log, std::sqrt;
inline float min(float a, float b) { return a < b ? a : b; }
inline float max(float a, float b) { return a > b ? a : b; }
inline float clamp(float x, float low, float high) { return min(max(x, low), high); }
#define REAL float
#include "kernels/near_field.h"
#undef REAL
} // namespace coif::in_floats

#undef COIF_FIBRE_H
#undef COIF_NEAR_FIELD_H
#undef FIBRE_PI

namespace coif::in_doubles
{
using std::asin, std::cos, std::exp, std::fabs, std::floor, std::log, std::sqrt;
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double clamp(double x, double low, double high) { return min(max(x, low), high); }
#define REAL double
#include "kernels/near_field.h"
#undef REAL
} // namespace coif::in_doubles

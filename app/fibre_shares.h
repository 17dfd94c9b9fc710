#pragma once
#include <vector>

namespace coif
{

// Shares of the light that one crossing of a fibre sends on and throws back, averaged over the width of the fibre
// (Zinke, Yuksel, Weber, Keyser. Dual scattering. 2008, eq. 6 and 12, with the lobes of Chiang et al. 2016).
struct Crossed
{
    double forward, backward;                   // of the light; they add up to 1 where nothing is absorbed
    double forward_variance, backward_variance; // of sin theta
    double behind, behind_variance;             // of what FIBRES_BEHIND fibres throw back, and of sin theta
};

// `absorption` per radius of the fibre, sine of the light's inclination, roughnesses in (0, 1].
Crossed crossed(double absorption, double sine, double roughness, double azimuthal, double ior);

// What a stack of so many fibres before something dark throws back, less what one fibre does: what two stacks make of
// each other (Stokes. On the intensity of the light reflected from or transmitted through a pile of plates. 1862). An
// endless stack of white hair throws all light back, a thin one lets much through.
double stack_albedo(double forward, double backward, double fibres);

// The variance of sin theta of what fibres behind one throw back, from those of one crossing (Zinke et al. 2008, eq. 16
// and 17, with units that fit).
double back_variance(double forward, double backward, double forward_variance, double backward_variance);

// The lobes' widths (Chiang et al. 2016, eq. 7 and 8): the variance of R along the fibre and the scale of the logistic
// about it, rad.
double lobe_variance(double roughness);
double lobe_logistic(double azimuthal);

// The mean of sin(theta) that light comes from, to -sin(theta) that it is seen at: of the lobe R, which is between the
// narrow TT and the wide TRT (the mean of the distribution that d'Eon et al. 2011, eq. 7, is made of: Fisher 1953).
double mean_on_cone(double roughness);

// Roughness below which nothing is told apart: the lobe would be narrower than numbers are.
constexpr double kLeastRoughness = 0.02;

// The table that kernels/look_shade.cl reads: SHARE_ROWS rows, even in sqrt(absorption) / (1 + sqrt(absorption)), of
// SHARE_TERMS: for each value of Crossed in turn the coefficients of 1, (1 - cos theta)^2 and (1 - cos theta)^5, then
// zeros.
std::vector<float> share_table(double roughness, double azimuthal, double ior);

// Such a table's value at an absorption and a sine.
Crossed from_table(const std::vector<float>& table, double absorption, double sine);

} // namespace coif

// How one hair scatters light, where it is known how far from its middle light meets it (near field): the fibre model
// of Chiang, Bitterli, Tappan, Burley. A practical and controllable hair and fur model for production path tracing.
// 2016. In double precision and apart from the real-time levels, for which it is the reference.
//
// Angles: theta from the plane across the fibre, positive towards the tip; phi about the fibre. `o` is where light goes
// (the eye), `i` where it comes from. Lobes p = 0, 1, 2, 3: reflected (R), passed through (TT), reflected within (TRT),
// and all that is reflected more often.
#pragma once
#include <glm/vec3.hpp>

#include <array>

namespace coif
{

constexpr int kLobes = 4;

struct FibreLook
{
    double roughness = 0.3, azimuthal = 0.3; // beta_m and beta_n, 0 to 1
    double tilt = 0.0;                       // of the scales, rad
    double ior = 1.55;                       // above 1
};

// A fibre as it is met.
struct FibreNear
{
    FibreLook look;
    double h = 0.0;             // from its middle across, -1 to 1
    glm::dvec3 absorption{0.0}; // per radius
};

// Variances of the longitudinal lobes, rad^2; section 4.1 and eq. 7 of the paper.
std::array<double, kLobes> longitudinal_variances(double roughness);
// Scale of the azimuthal logistic, rad; eq. 8.
double azimuthal_scale(double azimuthal);

// exp(-|x|) I_0(x): the modified Bessel function, scaled so that it never overflows. Abramowitz, Stegun 9.6.12, 9.7.1.
double scaled_bessel_i0(double x);

// M_p: d'Eon, Francois, Hill, Letteri, Aubry. An energy-conserving hair reflectance model. 2011, eq. 7. The integral
// over theta_i with cos theta_i is 1.
double longitudinal(double sin_i, double cos_i, double sin_o, double cos_o, double variance);

// The angle to the eye as lobe p sees it through the tilted scales: M_p peaks at theta_o = -theta_i - 2a for R, + a for
// TT, + 4a for TRT (Marschner, Jensen, Cammarano, Worley, Hanrahan. Light scattering from human hair fibers. 2003,
// table 1), so that R leans to the root. Gives sine and cosine.
std::array<double, 2> tilted(int lobe, double sin_o, double cos_o, double tilt);

// Unpolarised reflectance from outside (Fresnel), at the cosine of the angle to the normal.
double fresnel(double cosine, double ior);

// A_p of each lobe and channel; Chiang eq. 11 and section 3.3. Without absorption they add up to 1.
std::array<glm::dvec3, kLobes> attenuation(const FibreNear& fibre, double sin_o);

// M_p A_p N_p of one lobe: outgoing radiance per irradiance on a plane across the light.
glm::dvec3 scatter_lobe(const FibreNear& fibre, int lobe, double sin_o, double sin_i, double phi);
// All of them; Chiang eq. 1. `phi` = phi_i - phi_o.
glm::dvec3 scatter(const FibreNear& fibre, double sin_o, double sin_i, double phi);

// A way for light to have come, chosen about as scatter() has it; Chiang section 4.2, d'Eon, Marschner, Hanika.
// Importance sampling for physically-based hair fiber models. 2013. `random` are four numbers in [0, 1).
struct FibreSample
{
    double sin_i = 0.0, phi = 0.0;
    glm::dvec3 weight{0.0}; // scatter() / pdf
    double pdf = 0.0;       // per steradian; 0: no light
};
FibreSample sample(const FibreNear& fibre, double sin_o, const std::array<double, 4>& random);
double sample_pdf(const FibreNear& fibre, double sin_o, double sin_i, double phi);

} // namespace coif

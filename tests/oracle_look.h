// Double-precision twins of the passes that follow light through the hair (kernels/look.h), as oracle.h says. Of one
// fibre they read the text that kernels read, in doubles: tests/host/test_fibre.cpp holds that against a twin of its
// own.
#pragma once
#include "app/fibre_shares.h"
#include "kernels/look.h"
#include "kernels/raster.h"
#include "tests/fibre.h"
#include "tests/oracle.h"

#include <array>

namespace coif::oracle
{

// Of a voxel: fibre times the way it runs, and fibre.
using Fibres = std::array<double, 4>;

size_t voxels_of(const LookVolume& volume);

// In voxels from the first one's middle.
Vec in_voxels(Vec p, const LookVolume& volume);

// Length times width of each voxel, m^2, shared out trilinearly from the middles of parts of at most a voxel.
std::vector<Fibres> fibre_in_voxels(const std::vector<float4>& places, const LookVolume& volume);

// What bodies add to the fourth of each, 1/m: as deep as a ray of `deep` takes in a voxel, less under the surface's
// first two voxels.
std::vector<double> bodies_in_voxels(const std::vector<Capsule>& colliders, const Body& body, const LookVolume& volume,
                                     const StepInfo& info);

// 1/m, along a direction of unit length.
double extinction(const Fibres& fibre, Vec direction, double self_shadow);

// Of each ray of a bundle what look_extinction has left, as voxels lie: those along x have it turned (kernels/look.h).
std::vector<float> as_voxels_lie(const std::vector<float>& extinction, const LookVolume& volume,
                                 const std::vector<LookRay>& rays);

// Optical depth of each ray of a bundle in each slice: [slice][v][u].
std::vector<double> sweep(const float* extinction, const LookVolume& volume, const LookRay& ray);

// Read from such a sweep, at a point in voxels; from outside of the volume, from where the ray comes in.
double depth_at(const float* depth, const LookVolume& volume, const LookRay& ray, Vec at);

// The same by a march of half a voxel's steps through the trilinear extinction; nothing lies outside.
double march(const float* extinction, const LookVolume& volume, Vec at, Vec direction);

// How far each point of a sweep lies behind the place where its ray has come through SEEN, m.
std::vector<double> front(const float* extinction, const LookVolume& volume, const LookRay& ray);

// What comes from two sides, of moments of each coarse voxel. As kernels/look_rays.h has it.
struct TwoSides
{
    std::array<double, 4> front, behind;
};
TwoSides two_sides(const std::vector<float>& moments, const LookVolume& coarse, Vec p, Vec middle, Vec aside);

// What a step through a coarse voxel leaves of light: its bodies, and its hair in each channel; how deep that is; and
// what skin there sends out behind it.
struct Step
{
    double open = 1.0, depth = 0.0;
    Vec left{1.0}, sent{0.0};
};

// `fibre`: the coarse voxels' five planes; `skin_in` and `sent`: of each voxel's point of skin, if there is any.
std::vector<Step> steps_of(const std::vector<float>& fibre, const std::vector<int>& skin_in,
                           const std::vector<float4>& sent, const LookVolume& coarse, double self_shadow,
                           Vec from_all_sides);

// The share of light from a direction that bodies within STEPS steps of a coarse voxel leave, and what skin sends along
// there.
struct Stepped
{
    double open = 1.0;
    Vec comes{0.0};
};
Stepped step_along(const std::vector<Step>& steps, const LookVolume& coarse, glm::ivec3 from, const LookRay& ray);

// All that the colours of a hair's places hang on besides the strand.
struct Lit
{
    HairParams params; // as the device reads them
    LookFrame frame;
    LookVolume volume, coarse;
    std::vector<LookRay> rays, body_rays; // through the volume, and through the coarse one
    LookRay eye_ray = {};
    std::vector<float> depth, body_depth, eye_depth, sky, around, table;
    Vec forward, from_all_sides; // what is left of light after a crossing
};

// Radiance of place `k` of a strand, at LEVEL as kernels/look_shade.cl has it.
Vec shade(const Lit& lit, const float4* places, int k, const StrandLook& look, int level);

// What a strand's point sends to the eye of the light straight from the suns, of which it gets a share of each: the
// mean over its width from `from` to `to`, -1 to 1 from its right to its left as it runs up (kernels/raster_across.h).
Vec near_light(const Lit& lit, Vec p, Vec tangent, Vec absorption, const std::vector<double>& straight, double from,
               double to);

Vec lit_surface(const Lit& lit, const LookSurface& surface);

} // namespace coif::oracle

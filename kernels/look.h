// Light in the hair, for the levels above Kajiya-Kay: the contract between host and device, and what the passes share.
// Places are points of the drawn curves, as many on each strand; all positions are relative to the head's origin, m.
//
//   look_places      the places, with all that is laid on the strands
//   look_density     how much fibre there is in each voxel, and which way it runs
//   look_volume      that, with the bodies that stand in it
//   look_coarse      the same in voxels three times as wide, for the sky
//   look_extinction  what each voxel takes away from each ray's light
//   look_sweep       the optical depth along the rays, away from their light, or how far behind what is seen
//   look_steps       what a step through each coarse voxel leaves of light
//   look_sky         what of the sky is left in each coarse voxel, and where it comes from
//   look_skin        what the skin in each coarse voxel sends out
//   look_bounce      how much of it comes to each coarse voxel, and from where
//   look_around      both of these as one light from all around
//   look_shade       the colour of each place
//   look_across      what each sends from side to side where strands are wide and the geometry shader draws them
//   look_share       how much of the light there comes by way of other fibres
//   look_surface     that of the head and of other solid things
//
// Density is summed in integers, so that it does not hang on who comes first.
#ifndef COIF_LOOK_H
#define COIF_LOOK_H
#include "shared.h"

#define SKY_RAYS 26 // directions that the sky is looked at in
#define COARSE 3    // voxels to a coarse one, each way

#define BODY_DEPTH 6.0f // units of optical depth that a voxel of a body takes
#define STEPS 4         // of a coarse voxel, that look for bodies near by and for their light

// The volume smears hair over two voxels, in dense hair more than light comes through, but what is seen lies where the
// eye's own ray meets it: light is looked up where that has come through so much optical depth (SEEN), so many voxels
// further to the sun (fewer the further apart sun and eye are: look_shade.cl), and coarse voxels further to the eye for
// the sky. A place that lies deeper is moved there, one in front of it is not: what is moved is hidden anyway. And hair
// is no endless stack: behind a fibre that is seen there are so many, then skin or nothing. README.md says on what
// these were chosen, and how well they do on other hair.
#define SEEN 0.7f
#define OUT_TO_SUN 1.2f
#define SKY_TO_EYE 0.35f
#define FIBRES_BEHIND 6.0f

// Hair takes so many times as much of the skin's light as its mean over coarse voxels says: what is seen of it lies on
// the outside.
#define SKIN_TAKEN 2.5f

// Voxels off a surface that its light is looked up at: of what is drawn, so far that the body's own voxels, which are
// smeared too, take none of it; of what sends light back, so near that the hair over it does.
#define LIT_ABOVE 1.5f
#define SENDS_ABOVE 0.5f

// Of the gloss on skin: Fresnel at normal incidence, for an index of 1.4, and the root of the width of GGX.
#define SKIN_MIRRORS 0.028f
#define SKIN_ROUGH 0.45f

#define SHARE_TERMS 20 // floats a row of the table of shares: look_shade.cl
#define SHARE_ROWS 32

#ifdef __cplusplus
namespace coif
{
#endif

// Voxels along the world's axes.
typedef struct LookVolume
{
    float4 corner; // of the first voxel, m; w: side of a voxel
    int x, y, z;   // voxels; x is a multiple of 16
    int rays;      // that light is followed along
    float unit;    // of a density sum: a metre of fibre, times its width, over the square of the voxel's side
    int copies;    // of the sums, one for each worker
    int strands, places;
} LookVolume;

// A direction that light comes from, and the sweep along it (light_grid.h has the idea): slice after slice of the axis
// it leans to most.
typedef struct LookRay
{
    float4 direction;  // towards the light; w: variance that the light's own width adds
    float4 irradiance; // linear
    float4 slant;      // x, y: voxels sideways from slice to slice; z: m from slice to slice
    int axis, from, sign, unused;
} LookRay;

typedef struct LookFrame
{
    float4 eye;                               // m; w: share of the strands that are drawn
    float4 sky;                               // radiance, linear
    float4 tilts[2];                          // sine and cosine of the tilt and of twice it, of four times it
    float variance, logistic, ior, roughness; // of a fibre
    float per_log;                            // absorption_of() of fibre.h
    int suns, nodes, braided;
    int surfaces; // points of solid things
    int stride;   // from strand to strand, for look_share
    float cone;   // how far light that a fibre sends one way comes from one inclination, 0 to 1: mean_on_cone()
    float near;   // of the light that comes straight from suns, the share that is not in the colours: raster_near.h
} LookFrame;

// A point of something solid.
typedef struct LookSurface
{
    float4 position; // m; w: voxels off it that light is looked up at
    float4 normal;   // w: how glossy, 0 or 1
    float4 albedo;   // linear; w: how far red light travels under the skin, 0 or 1
} LookSurface;

#ifdef __cplusplus
} // namespace coif
#else

static inline int volume_voxels(constant LookVolume* volume) { return volume->x * volume->y * volume->z; }

// A slice's two axes: u is x unless the sweep runs along it, v is z unless the sweep does. Sizes, and strides in what
// look_extinction has left: as voxels lie, but for a ray along x, which has them turned so that u lies side by side.
typedef struct Slices
{
    int u, v, count;
    int stride_v, stride;
} Slices;

static inline Slices slices_of(constant LookVolume* volume, int axis)
{
    const int row = volume->x, plane = volume->x * volume->y;
    Slices s;
    s.u = axis == 0 ? volume->y : volume->x;
    s.v = axis == 2 ? volume->y : volume->z;
    s.count = axis == 0 ? volume->x : axis == 1 ? volume->y : volume->z;
    s.stride_v = axis == 0 ? s.u : axis == 2 ? row : plane;
    s.stride = axis == 0 ? s.u * s.v : axis == 1 ? row : plane;
    return s;
}

#endif
#endif

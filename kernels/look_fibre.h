// One strand's fibre, as passes read it from the look's frame and the strand's colours.
#ifndef COIF_LOOK_FIBRE_H
#define COIF_LOOK_FIBRE_H
#include "drawn_lanes.h"
#include "look.h"
#include "raster_strand.h"

#define SELECT(no, yes, test) select(no, yes, test)
#include "fibre.h"

static inline Fibre fibre_of(constant LookFrame* look_frame)
{
    Fibre fibre;
    fibre.variance = look_frame->variance;
    fibre.logistic = look_frame->logistic;
    fibre.ior = look_frame->ior;
    fibre.sin_tilt = look_frame->tilts[0].x;
    fibre.cos_tilt = look_frame->tilts[0].y;
    fibre.sin_twice_tilt = look_frame->tilts[0].z;
    fibre.cos_twice_tilt = look_frame->tilts[0].w;
    fibre.sin_four_tilt = look_frame->tilts[1].x;
    fibre.cos_four_tilt = look_frame->tilts[1].y;
    return fibre;
}

// absorption_of()'s `per_log`. A brighter strand has less pigment: its colour is that of exp(-sqrt(absorption)).
static inline float per_log_of(constant LookFrame* look_frame, float brightness)
{
    return look_frame->per_log / (brightness * brightness);
}

// Where the colour is the tip's by the share `tip`.
LAID_IN Rgb absorption_at(const RibbonLook* look, real tip, float per_log)
{
    const float4 root = look->root_color, step_color = look->tip_color - look->root_color;
    return rgb(absorption_of(root.x + step_color.x * tip, per_log), absorption_of(root.y + step_color.y * tip, per_log),
               absorption_of(root.z + step_color.z * tip, per_log));
}

// Places side by side: where they are, and the tangent and the way to the eye there, of unit length.
typedef struct SeenPlaces
{
    Points at, tangent, eye;
} SeenPlaces;

static inline Points shortened(Points v) { return times(INVERSE_SQRT(fmax(dot_lanes(v, v), (real)(1e-30f))), v); }

// From place `first` of a strand's `count` on; past the last it is repeated.
LAID_IN SeenPlaces load_places(global const float4* own, int first, int count, float4 eye)
{
    float px[WIDTH], py[WIDTH], pz[WIDTH], wx[WIDTH], wy[WIDTH], wz[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const int k = min(first + lane, count - 1);
        const float4 p = own[k], way = own[min(k + 1, count - 1)] - own[max(k - 1, 0)];
        px[lane] = p.x;
        py[lane] = p.y;
        pz[lane] = p.z;
        wx[lane] = way.x;
        wy[lane] = way.y;
        wz[lane] = way.z;
    }
    SeenPlaces seen;
    seen.at = points(LANES_LOAD(px), LANES_LOAD(py), LANES_LOAD(pz));
    seen.tangent = shortened(points(LANES_LOAD(wx), LANES_LOAD(wy) + 1e-12f, LANES_LOAD(wz)));
    seen.eye = shortened(points(eye.x - seen.at.x, eye.y - seen.at.y, eye.z - seen.at.z));
    return seen;
}

#endif

// One strand's fibre, as passes read it from the look's frame and the strand's colours.
#ifndef COIF_LOOK_FIBRE_H
#define COIF_LOOK_FIBRE_H
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

#endif

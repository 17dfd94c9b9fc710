// How far the farthest of the solid things is in each block of pixels: what lies behind it is hidden in all of them.
// Work-item: a block.
#include "raster.h"

kernel void raster_solids(global const float* solid, global float* farthest, constant RasterFrame* frame)
{
    const int block = get_global_id(0);
    if (block >= frame->blocks_x * frame->blocks_y)
        return;
    const int x0 = block % frame->blocks_x * BLOCK, y0 = block / frame->blocks_x * BLOCK;
    float far = 0.0f;
    if (x0 + BLOCK <= frame->width)
        for (int y = y0; y < min(y0 + BLOCK, frame->height); ++y)
        {
            const float8 a = vload8(0, solid + y * frame->width + x0), b = vload8(0, solid + y * frame->width + x0 + 8);
            const float8 both = fmax(a, b);
            const float4 four = fmax(both.lo, both.hi);
            far = fmax(far, fmax(fmax(four.x, four.y), fmax(four.z, four.w)));
        }
    else
        for (int y = y0; y < min(y0 + BLOCK, frame->height); ++y)
            for (int x = x0; x < frame->width; ++x)
                far = fmax(far, solid[y * frame->width + x]);
    farthest[block] = far;
}

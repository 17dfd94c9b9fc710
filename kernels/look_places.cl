// The places of the drawn curves that light is looked at in: `pieces` on each segment, whatever the camera sees. Work-item:
// a strand; lanes: places along it. w: how wide the strand is there, as far as it is opaque, m.
#include "look.h"

#define ROOM ((NODES - 2) * PIECES + 2 * WIDTH + 1)
#include "strand_places.h"

kernel void look_places(global const float4* drawn_position, global const float4* drawn_frame,
                        global const StrandLook* looks, global const DrawnStrand* strands,
                        global const float4* braids, global const float* wave_table, constant HairParams* params,
                        constant LookFrame* look_frame, constant LookVolume* volume, global float4* places)
{
    const int strand = (int)get_global_id(0);
    if (strand >= volume->strands)
        return;
    const RibbonLook look = look_of(strand, looks, strands, braids, params, look_frame->braided);
    StrandNodes n;
    load_strand(&n, drawn_position, drawn_frame, strand);
    Places at;
    at.count = volume->places;
    for (int i = 0; i < at.count + WIDTH; ++i)
    {
        const int k = min(i, at.count - 1), segment = min(k / PIECES, NODES - 3);
        at.segment[i] = 1 + segment;
        at.t[i] = (float)(k - segment * PIECES) / (float)PIECES;
    }
    for (int i = 0; i < at.count; i += WIDTH)
    {
        place_curve(&n, &look, &at, i, params, wave_table);
        const whole numbers = LANES_LOAD(at.segment + i);
        const real along = (TO_REAL(numbers - 1) + LANES_LOAD(at.t + i)) * (1.0f / (float)(NODES - 2));
        const real width = ribbon_width(params, wave_table, look.width, along) * look.opacity *
                           profile_at(params->look_opacity_along, along);
        float wide[WIDTH];
        LANES_STORE(fmax(width, (real)(0.0f)), wide);
        for (int lane = 0; lane < min(WIDTH, at.count - i); ++lane)
            places[strand * at.count + i + lane] =
                (float4)(at.x[i + lane], at.y[i + lane], at.z[i + lane], wide[lane]);
    }
}

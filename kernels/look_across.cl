// What the places send to the eye from each of NEAR_CELLS cells across the strand, for the geometry shader's ribbons
// where they are wide: what raster_points.cl works out at the rasteriser's points. look_shade.cl has left it out of the
// colours. Work-item: a strand; lanes: places along it.
#include "raster_near.h"

kernel void look_across(global const float4* places, global const StrandLook* looks,
                        global const DrawnStrand* strands, global const float4* braids,
                        global const float* wave_table, constant HairParams* params, constant LookFrame* look_frame,
                        constant LookVolume* volume, constant LookRay* rays, global const ushort* straight_light,
                        global ushort* near_light)
{
    const int strand = (int)get_global_id(0);
    if (strand >= volume->strands || STRAND_TURN(strand) >= look_frame->eye.w * (1.0f + FADE))
        return;
    const RibbonLook look = look_of(strand, looks, strands, braids, params, look_frame->braided);
    const float per_log = per_log_of(look_frame, FIRST_LANE(brightness_of(params, wave_table, look.laid.own)));
    const int count = volume->places;
    const size_t begin = (size_t)strand * (size_t)count;
    global const float4* own = places + begin;
    for (int i = 0; i < count; i += WIDTH)
    {
        const SeenPlaces seen = load_places(own, i, count, look_frame->eye);
        const Points t = seen.tangent, e = seen.eye;
        const whole at = min(LANE_NUMBERS + i, (whole)(count - 1));
        const real along = TO_REAL(at) * (1.0f / (float)(count - 1)), none = (real)(0.0f);
        // The last place has none behind it.
        const whole below = min(at, (whole)(count - 2));
        store_near(reals(t.x, t.y, t.z, none), reals(e.x, e.y, e.z, none),
                   absorption_at(&look, profile_at(params->look_color_along, along), per_log),
                   straight_light + begin * (size_t)look_frame->suns, count, below, TO_REAL(at - below), look_frame,
                   rays, min(WIDTH, count - i), near_light + (begin + (size_t)i) * NEAR_LIGHT);
    }
}

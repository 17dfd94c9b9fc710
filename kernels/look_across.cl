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
    const float4 eye = look_frame->eye;
    for (int i = 0; i < count; i += WIDTH)
    {
        float px[WIDTH], py[WIDTH], pz[WIDTH], wx[WIDTH], wy[WIDTH], wz[WIDTH];
        for (int lane = 0; lane < WIDTH; ++lane)
        {
            const int k = min(i + lane, count - 1);
            const float4 p = own[k], way = own[min(k + 1, count - 1)] - own[max(k - 1, 0)];
            px[lane] = p.x;
            py[lane] = p.y;
            pz[lane] = p.z;
            wx[lane] = way.x;
            wy[lane] = way.y;
            wz[lane] = way.z;
        }
        const real tx = LANES_LOAD(wx), ty = LANES_LOAD(wy) + 1e-12f, tz = LANES_LOAD(wz);
        const real shorten = INVERSE_SQRT(fmax(tx * tx + ty * ty + tz * tz, (real)(1e-30f)));
        const real ex = eye.x - LANES_LOAD(px), ey = eye.y - LANES_LOAD(py), ez = eye.z - LANES_LOAD(pz);
        const real near_eye = INVERSE_SQRT(fmax(ex * ex + ey * ey + ez * ez, (real)(1e-30f)));
        const whole at = min(LANE_NUMBERS + i, (whole)(count - 1));
        const real along = TO_REAL(at) * (1.0f / (float)(count - 1)), none = (real)(0.0f);
        // The last place has none behind it.
        const whole below = min(at, (whole)(count - 2));
        store_near(reals(tx * shorten, ty * shorten, tz * shorten, none),
                   reals(ex * near_eye, ey * near_eye, ez * near_eye, none),
                   absorption_at(&look, profile_at(params->look_color_along, along), per_log),
                   straight_light + begin * (size_t)look_frame->suns, count, below, TO_REAL(at - below), look_frame,
                   rays, min(WIDTH, count - i), near_light + (begin + (size_t)i) * NEAR_LIGHT);
    }
}

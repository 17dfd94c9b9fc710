// The light that skin sends back into the hair, from all around each coarse voxel: the mean over SKY_RAYS directions d of
// what comes along them, and of that times 3 d, red, green, blue and nothing, as look_sky.cl has them. A march of
// STEPS steps of a voxel through what look_steps and look_skin have left, by the nearest voxels. Own hair takes of all of
// it. Where neither a voxel nor those around it hold hair there is none that asks.
// Work-item: WIDTH coarse voxels along x.
#include "lanes.h"
#include "look.h"

kernel void look_bounce(global const float* steps, global const float* skin_light, global float* bounced,
                        constant LookVolume* coarse_volume, constant LookRay* sky_rays, constant int* sky_steps)
{
    const int first = (int)get_global_id(0) * WIDTH, y = (int)get_global_id(1), z = (int)get_global_id(2);
    const int row = coarse_volume->x + 2 * STEPS, plane = row * (coarse_volume->y + 2 * STEPS);
    const int all = plane * (coarse_volume->z + 2 * STEPS);
    const int own = (z + STEPS) * plane + (y + STEPS) * row + first + STEPS;
    real sums[12];
    for (int i = 0; i < 12; ++i)
        sums[i] = (real)(0.0f);
    global const float* depth = steps + 4 * all + own;
    real hair = (real)(0.0f);
    for (int k = -plane; k <= plane; k += plane)
        for (int j = -row; j <= row; j += row)
            for (int i = -1; i <= 1; ++i)
                hair += LANES_LOAD(depth + k + j + i);
    for (int i = 0; i < SKY_RAYS && any_lane(hair > 0.0f); ++i)
    {
        const float4 d = sky_rays[i].direction;
        int at[STEPS];
        real open[STEPS], past = (real)(1.0f);
        for (int step = 0; step < STEPS; ++step)
        {
            at[step] = own + sky_steps[i * STEPS + step];
            open[step] = LANES_LOAD(steps + at[step]);
            past = fmin(past, open[step]);
        }
        if (!any_lane(past < 1.0f))
            continue; // no body that way
        real left[3] = {(real)(1.0f), (real)(1.0f), (real)(1.0f)}, found[3] = {(real)(0.0f), (real)(0.0f), (real)(0.0f)};
        for (int step = 0; step < STEPS; ++step)
            for (int c = 0; c < 3; ++c)
            {
                found[c] += left[c] * LANES_LOAD(skin_light + c * all + at[step]);
                left[c] *= open[step] * LANES_LOAD(steps + (1 + c) * all + at[step]);
            }
        for (int c = 0; c < 3; ++c)
        {
            sums[c] += found[c];
            sums[3 + c] += d.x * found[c];
            sums[6 + c] += d.y * found[c];
            sums[9 + c] += d.z * found[c];
        }
    }
    global float* to = bounced + (size_t)((z * coarse_volume->y + y) * coarse_volume->x + first) * 16;
    for (int c = 0; c < 3; ++c)
    {
        const real mean = LANES_LOAD(steps + (1 + c) * all + own) * (1.0f / (float)SKY_RAYS);
        for (int moment = 0; moment < 4; ++moment)
        {
            float values[WIDTH];
            LANES_STORE((moment > 0 ? 3.0f : 1.0f) * mean * sums[3 * moment + c], values);
            for (int lane = 0; lane < WIDTH; ++lane)
                to[lane * 16 + 4 * moment + c] = values[lane];
        }
    }
}

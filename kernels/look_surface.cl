// The colour of points of solid things, in the same light as the hair: Lambert, with light that comes round under the
// skin (the redder, the further), and a broad highlight (GGX: Walter et al. 2007, with the joint masking of Heitz 2014)
// where they are glossy. Hair hands light on to them in its own colour: each channel is shaded by
// exp(-tau (1 - forward)), as the sky is. Work-item: WIDTH points.
#include "look_rays.h"

// What of sun k's light comes through to a point, of each channel: the mean of four a voxel about it, across the light.
// Where depth goes from little to much within a voxel, one alone would follow the voxels' stairs (means of light, not of
// depth: Reeves, Salesin, Cook. Rendering antialiased shadows with depth maps. 1987). What of it bodies take, they keep:
// only hair hands on. Their depth is known from coarser voxels.
static inline void light_through(real* through, Points p, int k, float4 handed_on, constant LookVolume* volume,
                                 constant LookVolume* coarse_volume, constant LookRay* rays, global const float* depth,
                                 constant LookRay* body_rays, global const float* body_depth)
{
    const LookRay ray = rays[k];
    const float4 l = ray.direction;
    const float on[3] = {handed_on.x, handed_on.y, handed_on.z};
    const float3 least = fabs(l.x) < 0.6f ? (float3)(1.0f, 0.0f, 0.0f) : (float3)(0.0f, 1.0f, 0.0f);
    const float3 side = volume->corner.w * normalize(cross(l.xyz, least)), up = cross(l.xyz, side);
    const size_t all = (size_t)volume_voxels(volume), all_coarse = (size_t)volume_voxels(coarse_volume);
    for (int c = 0; c < 3; ++c)
        through[c] = (real)(0.0f);
    for (int tap = 0; tap < 4; ++tap)
    {
        const float3 by = (tap & 1 ? up : side) * (tap & 2 ? -1.0f : 1.0f);
        const Points at = points(p.x + by.x, p.y + by.y, p.z + by.z);
        const real tau = depth_to(depth + k * all, ray, in_voxels(at, l, 0.0f, volume), volume);
        const real kept = fmin(tau, depth_to(body_depth + k * all_coarse, body_rays[k],
                                             in_voxels(at, l, 0.0f, coarse_volume), coarse_volume));
        for (int c = 0; c < 3; ++c)
            through[c] += 0.25f * exp((on[c] - 1.0f) * (tau - kept) - kept);
    }
}

kernel void look_surface(global const LookSurface* surfaces, global float4* lit, constant LookFrame* look_frame,
                         constant LookVolume* volume, constant LookVolume* coarse_volume, constant LookRay* rays,
                         global const float* depth, constant LookRay* body_rays, global const float* body_depth,
                         global const float* sky, global const float4* forward)
{
    const int points_lit = look_frame->surfaces;
    const int first = (int)get_global_id(0) * WIDTH;
    if (first >= points_lit)
        return;
    float p_x[WIDTH], p_y[WIDTH], p_z[WIDTH], offs[WIDTH], n_x[WIDTH], n_y[WIDTH], n_z[WIDTH], glosses[WIDTH], fars[WIDTH];
    float4 albedo[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane)
    {
        const LookSurface s = surfaces[min(first + lane, points_lit - 1)];
        p_x[lane] = s.position.x;
        p_y[lane] = s.position.y;
        p_z[lane] = s.position.z;
        offs[lane] = s.position.w;
        n_x[lane] = s.normal.x;
        n_y[lane] = s.normal.y;
        n_z[lane] = s.normal.z;
        glosses[lane] = s.normal.w;
        fars[lane] = s.albedo.w;
        albedo[lane] = s.albedo;
    }
    const Points p = points(LANES_LOAD(p_x), LANES_LOAD(p_y), LANES_LOAD(p_z));
    const real nx = LANES_LOAD(n_x), ny = LANES_LOAD(n_y), nz = LANES_LOAD(n_z);
    real ex = look_frame->eye.x - p.x, ey = look_frame->eye.y - p.y, ez = look_frame->eye.z - p.z;
    const real near_eye = INVERSE_SQRT(fmax(ex * ex + ey * ey + ez * ez, (real)(1e-30f)));
    ex *= near_eye;
    ey *= near_eye;
    ez *= near_eye;
    const real to_eye = fmax(nx * ex + ny * ey + nz * ez, (real)(1e-3f));
    const real gloss = LANES_LOAD(glosses), far = LANES_LOAD(fars);
    const float4 handed_on = forward[0];
    const float a2 = SKIN_ROUGH * SKIN_ROUGH * SKIN_ROUGH * SKIN_ROUGH;

    // Off the surface: the volume holds the body itself.
    const real off = volume->corner.w * LANES_LOAD(offs);
    const Points above = points(p.x + off * nx, p.y + off * ny, p.z + off * nz);
    real diffuse[3] = {(real)(0.0f), (real)(0.0f), (real)(0.0f)}, shine[3] = {(real)(0.0f), (real)(0.0f), (real)(0.0f)};
    for (int k = 0; k < look_frame->suns; ++k)
    {
        const LookRay ray = rays[k];
        const float4 l = ray.direction;
        const float e[3] = {ray.irradiance.x, ray.irradiance.y, ray.irradiance.z}, reach[3] = {0.35f, 0.18f, 0.12f};
        real through[3];
        light_through(through, above, k, handed_on, volume, coarse_volume, rays, depth, body_rays, body_depth);
        const real cosine = nx * l.x + ny * l.y + nz * l.z;
        const real hx = ex + l.x, hy = ey + l.y, hz = ez + l.z;
        const real per_h = INVERSE_SQRT(fmax(hx * hx + hy * hy + hz * hz, (real)(1e-12f)));
        const real to_h = (nx * hx + ny * hy + nz * hz) * per_h, eye_h = (ex * hx + ey * hy + ez * hz) * per_h;
        const real lit_by = fmax(cosine, (real)(0.0f));
        const real facets = to_h * to_h * (a2 - 1.0f) + 1.0f;
        const real masked = lit_by * sqrt(to_eye * to_eye * (1.0f - a2) + a2) +
                            to_eye * sqrt(lit_by * lit_by * (1.0f - a2) + a2);
        const real m = 1.0f - clamp(eye_h, (real)(0.0f), (real)(1.0f)), m2 = m * m;
        const real mirrored = SKIN_MIRRORS + (1.0f - SKIN_MIRRORS) * m2 * m2 * m;
        const real ggx = gloss * mirrored * a2 / (3.14159265f * facets * facets) * 0.5f * lit_by /
                         fmax(masked, (real)(1e-4f));
        for (int c = 0; c < 3; ++c)
        {
            const real reached = e[c] * through[c];
            const real round = fmax(cosine + reach[c], (real)(0.0f)) * (1.0f / (1.0f + reach[c]));
            diffuse[c] += reached * mix(lit_by, round, far) * 0.318309886f;
            shine[c] += reached * ggx;
        }
    }
    float out[6][WIDTH];
    for (int c = 0; c < 3; ++c)
    {
        LANES_STORE(diffuse[c], out[c]);
        LANES_STORE(shine[c], out[3 + c]);
    }
    float a_x[WIDTH], a_y[WIDTH], a_z[WIDTH];
    LANES_STORE(above.x, a_x);
    LANES_STORE(above.y, a_y);
    LANES_STORE(above.z, a_z);
    for (int lane = 0; lane < WIDTH && first + lane < points_lit; ++lane)
    {
        // Lambert's cosine weighs directions about the normal; their mean is two thirds of it.
        const TwoSides sky_there =
            two_sides(sky, (float4)(a_x[lane], a_y[lane], a_z[lane], 0.0f), (float4)(0.0f),
                      (float4)(n_x[lane], n_y[lane], n_z[lane], 0.0f) * (2.0f / 3.0f), coarse_volume);
        const float4 left = fmin(sky_there.front, 1.0f); // straight, red, green, blue
        const float4 bright = look_frame->sky;
        lit[first + lane] = (float4)(
            albedo[lane].x * (out[0][lane] + bright.x * left.y) + out[3][lane],
            albedo[lane].y * (out[1][lane] + bright.y * left.z) + out[4][lane],
            albedo[lane].z * (out[2][lane] + bright.z * left.w) + out[5][lane], 1.0f);
    }
}

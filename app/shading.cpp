#include "app/shading.h"

#include "app/fibre_shares.h"
#include "app/skin.h"
#include "sim/error.h"
#include "sim/hair_color.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr float kLargest = 3.0f; // m from the head's origin: hair further off casts no shadow
static constexpr int kMostVoxels = 1 << 22, kMostCopies = 8;

Shading::Shading(const Device& device)
    : passes_(device, fmt::format("-D WIDTH={}", device.width), "following the light")
{
}

int shaded_pieces(const HairParams& p, const Groom& groom)
{
    const float segment = groom.longest * p.strand_spacing / float(std::max(groom.nodes - 2, 1));
    const auto waves = [&](float height, float frequency) { return height > 0.0f ? segment * frequency : 0.0f; };
    float turns = std::max(waves(p.wave_normal_amplitude, p.wave_normal_frequency),
                           waves(p.wave_binormal_amplitude, p.wave_binormal_frequency));
    turns = std::max(turns, waves(p.curl_radius, 1.0f / (p.curl_pitch * (1.0f - 0.5f * p.curl_variation))));
    turns = std::max(turns, waves(p.frizz_amount, 0.5f * p.frizz_frequency));
    for (const StrandLook& look : groom.looks)
        turns = std::max({turns, waves(look.wave.x, look.wave.y), waves(look.wave.z, look.wave.w),
                          waves(look.own.y, 1.0f / (p.curl_pitch * (1.0f - 0.5f * p.curl_variation))),
                          waves(look.own.z, 0.5f * p.frizz_frequency)});
    for (const Tail& tail : groom.tails)
        if (tail.axis.w > 0.0f)
            turns = std::max(turns, segment / tail.axis.w);
    const int bent = std::clamp(int(std::ceil(8.0f * turns)), 1, 8);
    return std::max(bent, groom.nodes <= 24 ? 2 : 1);
}

LookRay ray_towards(const LookVolume& volume, glm::vec3 direction)
{
    const int counts[3] = {volume.x, volume.y, volume.z};
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(direction[i]) > std::abs(direction[axis]))
            axis = i;
    const float lean = std::abs(direction[axis]); // at least 1 / sqrt(3)
    LookRay ray = {};
    ray.direction = F4(direction.x, direction.y, direction.z, 0.0f);
    ray.slant =
        F4(-direction[axis == 0 ? 1 : 0] / lean, -direction[axis == 2 ? 1 : 2] / lean, volume.corner.w / lean, 0.0f);
    ray.axis = axis;
    ray.from = direction[axis] > 0.0f ? counts[axis] - 1 : 0;
    ray.sign = direction[axis] > 0.0f ? -1 : 1;
    return ray;
}

// As evenly over the sphere as a spiral can: Gonzalez. Measurement of areas on a sphere using Fibonacci and
// latitude-longitude lattices. 2010.
static glm::vec3 sky_direction(int i)
{
    const float up = 1.0f - 2.0f * (float(i) + 0.5f) / float(SKY_RAYS), out = std::sqrt(1.0f - up * up);
    const float turn = float(i) * std::numbers::pi_v<float> * (3.0f - std::sqrt(5.0f));
    return {out * std::cos(turn), up, out * std::sin(turn)};
}

// About all hair and what else casts shadows, of so many voxels whatever its shape: light costs the same in short hair
// and in long. Voxels change by eighths of an octave, and lie at whole ones, so that they do not crawl as hair moves.
void Shading::place_volume(const LitScene& scene)
{
    const size_t places = size_t(volume_.strands) * size_t(volume_.places);
    glm::vec3 low = scene.low, high = scene.high;
    if (glm::any(glm::greaterThan(low, high)))
        low = glm::vec3(INFINITY), high = glm::vec3(-INFINITY);
    double covered = 0.0; // m^2: length times width of all pieces
    {
        const Mapped mapped(passes_.device, passes_.buffers["places"], places * sizeof(float4));
        const float4* at = mapped.as<float4>();
        for (size_t i = 0; i < places; ++i)
        {
            const glm::vec3 p(at[i].x, at[i].y, at[i].z);
            if (!(std::abs(p.x) < kLargest && std::abs(p.y) < kLargest && std::abs(p.z) < kLargest))
                continue;
            low = glm::min(low, p);
            high = glm::max(high, p);
            if (i + 1 < places)
            {
                const glm::vec3 way = glm::vec3(at[i + 1].x, at[i + 1].y, at[i + 1].z) - p;
                const float area = glm::length(way) * std::max(at[i].w, at[i + 1].w);
                covered += area < kLargest ? double(area) : 0.0; // no number is nothing
            }
        }
    }
    if (!glm::all(glm::lessThanEqual(low, high)))
        low = glm::vec3(-0.1f), high = glm::vec3(0.1f);
    const glm::vec3 size = high - low;
    const float longest = std::max({size.x, size.y, size.z, 0.02f});
    const glm::vec3 room = glm::max(size, 0.5f * longest); // a single strand has none
    float voxel = std::cbrt(room.x * room.y * room.z) / float(params_.look_volume);
    voxel = std::exp2(std::round(std::log2(voxel) * 8.0f) / 8.0f);
    for (;; voxel *= std::exp2(0.125f))
    {
        const glm::vec3 corner = glm::floor(low / voxel - 0.5f), end = glm::ceil(high / voxel + 0.5f);
        volume_.x = (int(end.x - corner.x) + 15) / 16 * 16;
        volume_.y = std::max(int(end.y - corner.y), 4);
        volume_.z = std::max(int(end.z - corner.z), 4);
        volume_.corner = F4(corner.x * voxel, corner.y * voxel, corner.z * voxel, voxel);
        if (double(volume_.x) * volume_.y * volume_.z <= kMostVoxels)
            break;
    }
    // Though all fibre lay in one voxel, its sum would fit; so would that of each worker.
    const double most = covered / (double(voxel) * voxel);
    volume_.unit = float(std::min(double(1 << 30) / std::max(most, 1e-6), 1e9));
    volume_.copies =
        passes_.device.is_gpu
            ? 1
            : std::clamp(int(passes_.device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()), 1, kMostCopies);
    coarse_ = volume_;
    coarse_.x = ((volume_.x + COARSE - 1) / COARSE + 15) / 16 * 16;
    coarse_.y = std::max((volume_.y + COARSE - 1) / COARSE, 2);
    coarse_.z = std::max((volume_.z + COARSE - 1) / COARSE, 2);
    coarse_.corner.w = voxel * COARSE;
}

static size_t voxels_of(const LookVolume& v) { return size_t(v.x) * size_t(v.y) * size_t(v.z); }
// With STEPS more on all sides.
static size_t stepped_rows(const LookVolume& v) { return size_t(v.y + 2 * STEPS) * size_t(v.z + 2 * STEPS); }
static size_t stepped_voxels(const LookVolume& v) { return size_t(v.x + 2 * STEPS) * stepped_rows(v); }

// From a voxel to each that a ray's steps of a voxel's side lead to, in what look_steps leaves.
static std::vector<cl_int> steps_along(const std::vector<LookRay>& rays, const LookVolume& v)
{
    std::vector<cl_int> steps;
    for (const LookRay& ray : rays)
        for (int step = 1; step <= STEPS; ++step)
        {
            const auto whole = [&](float way) { return int(std::nearbyint(way * float(step))); };
            steps.push_back(whole(ray.direction.x) +
                            (v.x + 2 * STEPS) * (whole(ray.direction.y) + (v.y + 2 * STEPS) * whole(ray.direction.z)));
        }
    return steps;
}

// Extinction along so many rays through the volume that kernels read, and what the sweep finds. `whose` goes before the
// names of the rays and of both.
void Shading::follow(const LookVolume& volume, const std::string& whose, size_t rays, const std::string& what)
{
    const size_t all = voxels_of(volume), width = size_t(passes_.device.width);
    const size_t lanes = all / width, side = size_t(std::max({volume.x, volume.y, volume.z}));
    passes_.room_for(whose + "extinction", all * rays * sizeof(float));
    passes_.room_for(whose + "depth", all * rays * sizeof(float));
    const auto rename = [&]
    {
        if (!whose.empty())
            for (const char* name : {"rays", "extinction", "depth"})
                std::swap(passes_.buffers[name], passes_.buffers[whose + name]);
    };
    rename();
    try
    {
        passes_.launch("look_extinction", what, cl::NDRange(lanes, rays), cl::NDRange(lanes % 64 == 0 ? 64 : 1, 1));
        const size_t group = passes_.device.is_gpu ? 8 : 1, items = (side + width - 1) / width;
        passes_.launch("look_sweep", what == "-D FRONT" ? what : "",
                       cl::NDRange((items + group - 1) / group * group, side, rays), cl::NDRange(group, 1, 1));
    }
    catch (...)
    {
        rename();
        throw;
    }
    rename();
}

// Optical depth along each sun's rays, and along the sky's through coarser voxels.
void Shading::sweep(const Lighting& lighting)
{
    std::vector<LookRay> suns, sky;
    for (const Sun& sun : lighting.suns)
    {
        suns.push_back(ray_towards(volume_, sun.direction));
        suns.back().direction.w = sun.radius * sun.radius;
        suns.back().irradiance = F4(sun.irradiance.x, sun.irradiance.y, sun.irradiance.z, 0.0f);
    }
    for (int i = 0; i < SKY_RAYS; ++i)
        sky.push_back(ray_towards(coarse_, sky_direction(i)));
    suns_ = int(suns.size());
    if (suns.empty())
        suns.push_back(ray_towards(volume_, {0.0f, 1.0f, 0.0f})); // kernels ask for a ray; no sun reads it
    passes_.fill("rays", suns);
    follow(volume_, "", suns.size(), "");

    const size_t coarse = voxels_of(coarse_);
    passes_.room_for("coarse_fibre", coarse * 5 * sizeof(float));
    passes_.room_for("sky", coarse * 16 * sizeof(float));
    passes_.launch("look_coarse", "", coarse);
    // The coarse volume under the name of the fine one, and back.
    const auto swap_volumes = [&]
    {
        std::swap(passes_.buffers["volume"], passes_.buffers["coarse_volume"]);
        std::swap(passes_.buffers["fibre"], passes_.buffers["coarse_fibre"]);
    };
    passes_.fill("sky_rays", sky);
    std::vector<LookRay> bodies;
    for (const LookRay& sun : suns)
        bodies.push_back(ray_towards(coarse_, {sun.direction.x, sun.direction.y, sun.direction.z}));
    passes_.fill("body_rays", bodies);
    swap_volumes();
    try
    {
        follow(coarse_, "sky_", sky.size(), "");
        follow(coarse_, "body_", bodies.size(), "-D BODIES");
    }
    catch (...)
    {
        swap_volumes();
        throw;
    }
    swap_volumes();
    const size_t width = size_t(passes_.device.width);
    passes_.fill("sky_steps", steps_along(sky, coarse_));
    passes_.room_for("steps", stepped_voxels(coarse_) * 5 * sizeof(float));
    passes_.launch("look_steps", "", stepped_rows(coarse_));
    passes_.launch("look_sky", options_, cl::NDRange(size_t(coarse_.x) / width, size_t(coarse_.y), size_t(coarse_.z)),
                   cl::NDRange(1, 1, 1));
}

// What the skin in each coarse voxel sends out, and how much of it comes to each.
void Shading::send_back(const std::vector<LookSurface>& skin)
{
    const SkinInVoxels found = skin_in_voxels(skin, coarse_);
    skin_ = !found.points.empty();
    if (!skin_)
        return;
    light_surfaces(found.points, glm::vec3(0.0f));
    const size_t coarse = voxels_of(coarse_), width = size_t(passes_.device.width);
    passes_.fill("skin_in", found.in_voxel);
    passes_.room_for("skin_light", stepped_voxels(coarse_) * 3 * sizeof(float));
    passes_.room_for("bounced", coarse * 16 * sizeof(float));
    passes_.launch("look_skin", "", stepped_rows(coarse_));
    passes_.launch("look_bounce", "", cl::NDRange(size_t(coarse_.x) / width, size_t(coarse_.y), size_t(coarse_.z)),
                   cl::NDRange(1, 1, 1));
}

// What light loses on its way through hair, by the mean of its colours, as the share that is left of a crossing in each
// channel: first of light that comes one way (Zinke et al. 2008, eq. 5), then of light from all sides, where what
// fibres throw back comes back again: sqrt(K (K + 2 S)) of what they swallow, K, and throw back, S (Kubelka, Munk. Ein
// Beitrag zur Optik der Farbanstriche. 1931).
static std::vector<float4> handed_on(const HairParams& params, const Groom& groom, const std::vector<float>& table,
                                     double per_log)
{
    glm::dvec3 color(0.0);
    const auto add = [&](const float4& c, double weight) { color += weight * glm::dvec3(c.x, c.y, c.z); };
    for (const StrandLook& look : groom.looks)
    {
        add(look.root_color, 0.5 / double(groom.looks.size()));
        add(look.tip_color, 0.5 / double(groom.looks.size()));
    }
    if (groom.looks.empty())
    {
        add(params.look_root_color, 0.5);
        add(params.look_tip_color, 0.5);
    }
    std::array<double, 3> one_way, all_sides;
    for (int i = 0; i < 3; ++i)
    {
        const double log = std::log(std::clamp(color[i], 1e-4, 0.9999));
        const Crossed c = from_table(table, log * log * per_log, 0.5);
        one_way[size_t(i)] = c.forward;
        all_sides[size_t(i)] =
            1.0 - std::sqrt(std::max((1.0 - c.forward) * (1.0 - c.forward) - c.backward * c.backward, 0.0));
    }
    const auto as_float4 = [](const std::array<double, 3>& v)
    { return F4(float(v[0]), float(v[1]), float(v[2]), 0.0f); };
    return {as_float4(one_way), as_float4(all_sides)};
}

// As absorption_of() of fibre.h takes it.
static double per_log(float azimuthal)
{
    const double p = color_per_root_absorption(azimuthal);
    return 1.0 / (p * p);
}

void Shading::light(const LitScene& scene)
try
{
    const Groom& groom = scene.solver->groom();
    params_ = scene.params;
    sky_ = scene.lighting.sky;
    volume_.strands = int(groom.drawn.size());
    shaded_.pieces = shaded_pieces(params_, groom);
    volume_.places = (groom.nodes - 2) * shaded_.pieces + 1;
    braided_ = int(scene.braids.size() / 3);
    options_ =
        fmt::format("-D NODES={} -D PIECES={}{}", groom.nodes, shaded_.pieces, groom.looks.empty() ? "" : " -D VARIED");
    for (const char* shared : {"drawn_position", "drawn_frame", "looks", "strands", "info", "colliders"})
        passes_.buffers[shared] = scene.solver->buffers().at(shared);
    const std::vector<float> key = {params_.look_roughness, params_.look_azimuthal_roughness, params_.look_ior};
    if (key != table_key_)
    {
        table_ = share_table(key[0], key[1], key[2]);
        table_key_ = key;
        passes_.fill("shares", table_);
    }
    passes_.fill("params", std::vector<HairParams>(1, params_));
    passes_.fill("forward", handed_on(params_, groom, table_, per_log(params_.look_azimuthal_roughness)));
    passes_.fill("wave_table", scene.waves);
    passes_.fill("braids", scene.braids.empty() ? std::vector<float4>(1, F4(0, 0, 0, 0)) : scene.braids);
    look_at(glm::vec3(0.0f), 1.0f, 0);
    passes_.fill("volume", std::vector<LookVolume>(1, volume_));
    const size_t strands = size_t(volume_.strands);
    passes_.room_for("places", std::max<size_t>(strands, 1) * size_t(volume_.places) * sizeof(float4));
    if (strands > 0)
        passes_.launch("look_places", options_, strands);
    place_volume(scene);
    passes_.fill("volume", std::vector<LookVolume>(1, volume_));
    passes_.fill("coarse_volume", std::vector<LookVolume>(1, coarse_));

    const size_t all = voxels_of(volume_), width = size_t(passes_.device.width);
    const cl::Buffer& sums = passes_.room_for("fibre_sums", all * size_t(volume_.copies) * sizeof(cl_int4));
    passes_.room_for("fibre", all * 5 * sizeof(float));
    if (passes_.device.is_gpu)
        passes_.device.queue.enqueueFillBuffer(sums, cl_int(0), 0, all * sizeof(cl_int4));
    passes_.launch("look_density", passes_.device.is_gpu ? "-D ATOMIC" : "",
                   passes_.device.is_gpu ? strands : size_t(volume_.copies));
    if (scene.solver->body().grid)
        passes_.buffers["body_distance"] = scene.solver->buffers().at("body_distance");
    passes_.launch("look_volume", options_ + (scene.solver->body().grid ? " -D BODY_GRID" : ""),
                   cl::NDRange(size_t(volume_.x) / width, size_t(volume_.y), size_t(volume_.z)), cl::NDRange(1, 1, 1));
    sweep(scene.lighting);
    send_back(scene.skin);
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while following the light", e.err(), e.what());
}

void Shading::look_at(glm::vec3 eye, float kept, size_t surfaces, int stride, float near)
{
    LookFrame frame = {};
    frame.eye = F4(eye.x, eye.y, eye.z, kept);
    frame.sky = F4(sky_.x, sky_.y, sky_.z, 0.0f);
    const float tilt = params_.look_scale_tilt;
    frame.tilts[0] = F4(std::sin(tilt), std::cos(tilt), std::sin(2.0f * tilt), std::cos(2.0f * tilt));
    frame.tilts[1] = F4(std::sin(4.0f * tilt), std::cos(4.0f * tilt), 0.0f, 0.0f);
    frame.variance = float(lobe_variance(params_.look_roughness));
    frame.logistic = float(lobe_logistic(params_.look_azimuthal_roughness));
    frame.ior = params_.look_ior;
    frame.roughness = std::max(params_.look_roughness, float(kLeastRoughness));
    frame.per_log = float(per_log(params_.look_azimuthal_roughness));
    frame.suns = suns_;
    frame.nodes = params_.look_azimuthal_roughness < 0.25f ? 8 : 4; // narrow lobes band
    frame.braided = braided_;
    frame.surfaces = int(surfaces);
    frame.stride = stride;
    frame.cone = float(mean_on_cone(params_.look_roughness));
    frame.near = near;
    passes_.fill("look_frame", std::vector<LookFrame>(1, frame));
    if (near > 0.0f) // it is read when solid things have been lit, too
        passes_.fill("near_frame", std::vector<LookFrame>(1, frame));
}

// How far behind what the eye sees each voxel lies, by rays from the volume's middle.
void Shading::find_front(glm::vec3 eye)
{
    const glm::vec3 middle = glm::vec3(volume_.corner.x, volume_.corner.y, volume_.corner.z) +
                             0.5f * volume_.corner.w * glm::vec3(float(volume_.x), float(volume_.y), float(volume_.z));
    const glm::vec3 way = eye - middle;
    const float far = glm::length(way);
    passes_.fill("eye_rays",
                 std::vector<LookRay>(1, ray_towards(volume_, far > 1e-6f ? way / far : glm::vec3(0.0f, 0.0f, 1.0f))));
    follow(volume_, "eye_", 1, "-D FRONT");
}

const ShadedStrands& Shading::shade(glm::vec3 eye, int level, float kept, const cl::Buffer* pieces, float near)
try
{
    const size_t strands = size_t(volume_.strands);
    const size_t lit_places = std::max<size_t>(strands, 1) * size_t(volume_.places) * size_t(suns_);
    shaded_.near = level > LOOK_KARIS && suns_ > 0 && lit_places <= most_lit_places ? near : 0.0f;
    look_at(eye, kept, 0, 1, shaded_.near);
    if (strands > 0)
    {
        find_front(eye);
        const size_t coarse = voxels_of(coarse_);
        passes_.room_for("around", coarse * 16 * sizeof(float));
        passes_.launch("look_around", fmt::format("-D LEVEL={}{}", level - LOOK_KAJIYA_KAY, skin_ ? " -D SKIN" : ""),
                       coarse);
    }
    shaded_.colors =
        passes_.room_for("shaded", std::max<size_t>(strands, 1) * size_t(volume_.places) * 2 * sizeof(cl_uint));
    std::string options = options_ + fmt::format(" -D LEVEL={}", level - LOOK_KAJIYA_KAY);
    if (pieces)
    {
        options += " -D CULLED";
        passes_.buffers["pieces"] = *pieces;
    }
    if (shaded_.near > 0.0f)
    {
        options += " -D NEAR_FIELD";
        shaded_.straight = passes_.room_for("straight_light", lit_places * sizeof(cl_half));
        shaded_.frame = passes_.buffers["near_frame"];
        shaded_.suns = passes_.buffers["rays"];
    }
    if (strands > 0)
        passes_.launch("look_shade", options, strands);
    return shaded_;
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while shading the strands", e.err(), e.what());
}

const cl::Buffer& Shading::across()
try
{
    const size_t strands = size_t(volume_.strands);
    const cl::Buffer& cells = passes_.room_for("near_light", std::max<size_t>(strands, 1) * size_t(volume_.places) *
                                                                 NEAR_LIGHT * sizeof(cl_half));
    if (strands > 0)
        passes_.launch("look_across", options_, strands);
    return cells;
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while shading the strands", e.err(), e.what());
}

double Shading::handed_on_share()
try
{
    constexpr int kStrands = 512; // that it is looked at on, at most twice as many
    const int stride = std::max(1, volume_.strands / kStrands);
    const size_t items = size_t((volume_.strands + stride - 1) / stride);
    if (items == 0 || suns_ == 0)
        return 0.0;
    look_at(glm::vec3(0.0f), 1.0f, 0, stride);
    // Groups of 64 on GPUs write as many.
    passes_.fill("straight_and_handed", std::vector<cl_float2>((items + 63) / 64 * 64, cl_float2{}));
    passes_.launch("look_share", options_, items);
    glm::dvec2 sum(0.0);
    for (const cl_float2& share : read<cl_float2>(passes_.device, passes_.buffers["straight_and_handed"], items))
        if (std::isfinite(share.s[0]) && std::isfinite(share.s[1]))
            sum += glm::dvec2(share.s[0], share.s[1]);
    return sum.y / std::max(sum.x + sum.y, 1e-12);
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while following the light", e.err(), e.what());
}

void Shading::light_surfaces(const std::vector<LookSurface>& surfaces, glm::vec3 eye)
{
    look_at(eye, 1.0f, surfaces.size());
    passes_.fill("surfaces", surfaces);
    passes_.room_for("lit", surfaces.size() * sizeof(float4));
    const size_t width = size_t(passes_.device.width);
    passes_.launch("look_surface", options_, (surfaces.size() + width - 1) / width);
}

std::vector<float4> Shading::lit(const std::vector<LookSurface>& surfaces, glm::vec3 eye)
try
{
    if (surfaces.empty())
        return {};
    light_surfaces(surfaces, eye);
    return read<float4>(passes_.device, passes_.buffers["lit"], surfaces.size());
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while lighting the head", e.err(), e.what());
}

} // namespace coif

#include "app/traced/rays.h"

#include "app/ground.h"
#include "sim/error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coif
{

static constexpr int kMostSkipped = 64; // surfaces that a ray leaves strands by, before it comes into the next
static constexpr float kOff = 2e-5f;    // m that rays begin off a solid, so that they do not meet it again

void TracedRays::check(const char* doing) const
{
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw fail("there is not enough memory to {}; draw fewer strands", doing);
    if (error != RTC_ERROR_NONE)
        throw fail("Embree could not {}: error {}", doing, int(error));
}

void TracedRays::add_strands()
{
    const size_t n = of.points, count = of.strands();
    if (count == 0)
        return;
    if (of.curve.size() > std::numeric_limits<unsigned>::max())
        throw fail("{} strands of {} points are more than can be traced; draw fewer strands", count, n);
    segments.reserve(count * (n - 1));
    for (size_t s = 0; s < count; ++s)
        for (size_t k = 0; k + 1 < n; ++k)
            segments.push_back(unsigned(s * (n + 2) + k));
    strands = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_CATMULL_ROM_CURVE);
    rtcSetSharedGeometryBuffer(strands, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, of.curve.data(), 0,
                               sizeof(glm::vec4), of.curve.size());
    rtcSetSharedGeometryBuffer(strands, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, segments.data(), 0, sizeof(unsigned),
                               segments.size());
    rtcCommitGeometry(strands);
    strands_id = rtcAttachGeometry(scene, strands);
}

void TracedRays::add_solids()
{
    if (of.triangles.empty())
        return;
    of.position.emplace_back(0.0f); // Embree reads 16 bytes of each
    solids = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(solids, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, of.position.data(), 0,
                               sizeof(glm::vec3), of.position.size() - 1);
    rtcSetSharedGeometryBuffer(solids, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, of.triangles.data(), 0,
                               sizeof(glm::uvec3), of.triangles.size());
    rtcCommitGeometry(solids);
    solids_id = rtcAttachGeometry(scene, solids);
}

TracedRays::TracedRays(TracedScene traced) : of(std::move(traced)), device(rtcNewDevice(nullptr))
{
    if (!device)
        throw fail("Embree, which traces rays, does not start on this machine: error {}",
                   int(rtcGetDeviceError(nullptr)));
    scene = rtcNewScene(device);
    add_strands();
    add_solids();
    rtcCommitScene(scene);
}

TracedRays::~TracedRays()
{
    for (const RTCGeometry geometry : {strands, solids})
        if (geometry)
            rtcReleaseGeometry(geometry);
    if (scene)
        rtcReleaseScene(scene);
    if (device)
        rtcReleaseDevice(device);
}

static void set_ray(RTCRay& to, const Ray& ray)
{
    to = {};
    to.org_x = float(ray.from.x);
    to.org_y = float(ray.from.y);
    to.org_z = float(ray.from.z);
    to.dir_x = float(ray.way.x);
    to.dir_y = float(ray.way.y);
    to.dir_z = float(ray.way.z);
    to.tfar = std::numeric_limits<float>::infinity();
    to.mask = ~0u;
}

// What it enters first. Strands of hair that stand for several lie within each other: what counts is where a ray comes
// into one, though it be in another, so that as much hair is met as there is.
RTCRayHit TracedRays::meet(const Ray& ray) const
{
    float near = 0.0f;
    for (int skipped = 0;; ++skipped)
    {
        RTCRayHit hit = {};
        set_ray(hit.ray, ray);
        hit.ray.tnear = near;
        hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(scene, &hit);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &hit);
#endif
        if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID || hit.hit.geomID != strands_id || skipped == kMostSkipped)
            return hit;
        const double outwards = hit.hit.Ng_x * ray.way.x + hit.hit.Ng_y * ray.way.y + hit.hit.Ng_z * ray.way.z;
        const bool own = hit.hit.primID / (of.points - 1) == ray.strand && hit.ray.tfar < ray.within;
        if (outwards < 0.0 && !own)
            return hit;
        near = std::nextafter(hit.ray.tfar, std::numeric_limits<float>::infinity()) + 1e-7f;
    }
}

OnGround TracedRays::ground_along(const Ray& ray) const
{
    if (!(of.ground.radius > 0.0 && ray.way.y < 0.0)) // from below it is not there
        return {};
    const double far = (of.ground.middle.y - ray.from.y) / ray.way.y;
    if (!(far > 0.0))
        return {};
    const glm::dvec3 out = ray.from + far * ray.way - of.ground.middle;
    return {far, ground_cover(std::hypot(out.x, out.z) / of.ground.radius)};
}

double TracedRays::reaches(const Ray& ray) const
{
    return meet(ray).hit.geomID == RTC_INVALID_GEOMETRY_ID ? 1.0 - ground_along(ray).share : 0.0;
}

glm::dvec3 face_of(const RTCRayHit& met)
{
    const glm::dvec3 across(met.hit.Ng_x, met.hit.Ng_y, met.hit.Ng_z);
    return across / std::max(glm::length(across), 1e-300);
}

SolidPlace TracedRays::solid_place(const RTCRayHit& met, const glm::dvec3& to_eye) const
{
    const glm::uvec3 t = of.triangles[met.hit.primID];
    const float u = met.hit.u, v = met.hit.v, w = 1.0f - u - v;
    const auto between = [&](const auto& of_corner)
    { return w * of_corner[t.x] + u * of_corner[t.y] + v * of_corner[t.z]; };
    SolidPlace place;
    place.face = face_of(met);
    if (glm::dot(place.face, to_eye) < 0.0)
        place.face = -place.face;
    place.normal = glm::dvec3(between(of.normal));
    place.normal /= std::max(glm::length(place.normal), 1e-30);
    const double turned = glm::dot(place.normal, place.face);
    if (!(turned > 0.0)) // a mesh whose normals look inwards, or has none there
        place.normal = turned < 0.0 ? -place.normal : place.face;
    place.at = glm::dvec3(between(of.position)) + double(kOff) * place.face;
    place.look.albedo = glm::dvec3(between(of.albedo));
    if (!of.gloss.empty())
        place.look.gloss = std::clamp(double(between(of.gloss)), 0.0, 1.0);
    return place;
}

SolidPlace TracedRays::ground_place(const glm::dvec3& at) const
{
    const glm::dvec3 up(0.0, 1.0, 0.0);
    return {glm::dvec3(at.x, of.ground.middle.y, at.z), up, up, {of.ground.albedo, 0.0}};
}

} // namespace coif

// Rays through a scene that Embree has sorted: what they meet.
#pragma once
#include "app/traced/scene.h"
#include "app/traced/solid.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace coif
{

struct Ray
{
    glm::dvec3 from, way; // of unit length
    // The strand that it comes out of is not met again before it is left behind, m.
    size_t strand = SIZE_MAX;
    double within = 0.0;
};

// Where a ray comes down onto the ground, m along it, and how much of it that takes: there is less and less of it
// towards its rim.
struct OnGround
{
    double far = 0.0, share = 0.0;
};

glm::dvec3 face_of(const RTCRayHit& met); // across what was met, to either side

// A place on something solid: ways from it are off its face, which `normal` is the smoother of.
struct SolidPlace
{
    glm::dvec3 at{0.0}, face{0.0}, normal{0.0};
    SolidLook look;
};

// Holds the scene that Embree reads. Throws Error when there is no memory for it.
struct TracedRays
{
    TracedScene of;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCGeometry strands = nullptr, solids = nullptr;
    std::vector<unsigned> segments; // first control point of each
    unsigned strands_id = RTC_INVALID_GEOMETRY_ID, solids_id = RTC_INVALID_GEOMETRY_ID;

    explicit TracedRays(TracedScene scene);
    ~TracedRays();
    TracedRays(const TracedRays&) = delete;

    RTCRayHit meet(const Ray& ray) const; // but for the ground
    OnGround ground_along(const Ray& ray) const;
    double reaches(const Ray& ray) const; // a light, past everything: the share of it that does
    SolidPlace solid_place(const RTCRayHit& met, const glm::dvec3& to_eye) const;
    SolidPlace ground_place(const glm::dvec3& at) const;
    void check(const char* doing) const;

  private:
    void add_strands();
    void add_solids();
};

} // namespace coif

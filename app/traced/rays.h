// Rays through a scene that Embree has sorted: what they meet.
#pragma once
#include "app/traced/scene.h"

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

    RTCRayHit meet(const Ray& ray) const;
    bool reaches(const Ray& ray) const; // a light, past everything
    void check(const char* doing) const;

  private:
    void add_strands();
    void add_solids();
};

} // namespace coif

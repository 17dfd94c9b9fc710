// How far the levels of the look are from light that is followed through the same strands, in small pictures.
#pragma once
#include "app/likeness.h"
#include "app/renderer.h"
#include "app/traced/tracer.h"

#include <functional>

namespace coif
{

struct SmallPicture
{
    int width = 160, height = 160; // pixels
    int samples = 4;               // jittered pictures that are averaged
};

// The hair's light at a level of the look other than auto, with nothing behind it and no ground. Leaves the simulation
// as it was, but awake.
LinearImage light_at_level(Renderer& renderer, Simulation& simulation, const Camera& camera, int level,
                           const SmallPicture& picture);

// The scene of the picture that they are held against: without a ground too, whose light the levels do not hand on.
TracedScene truth_scene(const Simulation& simulation, const Camera& camera);

// What they are held against.
struct LookTruth
{
    LinearImage light;
    std::vector<float> hair; // share of each pixel that shows hair first
    uint32_t samples = 0;    // of any pixel, at least
    double seconds = 0.0;    // that it took
};

struct TruthLimits
{
    int samples = 16;     // a pixel
    double seconds = 5.0; // after which it is left at fewer, but one
    int threads = 0;      // 0: as many as there are cores
    std::function<bool()> stopped = [] { return false; };
};
LookTruth look_truth(const Tracer& tracer, const SmallPicture& picture, const TruthLimits& limits = {});

} // namespace coif

// Light followed from the eye backwards through hair: path tracing with Embree. The truth that the faster levels are
// held against, as far as fibres are round, smooth curves of one material.
#pragma once
#include "app/traced/scene.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace coif
{

// A picture that grows, row by row: the sums of its samples, linear, premultiplied, with the share that shows something
// for alpha. Top row first.
struct Accumulation
{
    int width = 0, height = 0;
    std::vector<uint32_t> samples; // [row]
    std::vector<glm::vec4> sum;    // [pixel]
    uint32_t fewest() const;       // samples of any row
};
Accumulation empty_accumulation(int width, int height);

struct TraceLimits
{
    int bounces = 64; // after the first thing that is met; 0: light that comes straight from its source
    int threads = 0;  // 0: as many as there are cores
    uint64_t seed = 0;
};

// Hears now and then what share is done and how many seconds are left; false: stop.
using TraceSays = std::function<bool(double share, double seconds_left)>;

// Takes its scene and gives it to Embree. Throws Error when there is no memory for it.
class Tracer
{
  public:
    explicit Tracer(TracedScene scene);
    ~Tracer();
    Tracer(const Tracer&) = delete;

    // Until every row has so many samples a pixel, or it is stopped: then each row is whole, but some may have fewer.
    // A sample depends on its pixel, its number and the seed alone, so that neither threads nor stops change anything.
    void trace(Accumulation& picture, uint32_t samples, const TraceLimits& limits, const TraceSays& says = {}) const;

    // The share of each pixel where hair is what is met first.
    std::vector<float> hair(int width, int height, int samples) const;

    const TracedScene& scene() const;

  private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

} // namespace coif

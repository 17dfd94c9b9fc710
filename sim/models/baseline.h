// The thesis' own kernel on a device: kernels/baseline/simulate.cl, one work-group a strand and one work-item a node,
// to stand beside coif's in the same run.
#pragma once
#include "kernels/shared.h"
#include "sim/device.h"

#include "kernels/baseline/settings.h"

#include <glm/vec3.hpp>

#include <vector>

namespace coif::study
{

struct BaselineSetup
{
    int nodes = 16; // with the two that follow the scalp
    int iterations = 8;
    std::vector<float4> roots;   // one a strand: place relative to the scalp's centre, m; w: length of a segment, m
    std::vector<float4> spheres; // that move with the scalp: centre relative to its own, m; w: radius, m
    float rate = 60.0f;          // steps a second
    float gravity = -9.81f;      // m/s^2 along y
    float drag = 0.0f;           // 1/s
    float stretching = 1.0f;     // strength, 0 to 1
    float bending = 0.0f;        // strength, 0 to 1
    float bending_attenuation = 1.0f;
    float bending_scale = 1.0f;
};

// What the kernel reads in a step; `first` when previous positions are no motion yet.
BaselineSettings make_settings(const BaselineSetup& setup, glm::vec3 scalp, bool first);

// Strands straight out of the scalp at rest, then one step after another. Throws Error when a work-group of that many
// nodes, or the memory, is more than the device has.
class Baseline
{
  public:
    Baseline(const Device& device, const BaselineSetup& setup, glm::vec3 scalp);

    double step(glm::vec3 scalp);             // ns a strand that the device took
    std::vector<glm::vec3> positions() const; // [strand][node], in the world, m

  private:
    const Device& device_;
    BaselineSetup setup_;
    Kernel kernel_;
    Buffers buffers_;
    bool first_ = true;
};

struct BaselineResult
{
    std::vector<glm::vec3> positions; // [strand][node] after the last step
    double ns;                        // a strand and frame, the median
};

// Plays `frames` steps under a scalp that stays.
BaselineResult run_baseline(const Device& device, const BaselineSetup& setup, int frames);

} // namespace coif::study

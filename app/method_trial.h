#pragma once
#include "app/renderer.h"

#include <array>

namespace coif
{

// Which way of drawing strands is faster in a window, found by drawing the first frames both ways. Pictures that go to
// files never ask a stopwatch: Renderer::method_of() has their rule.
class MethodTrial
{
  public:
    // Renderer::show(); by either way in turn, then by the faster one, where render.method is "auto".
    void show(Renderer& renderer, FrameInput& frame, int width, int height);
    // As found, for another frame of the same window.
    void apply(FrameInput& frame) const;
    // A line about what draws the strands, and why.
    std::string said(const HairParams& params) const;

  private:
    Method faster() const;

    size_t strands_ = 0; // that it was found with
    int width_ = 0, height_ = 0;
    std::array<std::vector<double>, 2> ms_; // of frames by geometry, by opencl
};

} // namespace coif

#include "app/method_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace coif
{

static constexpr size_t kWarm = 1, kTimed = 3; // frames of each way; what is compiled and allocated is in the first
static constexpr double kOther = 1.5;          // as many times the strands or pixels are another case

static bool is_near(double a, double b) { return std::max(a, b) <= kOther * std::min(a, b); }

void MethodTrial::show(Renderer& renderer, FrameInput& frame, int width, int height)
{
    const size_t strands = frame.simulation->solver().groom().drawn.size();
    if (frame.params.render_method != BY_ITSELF || frame.params.render_show == 1 || strands == 0)
        return renderer.show(frame, width, height);
    if (!is_near(double(strands), double(strands_)) ||
        !is_near(double(width) * double(height), double(width_) * double(height_)))
    {
        ms_ = {};
        strands_ = strands;
        width_ = width;
        height_ = height;
    }
    const size_t way = ms_[0].size() <= ms_[1].size() ? 0 : 1;
    if (ms_[way].size() == kWarm + kTimed)
    {
        apply(frame);
        return renderer.show(frame, width, height);
    }
    frame.params.render_method = way == 0 ? BY_GEOMETRY : BY_OPENCL;
    glFinish(); // what came before
    const auto begin = std::chrono::steady_clock::now();
    renderer.show(frame, width, height);
    glFinish();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    ms_[way].push_back(took.count() / frame.samples);
    if (ms_[way].size() == kWarm)
        ms_[way].front() = INFINITY;
}

Method MethodTrial::faster() const
{
    return *std::ranges::min_element(ms_[1]) < *std::ranges::min_element(ms_[0]) ? BY_OPENCL : BY_GEOMETRY;
}

void MethodTrial::apply(FrameInput& frame) const
{
    if (frame.params.render_method == BY_ITSELF && ms_[1].size() == kWarm + kTimed)
        frame.params.render_method = faster();
}

std::string MethodTrial::said(const HairParams& params) const
{
    const auto name = [](Method method) { return method == BY_OPENCL ? "rasteriser in OpenCL" : "geometry shader"; };
    if (params.render_method != BY_ITSELF)
        return fmt::format("strands by the {} (pinned)", name(Method(params.render_method)));
    if (ms_[1].size() < kWarm + kTimed)
        return "strands by either way in turn, for a trial";
    const Method best = faster();
    const double ms[2] = {*std::ranges::min_element(ms_[0]), *std::ranges::min_element(ms_[1])};
    return fmt::format("strands by the {}: {:.0f} ms, not {:.0f}", name(best), ms[best == BY_OPENCL],
                       ms[best != BY_OPENCL]);
}

} // namespace coif

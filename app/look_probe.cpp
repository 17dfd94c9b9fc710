#include "app/look_probe.h"

#include "app/look_level.h"
#include "app/traced/scene.h"

#include <algorithm>
#include <chrono>

namespace coif
{

LookProbe::~LookProbe()
{
    stop_ = true;
    if (work_.valid())
        work_.wait();
}

void LookProbe::begin(Renderer& renderer, Simulation& simulation, const Camera& camera, int level)
{
    const SmallPicture small;
    HairParams shown = simulation.params();
    shown.look_level = LOOK_DUAL_SCATTERING; // both through one display transform
    of_ = {simulation.params(), simulation.lighting()};
    LinearImage light = light_at_level(renderer, simulation, camera, level, small);
    TracedScene scene = truth_scene(simulation, camera);
    said_.clear();
    work_ = std::async(std::launch::async,
                       [this, small, shown, level, light = std::move(light), scene = std::move(scene)]() mutable
                       {
                           TruthLimits limits;
                           limits.threads = 1; // the window goes on
                           limits.seconds = 20.0;
                           limits.stopped = [this] { return stop_.load(); };
                           const LookTruth truth = look_truth(Tracer(std::move(scene)), small, limits);
                           return fmt::format("{} {}", level_name(level),
                                              likeness_text(likeness(light, truth.light, truth.hair, shown)));
                       });
}

bool LookProbe::look()
{
    if (!work_.valid() || work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return false;
    said_ = work_.get();
    return true;
}

// But for the camera.
static bool same_look(const HairParams& a, const HairParams& b)
{
    return std::ranges::all_of(param_table(),
                               [&](const ParamInfo& info)
                               {
                                   float of_a[kMostNumbers] = {}, of_b[kMostNumbers] = {};
                                   if (info.on_host() || info.group == std::string_view("camera"))
                                       return true;
                                   get_numbers(a, info, of_a);
                                   get_numbers(b, info, of_b);
                                   return std::ranges::equal(of_a, of_b);
                               });
}

static bool same(const Lighting& a, const Lighting& b)
{
    return a.sky == b.sky && a.suns.size() == b.suns.size() &&
           std::ranges::equal(a.suns, b.suns,
                              [](const Sun& x, const Sun& y) {
                                  return x.direction == y.direction && x.irradiance == y.irradiance &&
                                         x.radius == y.radius;
                              });
}

std::string LookProbe::said(const HairParams& params, const Lighting& lighting) const
{
    if (said_.empty())
        return {};
    const bool as_then = same_look(params, of_.params) && same(lighting, of_.lighting);
    return said_ + (as_then ? "" : ", before the last change");
}

} // namespace coif

#include "app/look_probe.h"

#include "app/look_level.h"
#include "app/traced/scene.h"

#include <chrono>
#include <cstring>

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
    TracedScene scene = traced_scene(frame_input(simulation, camera));
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
    HairParams now = params;
    keep_camera(Camera(), now);
    HairParams then = of_.params;
    keep_camera(Camera(), then);
    const bool as_then = std::memcmp(&now, &then, sizeof now) == 0 && same(lighting, of_.lighting);
    return said_ + (as_then ? "" : ", before the last change");
}

} // namespace coif

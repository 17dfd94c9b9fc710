#include "app/look_error.h"

#include "app/traced/accumulation.h"

#include <chrono>

namespace coif
{

namespace
{
struct Shown // with other parameters than the simulation's, as long as it lives
{
    Simulation& simulation;
    Shown(Simulation& s, const HairParams& params) : simulation(s)
    {
        simulation.solver().set_params(params); // Kajiya-Kay has its shadows there
        simulation.solver().draw();
    }
    ~Shown() { simulation.solver().set_params(simulation.params()); }
    Shown(const Shown&) = delete;
};
} // namespace

LinearImage light_at_level(Renderer& renderer, Simulation& simulation, const Camera& camera, int level,
                           const SmallPicture& picture)
{
    HairParams params = simulation.params();
    params.look_level = level;
    params.look_ground = params.render_show = params.render_colors = 0;
    const Shown shown(simulation, params);
    FrameInput frame = frame_input(simulation, camera);
    frame.params = params;
    frame.colors = {};
    frame.samples = picture.samples;
    frame.transparent = true;
    return renderer.linear_picture(frame, picture.width, picture.height);
}

TracedScene truth_scene(const Simulation& simulation, const Camera& camera)
{
    FrameInput frame = frame_input(simulation, camera);
    frame.params.look_ground = 0;
    return traced_scene(frame);
}

LookTruth look_truth(const Tracer& tracer, const SmallPicture& picture, const TruthLimits& limits)
{
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    LookTruth truth;
    truth.hair = tracer.hair(picture.width, picture.height, 16);
    Accumulation sums = empty_accumulation(picture.width, picture.height);
    TraceLimits with;
    with.threads = limits.threads;
    const auto go_on = [&](double, double)
    { return !limits.stopped() && (seconds() < limits.seconds || sums.fewest() == 0); };
    tracer.trace(sums, uint32_t(limits.samples), with, go_on);
    truth.light = mean_of(sums);
    truth.samples = sums.fewest();
    truth.seconds = seconds();
    return truth;
}

} // namespace coif

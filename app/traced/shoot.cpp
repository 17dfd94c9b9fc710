#include "app/traced/shoot.h"

#include "app/display.h"
#include "app/progress.h"
#include "app/shading.h"
#include "app/traced/accumulation.h"
#include "sim/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>

namespace coif
{

static volatile std::sig_atomic_t asked_to_stop = 0;

namespace
{
// While it lives the first Ctrl-C asks to stop; a second one does.
struct Stoppable
{
    void (*interrupt)(int);
    void (*terminate)(int);
    Stoppable()
    {
        asked_to_stop = 0;
        const auto ask = [](int signal)
        {
            asked_to_stop = 1;
            std::signal(signal, SIG_DFL);
        };
        interrupt = std::signal(SIGINT, ask);
        terminate = std::signal(SIGTERM, ask);
    }
    ~Stoppable()
    {
        std::signal(SIGINT, interrupt);
        std::signal(SIGTERM, terminate);
    }
};
} // namespace

// shaders/background.frag behind it.
static void put_backdrop(LinearImage& image, const HairParams& params)
{
    const float4 c = device_params(params).look_background;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
        {
            const glm::vec2 at((float(x) + 0.5f) / float(image.width), 1.0f - (float(y) + 0.5f) / float(image.height));
            const glm::vec2 p = (at - glm::vec2(0.5f, 0.55f)) * glm::vec2(1.2f, 1.0f);
            const float glow = glm::mix(1.25f, 0.6f, glm::smoothstep(0.0f, 0.8f, glm::length(p)));
            float* pixel = &image.pixels[4 * (size_t(y) * size_t(image.width) + size_t(x))];
            const float open = glow * (1.0f - pixel[3]);
            pixel[0] += open * c.x;
            pixel[1] += open * c.y;
            pixel[2] += open * c.z;
            pixel[3] = 1.0f;
        }
}

static std::string duration(double seconds)
{
    return seconds < 90.0 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60.0);
}

// The n-th moment of an open shutter, as a share of it: however many are taken, they fill it evenly (additive
// recurrence by the golden ratio; Weyl 1916).
static double moment_of(uint32_t n)
{
    const double at = 0.5 + 0.6180339887498949 * double(n);
    return at - std::floor(at);
}

// Of all that the light in a picture of what moves depends on.
static Hash hash_of(const TracedScene& end, const Moments& moments, double open)
{
    Hash hash = hash_of(end);
    for (const auto& [step, moment] : moments)
    {
        const glm::dvec3 at = moment.head.origin, jumped = moment.jumped;
        const glm::dquat turn = moment.head.turn;
        for (const double number : {double(moments.back().first - step), open, at.x, at.y, at.z, jumped.x, jumped.y,
                                    jumped.z, turn.w, turn.x, turn.y, turn.z})
            hash.add(&number, sizeof number);
        hash.add(moment.guides.data(), moment.guides.size() * sizeof(float));
    }
    return hash;
}

// Each sample in a moment of its own, whose strands are sorted anew for it: no more than one scene is held at a time.
static void trace_moments(Accumulation& picture, uint32_t samples, Simulation& simulation, const Moments& moments,
                          const std::function<TracedScene()>& scene_now, const TraceSays& says)
{
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    const uint32_t first = picture.fewest();
    bool stopped = false;
    for (uint32_t n = first; n < samples && !stopped; ++n)
    {
        const auto of_all = [&](double share, double)
        {
            const double done = share * (n + 1.0), taken = std::chrono::duration<double>(Clock::now() - begin).count();
            stopped = !says(done / samples, taken * (samples - done) / std::max(done - first, 1e-3));
            return !stopped;
        };
        simulation.solver().show(moment_at(moments, simulation, moment_of(n)));
        Tracer(scene_now()).trace(picture, n + 1, {}, of_all);
        simulation.solver().take_times(); // lets the queue's uploads go
    }
    simulation.solver().show(moments.back().second);
}

int shoot_traced(const Options& options, const ShotOptions& shot, int samples, double turn)
{
    if (samples < 1 || samples > kMostTraced)
        throw fail("--traced {}: expected 1 to {} samples a pixel", samples, kMostTraced);
    check_shot(options, shot);
    check_folder(options.output);
    const std::filesystem::path file = record_of(options.output);
    std::optional<Record> before = read_record(file);
    const Hairstyle style = load_style(options);
    const Motion motion = find_motion(options.motion);
    const Device device = open_device(options);
    const Progress progress;
    progress.say(style.name() + ": falls to rest");
    Simulation simulation(device, style);
    simulation.play(motion);
    progress.say(style.name() + ": moves");
    Moments moments;
    const long target = std::lround(options.seconds / simulation.step_seconds());
    const auto note = [&] { note_moment(moments, simulation, target); };
    note();
    play_to(simulation, shot, options.seconds, note);
    HairParams params = simulation.params();
    params.look_level = LOOK_DUAL_SCATTERING; // shown as the levels that reckon with the strength of light are
    const auto scene_now = [&]
    {
        simulation.solver().draw();
        return traced_scene(frame_input(simulation, shot_camera(simulation, shot, turn)));
    };
    TracedScene scene = scene_now(); // at the end
    const Hash hash = hash_of(scene, moments, open_steps(simulation));
    Accumulation picture = empty_accumulation(shot.width, shot.height);
    progress.clear();
    if (before && before->of.word[0] == hash.word[0] && before->of.word[1] == hash.word[1] &&
        before->picture.width == shot.width && before->picture.height == shot.height)
    {
        picture = std::move(before->picture);
        fmt::print(stderr, "{}: goes on from {} samples a pixel\n", file.string(), picture.fewest());
    }
    else if (before)
        fmt::print(stderr, "{}: is of another picture, so this one starts anew\n", file.string());
    before.reset();

    const Stoppable stoppable;
    const auto say = [&](double share, double left)
    {
        progress.say(fmt::format("{}: traced {:.0f} %, {} left", style.name(), 100.0 * share, duration(left)));
        return !asked_to_stop;
    };
    if (moments.empty())
        Tracer(std::move(scene)).trace(picture, uint32_t(samples), {}, say);
    else
    {
        scene = {}; // may be large
        trace_moments(picture, uint32_t(samples), simulation, moments, scene_now, say);
    }
    progress.clear();
    write_record(file, hash, picture);

    LinearImage image = mean_of(picture);
    if (!shot.transparent)
        put_backdrop(image, params);
    if (is_linear(options.output))
        save_hdr(options.output, image, display_of(params).gain);
    else
        save_png(options.output, displayed(image, params));
    if (asked_to_stop)
    {
        fmt::print(stderr, "wrote {}, stopped at {} of {} samples; the same command goes on from there\n",
                   options.output, picture.fewest(), samples);
        return 1;
    }
    fmt::print(stderr, "wrote {}: {} samples a pixel\n", options.output, picture.fewest());
    return 0;
}

} // namespace coif

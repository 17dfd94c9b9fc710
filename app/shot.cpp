#include "app/shot.h"

#include "app/display.h"
#include "app/lens.h"
#include "app/progress.h"
#include "sim/error.h"
#include "sim/shown.h"
#include "sim/source.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace coif
{

void parse_size(const std::string& text, ShotOptions& shot)
{
    char end = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &shot.width, &shot.height, &end) != 2 || shot.width < 1 ||
        shot.height < 1 || shot.width > 8192 || shot.height > 8192)
        throw fail("--size {}: expected WIDTHxHEIGHT, each from 1 to 8192", text);
}

static Camera parse_camera(const std::string& text, Camera camera)
{
    const double degree = std::numbers::pi / 180.0;
    const struct
    {
        const char* name;
        double yaw, pitch;
    } views[] = {{"front", 0, 0}, {"left", 90, 0}, {"right", -90, 0}, {"back", 180, 0}, {"top", 0, 80}};
    for (const auto& view : views)
        if (text == view.name)
        {
            camera.yaw = view.yaw * degree;
            camera.pitch = view.pitch * degree;
            return camera;
        }
    double yaw = 0, pitch = 0, distance = camera.distance;
    int two = 0, three = 0; // characters that so many numbers take
    std::sscanf(text.c_str(), "%lf,%lf%n,%lf%n", &yaw, &pitch, &two, &distance, &three);
    if (text.empty() || size_t(std::max(two, three)) != text.size())
        throw fail("--camera {}: expected front, left, right, back, top, or yaw,pitch[,distance] in degrees and "
                   "metres: as 25,5 or 25,5,0.95",
                   shown(text));
    for (const auto& [key, number] :
         {std::pair("camera.yaw", yaw), {"camera.pitch", pitch}, {"camera.distance", distance}})
        try
        {
            HairParams of_a_style; // whose bounds these are too
            const double numbers[kMostNumbers] = {number};
            set_numbers(of_a_style, *find_param(key), numbers);
        }
        catch (const Error& e)
        {
            throw fail("--camera {}: {}", shown(text), e.what());
        }
    camera.yaw = yaw * degree;
    camera.pitch = pitch * degree;
    camera.distance = distance;
    return camera;
}

void check_shot(const Options& options, const ShotOptions& shot)
{
    if (!(options.seconds >= 0.0 && options.seconds <= kLongestShot))
        throw fail("--time {}: expected seconds from 0 to {}", options.seconds, kLongestShot);
    if (shot.samples && (*shot.samples < 1 || *shot.samples > 1024))
        throw fail("--samples {}: expected 1 to 1024", *shot.samples);
    if (!shot.camera.empty())
        parse_camera(shot.camera, {});
}

Studio::Studio(const Device& device, const Hairstyle& style, const Motion& motion, const ShotOptions& shot)
    : shot_(shot), simulation_(device, style), renderer_(data_folder() / "shaders")
{
    simulation_.play(motion);
    if (shot.samples == 1 && is_blurred(style.params))
        fmt::print(stderr, "coif: one sample shows neither camera.aperture nor camera.shutter; take more --samples\n");
}

void Studio::play_to(double seconds)
{
    const long target = std::lround(seconds / simulation_.step_seconds());
    note_moment(moments_, simulation_, target);
    coif::play_to(simulation_, shot_, seconds, [&] { note_moment(moments_, simulation_, target); });
}

void play_to(Simulation& simulation, const ShotOptions& shot, double seconds, const std::function<void()>& after_step)
{
    const long steps = std::lround(seconds / simulation.step_seconds());
    while (simulation.steps() < steps)
    {
        // Views from all around are from as far: what each shows must not hang on which others are taken.
        simulation.set_view(view_of(shot_camera(simulation, shot, 0.0), shot.height));
        simulation.step(simulation.hand());
        if (after_step)
            after_step();
        if (simulation.steps() % 16 == 1)
            simulation.solver().take_times(); // lets the queue's uploads go
    }
}

Camera shot_camera(const Simulation& simulation, const ShotOptions& shot, double turn)
{
    Camera camera = camera_of(simulation.params());
    if (!shot.camera.empty())
        camera = parse_camera(shot.camera, camera);
    camera.yaw += turn;
    camera.target += simulation.jumped();
    return camera;
}

FrameInput Studio::frame(double turn)
{
    simulation_.solver().draw();
    FrameInput frame = frame_input(simulation_, shot_camera(simulation_, shot_, turn));
    frame.samples = shot_.samples.value_or(good_samples(frame.params));
    frame.transparent = shot_.transparent;
    return frame;
}

LinearImage Studio::moving_picture(double turn)
{
    Solver& solver = simulation_.solver();
    const int samples = shot_.samples.value_or(good_samples(simulation_.params()));
    LinearImage mean{shot_.width, shot_.height, {}};
    for (int i = 0; i < samples; ++i)
    {
        solver.show(moment_at(moments_, simulation_, (i + 0.5) / samples));
        FrameInput sample = frame(turn);
        sample.samples = 1;
        sample.first = i;
        const LinearImage light = renderer_.linear_picture(sample, shot_.width, shot_.height);
        mean.pixels.resize(light.pixels.size());
        for (size_t k = 0; k < light.pixels.size(); ++k)
            mean.pixels[k] += light.pixels[k] / float(samples);
        solver.take_times(); // lets the queue's uploads go
    }
    solver.show(moments_.back().second);
    return mean;
}

LinearImage Studio::linear_picture(double turn)
{
    if (open_steps(simulation_) > 0.0)
        return moving_picture(turn);
    return renderer_.linear_picture(frame(turn), shot_.width, shot_.height);
}

Image Studio::picture(double turn)
{
    if (open_steps(simulation_) > 0.0)
        return displayed(moving_picture(turn), simulation_.params());
    return renderer_.picture(frame(turn), shot_.width, shot_.height);
}

void Studio::save(const std::filesystem::path& file, double turn)
{
    if (is_linear(file))
        save_hdr(file, linear_picture(turn), display_of(simulation_.params()).gain);
    else
        save_png(file, picture(turn));
}

bool is_linear(const std::filesystem::path& file) { return file.extension() == ".hdr"; }

// Calls back with a studio that has played the motion.
template <typename Take> static auto at_its_time(const Options& options, const ShotOptions& shot, const Take& take)
{
    check_shot(options, shot);
    const Hairstyle style = load_style(options);
    const Motion motion = find_motion(options.motion);
    const Window window(16, 16, Window::HIDDEN);
    const Device device = shared_with_gl(open_device(options));
    const Progress progress;
    progress.say(style.name() + ": falls to rest"); // thousands of guides take minutes
    Studio studio(device, style, motion, shot);
    progress.say(style.name() + ": moves");
    studio.play_to(options.seconds);
    return take(studio);
}

Image take_shot(const Options& options, const ShotOptions& shot, double turn)
{
    return at_its_time(options, shot, [&](Studio& studio) { return studio.picture(turn); });
}

void save_shot(const Options& options, const ShotOptions& shot, double turn)
{
    at_its_time(options, shot, [&](Studio& studio) { studio.save(options.output, turn); });
}

} // namespace coif

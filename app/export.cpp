#include "app/export.h"

#include "app/film.h"
#include "app/progress.h"
#include "sim/error.h"

#include <chrono>
#include <cmath>

namespace coif
{

namespace fs = std::filesystem;

static constexpr uint64_t kMostPoints = 100'000'000; // in all: 5 GB of memory

ExportPlan plan_export(const std::string& output, const ExportOptions& wanted, const Hairstyle& style)
{
    ExportPlan plan;
    plan.file = output;
    plan.format = &format_of(output);
    plan.target = find_target(wanted.target);
    plan.placement = placement_of(*plan.format, plan.target);
    if (wanted.strands != "drawn" && wanted.strands != "guides")
        throw fail("--strands {}: expected drawn or guides", wanted.strands);
    plan.guides = wanted.strands == "guides";
    if (wanted.points != 0 && (wanted.points < 2 || wanted.points > 65536))
        throw fail("--points {}: expected 2 to 65536", wanted.points);
    if (plan.format->format == Format::TFX && wanted.points != 0 &&
        wanted.points != tfx_points(uint32_t(wanted.points)))
        throw fail("--points {}: a .tfx has 4, 8, 16, 32 or 64 points a strand", wanted.points);
    plan.points = wanted.points;

    Through through = plan.format->through;
    const bool unity = plan.target && std::string_view(plan.target->name) == "unity"; // draws straight pieces
    if (unity || style.params.smoothing_curve < 2)
        through = Through::LINES;
    if (wanted.curve == "linear")
        through = Through::LINES;
    else if (wanted.curve == "catmull_rom")
    {
        if (!plan.format->curves)
            throw fail("--curve catmull_rom: a {} holds straight pieces only; leave it out, ask for more --points, or "
                       "write .usda, .abc or .pbrt",
                       plan.format->suffix);
        through = Through::CATMULL_ROM;
    }
    else if (!wanted.curve.empty())
        throw fail("--curve {}: expected linear or catmull_rom", wanted.curve);
    plan.words = words_of(plan.placement, through);
    return plan;
}

ExportHair take_hair(const Simulation& simulation, const ExportPlan& plan)
{
    const Groom& groom = simulation.solver().groom();
    ExportHair hair;
    hair.taken = taken(simulation, plan.guides, plan.points);
    if (plan.format->format == Format::TFX && plan.points == 0)
        hair.taken = taken(simulation, plan.guides, tfx_points(uint32_t((groom.nodes - 2) * hair.taken.pieces + 1)));
    const uint64_t strands = plan.guides ? uint64_t(groom.guides) : groom.drawn.size();
    const uint64_t points = uint64_t(hair.taken.points ? hair.taken.points : (groom.nodes - 2) * hair.taken.pieces + 1);
    if (strands * points > kMostPoints)
        throw fail("{} strands of {} points are more than the {} points that coif exports; ask for fewer --points",
                   strands, points, kMostPoints);
    hair.curves = curves_of(simulation, hair.taken);
    check_curves(hair.curves, *plan.format);
    place(hair.curves, plan.placement);
    return hair;
}

std::vector<std::string> export_words(const ExportPlan& plan, const Curves& curves, const FileSize& size)
{
    const FormatInfo& format = *plan.format;
    std::vector<std::string> said;
    said.push_back(fmt::format("{} {} of {} points, {}; {}", curves.strands(), plan.guides ? "guides" : "strands",
                               curves.count[0], size_text(size),
                               plan.words.through == Through::LINES ? "straight from point to point"
                                                                    : "Catmull-Rom curves through the points"));
    const char* told = format.says_axes ? ", as the file says itself" : ", which the file does not say";
    said.push_back(fmt::format("{}, {}{}", plan.words.units, plan.words.axes, told));
    if (!curves.group_name.empty())
        said.push_back(fmt::format("groups: {}", fmt::join(curves.group_name, ", ")));
    if (*format.leaves_out)
        said.push_back(fmt::format("{} does not carry {}", format.suffix, format.leaves_out));
    if (plan.target)
    {
        const std::string reads = fmt::format(" {} ", plan.target->reads);
        if (reads.find(fmt::format(" {} ", format.suffix)) == reads.npos)
            said.push_back(fmt::format("{} is not known to read hair from {}; it takes {}", plan.target->name,
                                       format.suffix, plan.target->reads));
        else
            said.push_back(fmt::format("{}: {}", plan.target->name, plan.target->advice));
    }
    if (format.format == Format::ABC && plan.words.through == Through::CATMULL_ROM)
        said.push_back("Blender before 4.2 crashes on Catmull-Rom curves in Alembic; --curve linear is safe there");
    return said;
}

std::string write_export(const ExportPlan& plan, const Curves& curves, const Cache* cache)
{
    const auto began = std::chrono::steady_clock::now();
    NewFile file(plan.file);
    write_curves(file, *plan.format, curves, plan.words, cache);
    const uint64_t bytes = file.size();
    file.finish();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - began;
    const double seconds = spent.count();
    return fmt::format("{}: {}{}, in {} s", plan.file.string(), size_text({bytes, true}),
                       cache ? fmt::format(", {} frames", cache->count) : "",
                       seconds < 10.0 ? fmt::format("{:.2g}", seconds) : fmt::format("{:.0f}", seconds));
}

std::vector<Frame> export_moments(ExportPlan& plan, const SequenceOptions& frames, double time)
{
    plan.cache = frames.wanted();
    if (!plan.cache)
        return {{0, time, 0.0}};
    if (!plan.format->caches)
        throw fail("--frames: a {} holds one pose; write .usda or .abc, or leave it out", plan.format->suffix);
    return frames_of(frames, time);
}

Cache times_of(const std::vector<Frame>& moments, double fps)
{
    return {moments[0].number, int(moments.size()), fps, {}};
}

std::string export_motion(const Device& device, const Hairstyle& style, const ExportPlan& plan, const Motion& motion,
                          const std::vector<Frame>& moments, const Cache& times, const ExportSays& says)
{
    Simulation simulation(device, style, [&](double share) { says.doing(style.name() + " falls to rest", share); });
    simulation.play(motion);
    const auto play_to = [&](double seconds)
    {
        const long steps = std::lround(seconds / simulation.step_seconds());
        const long from = simulation.steps();
        while (simulation.steps() < steps)
        {
            simulation.step(simulation.hand());
            if (simulation.steps() % 16 == 1)
            {
                simulation.solver().take_times(); // lets the queue's uploads go
                if (moments.size() == 1)
                    says.doing(style.name() + " moves", double(simulation.steps() - from) / double(steps - from));
            }
        }
        simulation.solver().draw();
    };
    play_to(moments[0].seconds);
    const ExportHair hair = take_hair(simulation, plan);
    Cache cache = times;
    cache.positions = [&](int frame, std::vector<glm::vec3>& position)
    {
        const int done = frame - cache.first;
        says.doing(fmt::format("frame {} of {}", done + 1, cache.count), double(done) / cache.count);
        play_to(moments[size_t(done)].seconds);
        positions_of(simulation, hair.taken, position);
        check_positions(hair.curves, position, frame);
        place(position, plan.placement);
    };
    const Cache* moving = plan.cache ? &cache : nullptr;
    const FileSize size = size_of(*plan.format, hair.curves, plan.words, moving);
    says.words(export_words(plan, hair.curves, size));
    check_room(plan.file, size);
    return write_export(plan, hair.curves, moving);
}

int export_style(const Options& options, const ExportOptions& wanted, const SequenceOptions& frames)
{
    const Hairstyle style = load_style(options);
    ExportPlan plan = plan_export(options.output, wanted, style);
    if (!(options.seconds >= 0.0 && options.seconds <= kLongestShot))
        throw fail("--time {}: expected seconds from 0 to {}", options.seconds, kLongestShot);
    const std::vector<Frame> moments = export_moments(plan, frames, options.seconds);
    check_folder(plan.file);
    const Motion motion = find_motion(options.motion);
    const Device device = open_device(options);
    const Progress progress;
    ExportSays says;
    says.doing = [&](const std::string& doing, double share)
    { progress.say(fmt::format("{}, {:.0f} %", doing, 100.0 * share)); };
    says.words = [&](const std::vector<std::string>& words)
    {
        progress.clear();
        fmt::print(stderr, "{}\n", fmt::join(words, "\n"));
    };
    const std::string wrote = export_motion(device, style, plan, motion, moments, times_of(moments, frames.fps), says);
    progress.clear();
    fmt::print(stderr, "wrote {}\n", wrote);
    return 0;
}

} // namespace coif

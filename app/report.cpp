#include "app/report.h"

#include "app/csv.h"
#include "app/json.h"
#include "app/progress.h"
#include "app/report_look.h"
#include "app/shot.h"
#include "app/traced/shoot.h"
#include "sim/error.h"
#include "sim/health.h"
#include "sim/median.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace coif
{

static constexpr int kReportTraced = 16;  // samples a pixel
static constexpr size_t kMostNamed = 100; // of the strands that were reset, the first so many are named

namespace
{
struct Bad // a strand that was reset, and when
{
    Reset reset;
    long frame;
    double time; // s
    std::string cause;
};
} // namespace

static std::string json(const std::vector<Bad>& all)
{
    std::vector<std::string> objects;
    for (const Bad& bad : all)
        objects.push_back(fmt::format("{{\"strand\": {}, \"frame\": {}, \"time\": {}, \"times\": {}, \"cause\": {}}}",
                                      bad.reset.strand, bad.frame, json_number(bad.time), bad.reset.times,
                                      json_text(bad.cause)));
    return fmt::format("[{}]", fmt::join(objects, ", "));
}

int report(const Options& options, const ReportOptions& wanted)
{
    if (!(wanted.fps >= 1.0 && wanted.fps <= 1000.0))
        throw fail("--fps {}: expected 1 to 1000 frames a second", wanted.fps);
    if (!(options.seconds > 0.0 && options.seconds <= 3600.0) || !(wanted.settle >= 0.0 && wanted.settle <= 3600.0))
        throw fail("--seconds and --settle must lie within an hour");
    if (wanted.traced && (*wanted.traced < 0 || *wanted.traced > kMostTraced))
        throw fail("--traced {}: expected 0, for none, to {} samples a pixel", *wanted.traced, kMostTraced);
    const Motion motion = find_motion(options.motion);
    const Hairstyle style = load_style(options);
    const Device device = open_device(options);
    const Progress progress;
    progress.say(style.name() + ": grows");
    Simulation simulation(device, style,
                          [&](double share)
                          { progress.say(fmt::format("{}: falls to rest, {:.0f} %", style.name(), 100.0 * share)); });
    simulation.settle(wanted.settle);
    simulation.solver().take_times();
    simulation.play(motion);
    const ShotOptions pictured; // as a shot is that says nothing of size and camera

    const long frames = std::max(1L, std::lround(options.seconds * wanted.fps));
    Health worst;
    std::vector<int> seen = simulation.solver().resets();
    std::vector<Bad> bad;
    double stretch_sum = 0.0;
    std::vector<double> frame_ms;
    std::vector<std::pair<std::string, std::vector<double>>> pass_ms;
    std::string csv = "frame,time,stretch_max,stretch_mean,penetration_mm,drawn_penetration_mm,ms\n";
    for (long f = 0; f < frames; ++f)
    {
        simulation.set_view(view_of(shot_camera(simulation, pictured, 0.0), pictured.height));
        simulation.advance(1.0 / wanted.fps, simulation.hand(), 1 << 20);
        simulation.solver().draw();
        const PassTimes times = simulation.solver().take_times();
        double ms = 0.0;
        for (const auto& [pass, spent] : times)
        {
            const std::string& name = pass;
            auto found = std::find_if(pass_ms.begin(), pass_ms.end(), [&](const auto& p) { return p.first == name; });
            if (found == pass_ms.end())
                found = pass_ms.insert(pass_ms.end(), {pass, {}});
            found->second.push_back(spent);
            ms += spent;
        }
        frame_ms.push_back(ms);
        for (const Reset& reset : find_resets(simulation.solver(), seen))
            if (bad.size() < kMostNamed)
                bad.push_back({reset, f, simulation.time(), likely_cause(reset, simulation.solver().info())});
        const Health now = measure_health(simulation.solver(), style.params, true);
        worst.stretch_max = std::max(worst.stretch_max, now.stretch_max);
        worst.penetration_max = std::max(worst.penetration_max, now.penetration_max);
        worst.drawn_penetration_max = std::max(worst.drawn_penetration_max, now.drawn_penetration_max);
        worst.finite &= now.finite;
        stretch_sum += now.stretch_mean;
        csv += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", f, simulation.time(), now.stretch_max,
                           now.stretch_mean, 1e3 * now.penetration_max, 1e3 * now.drawn_penetration_max, ms);
        if (f % 10 == 9)
            progress.say(fmt::format("frame {} of {}", f + 1, frames));
    }
    // Where nobody looks at the light it need not be followed for seconds.
    const bool usual = !wanted.row && !wanted.csv && simulation.params().look_level != LOOK_KAJIYA_KAY;
    const int traced = wanted.traced.value_or(usual ? kReportTraced : 0);
    const LookReport look = wanted.csv ? LookReport() : report_look(simulation, traced, progress);
    progress.clear();
    // Measured on this motion, where a tolerance was asked for.
    const Quality& quality = simulation.quality();
    const double time_error = quality.rungs.empty()
                                  ? NAN
                                  : measure_time_error(device, simulation.params(), simulation.solver().groom(), motion,
                                                       std::min(options.seconds, 2.0));
    const std::vector<int> resets = simulation.solver().resets();
    const Groom& groom = simulation.solver().groom();
    const double stretch_mean = stretch_sum / double(frames);
    const long reset_count = std::accumulate(resets.begin(), resets.end(), 0L);

    std::string text;
    if (wanted.csv)
        text = csv;
    else if (wanted.row)
        text = fmt::format(
            "style,settings,motion,seconds,guides,strands,nodes,finite,stretch_max,stretch_mean,"
            "penetration_max_mm,drawn_penetration_max_mm,resets,ms_frame_median,{}\n"
            "{},{},{},{:.6g},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{}\n",
            kLookColumns, csv_text(style.name()), csv_text(fmt::format("{}", fmt::join(options.sets, " "))),
            csv_text(motion.name), options.seconds, groom.guides, groom.drawn.size(), groom.nodes, worst.finite,
            worst.stretch_max, stretch_mean, 1e3 * worst.penetration_max, 1e3 * worst.drawn_penetration_max,
            reset_count, wanted.untimed ? "" : fmt::format("{:.6g}", median(frame_ms)), row_of(look, wanted.untimed));
    else if (wanted.json)
    {
        std::vector<std::string> passes, ran;
        for (const auto& [pass, spent] : pass_ms)
        {
            ran.push_back(fmt::format("{}: {}", json_text(pass), spent.size()));
            passes.push_back(fmt::format("{}: {}", json_text(pass), json_number(median(spent))));
        }
        const double predicted = quality.rungs.empty() ? NAN : quality.time_error;
        text = fmt::format(
            "{{\"style\": {}, \"motion\": {}, \"device\": {}, \"guides\": {}, \"strands\": {}, \"nodes\": "
            "{}, \"frames\": {}, \"finite\": {}, \"stretch_max\": {}, \"stretch_mean\": {}, \"penetration_max_mm\": "
            "{}, \"drawn_penetration_max_mm\": {}, \"resets\": {}, \"bad_strands\": {}, \"dropped_steps\": {}, "
            "\"ms_frame_median\": {}, "
            "\"ms_pass\": {{{}}}, \"frames_pass\": {{{}}}, \"asleep\": {}, \"blocks\": {}, \"blocks_awake\": {}, "
            "\"blocks_thin\": {}, "
            "\"quality\": {}, \"substeps_error_predicted\": {}, \"substeps_error_measured\": {}, \"look\": {}}}\n",
            json_text(style.name()), json_text(motion.name), json_text(device.name), groom.guides, groom.drawn.size(),
            groom.nodes, frames, worst.finite, json_number(worst.stretch_max), json_number(stretch_mean),
            json_number(1e3 * worst.penetration_max), json_number(1e3 * worst.drawn_penetration_max), reset_count,
            json(bad), simulation.dropped(), json_number(median(frame_ms)), fmt::join(passes, ", "),
            fmt::join(ran, ", "), simulation.solver().asleep(), groom.blocks, simulation.solver().blocks_awake(),
            simulation.solver().blocks_thin(), json_text(quality.said), json_number(predicted), json_number(time_error),
            json_of(look));
    }
    else
    {
        text = fmt::format("{} on {}, {}: {} guides of {} nodes, {} strands drawn, {} frames\n", style.name(),
                           device.name, motion.name, groom.guides, groom.nodes, groom.drawn.size(), frames);
        text +=
            fmt::format("  stretch      worst {:.2f} %, mean {:.3f} %\n", 100 * worst.stretch_max, 100 * stretch_mean);
        text += fmt::format("  penetration  guides {:.2f} mm, drawn strands {:.2f} mm\n", 1e3 * worst.penetration_max,
                            1e3 * worst.drawn_penetration_max);
        text += fmt::format("  {}, {} strands reset, {} steps dropped\n", worst.finite ? "finite" : "NOT FINITE",
                            reset_count, simulation.dropped());
        for (size_t i = 0; i < bad.size() && i < 10; ++i)
            text += fmt::format("    strand {} in frame {} ({:.3f} s): {}\n", bad[i].reset.strand, bad[i].frame,
                                bad[i].time, bad[i].cause);
        if (bad.size() > 10)
            text += fmt::format("    and {} more\n", reset_count - 10);
        text += fmt::format("  {:.2f} ms a frame (median)\n", median(frame_ms));
        for (const auto& [pass, spent] : pass_ms)
            text +=
                fmt::format("    {:<20} {:.3f} ms, in {} of {} frames\n", pass, median(spent), spent.size(), frames);
        text += text_of(look);
        if (simulation.solver().asleep())
            text += "  asleep: at rest, nothing runs\n";
        else
            text += fmt::format("  {} of {} blocks of {} guides awake at the end\n", simulation.solver().blocks_awake(),
                                groom.blocks, LANES);
        if (simulation.params().solver_far_tolerance > 0.0f)
            text += fmt::format("  {} of {} blocks are far in a picture of {} lines and step with half the nodes{}\n",
                                simulation.solver().blocks_thin(), groom.blocks, pictured.height,
                                simulation.thin_error() ? fmt::format(": {:.2g} % of the length off, predicted",
                                                                      100.0 * *simulation.thin_error())
                                                        : "");
        if (!quality.said.empty())
            text += quality_text(quality) + "\n";
        if (!quality.rungs.empty())
            text += fmt::format("measured on this motion: substeps {:.2g} %, against eight times as many\n",
                                100 * time_error);
    }
    if (options.output.empty())
        fmt::print("{}", text);
    else
        write_file(options.output, text);
    return worst.finite || wanted.row ? 0 : 1;
}

} // namespace coif

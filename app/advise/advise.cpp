#include "app/advise/advise.h"

#include "app/advise/lean.h"
#include "app/progress.h"
#include "sim/error.h"
#include "sim/scatter.h"
#include "sim/source.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdio>

namespace coif
{

namespace fs = std::filesystem;

// In contact smaller errors cannot be told: what bodies do to hair is known no better.
static constexpr float kToleranceUnsaid = 3.0f; // %
static constexpr double kShareOfSeed = 0.5;     // of what another seed does to a picture, that is surely seen
static constexpr double kRoom = 0.5;            // of the tolerances, that one count alone may take by going further

static bool blows(const Trial& trial)
{
    for (double t = 0.0; t <= trial.seconds; t += 1.0 / 60.0)
        if (glm::length(pose_at(trial.motion, t).wind) > 0.0)
            return true;
    return false;
}

// How much of the tolerances a difference takes: 1 is all of the one or of the other.
static double taken(const Advice& advice, const Difference& d)
{
    return std::max(d.motion / advice.tolerance, d.picture / advice.picture_tolerance);
}

static bool within(const Advice& advice, const Difference& d)
{
    return d.motion <= advice.tolerance && d.picture <= advice.picture_tolerance;
}

static Hairstyle another_seed(Hairstyle style)
{
    style.params.interpolation_seed += style.params.interpolation_seed > 0 ? -1 : 1;
    return style;
}

// All features once, and the yardsticks.
static void measure_features(const Trial& trial, Advice& advice)
{
    std::vector<Feature> features = used_features(advice.base, blows(trial));
    const std::vector<Feature> lacked = lacked_features(advice.base, blows(trial));
    features.insert(features.end(), lacked.begin(), lacked.end());
    std::vector<Hairstyle> changed = {another_seed(advice.base)};
    for (const Feature& feature : features)
        changed.push_back(feature.style);
    const Comparison all = compare(trial, advice.base, changed);
    advice.step_ms = all.step_ms;
    advice.picture_ms = all.picture_ms;
    advice.another_seed = all.changed[0].picture;
    advice.picture_tolerance = std::min(all.moved, kShareOfSeed * advice.another_seed);
    for (size_t i = 0; i < features.size(); ++i)
    {
        const Difference& d = all.changed[i + 1];
        const Verdict verdict = features[i].lacked ? (within(advice, d) ? Verdict::ENOUGH : Verdict::LACKS)
                                                   : (within(advice, d) ? Verdict::LEAVE_OUT : Verdict::KEEP);
        advice.features.push_back({features[i], d, verdict});
    }
}

// What has a cheaper step still takes it, as long as it leaves the others room.
static void go_further(const Trial& trial, Advice& advice)
{
    std::vector<size_t> going;
    for (size_t i = 0; i < advice.features.size(); ++i)
        if (advice.features[i].verdict == Verdict::LEAVE_OUT && taken(advice, advice.features[i].difference) <= kRoom)
            going.push_back(i);
    while (!going.empty())
    {
        std::vector<Feature> next;
        std::vector<Hairstyle> changed;
        std::vector<size_t> tried;
        for (const size_t i : going)
        {
            const Feature feature = further(advice.features[i].feature);
            if (changes_text(advice.features[i].feature.style, feature.style).empty())
                continue;
            tried.push_back(i);
            next.push_back(feature);
            changed.push_back(feature.style);
        }
        going.clear();
        if (changed.empty())
            return;
        const Comparison found = compare(trial, advice.base, changed);
        for (size_t i = 0; i < tried.size(); ++i)
            if (taken(advice, found.changed[i]) <= kRoom)
            {
                advice.features[tried[i]].feature = next[i];
                advice.features[tried[i]].difference = found.changed[i];
                going.push_back(tried[i]);
            }
    }
}

static void put_together(const Trial& trial, Advice& advice)
{
    for (;;)
    {
        std::vector<Advised*> out;
        advice.lean = advice.base;
        for (Advised& a : advice.features)
            if (a.verdict == Verdict::LEAVE_OUT)
            {
                out.push_back(&a);
                advice.lean = with_changes(advice.lean, advice.base, a.feature.style);
            }
        advice.together = out.empty() ? Difference{} : out[0]->difference;
        if (out.size() < 2)
            return;
        advice.together = compare(trial, advice.base, {advice.lean}).changed[0];
        if (within(advice, advice.together))
            return;
        const auto most =
            std::ranges::max_element(out, {}, [&](const Advised* a) { return taken(advice, a->difference); });
        (*most)->verdict = Verdict::TOGETHER_NOT;
    }
}

Advice advise_on(const Trial& trial, const Hairstyle& style)
{
    Advice advice;
    advice.style = style.name();
    advice.motion = trial.motion.name;
    advice.device = trial.device.name;
    advice.seconds = trial.seconds;
    advice.tolerance = trial.tolerance;
    advice.base = style;
    const Assets assets = load_assets(style);
    advice.guides = grow(style.params, assets.scalp, style.host).guides;
    advice.guide_error = style.params.interpolation_guides == GUIDES_ALL
                             ? 0.0
                             : error_of_guides(style.params, assets.scalp, advice.guides);
    measure_features(trial, advice);
    go_further(trial, advice);
    put_together(trial, advice);
    return advice;
}

// What quality.tolerance chooses, written out.
static Hairstyle chosen(const Device& device, const Hairstyle& style)
{
    Quality quality;
    Assets assets = load_assets(style);
    Hairstyle live = meet_tolerance(device, style, assets, quality);
    live.params.quality_tolerance = 0.0f;
    return live;
}

int advise(const Options& options, const AdviseOptions& wanted)
{
    if (!(wanted.seconds >= 0.05 && wanted.seconds <= 60.0))
        throw fail("--seconds {}: expected 0.05 to 60", wanted.seconds);
    Options untold = options;
    untold.tolerance.clear();
    const Hairstyle authored = load_style(untold);
    float tolerance = load_style(options).params.quality_tolerance; // %
    if (tolerance == 0.0f && options.tolerance.empty())
        tolerance = kToleranceUnsaid;
    if (!(tolerance > 0.0f))
        throw fail("--tolerance {}: expected more than 0 %", options.tolerance);
    const fs::path target = options.output.empty() ? lean_path(options.style, authored.file) : fs::path(options.output);
    if (wanted.apply)
        check_lean(target); // before a minute's work, not after
    const Motion motion = find_motion(wanted.motion);
    const Window window(16, 16, Window::HIDDEN);
    const Device device = shared_with_gl(open_device(options));
    Renderer renderer(data_folder() / "shaders");
    Trial trial{device, renderer, motion, wanted.seconds, 0.01 * double(tolerance)};
    const Progress line;
    trial.progress = [&](const std::string& doing) { line.say(doing); };
    const Advice advice = advise_on(trial, chosen(device, authored));
    line.clear();

    const bool leaner = !changes_text(advice.base, advice.lean).empty(), write = wanted.apply && leaner;
    if (write)
        write_lean(advice.lean, target); // as it was measured, what a tolerance chose written out
    fmt::print("{}", wanted.json ? json_of(advice, write ? target.string() : "") : table_of(advice));
    std::fflush(stdout); // before the words
    if (write)
        fmt::print(stderr, "wrote {}: motion {:.2f} %, picture {:.2f} % from {}\n", target.string(),
                   100.0 * advice.together.motion, 100.0 * advice.together.picture, advice.style);
    else if (wanted.apply)
        fmt::print(stderr, "there is nothing to leave out: nothing was written\n");
    return 0;
}

} // namespace coif

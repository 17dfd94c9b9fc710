#include "app/advise/advise.h"

#include "app/advise/lean.h"
#include "app/progress.h"
#include "sim/error.h"
#include "sim/scatter.h"
#include "sim/source.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

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

// ms of a frame's passes and its picture.
static double saving(const Difference& d) { return d.step_ms + d.picture_ms; }

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

// What has a cheaper step still takes it if that saves more, as long as it leaves the others room.
static void go_further(const Trial& trial, Advice& advice)
{
    std::vector<std::pair<size_t, Feature>> going; // which, and as far as it has gone
    for (size_t i = 0; i < advice.features.size(); ++i)
        if (advice.features[i].verdict == Verdict::LEAVE_OUT && taken(advice, advice.features[i].difference) <= kRoom)
            going.emplace_back(i, advice.features[i].feature);
    while (!going.empty())
    {
        std::vector<std::pair<size_t, Feature>> tried;
        std::vector<Hairstyle> changed;
        for (const auto& [which, now] : going)
        {
            const Feature next = further(now);
            if (changes_text(now.style, next.style).empty())
                continue;
            tried.emplace_back(which, next);
            changed.push_back(next.style);
        }
        going.clear();
        if (changed.empty())
            return;
        const Comparison found = compare(trial, advice.base, changed);
        for (size_t i = 0; i < tried.size(); ++i)
        {
            const Difference& d = found.changed[i];
            if (taken(advice, d) > kRoom)
                continue;
            going.push_back(tried[i]);
            Advised& a = advice.features[tried[i].first];
            if (saving(d) <= saving(a.difference))
                continue;
            a.feature = tried[i].second;
            a.difference = d;
        }
    }
}

// Differences of independent causes.
static Difference add_up(const std::vector<Difference>& each, const std::vector<size_t>& out)
{
    Difference all{1e-9, 1e-9}; // nothing that is measured is less, and `worse` is a ratio
    for (const size_t i : out)
    {
        all.motion = std::hypot(all.motion, each[i].motion);
        all.picture = std::hypot(all.picture, each[i].picture);
        all.step_ms += each[i].step_ms;
        all.picture_ms += each[i].picture_ms;
    }
    return all;
}

std::vector<size_t> most_saving(const std::vector<Difference>& each, double motion, double picture, double worse)
{
    constexpr size_t kMost = 14; // whose subsets are all looked at
    std::vector<size_t> may;
    for (size_t i = 0; i < each.size(); ++i)
        if (saving(each[i]) > 0.0)
            may.push_back(i);
    std::ranges::stable_sort(may, std::greater{}, [&](size_t i) { return saving(each[i]); });
    may.resize(std::min(may.size(), kMost));
    std::vector<size_t> best;
    double most = 0.0;
    for (size_t set = 1; set < size_t(1) << may.size(); ++set)
    {
        std::vector<size_t> out;
        for (size_t k = 0; k < may.size(); ++k)
            if (set >> k & 1)
                out.push_back(may[k]);
        const Difference all = add_up(each, out);
        const double more = out.size() > 1 ? worse : 1.0; // what each does alone is known
        if (saving(all) <= most || more * all.motion > motion || more * all.picture > picture)
            continue;
        most = saving(all);
        best = out;
    }
    std::ranges::sort(best);
    return best;
}

static void put_together(const Trial& trial, Advice& advice)
{
    std::vector<Advised*> may;
    std::vector<Difference> each;
    for (Advised& a : advice.features)
        if (a.verdict == Verdict::LEAVE_OUT)
        {
            const bool saves = saving(a.difference) > 0.0;
            a.verdict = saves ? Verdict::TOGETHER_NOT : Verdict::SAVES_NOTHING;
            if (!saves)
                continue;
            may.push_back(&a);
            each.push_back(a.difference);
        }
    for (double worse = 1.0;;)
    {
        const std::vector<size_t> out = most_saving(each, advice.tolerance, advice.picture_tolerance, worse);
        advice.lean = advice.base;
        for (const size_t i : out)
            advice.lean = with_changes(advice.lean, advice.base, may[i]->feature.style);
        advice.together = out.empty() ? Difference{} : each[out[0]];
        if (out.size() > 1)
            advice.together = compare(trial, advice.base, {advice.lean}).changed[0];
        if (!within(advice, advice.together))
        {
            worse = taken(advice, advice.together) / taken(advice, add_up(each, out)); // more than it was
            continue;
        }
        for (const size_t i : out)
            may[i]->verdict = Verdict::LEAVE_OUT;
        return;
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
    Hairstyle live = meet_tolerance(device, style, load_assets(style).scalp, quality);
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
    const Device device = open_device(options);
    const Window window(16, 16, Window::HIDDEN);
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

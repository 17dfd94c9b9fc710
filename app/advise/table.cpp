// The advice as a table and as JSON.
#include "app/advise/advise.h"

#include "app/json.h"
#include "app/table.h"
#include "sim/error.h"

namespace coif
{

static const char* word(Verdict verdict)
{
    switch (verdict)
    {
    case Verdict::LEAVE_OUT:
        return "leave out";
    case Verdict::TOGETHER_NOT:
        return "keep: with the others it is too much";
    case Verdict::KEEP:
        return "keep";
    case Verdict::LACKS:
        return "lacks";
    case Verdict::ENOUGH:
        return "does without";
    }
    return "";
}

static std::string percent(double fraction) { return fmt::format("{:.2f} %", 100.0 * fraction); }

// What the clock cannot tell is nothing.
static std::string ms(double value) { return value == 0.0 ? "" : fmt::format("{:.2f} ms", value); }

// A line of the table; `sign` is -1 where a difference is a cost.
static std::vector<std::string> line(const std::string& name, const std::string& change, const Difference& d,
                                     double sign, const std::string& verdict)
{
    return {name,
            change,
            percent(d.motion),
            percent(d.picture),
            ms(sign * d.step_ms),
            d.step_ms == 0.0 ? "" : fmt::format("{:.0f} %", 100.0 * sign * d.share),
            ms(sign * d.picture_ms),
            verdict};
}

std::string table_of(const Advice& advice)
{
    std::string text = fmt::format(
        "{} on {}, {} for {:.3g} s: a frame takes {:.2f} ms, a picture of {} x {} pixels {:.0f} ms more\n"
        "Motion counts as the same within {:.3g} % of the hair's length, a picture within {:.2f} % (1 - SSIM over hair "
        "from afar;\nanother seed of this style makes {:.2f} %).\n\n",
        advice.style, advice.device, advice.motion, advice.seconds, advice.step_ms, kPictureSize, kPictureSize,
        advice.picture_ms, 100.0 * advice.tolerance, 100.0 * advice.picture_tolerance, 100.0 * advice.another_seed);
    std::vector<std::vector<std::string>> lines = {
        {"it has", "without it, or with less", "motion", "picture", "saves", "", "a picture", ""}};
    const auto add = [&](bool lacked, auto&& wanted)
    {
        for (const Advised& a : advice.features)
            if (a.feature.lacked == lacked && wanted(a.verdict))
                lines.push_back(line(a.feature.name, changes_text(advice.base, a.feature.style), a.difference,
                                     lacked ? -1.0 : 1.0, word(a.verdict)));
    };
    add(false, [](Verdict v) { return v == Verdict::LEAVE_OUT; });
    const size_t out = lines.size() - 1;
    if (out > 1)
        lines.push_back(line("all of these", fmt::format("{} together", out), advice.together, 1.0, ""));
    add(false, [](Verdict v) { return v != Verdict::LEAVE_OUT; });
    lines.push_back({});
    lines.push_back({"it lacks", "with it, or with more", "motion", "picture", "costs", "", "a picture", ""});
    add(true, [](Verdict) { return true; });
    lines.push_back({"guides", fmt::format("{} now", advice.guides), percent(advice.guide_error), "", "", "", "",
                     advice.guide_error > advice.tolerance ? "lacks: predicted; interpolation.refine gives more"
                                                           : "enough: predicted"});
    return text + aligned(lines, {0, 1, 7});
}

static std::string json(const Difference& d)
{
    return fmt::format(
        "\"motion\": {}, \"picture\": {}, \"saves_ms\": {}, \"saves_share\": {}, \"saves_picture_ms\": {}",
        json_number(d.motion), json_number(d.picture), json_number(d.step_ms), json_number(d.share),
        json_number(d.picture_ms));
}

std::string json_of(const Advice& advice, const std::string& written)
{
    std::vector<std::string> features;
    for (const Advised& a : advice.features)
        features.push_back(fmt::format("  {{\"feature\": {}, \"lacked\": {}, \"change\": {}, {}, \"verdict\": {}}}",
                                       json_text(a.feature.name), a.feature.lacked,
                                       json_text(changes_text(advice.base, a.feature.style)), json(a.difference),
                                       json_text(word(a.verdict))));
    return fmt::format(
        "{{\"style\": {}, \"motion\": {}, \"device\": {}, \"seconds\": {}, \"tolerance\": {}, \"picture_tolerance\": "
        "{}, \"another_seed\": {}, \"ms_frame\": {}, \"ms_picture\": {}, \"guides\": {}, \"guide_error\": {},\n"
        "\"together\": {{\"change\": {}, {}}},\n\"written\": {},\n\"features\": [\n{}\n]}}\n",
        json_text(advice.style), json_text(advice.motion), json_text(advice.device), json_number(advice.seconds),
        json_number(advice.tolerance), json_number(advice.picture_tolerance), json_number(advice.another_seed),
        json_number(advice.step_ms), json_number(advice.picture_ms), advice.guides, json_number(advice.guide_error),
        json_text(changes_text(advice.base, advice.lean)), json(advice.together),
        written.empty() ? "null" : json_text(written), fmt::join(features, ",\n"));
}

} // namespace coif

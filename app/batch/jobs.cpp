#include "app/batch/jobs.h"

#include "app/batch/list.h"
#include "app/measure/measure.h"
#include "app/sheet.h"
#include "app/stress/stage.h"
#include "sim/error.h"

#include <algorithm>

namespace coif
{

static constexpr size_t kMostLines = 1000000;

static void append(std::vector<std::string>& words, const std::vector<std::string>& more)
{
    words.insert(words.end(), more.begin(), more.end());
}

// The styles' names, as a sheet has them, fit for names of files.
static std::vector<std::string> names_of(const std::vector<std::string>& styles)
{
    std::vector<std::string> names;
    for (const std::string& style : styles)
    {
        load_hairstyle(find_style(style)); // what is wrong with it is told now
        names.push_back(find_style(style).stem().string());
        std::ranges::replace(names.back(), '%', '_');
    }
    return names;
}

static std::string check(const std::vector<std::string>& words)
{
    task_of(words);
    return quoted(words);
}

static void bound(size_t lines)
{
    if (lines > kMostLines)
        throw fail("that would be {} lines; coif writes {} at most", lines, kMostLines);
}

std::vector<std::string> sheet_jobs(const JobsOptions& wanted)
{
    if (wanted.random < 0)
        throw fail("--random {}: expected 1 or more", wanted.random);
    const std::vector<std::string> names = names_of(wanted.styles);
    bound(names.size() * size_t(std::max(1, wanted.random)));
    std::vector<std::string> lines;
    int chance = 0; // counts through: with the same number each style would become longer, or each shorter
    for (size_t i = 0; i < names.size(); ++i)
        for (int n = wanted.random ? 1 : 0; n <= wanted.random; ++n)
        {
            chance += n > 0;
            std::vector<std::string> words = {"shot", wanted.styles[i]};
            if (chance)
                append(words, {"--random", std::to_string(chance)});
            append(words, wanted.passed);
            append(words, {"-o", names[i] + (chance ? fmt::format("-{}", chance) : "") + ".png"});
            lines.push_back(check(words));
        }
    return lines;
}

std::vector<std::string> turntable_jobs(const JobsOptions& wanted)
{
    if (wanted.views < 1 || wanted.views > 3600)
        throw fail("--views {}: expected 1 to 3600", wanted.views);
    const std::vector<std::string> names = names_of(wanted.styles);
    bound(names.size() * size_t(wanted.views));
    std::vector<std::string> lines;
    for (size_t i = 0; i < names.size(); ++i)
        for (int view = 0; view < wanted.views; ++view)
        {
            std::vector<std::string> words = {"shot", wanted.styles[i]};
            append(words, {"--turntable", std::to_string(wanted.views), "--view", std::to_string(view)});
            append(words, wanted.passed);
            append(words, {"-o", fmt::format("{}_{:04}.png", names[i], view)});
            lines.push_back(check(words));
        }
    return lines;
}

// Every setting of what varies: the first key's values go slowest.
static std::vector<std::vector<std::string>> settings_of(const std::vector<std::string>& vary)
{
    std::vector<std::vector<std::string>> settings = {{}};
    for (const std::string& one : vary)
    {
        const size_t at = one.find('=');
        if (at == one.npos || at == 0 || at + 1 == one.size())
            throw fail("--vary {}: expected group.key=VALUE,VALUE,...", one);
        std::vector<std::vector<std::string>> more;
        for (const auto& setting : settings)
            for (size_t from = at + 1; from <= one.size();)
            {
                const size_t end = std::min(one.find(',', from), one.size());
                more.push_back(setting);
                more.back().push_back(one.substr(0, at + 1) + one.substr(from, end - from));
                from = end + 1;
                bound(more.size());
            }
        settings = more;
    }
    return settings;
}

std::vector<std::string> sweep_jobs(const JobsOptions& wanted)
{
    std::vector<std::string> lines;
    if (!wanted.styles.empty())
    {
        const auto settings = settings_of(wanted.vary);
        names_of(wanted.styles);
        bound(settings.size() * wanted.styles.size());
        for (const std::string& name : wanted.styles)
            for (const auto& setting : settings)
            {
                Options options;
                options.style = name;
                options.sets = setting;
                load_style(options); // refuses what cannot be
                std::vector<std::string> words = {"report", name};
                for (const std::string& set : setting)
                    append(words, {"--set", set});
                append(words, wanted.passed);
                append(words, {"--row", "--untimed", "-o", "row.csv"});
                lines.push_back(check(words));
            }
        return lines;
    }
    if (!wanted.vary.empty())
        throw Error("--vary: of which style? Name one or more");
    std::vector<std::string> ids;
    for (const Scene& scene : scenes())
        ids.emplace_back(scene.id);
    for (const size_t i : selected(wanted.only, ids, "scene"))
    {
        std::vector<std::string> words = {"measure", "--only", ids[i], "--untimed"};
        append(words, wanted.passed);
        append(words, {"-o", ids[i] + ".csv"});
        lines.push_back(check(words));
    }
    return lines;
}

std::vector<std::string> stress_jobs(const JobsOptions& wanted)
{
    std::vector<std::string> lines;
    std::vector<std::string> seed = {"--seed", std::to_string(wanted.seed)};
    if (wanted.untimed)
        seed.push_back("--untimed");
    if (wanted.count < 0)
    {
        // The random styles are a table of their own.
        std::vector<std::string> names;
        for (const stress::Case& one : stress::cases())
            if (one.name != std::string("random"))
                names.emplace_back(one.name);
        for (const size_t i : selected(wanted.only, names, "case"))
        {
            std::vector<std::string> words = {"stress", "--only", names[i]};
            append(words, seed);
            append(words, wanted.passed);
            append(words, {"-o", names[i] + ".csv"});
            lines.push_back(check(words));
        }
        return lines;
    }
    if (!wanted.only.empty())
        throw Error("--only and --count: a list is either of cases or of random styles");
    if (wanted.count < 1 || wanted.count > 1000000 || wanted.each < 1)
        throw fail("--count {} --each {}: expected 1 to 1000000, and 1 or more", wanted.count, wanted.each);
    const long end = wanted.from + wanted.count;
    for (long from = wanted.from; from < end; from += wanted.each)
    {
        const long cases = std::min(long(wanted.each), end - from);
        std::vector<std::string> words = {"stress", "--only", "random"};
        append(words, {"--from", std::to_string(from), "--cases", std::to_string(cases)});
        append(words, seed);
        append(words, wanted.passed);
        append(words, {"-o", fmt::format("random-{}.csv", from)});
        lines.push_back(check(words));
    }
    return lines;
}

std::vector<std::string> cache_jobs(const JobsOptions& wanted)
{
    const std::vector<std::string> names = names_of(wanted.styles);
    if (wanted.format.empty() || wanted.format.find_first_of("./%") != std::string::npos)
        throw fail("--format {}: expected the ending of a format, as usda", wanted.format);
    std::vector<std::string> lines;
    for (size_t i = 0; i < names.size(); ++i)
    {
        std::vector<std::string> words = {"export", wanted.styles[i]};
        append(words, wanted.passed);
        append(words, {"-o", names[i] + "." + wanted.format});
        lines.push_back(check(words));
    }
    return lines;
}

std::string shot_job(const Options& options, const ShotOptions& shot, const std::string& name)
{
    std::vector<std::string> words = {"shot", options.style};
    append(words, {"--size", fmt::format("{}x{}", shot.width, shot.height)});
    if (shot.samples)
        append(words, {"--samples", std::to_string(*shot.samples)});
    append(words, {"--motion", options.motion, "--time", fmt::format("{}", options.seconds)});
    const auto add = [&](const char* option, const std::string& value)
    {
        if (!value.empty())
            append(words, {option, value});
    };
    add("--camera", shot.camera);
    add("--variant", options.variant);
    add("--tolerance", options.tolerance);
    add("--device", options.device);
    if (options.random >= 0)
        append(words, {"--random", std::to_string(options.random)});
    if (shot.transparent)
        words.push_back("--transparent");
    for (const std::string& set : options.sets)
        append(words, {"--set", set});
    append(words, {"-o", name});
    return check(words);
}

} // namespace coif

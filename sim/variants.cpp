// Named snapshots of a hairstyle: [variant.NAME].
#include "sim/error.h"
#include "sim/hairstyle_lists.h"
#include "sim/shown.h"
#include "sim/toml_values.h"

#include <algorithm>

namespace coif
{

// Of the parameters that cross to the device, in the table's order.
static std::vector<Setting> differences(const HairParams& from, const HairParams& to)
{
    Hairstyle a, b;
    a.params = from;
    b.params = to;
    std::vector<Setting> settings;
    for (const ParamInfo& info : param_table())
    {
        if (info.on_host() || same_value(a, b, info))
            continue;
        Setting& setting = settings.emplace_back(Setting{&info, glm::vec4(0.0f)});
        get_numbers(to, info, &setting.value.x);
    }
    return settings;
}

static void lay_on(HairParams& params, const std::vector<Setting>& settings)
{
    for (const Setting& setting : settings)
    {
        const double values[4] = {setting.value.x, setting.value.y, setting.value.z, setting.value.w};
        set_numbers(params, *setting.info, values);
    }
}

std::map<std::string, std::vector<Setting>> current_variants(const Hairstyle& style)
{
    auto variants = style.variants;
    if (!style.variant.empty())
        variants[style.variant] = differences(style.own, style.params);
    return variants;
}

void switch_variant(Hairstyle& style, const std::string& name)
{
    const auto variants = current_variants(style);
    if (!name.empty() && !variants.contains(name))
    {
        std::string names;
        for (const auto& [known, settings] : variants)
            names += (names.empty() ? "" : ", ") + shown(known);
        throw fail("{} has no variant '{}'; it has {}", shown(style.name()), shown(name),
                   names.empty() ? "none" : names);
    }
    style.variants = variants;
    if (!style.variant.empty())
        style.params = style.own;
    style.own = style.params;
    style.variant = name;
    if (!name.empty())
        lay_on(style.params, style.variants.at(name));
}

void take_variant(Hairstyle& style, const std::string& name)
{
    const bool plain = !name.empty() && std::ranges::all_of(name, [](unsigned char c)
                                                            { return std::isalnum(c) || c == '_' || c == '-'; });
    if (!plain || name.size() > 60)
        throw fail("'{}' cannot be a variant's name: letters, digits, _ and - only", shown(name));
    style.variants = current_variants(style);
    if (style.variant.empty())
        style.own = style.text.empty() ? HairParams{} : parse_hairstyle(style.text, style.file, false).params;
    style.variant = name;
    style.variants[name] = differences(style.own, style.params);
}

void read_variants(Hairstyle& style, const toml::node& node)
{
    const std::filesystem::path& file = style.file;
    const toml::table* all = node.as_table();
    if (!all)
        throw fail("{}: variants must be written as [variant.NAME] tables", place(file, node.source()));
    constexpr size_t most = 64;
    if (all->size() > most)
    {
        std::vector<toml::source_region> there; // in the file's order, which is not the table's
        for (auto&& [name, entry] : *all)
            there.push_back(entry.source());
        std::ranges::sort(there, {},
                          [](const toml::source_region& r) { return std::pair(r.begin.line, r.begin.column); });
        throw fail("{}: {} variants are more than the {} that coif takes", place(file, there[most]), all->size(), most);
    }
    for (auto&& [name, entry] : *all)
    {
        const toml::table* groups = entry.as_table();
        if (!groups)
            throw fail("{}: variants must be written as [variant.NAME] tables", place(file, entry.source()));
        std::vector<Setting>& settings = style.variants[std::string(name.str())];
        for (auto&& [group, values] : *groups)
        {
            const toml::table* table = values.as_table();
            if (!table)
                throw fail("{}: a variant holds parameters as strand.length, not '{}'", place(file, values.source()),
                           shown(group.str()));
            for (auto&& [key, value] : *table)
                settings.push_back(
                    read_setting(file, fmt::format("{}.{}", std::string_view(group.str()), std::string_view(key.str())),
                                 key, value));
        }
        std::ranges::sort(settings, {}, &Setting::info); // the table's order
    }
}

bool same_variants(const Hairstyle& a, const Hairstyle& b)
{
    return a.variant == b.variant && current_variants(a) == current_variants(b);
}

bool same_style(const Hairstyle& a, const Hairstyle& b)
{
    return same_variants(a, b) &&
           std::ranges::all_of(param_table(), [&](const ParamInfo& info) { return same_value(a, b, info); });
}

} // namespace coif

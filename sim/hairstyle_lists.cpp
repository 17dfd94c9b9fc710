#include "sim/hairstyle_lists.h"

#include "sim/shown.h"
#include "sim/toml_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>

namespace coif
{

namespace fs = std::filesystem;

static std::string plural(const ParamInfo& info) { return std::string(info.group) + "s"; }

Setting read_setting(const fs::path& file, const std::string& path, const toml::key& key, const toml::node& node)
{
    const ParamInfo* info = find_param(path);
    if (!info)
        throw fail("{}: no parameter is called '{}'; the nearest is {}", place(file, key.source()), shown(path),
                   nearest_param(path));
    Hairstyle read;
    try
    {
        if (info->on_host())
            throw fail("{} cannot be set here", path);
        read_value(read, *info, node);
    }
    catch (const Error& e)
    {
        throw fail("{}: {}", place(file, node.source()), e.what());
    }
    Setting setting{info, glm::vec4(0.0f)};
    get_numbers(read.params, *info, &setting.value.x);
    return setting;
}

std::string setting_text(const Setting& setting)
{
    Hairstyle style;
    const double values[4] = {setting.value.x, setting.value.y, setting.value.z, setting.value.w};
    set_numbers(style.params, *setting.info, values);
    return value_text(style, *setting.info);
}

TomlEntry settings_entry(const std::vector<Setting>& settings)
{
    TomlEntry entry;
    for (const Setting& setting : settings)
    {
        const std::string item = fmt::format("{} = {}", setting.info->name, setting_text(setting));
        if (entry.empty() || entry.back().first != setting.info->group)
            entry.emplace_back(setting.info->group, item);
        else
            entry.back().second += ", " + item;
    }
    for (auto& [group, text] : entry)
        text = "{ " + text + " }";
    return entry;
}

namespace
{

// Walks the fields of one entry and takes from its table what is there.
struct EntryReader
{
    const fs::path& file;
    const std::string list;
    const toml::table& table;
    std::vector<std::string> known = {}, needed = {};
    bool takes_settings = false;

    const toml::node* get(const char* name, bool must = false)
    {
        known.push_back(name);
        const toml::node* node = table.get(name);
        if (must)
            needed.push_back(name);
        return node;
    }
    Error wrong(const toml::node& node, const char* name, const std::string& what) const
    {
        return fail("{}: {}.{} {}", place(file, node.source()), list, name, what);
    }
    float bounded(const toml::node& node, const char* name, double value, Limits bounds) const
    {
        if (!(float(value) >= bounds.min && float(value) <= bounds.max)) // as a float: 0.1 is not above 0.1
            throw wrong(node, name,
                        fmt::format("is {}, but must lie in [{}, {}]{}{}", value, bounds.min, bounds.max,
                                    *bounds.unit ? " " : "", bounds.unit));
        return float(value);
    }
    glm::vec3 three(const toml::node& node, const char* name, Limits bounds) const
    {
        double v[3];
        if (!read_numbers(node, v, 3))
            throw wrong(node, name, *bounds.unit ? "must be three numbers in metres" : "must be three numbers");
        return {bounded(node, name, v[0], bounds), bounded(node, name, v[1], bounds),
                bounded(node, name, v[2], bounds)};
    }
    std::string quoted(const toml::node& node, const char* name) const
    {
        if (!node.is_string())
            throw wrong(node, name, fmt::format("must be text in quotes, not {}", type_name(node)));
        const std::string text = *node.value<std::string>();
        if (text.find('\0') != text.npos)
            throw wrong(node, name, "must not hold a zero byte");
        return text;
    }
    const toml::array& listed(const toml::node& node, const char* name, const char* what) const
    {
        if (const toml::array* array = node.as_array())
            return *array;
        throw wrong(node, name, fmt::format("must be a list of {}, not {}", what, type_name(node)));
    }

    void text(const char* name, std::string& value, bool must = false)
    {
        if (const toml::node* node = get(name, must))
            value = quoted(*node, name);
    }
    void texts(const char* name, std::vector<std::string>& values)
    {
        const toml::node* node = get(name);
        if (node && node->is_string())
            values = {quoted(*node, name)};
        else if (node)
            for (const toml::node& item : listed(*node, name, "texts"))
                values.push_back(quoted(item, name));
    }
    void number(const char* name, float& value, Limits bounds, bool must = false)
    {
        const toml::node* node = get(name, must);
        if (node && !node->is_number())
            throw wrong(*node, name, fmt::format("must be a number, not {}", type_name(*node)));
        if (node)
            value = bounded(*node, name, *node->value<double>(), bounds);
    }
    void numbers(const char* name, std::vector<float>& values, Limits bounds)
    {
        if (const toml::node* node = get(name))
            for (const toml::node& item : listed(*node, name, "numbers"))
            {
                if (!item.is_number())
                    throw wrong(item, name, fmt::format("must hold numbers only, not {}", type_name(item)));
                values.push_back(bounded(item, name, *item.value<double>(), bounds));
            }
    }
    void point(const char* name, glm::vec3& value, Limits bounds, bool must = false)
    {
        if (const toml::node* node = get(name, must))
            value = three(*node, name, bounds);
    }
    void optional_point(const char* name, std::optional<glm::vec3>& value, Limits bounds)
    {
        if (const toml::node* node = get(name))
            value = three(*node, name, bounds);
    }
    void points(const char* name, std::vector<glm::vec3>& values, Limits bounds)
    {
        if (const toml::node* node = get(name, true))
            for (const toml::node& item : listed(*node, name, "points"))
                values.push_back(three(item, name, bounds));
    }
    void planes(const char* name, std::vector<glm::vec4>& values, Limits bounds)
    {
        if (const toml::node* node = get(name))
            for (const toml::node& item : listed(*node, name, "planes"))
            {
                double v[4];
                if (!read_numbers(item, v, 4))
                    throw wrong(item, name, "must hold planes of four numbers: a direction and how far along it (m)");
                glm::vec4 plane;
                for (int i = 0; i < 4; ++i)
                    plane[i] = bounded(item, name, v[i], bounds);
                if (!(plane.x * plane.x + plane.y * plane.y + plane.z * plane.z > 1e-12f))
                    throw wrong(item, name, "holds a plane without a direction");
                values.push_back(plane);
            }
    }
    void color(const char* name, glm::vec3& value)
    {
        const toml::node* node = get(name);
        if (!node)
            return;
        double v[3];
        Hairstyle read; // as any colour of a style
        if (!read_numbers(*node, v, 3) && !node->is_string())
            throw wrong(*node, name, fmt::format("must be a colour like \"#8a5a3c\", not {}", type_name(*node)));
        try
        {
            read_value(read, *find_param("look.root_color"), *node);
        }
        catch (const Error&)
        {
            throw wrong(*node, name, "must be a colour like \"#8a5a3c\" or three numbers from 0 to 1");
        }
        get_numbers(read.params, *find_param("look.root_color"), &value.x);
    }
    void flag(const char* name, bool& value)
    {
        const toml::node* node = get(name);
        if (node && !node->is_boolean())
            throw wrong(*node, name, fmt::format("must be true or false, not {}", type_name(*node)));
        if (node)
            value = *node->value<bool>();
    }
    template <typename Choice> void choice(const char* name, Choice& value, const char* labels)
    {
        const toml::node* node = get(name);
        if (!node)
            return;
        const std::vector<std::string> all = split_labels(labels);
        const auto found = std::find(all.begin(), all.end(), node->value<std::string>().value_or(""));
        if (found == all.end())
            throw wrong(*node, name, fmt::format("must be \"{}\"", fmt::join(all, "\" or \"")));
        value = Choice(found - all.begin());
    }
    void settings(std::vector<Setting>& values)
    {
        takes_settings = true;
        for (const ParamInfo& info : param_table())
        {
            const toml::table* group = info.on_host() ? nullptr : table[info.group].as_table();
            const toml::node* node = group ? group->get(info.name) : nullptr;
            if (!node)
                continue;
            if (info.scope != Scope::STRAND)
                throw fail("{}: {} is the same for the whole head and cannot be set in a {}",
                           place(file, node->source()), info.path(), list);
            values.push_back(read_setting(file, info.path(), group->find(info.name)->first, *node));
        }
    }

    // What is there and should not be, and what should be there and is not.
    void finish()
    {
        for (auto&& [key, value] : table)
        {
            const std::string name(key.str());
            if (std::find(known.begin(), known.end(), name) != known.end())
                continue;
            if (const toml::table* group = value.as_table(); takes_settings && group)
            {
                for (auto&& [inner, node] : *group)
                    if (const std::string path = name + "." + std::string(inner.str()); !find_param(path))
                        throw fail("{}: no parameter is called '{}'; the nearest is {}", place(file, inner.source()),
                                   shown(path), nearest_param(path));
                continue;
            }
            throw fail("{}: a {} has no '{}'; it has {}{}", place(file, value.source()), list, shown(name),
                       fmt::join(known, ", "), takes_settings ? ", and parameters as strand.length" : "");
        }
        for (const std::string& name : needed)
            if (!table.contains(name))
                throw fail("{}: a {} needs {}", place(file, table.source()), list, fmt::join(needed, " and "));
    }
};

// The fields of one entry as TOML.
struct EntryWriter
{
    TomlEntry entry = {};

    void put(const char* name, const std::string& text) { entry.emplace_back(name, text); }
    static std::string point_text(const glm::vec3& p) { return list_text(&p.x, 3); }
    template <typename Values, typename Text> void put_list(const char* name, const Values& values, Text text_of)
    {
        std::string text;
        for (const auto& value : values)
            text += (text.empty() ? "" : ", ") + text_of(value);
        put(name, "[" + text + "]");
    }

    void text(const char* name, const std::string& value, bool = false) { put(name, toml_string(value)); }
    void texts(const char* name, const std::vector<std::string>& values)
    {
        if (values.size() == 1)
            text(name, values[0]);
        else
            put_list(name, values, toml_string);
    }
    void number(const char* name, float value, Limits, bool = false) { put(name, float_text(value)); }
    void numbers(const char* name, const std::vector<float>& values, Limits) { put_list(name, values, float_text); }
    void point(const char* name, const glm::vec3& value, Limits, bool = false) { put(name, point_text(value)); }
    void optional_point(const char* name, const std::optional<glm::vec3>& value, Limits)
    {
        put(name, value ? point_text(*value) : "[]");
    }
    void points(const char* name, const std::vector<glm::vec3>& values, Limits) { put_list(name, values, point_text); }
    void planes(const char* name, const std::vector<glm::vec4>& values, Limits)
    {
        put_list(name, values, [](const glm::vec4& plane) { return list_text(&plane.x, 4); });
    }
    void color(const char* name, const glm::vec3& value)
    {
        put(name, setting_text({find_param("look.root_color"), glm::vec4(value, 1.0f)}));
    }
    void flag(const char* name, bool value) { put(name, value ? "true" : "false"); }
    template <typename Choice> void choice(const char* name, Choice value, const char* labels)
    {
        put(name, toml_string(split_labels(labels)[size_t(value)]));
    }
    void settings(const std::vector<Setting>& values)
    {
        const TomlEntry groups = settings_entry(values);
        entry.insert(entry.end(), groups.begin(), groups.end());
    }
};

} // namespace

template <typename Entry> static TomlEntry written(Entry entry)
{
    if constexpr (std::is_same_v<Entry, ScalpMap>)
        if (!entry.file.empty())
            entry.values.clear(); // which that holds
    if constexpr (std::is_same_v<Entry, Region>)
        if (!entry.file.empty())
            entry.weights.clear();
    EntryWriter writer;
    fields(writer, entry);
    return writer.entry;
}

std::vector<TomlEntry> list_entries(const HostParams& host, const ParamInfo& info)
{
    return with_list(host, info,
                     [](const auto& list)
                     {
                         std::vector<TomlEntry> entries;
                         using Entry = std::remove_cvref_t<decltype(list[0])>;
                         const TomlEntry usual = written(Entry{});
                         for (const Entry& entry : list)
                         {
                             TomlEntry all = written(entry);
                             // Names, places and sizes are said though they be the defaults.
                             std::erase_if(all,
                                           [&](const auto& field)
                                           {
                                               const bool needed = field.first == "center" || field.first == "radius" ||
                                                                   field.first == "direction";
                                               return !needed &&
                                                      std::find(usual.begin(), usual.end(), field) != usual.end();
                                           });
                             entries.push_back(all);
                         }
                         return entries;
                     });
}

static void check(const Collider&, const EntryReader&) {}

static void check(const Region& region, const EntryReader& at)
{
    for (const std::string& area : region.where)
        if (std::find(region_areas().begin(), region_areas().end(), area) == region_areas().end())
            throw at.wrong(*at.table.get("where"), "where",
                           fmt::format("is '{}', but must be of {}", shown(area), fmt::join(region_areas(), ", ")));
    if (!region.weights.empty() && !region.file.empty())
        throw at.wrong(*at.table.get("weights"), "weights", "must be left out where a file holds them");
}

static void check(const Parting& parting, const EntryReader& at)
{
    const toml::node& node = *at.table.get("points");
    constexpr size_t most = 256;
    if (const size_t size = parting.points.size(); size < 2 || size > most)
        throw at.wrong(size > most ? *node.as_array()->get(most) : node, "points",
                       fmt::format("must be 2 to {} points, not {}", most, size));
    for (size_t i = 1; i < parting.points.size(); ++i)
        if (parting.points[i] == parting.points[i - 1])
            throw at.wrong(node, "points", fmt::format("says the point {} twice", i));
}

static void check(const Light& light, const EntryReader& at)
{
    if (!points_somewhere(light.direction))
        throw at.wrong(*at.table.get("direction"), "direction", "is no direction: one of its numbers must not be 0");
}

static void check(ScalpMap& map, const EntryReader& at)
{
    const ParamInfo* info = find_param(map.of);
    const toml::node& of = *at.table.get("of");
    if (!info)
        throw at.wrong(of, "of",
                       fmt::format("is '{}', but no parameter is called that; the nearest is {}", shown(map.of),
                                   nearest_param(map.of)));
    if (info->on_host() || info->scope != Scope::STRAND)
        throw at.wrong(of, "of", fmt::format("is {}, which is the same for the whole head", map.of));
    const bool color = info->kind == Kind::COLOR;
    if (color && !at.table.contains("how"))
        map.how = MAP_OVER;
    if (color != (map.how == MAP_OVER))
        throw at.wrong(*at.table.get("how"), "how",
                       color ? "must be \"over\" for a colour" : "must be \"factor\" or \"offset\" for a number");
    if (map.values.empty() == map.file.empty())
        throw fail("{}: a map needs either values or a file of them", place(at.file, at.table.source()));
}

static void check(const Tie& tie, const EntryReader& at)
{
    if (tie.axis == glm::vec3(0.0f))
        throw at.wrong(*at.table.get("axis"), "axis", "must point somewhere, but is zero");
}

bool points_somewhere(const glm::vec3& direction) { return glm::dot(direction, direction) > 1e-12f; }

size_t most_entries(const ParamInfo& list)
{
    const std::string_view name = list.group;
    return name == "collider" ? MOST_COLLIDERS / 2 : name == "light" ? kMostLights : 64;
}

Sky read_sky(const fs::path& file, const toml::node& node)
{
    const toml::table* table = node.as_table();
    if (!table)
        throw fail("{}: sky must be written as a [sky] table", place(file, node.source()));
    Sky sky;
    EntryReader reader{file, "sky", *table};
    fields(reader, sky);
    reader.finish();
    return sky;
}

TomlEntry sky_entry(const Sky& sky) { return written(sky); }

void read_list(Hairstyle& style, const ParamInfo& info, const toml::node& node)
{
    const fs::path& file = style.file;
    const toml::array* array = node.as_array();
    if (!array)
        throw fail("{}: {} must be written as [[{}]] tables", place(file, node.source()), info.group, info.group);
    if (const size_t most = most_entries(info); array->size() > most)
        throw fail("{}: {} {} are more than the {} that coif takes", place(file, array->get(most)->source()),
                   array->size(), plural(info), most);
    with_list(style.host, info,
              [&](auto& list)
              {
                  list.clear();
                  for (const toml::node& item : *array)
                  {
                      const toml::table* table = item.as_table();
                      if (!table)
                          throw fail("{}: {} must be written as [[{}]] tables", place(file, item.source()), info.group,
                                     info.group);
                      auto& entry = list.emplace_back();
                      EntryReader reader{file, info.group, *table};
                      fields(reader, entry);
                      reader.finish();
                      check(entry, reader);
                      const std::string path = fmt::format("{}[{}]", info.group, list.size() - 1);
                      style.places[path] = place(file, item.source());
                      if (const toml::node* named = table->get("file"))
                          style.places[path + ".file"] = place(file, named->source());
                  }
              });
    for (size_t i = 0; i < style.host.regions.size(); ++i)
        for (size_t j = 0; j < i; ++j)
            if (style.host.regions[i].name == style.host.regions[j].name)
                throw fail("{}: two regions are called '{}'", style.places[fmt::format("region[{}]", i)],
                           shown(style.host.regions[i].name));
}

void load_beside(Hairstyle& style)
{
    const fs::path folder = style.file.parent_path();
    if (StoredShape& rest = style.host.groom_rest; !rest.file.empty())
        placed(style, "groom.rest",
               [&] { rest.shapes = std::make_shared<const StrandShapes>(read_shapes(folder / rest.file)); });
    for (size_t i = 0; i < style.host.regions.size(); ++i)
        if (Region& region = style.host.regions[i]; !region.file.empty())
            placed(style, fmt::format("region[{}].file", i),
                   [&] {
                       region.weights = read_map_values(folder / region.file, {0.0f, 1.0f, ""});
                   });
    for (size_t i = 0; i < style.host.maps.size(); ++i)
        if (ScalpMap& map = style.host.maps[i]; !map.file.empty())
            placed(style, fmt::format("map[{}].file", i),
                   [&] {
                       map.values = read_map_values(folder / map.file, {-1000.0f, 1000.0f, ""});
                   });
}

std::vector<float> read_map_values(const fs::path& file, Limits bounds)
{
    const std::string text = read_file(file, 16 << 20);
    std::vector<float> values;
    const char *at = text.data(), *end = at + text.size();
    for (size_t line = 1;;)
    {
        for (; at < end && (*at == ' ' || *at == '\t' || *at == '\r' || *at == '\n'); ++at)
            line += *at == '\n';
        if (at == end)
            return values;
        float value = 0.0f;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !(value >= bounds.min && value <= bounds.max) ||
            (next < end && !strchr(" \t\r\n", *next)))
            throw fail("{}:{}: must hold numbers from {} to {} only", shown_file(file), line, bounds.min, bounds.max);
        values.push_back(value);
        at = next;
    }
}

std::string map_values_text(const std::vector<float>& values)
{
    std::string text;
    for (const float value : values)
        text += float_text(value) + "\n";
    return text;
}

} // namespace coif

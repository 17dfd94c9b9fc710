#include "sim/hairstyle.h"

#include "sim/error.h"
#include "sim/hairstyle_lists.h"
#include "sim/shown.h"
#include "sim/toml_edit.h"
#include "sim/toml_values.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <toml++/toml.h>

namespace coif
{

namespace fs = std::filesystem;

const char* type_name(const toml::node& node)
{
    switch (node.type())
    {
    case toml::node_type::string:
        return "text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return "true or false";
    case toml::node_type::array:
        return "a list";
    case toml::node_type::table:
        return "a table";
    default:
        return "a date or time";
    }
}

bool read_numbers(const toml::node& node, double* out, size_t count)
{
    const toml::array* list = node.as_array();
    if (!list || list->size() != count)
        return false;
    for (size_t i = 0; i < count; ++i)
    {
        if (!list->get(i)->is_number())
            return false;
        out[i] = *list->get(i)->value<double>();
    }
    return true;
}

static bool read_hex_color(const std::string& text, double out[3])
{
    if (text.size() != 7 || text[0] != '#' || text.find_first_not_of("0123456789abcdefABCDEF", 1) != text.npos)
        return false;
    for (int i = 0; i < 3; ++i)
        out[i] = std::stoi(text.substr(size_t(1 + 2 * i), 2), nullptr, 16) / 255.0;
    return true;
}

template <typename Float> static std::string never_whole(Float value)
{
    const std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == text.npos ? text + ".0" : text;
}

void read_value(Hairstyle& style, const ParamInfo& info, const toml::node& node)
{
    double values[kMostNumbers] = {};
    const auto wrong = [&](const char* wanted)
    { return fail("{} must be {}, not {}", info.path(), wanted, type_name(node)); };
    switch (info.kind)
    {
    case Kind::FLOAT:
        if (!node.is_number())
            throw wrong("a number");
        values[0] = *node.value<double>();
        break;
    case Kind::INT:
    {
        const std::string whole = fmt::format("a whole number in [{}, {}]", info.min, info.max);
        if (node.is_floating_point())
            throw fail("{} must be {}, without point or exponent, not {}", info.path(), whole,
                       never_whole(*node.value<double>()));
        if (!node.is_integer())
            throw wrong(whole.c_str());
        const int64_t value = *node.value<int64_t>();
        if (value < int64_t(info.min) || value > int64_t(info.max)) // as a double it may be another
            throw fail("{} is {}, but must be {}", info.path(), value, whole);
        values[0] = double(value);
        break;
    }
    case Kind::VECTOR:
        if (!read_numbers(node, values, 3))
            throw wrong("three numbers like [0.0, 1.0, 0.0]");
        break;
    case Kind::COLOR:
        if (!read_numbers(node, values, 3) && !(node.is_string() && read_hex_color(*node.value<std::string>(), values)))
            throw wrong("a colour like \"#8a5a3c\" or three numbers from 0 to 1");
        break;
    case Kind::PROFILE:
        if (const toml::array* list = node.as_array(); list && list->size() != 4)
            throw fail("{} must be four numbers from root to tip, like [1.0, 1.0, 0.5, 0.0], not {}", info.path(),
                       list->size());
        if (!read_numbers(node, values, 4))
            throw wrong("four numbers from root to tip, like [1.0, 1.0, 0.5, 0.0]");
        break;
    case Kind::CHOICE:
    {
        const std::vector<std::string> labels = param_labels(info);
        const auto label = std::find(labels.begin(), labels.end(), node.value<std::string>().value_or(""));
        if (label == labels.end())
            throw fail("{} must be one of {}", info.path(), fmt::join(labels, ", "));
        values[0] = double(label - labels.begin());
        break;
    }
    case Kind::TEXT:
    {
        if (!node.is_string())
            throw wrong("text in quotes");
        const std::string text = *node.value<std::string>();
        if (text.find('\0') != text.npos)
            throw fail("{} must not hold a zero byte", info.path());
        *reinterpret_cast<std::string*>(reinterpret_cast<char*>(&style.host) + info.offset) = text;
        return;
    }
    case Kind::SHAPE:
    {
        if (!node.is_string())
            throw wrong("a file's name in quotes");
        const std::string file = *node.value<std::string>();
        if (file.find('\0') != file.npos)
            throw fail("{} must not hold a zero byte", info.path());
        *reinterpret_cast<StoredShape*>(reinterpret_cast<char*>(&style.host) + info.offset) = {file, nullptr};
        return;
    }
    case Kind::LIST:
        throw wrong(fmt::format("a list of [[{}]] tables", info.group).c_str());
    }
    set_numbers(style.params, info, values);
}

toml::table parse_toml(const std::string& text, const fs::path& file)
try
{
    refuse_deep_keys(text, file);
    return toml::parse(text, file.string());
}
catch (const toml::parse_error& e)
{
    throw fail("{}: not valid TOML: {}", place(file, e.source()), shown(e.description(), 200));
}

Hairstyle parse_hairstyle(const std::string& text, const fs::path& file, bool beside)
{
    const toml::table document = parse_toml(text, file);
    Hairstyle style;
    style.file = file;
    style.text = text;
    for (auto&& [group, node] : document)
    {
        if (const ParamInfo* list = find_param(group.str()); list && list->kind == Kind::LIST)
        {
            read_list(style, *list, node);
            continue;
        }
        if (group == "variant")
        {
            read_variants(style, node);
            continue;
        }
        const toml::table* table = node.as_table();
        if (!table)
            throw fail("{}: expected a [group], found the key '{}'; did you mean {}?", place(file, node.source()),
                       shown(group.str()), nearest_param(group.str()));
        for (auto&& [key, value] : *table)
        {
            const std::string path = fmt::format("{}.{}", std::string_view(group.str()), std::string_view(key.str()));
            const std::string at = place(file, value.source());
            const ParamInfo* info = find_param(path);
            if (!info)
                throw fail("{}: no parameter is called '{}'; the nearest is {}", place(file, key.source()), shown(path),
                           nearest_param(path));
            try
            {
                read_value(style, *info, value);
            }
            catch (const Error& e)
            {
                throw fail("{}: {}", at, e.what());
            }
            style.places[path] = at;
        }
    }
    if (beside)
        load_beside(style);
    return style;
}

Hairstyle load_hairstyle(const fs::path& file) { return parse_hairstyle(read_file(file, 4 << 20), file); }

std::vector<Collider> load_colliders(const fs::path& file)
{
    const toml::table document = parse_toml(read_file(file, 4 << 20), file);
    Hairstyle holder;
    holder.file = file;
    for (auto&& [key, node] : document)
    {
        if (key != "collider")
            throw fail("{}: expected [[collider]] tables only, found '{}'", place(file, key.source()),
                       shown(key.str()));
        read_list(holder, *find_param("collider"), node);
    }
    return holder.host.colliders;
}

void assign(Hairstyle& style, const std::string& assignment)
{
    const size_t equals = assignment.find('=');
    if (equals == assignment.npos)
        throw fail("--set {}: expected group.key=value", shown(assignment));
    const std::string path = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const ParamInfo* info = find_param(path);
    if (!info)
        throw fail("--set {}: no parameter is called '{}'; the nearest is {}", shown(assignment), shown(path),
                   nearest_param(path));
    toml::table document;
    const bool bare = text.empty() || text[0] == '#' || info->kind == Kind::CHOICE || info->kind == Kind::TEXT;
    try
    {
        if (bare && (text.size() < 2 || (text[0] != '"' && text[0] != '\'')))
            document.insert("value", text);
        else
        {
            refuse_deep_keys(text, "its value");
            document = toml::parse("value = " + text);
            if (document.size() != 1)
                throw fail("'{}' is more than one TOML value", shown(text));
        }
        read_value(style, *info, *document.get("value"));
        if (info->kind == Kind::SHAPE)
            load_beside(style);
    }
    catch (const toml::parse_error&)
    {
        const bool list = info->kind == Kind::LIST || info->kind == Kind::SHAPE;
        throw fail("--set {}: '{}' is no TOML value{}", shown(assignment), shown(text),
                   list ? "" : fmt::format("; write it as {}, which is the default", value_text(Hairstyle(), *info)));
    }
    catch (const Error& e)
    {
        throw fail("--set {}: {}", shown(assignment), e.what());
    }
    style.places[path] = "--set " + path;
}

std::string float_text(float value) { return never_whole(value); }

std::string toml_string(const std::string& text)
{
    std::string out = "\"";
    for (const char c : text)
        if (c == '"' || c == '\\')
            out += {'\\', c};
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04x}", int(c));
        else
            out += c;
    return out + '"';
}

std::string list_text(const float* values, size_t count)
{
    std::string text;
    for (size_t i = 0; i < count; ++i)
        text += (i ? ", " : "") + float_text(values[i]);
    return "[" + text + "]";
}

std::string value_text(const Hairstyle& style, const ParamInfo& info)
{
    float v[kMostNumbers] = {};
    if (!info.on_host())
        get_numbers(style.params, info, v);
    switch (info.kind)
    {
    case Kind::FLOAT:
        return float_text(v[0]);
    case Kind::INT:
        return fmt::format("{}", int(v[0]));
    case Kind::CHOICE:
        return toml_string(param_labels(info).at(size_t(v[0])));
    case Kind::VECTOR:
        return fmt::format("[{}, {}, {}]", float_text(v[0]), float_text(v[1]), float_text(v[2]));
    case Kind::PROFILE:
        return fmt::format("[{}, {}, {}, {}]", float_text(v[0]), float_text(v[1]), float_text(v[2]), float_text(v[3]));
    case Kind::COLOR:
    {
        int bytes[3];
        bool whole = true;
        for (int i = 0; i < 3; ++i)
        {
            bytes[i] = int(std::lround(v[i] * 255.0f));
            whole &= float(bytes[i] / 255.0) == v[i];
        }
        if (whole)
            return fmt::format("\"#{:02x}{:02x}{:02x}\"", bytes[0], bytes[1], bytes[2]);
        return fmt::format("[{}, {}, {}]", float_text(v[0]), float_text(v[1]), float_text(v[2]));
    }
    case Kind::TEXT:
        return toml_string(
            *reinterpret_cast<const std::string*>(reinterpret_cast<const char*>(&style.host) + info.offset));
    case Kind::SHAPE:
        return toml_string(
            reinterpret_cast<const StoredShape*>(reinterpret_cast<const char*>(&style.host) + info.offset)->file);
    case Kind::LIST:
        return fmt::format("{} of them", list_size(style.host, info));
    }
    return {};
}

bool same_value(const Hairstyle& a, const Hairstyle& b, const ParamInfo& info)
{
    if (info.kind == Kind::SHAPE)
        return *reinterpret_cast<const StoredShape*>(reinterpret_cast<const char*>(&a.host) + info.offset) ==
               *reinterpret_cast<const StoredShape*>(reinterpret_cast<const char*>(&b.host) + info.offset);
    if (info.kind != Kind::LIST)
        return value_text(a, info) == value_text(b, info);
    return with_list(a.host, info,
                     [&](const auto& list)
                     {
                         using List = std::remove_cvref_t<decltype(list)>;
                         const char* other = reinterpret_cast<const char*>(&b.host) + info.offset;
                         return list == *reinterpret_cast<const List*>(other);
                     });
}

void copy_value(const Hairstyle& from, Hairstyle& to, const ParamInfo& info)
{
    if (info.kind == Kind::LIST)
        with_list(to.host, info,
                  [&](auto& list)
                  {
                      using List = std::remove_cvref_t<decltype(list)>;
                      const char* other = reinterpret_cast<const char*>(&from.host) + info.offset;
                      list = *reinterpret_cast<const List*>(other);
                  });
    else if (info.kind == Kind::SHAPE)
        *reinterpret_cast<StoredShape*>(reinterpret_cast<char*>(&to.host) + info.offset) =
            *reinterpret_cast<const StoredShape*>(reinterpret_cast<const char*>(&from.host) + info.offset);
    else if (info.kind == Kind::TEXT)
        *reinterpret_cast<std::string*>(reinterpret_cast<char*>(&to.host) + info.offset) =
            *reinterpret_cast<const std::string*>(reinterpret_cast<const char*>(&from.host) + info.offset);
    else
        memcpy(reinterpret_cast<char*>(&to.params) + info.offset,
               reinterpret_cast<const char*>(&from.params) + info.offset, size_t(info.components()) * sizeof(float));
}

} // namespace coif

#include "sim/error.h"
#include "sim/hairstyle_lists.h"
#include "sim/shown.h"
#include "sim/source.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace coif
{

namespace fs = std::filesystem;

void check_regular(const fs::path& file)
{
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status))
        throw fail("{}: there is no such file", shown_file(file));
    if (fs::is_directory(status))
        throw fail("{}: is a folder, not a regular file; name a file in it", shown_file(file));
    if (!fs::is_regular_file(status))
        throw fail("{}: is a {}, not a regular file; write what it gives into a file and name that", shown_file(file),
                   fs::is_fifo(status)     ? "pipe"
                   : fs::is_socket(status) ? "socket"
                                           : "device");
}

std::string read_file(const fs::path& file, size_t limit)
{
    check_regular(file);
    // Not waiting and not beyond the limit: what never ends may pass for regular, as some of /proc does.
    std::string text;
    char piece[1 << 16];
    ssize_t got = -1;
    if (const int from = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); from >= 0)
    {
        while ((got = read(from, piece, sizeof piece)) > 0 && text.size() <= limit)
            text.append(piece, size_t(got));
        close(from);
    }
    if (got < 0)
        throw fail("{}: cannot be read", shown_file(file));
    if (text.size() > limit)
        throw fail("{}: is larger than the {} bytes that coif reads of such a file", shown_file(file), limit);
    return text;
}

void make_folder(const fs::path& folder)
{
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw fail("{}: the folder cannot be made: {}", folder.string(), error.message());
    if (access(folder.c_str(), W_OK | X_OK) != 0) // told before the work, not after
        throw fail("{}: the folder cannot be written into", folder.string());
}

void write_file(const fs::path& file, const std::string& bytes)
{
    // Through a link the file that it names is replaced, not the link.
    std::error_code error;
    const fs::path target = fs::is_symlink(file, error) ? fs::weakly_canonical(file, error) : file;
    if (const auto there = fs::status(target, error); fs::is_fifo(there) || fs::is_character_file(there))
    {
        // A pipe, a terminal or /dev/null takes the bytes and stays what it is.
        std::ofstream out(target, std::ios::binary);
        if (!(out << bytes).flush())
            throw fail("{}: cannot be written", file.string());
        return;
    }
    const fs::path beside = target.string() + fmt::format(".{}.new", getpid());
    {
        std::ofstream out(beside, std::ios::binary);
        if (!out)
            throw fail("{}: cannot be written; is its folder there, and writable?", file.string());
        out << bytes;
        out.flush();
        if (!out)
        {
            const std::string why = std::generic_category().message(errno);
            fs::remove(beside, error);
            throw fail("{}: cannot be written: {}; make room, or save elsewhere", file.string(), why);
        }
    }
    if (const auto status = fs::status(target, error); fs::exists(status))
        fs::permissions(beside, status.permissions(), error);
    fs::rename(beside, target, error);
    if (error)
    {
        std::error_code ignored;
        fs::remove(beside, ignored);
        throw fail("{}: cannot be written: {}", file.string(), error.message());
    }
}

void refuse_deep_keys(const std::string& text, const fs::path& file)
{
    // Dots beyond the 64th of their lines, but for the first in a run of digits: maps hold thousands of numbers. 256
    // colliders in one line hold some 1500 dots.
    size_t in_line = 0, surplus = 0;
    bool in_number = false, fraction = false; // within digits; after their dot
    for (const char c : text)
    {
        const bool digit = c >= '0' && c <= '9';
        const bool of_number = c == '.' && in_number && !fraction;
        if (c == '\n')
            in_line = 0;
        else if (c == '.' && !of_number)
            surplus += ++in_line > 64;
        fraction = of_number || (fraction && (digit || c == '.'));
        in_number = digit || c == '.';
    }
    if (surplus > 4000)
        throw fail("{}: holds keys with more dots than coif takes", shown_file(file));
}

fs::path resolve_path(const Hairstyle& style, const std::string& key, const std::string& written,
                      const fs::path& shipped)
{
    std::error_code error;
    const fs::path beside = style.file.parent_path() / written; // an absolute path replaces the folder
    if (fs::exists(beside, error))
        return beside;
    const fs::path data = shipped / written;
    if (fs::exists(data, error))
        return data;
    const auto at = style.places.find(key);
    throw fail("{}{}: no file '{}', neither as {} nor as {}", at == style.places.end() ? "" : at->second + ": ", key,
               shown(written), shown_file(beside), shown_file(data));
}

fs::path named_file(const Hairstyle& style, const std::string& key, const std::string& written)
{
    return resolve_path(style, key, written, data_folder() / (key == "look.lights" ? "hairstyles/lights" : "assets"));
}

// The style with its relative paths turned from its own folder to the target's.
static Hairstyle moved(const Hairstyle& style, const fs::path& target)
{
    Hairstyle result = style;
    if (style.file.empty())
        return result;
    // Without links: the system goes up from where a linked folder really is.
    std::error_code error;
    const fs::path from = fs::weakly_canonical(fs::absolute(style.file).parent_path(), error);
    const fs::path to = fs::weakly_canonical(fs::absolute(target).parent_path(), error);
    if (error || from == to)
        return result;
    for (const ParamInfo& info : param_table())
    {
        if (info.kind != Kind::TEXT)
            continue;
        auto& path = *reinterpret_cast<std::string*>(reinterpret_cast<char*>(&result.host) + info.offset);
        if (!path.empty() && fs::path(path).is_relative() && fs::exists(from / path, error))
            path = (from / path).lexically_normal().lexically_relative(to).string();
    }
    return result;
}

std::string hairstyle_text(const Hairstyle& style, const fs::path& target)
{
    Hairstyle wanted = moved(style, target);
    const auto variants = current_variants(wanted);
    if (!wanted.variant.empty())
        wanted.params = wanted.own;
    const Hairstyle written = style.text.empty() ? Hairstyle{} : parse_hairstyle(style.text, style.file, false);
    std::vector<TomlEdit> edits;
    for (const ParamInfo& info : param_table())
        if (info.kind != Kind::LIST && !same_value(wanted, written, info))
            edits.push_back({info.group, info.name, value_text(wanted, info)});
    std::string text = edit_toml(style.text, edits);
    edits.clear();
    for (const auto& [name, settings] : variants)
    {
        const auto old = written.variants.find(name);
        if (old == written.variants.end() && settings.empty())
            edits.push_back({"variant", name, "{}"});
        const std::vector<Setting> before = old == written.variants.end() ? std::vector<Setting>{} : old->second;
        const auto same_group = [](const ParamInfo* info)
        { return [info](const Setting& s) { return s.info->group == std::string_view(info->group); }; };
        // Where the author has begun a group, its keys are changed one by one; a new one is written as { ... }.
        std::vector<Setting> fresh;
        for (const Setting& setting : settings)
            if (std::ranges::none_of(before, same_group(setting.info)))
                fresh.push_back(setting);
            else if (std::ranges::find(before, setting) == before.end())
                edits.push_back({fmt::format("variant.{}.{}", name, setting.info->group), setting.info->name,
                                 setting_text(setting)});
        for (const auto& [group, values] : settings_entry(fresh))
            edits.push_back({"variant." + name, group, values});
        for (const Setting& setting : before)
            if (std::ranges::find(settings, setting.info, &Setting::info) == settings.end())
                edits.push_back(
                    {fmt::format("variant.{}.{}", name, setting.info->group), setting.info->name, std::nullopt});
    }
    for (const auto& [name, settings] : written.variants)
        if (!variants.contains(name))
            edits.push_back({"variant", name, std::nullopt});
    text = edit_toml(text, edits);
    for (const ParamInfo& info : param_table())
        if (info.kind == Kind::LIST && !same_value(wanted, written, info))
            text = edit_toml_array(text, info.group, list_entries(wanted.host, info));
    return text;
}

// What a style keeps in files beside it, given names where it has none yet: file and bytes of what is not there as it
// should be. Only what was this style's own is written over: a file of another's stays, and saved elsewhere a style
// takes copies along.
static std::vector<std::pair<fs::path, std::string>> side_files(Hairstyle& style, const fs::path& target)
{
    std::vector<std::pair<fs::path, std::string>> files;
    const fs::path folder = target.parent_path();
    const std::string stem = target.stem().string();
    std::error_code error;
    const bool same_style = fs::equivalent(style.file, target, error) && !error;
    const auto taken = [&](const std::string& name)
    {
        return fs::exists(fs::symlink_status(folder / name, error)) ||
               std::ranges::any_of(files, [&](const auto& file) { return file.first == folder / name; });
    };
    const auto keep = [&](std::string& name, const std::string& kind, const std::string& bytes)
    {
        if (same_style && !name.empty() && fs::is_regular_file(folder / name, error) &&
            read_file(folder / name) == bytes)
            return;
        const bool own = same_style && name.starts_with(stem + ".") && name.ends_with(kind);
        for (int n = 1; !own && (n == 1 || taken(name)); ++n)
            name = fmt::format("{}.{}{}", stem, n > 1 ? fmt::format("{}.", n) : "", kind);
        files.emplace_back(folder / name, bytes);
    };
    if (StoredShape& rest = style.host.groom_rest; rest.shapes)
        keep(rest.file, "rest", shapes_text(*rest.shapes));
    for (Region& region : style.host.regions)
        if (region.weights.size() > kMostInline || !region.file.empty())
            keep(region.file, "region", map_values_text(region.weights));
    for (ScalpMap& map : style.host.maps)
        if (map.values.size() > kMostInline || !map.file.empty())
            keep(map.file, map.of + ".map", map_values_text(map.values));
    return files;
}

void save_hairstyle(Hairstyle& style, const fs::path& target)
{
    Hairstyle named = style;
    for (const auto& [file, bytes] : side_files(named, target))
        write_file(file, bytes);
    const std::string text = hairstyle_text(named, target);
    Hairstyle saved = parse_hairstyle(text, target); // what was written is what will be read
    if (saved.variants.contains(style.variant))
        switch_variant(saved, style.variant);
    write_file(target, text);
    style = std::move(saved);
}

} // namespace coif

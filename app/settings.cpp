#include "app/settings.h"

#include "sim/error.h"
#include "sim/hairstyle.h"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace coif
{

namespace fs = std::filesystem;

static const char kOwnSection[] = "[coif][editor]";

static int number(const std::string& text, int low, int high)
{
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && value >= low && value <= high ? value : 0;
}

Settings parse_settings(const std::string& text)
{
    Settings settings;
    std::istringstream lines(text);
    enum
    {
        OTHER,
        OWN,
        WINDOW
    } section = OTHER;
    for (std::string line; std::getline(lines, line);)
    {
        if (line.starts_with("["))
            section = line == kOwnSection ? OWN : line.starts_with("[Window][") && line.ends_with("]") ? WINDOW : OTHER;
        // Only windows: ImGui trusts what a table says of its columns.
        if (section == WINDOW && line.find('\0') == line.npos)
            settings.windows += line + "\n";
        const size_t equals = line.find('=');
        if (section != OWN || equals == line.npos)
            continue;
        const std::string key = line.substr(0, equals), value = line.substr(equals + 1);
        if (key == "width")
            settings.width = number(value, 400, 16384);
        else if (key == "height")
            settings.height = number(value, 300, 16384);
        else if (key == "panel")
            settings.panel = value != "0";
        else if (key == "history")
            settings.history = value == "1";
        else if (key == "browser")
            settings.browser = value == "1";
        else if (key == "give_way")
            settings.give_way = value != "0";
        else if (key == "locked" && find_param(value))
            settings.locked.insert(value);
        else if (key == "folded" &&
                 std::ranges::any_of(param_table(), [&](const ParamInfo& info) { return info.group == value; }))
            settings.folded.insert(value);
    }
    return settings;
}

std::string settings_text(const Settings& settings)
{
    std::string text = fmt::format("{}\nwidth={}\nheight={}\npanel={:d}\nhistory={:d}\nbrowser={:d}\ngive_way={:d}\n",
                                   kOwnSection, settings.width, settings.height, settings.panel, settings.history,
                                   settings.browser, settings.give_way);
    for (const std::string& group : settings.folded)
        text += "folded=" + group + "\n";
    for (const std::string& path : settings.locked)
        text += "locked=" + path + "\n";
    return text + "\n" + settings.windows;
}

Settings load_settings(const fs::path& file)
try
{
    return parse_settings(read_file(file, 1 << 20));
}
catch (const std::exception&)
{
    return {};
}

void save_settings(const fs::path& file, const Settings& settings)
{
    make_folder(file.parent_path());
    write_file(file, settings_text(settings));
}

} // namespace coif

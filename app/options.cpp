#include "app/options.h"

#include "app/randomise.h"
#include "sim/error.h"
#include "sim/shown.h"
#include "sim/source.h"

#include <algorithm>

namespace coif
{

namespace fs = std::filesystem;

static constexpr double kChance = 0.3; // share of its sliders that --random moves a value by

std::vector<fs::path> preset_files()
{
    std::vector<fs::path> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(data_folder() / "hairstyles", error))
        if (entry.path().extension() == ".toml")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

fs::path find_style(const std::string& name_or_path)
{
    if (name_or_path.empty())
        return data_folder() / "hairstyles" / "bob.toml";
    std::error_code error;
    if (fs::exists(name_or_path, error))
        return name_or_path;
    if (fs::is_symlink(name_or_path, error))
        throw fail("{} is a link to {}, where there is no file", shown(name_or_path),
                   shown(fs::read_symlink(name_or_path, error).string()));
    std::vector<std::string> names;
    for (const fs::path& file : preset_files())
    {
        names.push_back(file.stem().string());
        if (name_or_path == names.back())
            return file;
    }
    throw fail("'{}' is neither a file nor one of coif's presets: {}", shown(name_or_path), fmt::join(names, ", "));
}

Hairstyle load_style(const Options& options)
{
    Hairstyle style = load_hairstyle(find_style(options.style));
    switch_variant(style, options.variant);
    if (options.random >= 0)
        style = randomised(style, options.random, kChance, {});
    for (const std::string& set : options.sets)
        assign(style, set);
    std::string tolerance = options.tolerance;
    if (!tolerance.empty() && tolerance.back() == '%')
        tolerance.pop_back();
    if (!tolerance.empty())
        assign(style, "quality.tolerance=" + tolerance);
    return style;
}

std::vector<size_t> selected(const std::vector<std::string>& only, const std::vector<std::string>& names,
                             const char* what)
{
    for (const std::string& name : only)
        if (!std::ranges::count(names, name))
            throw fail("--only {}: there is no such {}; there are {}", name, what, fmt::join(names, ", "));
    std::vector<size_t> indices;
    for (size_t i = 0; i < names.size(); ++i)
        if (only.empty() || std::ranges::count(only, names[i]))
            indices.push_back(i);
    return indices;
}

Device open_device(const Options& options) { return open_device(options.device, data_folder() / "kernels"); }

} // namespace coif

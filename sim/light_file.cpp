#include "sim/light_file.h"

#include "sim/hairstyle_lists.h"
#include "sim/shown.h"
#include "sim/source.h"
#include "sim/toml_values.h"

#include <algorithm>

namespace coif
{

namespace fs = std::filesystem;

static LightRig parse_lights(const std::string& text, const fs::path& file)
{
    const toml::table document = parse_toml(text, file);
    Hairstyle holder;
    holder.file = file;
    LightRig rig;
    for (auto&& [key, node] : document)
        if (key == "light")
            read_list(holder, *find_param("light"), node);
        else if (key == "sky")
            rig.sky = read_sky(file, node);
        else
            throw fail("{}: expected [[light]] tables and a [sky] only, found '{}'", place(file, key.source()),
                       shown(key.str()));
    if (document.empty())
        throw fail("{}: holds neither a [[light]] nor a [sky]; for darkness say radiance = 0 of a [sky]",
                   shown_file(file));
    rig.lights = holder.host.lights;
    return rig;
}

LightRig load_lights(const fs::path& file) { return parse_lights(read_file(file, 4 << 20), file); }

std::optional<LightRig> named_lights(const Hairstyle& style)
{
    if (style.host.look_lights.empty())
        return std::nullopt;
    const fs::path file = named_file(style, "look.lights", style.host.look_lights);
    return placed(style, "look.lights", [&] { return load_lights(file); });
}

void save_lights(const LightRig& rig, const fs::path& target)
{
    std::string text;
    LightRig before;
    std::error_code error;
    if (fs::exists(fs::symlink_status(target, error)))
        try
        {
            text = read_file(target, 4 << 20);
            before = parse_lights(text, target);
        }
        catch (const Error& e)
        {
            throw fail("{}: is there and holds something else than lights, so they need another name: {}",
                       shown_file(target), e.what());
        }
    if (rig.sky != before.sky || rig.lights.empty())
    {
        std::vector<TomlEdit> edits;
        for (const auto& [key, value] : sky_entry(rig.sky))
            edits.push_back({"sky", key, value});
        text = edit_toml(text, edits);
    }
    HostParams host;
    host.lights = rig.lights;
    if (rig.lights != before.lights)
        text = edit_toml_array(text, "light", list_entries(host, *find_param("light")));
    parse_lights(text, target); // what was written is what will be read
    make_folder(target.parent_path().empty() ? "." : target.parent_path());
    write_file(target, text);
}

std::vector<std::string> light_names(const fs::path& folder)
{
    std::vector<std::string> names;
    std::error_code error;
    const auto add = [&](const fs::path& from, const std::string& prefix, bool all)
    {
        std::vector<std::string> found;
        for (fs::directory_iterator entry(from, error), end; !error && entry != end; entry.increment(error))
        {
            if (entry->path().extension() != ".toml" || !entry->is_regular_file(error))
                continue;
            try
            {
                if (!all) // beside the style lie other styles
                    parse_lights(read_file(entry->path(), 1 << 16), entry->path());
                found.push_back(prefix + entry->path().filename().string());
            }
            catch (const Error&)
            {
                // A style, or not to be read.
            }
        }
        std::ranges::sort(found);
        names.insert(names.end(), found.begin(), found.end());
    };
    const fs::path shipped = data_folder() / "hairstyles" / "lights";
    const fs::path here = folder.empty() ? "." : folder;
    add(here, "", false);
    if (!fs::equivalent(here / "lights", shipped, error))
        add(here / "lights", "lights/", true);
    add(shipped, "", true);
    return names;
}

Light only_light(const HairParams& params)
{
    const float4 &direction = params.look_light_direction, &color = params.look_light_color;
    Light light;
    light.name = "light";
    light.direction = {direction.x, direction.y, direction.z};
    if (!points_somewhere(light.direction))
        light.direction = {0.0f, 1.0f, 0.0f}; // as device_params() has it
    light.color = {color.x, color.y, color.z};
    light.irradiance = params.look_light_irradiance;
    return light;
}

LightRig own_lights(const Hairstyle& style)
{
    const float4& sky = style.params.look_sky_color;
    LightRig rig{style.host.lights, {{sky.x, sky.y, sky.z}, style.params.look_sky_radiance}};
    const Light only = only_light(style.params);
    if (rig.lights.empty() && only.irradiance > 0.0f && only.color != glm::vec3(0.0f))
        rig.lights.push_back(only);
    return rig;
}

void set_own_lights(Hairstyle& style, const LightRig& rig)
{
    HairParams& p = style.params;
    style.host.look_lights.clear();
    style.host.lights = rig.lights;
    p.look_sky_color = F4(rig.sky.color.x, rig.sky.color.y, rig.sky.color.z, 1.0f);
    p.look_sky_radiance = rig.sky.radiance;
    if (!rig.lights.empty())
        return;
    p.look_light_color = F4(0.0f, 0.0f, 0.0f, 1.0f); // else that would shine in their place
    p.look_light_irradiance = 0.0f;
}

} // namespace coif

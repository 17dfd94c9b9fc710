#include "app/morph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace coif
{

namespace fs = std::filesystem;

// A path of `to` as it is to be written in `from`'s folder. What lies with coif is found from anywhere.
static std::string path_from(const std::string& written, const Hairstyle& from, const Hairstyle& to)
{
    std::error_code error;
    if (from.file.empty() || to.file.empty())
        return written;
    const fs::path here = fs::weakly_canonical(fs::absolute(from.file).parent_path(), error);
    const fs::path there = fs::weakly_canonical(fs::absolute(to.file).parent_path(), error);
    if (written.empty() || error || here == there || fs::path(written).is_absolute() ||
        !fs::exists(there / written, error))
        return written;
    return (there / written).lexically_normal().lexically_relative(here).string();
}

static double between(const ParamInfo& info, double a, double b, double at)
{
    const bool turns = info.unit == std::string_view("deg") && info.min == -180.0f && info.max == 180.0f;
    if (!turns || std::abs(b - a) <= 180.0)
        return a + (b - a) * at;
    const double turned = a + (b - a + (b > a ? -360.0 : 360.0)) * at;
    return turned > 180.0 ? turned - 360.0 : turned < -180.0 ? turned + 360.0 : turned;
}

// Maps go over evenly where both are of one scalp; where only one style has a map, the other's changes nothing.
static std::vector<ScalpMap> morphed_maps(const std::vector<ScalpMap>& from, const std::vector<ScalpMap>& to, float at)
{
    std::vector<ScalpMap> result;
    const auto twin = [](const std::vector<ScalpMap>& maps, const ScalpMap& map)
    {
        return std::ranges::find_if(maps,
                                    [&](const ScalpMap& other) { return other.of == map.of && other.how == map.how; });
    };
    const auto none = [](const ScalpMap& map)
    { return std::vector<float>(map.values.size(), map.how == MAP_FACTOR ? 1.0f : 0.0f); };
    const auto add = [&](ScalpMap map, const std::vector<float>& a, const std::vector<float>& b)
    {
        map.file.clear();
        for (size_t i = 0; i < map.values.size(); ++i)
            map.values[i] = a[i] + (b[i] - a[i]) * at;
        result.push_back(map);
    };
    for (const ScalpMap& map : from)
    {
        const auto other = twin(to, map);
        if (other != to.end() && other->values.size() != map.values.size())
            result.push_back(at < 0.5f ? map : *other); // of another scalp
        else
            add(map, map.values, other != to.end() ? other->values : none(map));
    }
    for (const ScalpMap& map : to)
        if (twin(from, map) == from.end())
            add(map, none(map), map.values);
    return result;
}

// Node by node where both shapes have the same; else the nearer one.
static StoredShape morphed_shape(const StoredShape& from, const StoredShape& to, float at)
{
    if (from == to || !from.shapes || !to.shapes || from.shapes->nodes != to.shapes->nodes ||
        from.shapes->position.size() != to.shapes->position.size())
        return at < 0.5f ? from : to;
    StrandShapes shapes = *from.shapes;
    for (size_t i = 0; i < shapes.position.size(); ++i)
        shapes.position[i] += (to.shapes->position[i] - shapes.position[i]) * at;
    return {"", std::make_shared<const StrandShapes>(std::move(shapes))};
}

Hairstyle morphed(const Hairstyle& from, const Hairstyle& to, double at)
{
    Hairstyle result = from;
    at = std::clamp(at, 0.0, 1.0);
    if (at == 0.0)
        return result;
    for (const ParamInfo& info : param_table())
    {
        if (info.on_host() || info.kind == Kind::CHOICE)
        {
            if (at < 0.5)
                continue;
            copy_value(to, result, info);
            if (info.kind == Kind::TEXT)
            {
                auto& path = *reinterpret_cast<std::string*>(reinterpret_cast<char*>(&result.host) + info.offset);
                path = path_from(path, from, to);
            }
            continue;
        }
        if (at == 1.0)
        {
            copy_value(to, result, info);
            continue;
        }
        float a[kMostNumbers] = {}, b[kMostNumbers] = {};
        get_numbers(from.params, info, a);
        get_numbers(to.params, info, b);
        double values[kMostNumbers] = {};
        for (int i = 0; i < info.components(); ++i)
        {
            values[i] = between(info, double(a[i]), double(b[i]), at);
            if (info.kind == Kind::INT)
                values[i] = std::round(values[i]);
            else // to as many digits as one would write
                values[i] = std::strtod(fmt::format("{:.6g}", values[i]).c_str(), nullptr);
            values[i] = a[i] == b[i] ? double(a[i]) : std::clamp(values[i], double(info.min), double(info.max));
        }
        set_numbers(result.params, info, values);
    }
    if (at < 1.0)
    {
        result.host.maps = morphed_maps(from.host.maps, to.host.maps, float(at));
        result.host.groom_rest = morphed_shape(from.host.groom_rest, to.host.groom_rest, float(at));
    }
    return result;
}

} // namespace coif

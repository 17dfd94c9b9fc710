#include "app/morph.h"

#include <algorithm>
#include <cmath>

namespace coif
{

namespace fs = std::filesystem;

// A path of `to` as it is to be written in `from`'s folder. What lies with coif is found from anywhere.
static std::string path_from(const std::string& written, const Hairstyle& from, const Hairstyle& to)
{
    std::error_code error;
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
        float a[3] = {}, b[3] = {};
        get_numbers(from.params, info, a);
        get_numbers(to.params, info, b);
        double values[3] = {};
        for (int i = 0; i < info.components(); ++i)
        {
            values[i] = between(info, double(a[i]), double(b[i]), at);
            if (info.kind == Kind::INT)
                values[i] = std::round(values[i]);
            values[i] = a[i] == b[i] ? double(a[i]) : std::clamp(values[i], double(info.min), double(info.max));
        }
        set_numbers(result.params, info, values);
    }
    return result;
}

} // namespace coif

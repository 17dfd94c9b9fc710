#include "app/randomise.h"

#include "sim/hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace coif
{

bool is_left_to_chance(const ParamInfo& info, const HairParams& params)
{
    if (info.on_host() || !is_read(info, params) || info.group == std::string_view("solver"))
        return false;
    // A material is measured, and nobody wants half the hair to be seen through.
    for (const char* measured : {"bending.modulus", "bending.diameter", "look.opacity"})
        if (info.path() == measured)
            return false;
    // What may differ from strand to strand is what shapes the hair; where it grows from does too.
    return info.scope != Scope::GLOBAL || info.group == std::string_view("root");
}

static double usual_value(const ParamInfo& info)
{
    static const HairParams defaults;
    float usual[kMostNumbers];
    get_numbers(defaults, info, usual);
    return double(usual[0]);
}

static bool is_wide(const ParamInfo& info)
{
    const double usual = usual_value(info);
    return info.min >= 0.0f && usual > 0.0 && double(info.max) > 10.0 * usual;
}

double slider_place(const ParamInfo& info, double value)
{
    const double low = double(info.min), high = double(info.max);
    if (!is_wide(info))
        return (value - low) / (high - low);
    const double usual = usual_value(info);
    return std::log1p((value - low) / usual) / std::log1p((high - low) / usual);
}

double slider_value(const ParamInfo& info, double place)
{
    const double low = double(info.min), high = double(info.max);
    if (!is_wide(info))
        return low + place * (high - low);
    const double usual = usual_value(info);
    return low + usual * std::expm1(place * std::log1p((high - low) / usual));
}

Hairstyle randomised(const Hairstyle& style, int seed, double amount, const std::set<std::string>& locked)
{
    Hairstyle result = style;
    for (const ParamInfo& info : param_table())
    {
        const std::string path = info.path();
        if (!is_left_to_chance(info, style.params) || locked.contains(path))
            continue;
        Hash own; // a stream of numbers of its own
        own.add(path.data(), path.size());
        own.add(&seed, sizeof seed);
        std::mt19937 random(unsigned(own.word[0] ^ own.word[1]));
        const auto share = [&] { return double(random()) / 4294967295.0; }; // the same everywhere
        float now[kMostNumbers];
        get_numbers(style.params, info, now);
        double values[kMostNumbers];
        if (info.kind == Kind::CHOICE)
        {
            const double count = double(param_labels(info).size());
            values[0] = share() < amount ? std::min(std::floor(share() * count), count - 1.0) : double(now[0]);
        }
        else
        {
            // Colours go lighter or darker as a whole, and a little off their hue.
            const double together = share() - 0.5;
            for (int i = 0; i < info.components(); ++i)
            {
                const double apart = share() - 0.5;
                const double by = info.kind == Kind::COLOR ? 0.7 * together + 0.3 * apart : apart;
                const double place = std::clamp(slider_place(info, double(now[i])) + amount * by, 0.0, 1.0);
                const double value = std::clamp(slider_value(info, place), double(info.min), double(info.max));
                if (info.kind == Kind::COLOR)
                    values[i] = std::round(255.0 * value) / 255.0; // as files write them
                else if (info.kind == Kind::INT)
                    values[i] = std::round(value);
                else // three digits are enough to read
                    values[i] = std::clamp(std::stod(fmt::format("{:.3g}", value)), double(info.min), double(info.max));
            }
        }
        set_numbers(result.params, info, values);
    }
    return result;
}

} // namespace coif

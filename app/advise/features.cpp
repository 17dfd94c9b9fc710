#include "app/advise/features.h"

#include "sim/error.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace coif
{

namespace
{
// When a feature has a say at all.
using Matters = bool (*)(const Hairstyle& style, bool windy);

// What can be switched off: its parameters where they do nothing, as --set takes them.
struct Switch
{
    const char* name;
    std::vector<const char*> off;
    Matters matters;
};

// A count that can be lowered step by step, each time by the factor `less` (which is above 1 where more is cheaper),
// down to `cheapest`; and raised once by its inverse, up to `dearest`.
struct Count
{
    const char* name;
    const char* path;
    double less, cheapest, dearest;
    Matters matters;
    const char* instead = nullptr; // grows as the count shrinks
};
} // namespace

static bool always(const Hairstyle&, bool) { return true; }
static bool direct(const Hairstyle& s, bool) { return s.params.solver_kind == 0; }
static bool pbd(const Hairstyle& s, bool) { return s.params.solver_kind == 1; }
static bool has_grid(const Hairstyle& s, bool)
{
    return s.params.forces_repulsion > 0.0f || (s.params.look_self_shadow > 0.0f && lit_by_kajiya_kay(s.params));
}
static bool draws(const Hairstyle& s, bool) { return s.params.interpolation_strands > 0; }
static bool in_wind(const Hairstyle& s, bool windy)
{
    const float4& wind = s.params.forces_wind;
    return windy || wind.x != 0.0f || wind.y != 0.0f || wind.z != 0.0f;
}
// Is there a shape that spheres and capsules could stand for?
static bool has_shape(const Hairstyle& s, bool) { return !s.host.head_mesh.empty() && !s.host.head_spheres.empty(); }
// Is what stands for the head no more than those, or is there nothing but a ball that could?
static bool has_spheres(const Hairstyle& s, bool windy)
{
    return !has_shape(s, windy) ||
           param_labels(*find_param("head.contact"))[size_t(s.params.head_contact)] == "spheres";
}

// Where two have one name, the second goes further than the first.
static const Switch kSwitches[] = {
    {"self-shadow", {"look.self_shadow=0"}, draws},
    {"repulsion", {"forces.repulsion=0"}, always},
    {"blur of the grid", {"grid.blur=0"}, has_grid},
    {"mixing of guides", {"interpolation.ratio=1"}, draws},
    {"shape of the head", {"head.contact=spheres"}, has_shape},
    {"shape of the head", {"head.contact=spheres", "head.spheres="}, has_spheres},
    {"colliders", {"collider"}, always},
    {"friction", {"forces.friction=0"}, direct},
    {"bending", {"bending.droop=10000", "bending.modulus=0"}, direct},
    {"bending", {"solver.bending=0"}, pbd},
    {"wind", {"forces.wind=[0,0,0]"}, always},
    {"gusts", {"forces.turbulence=0"}, in_wind},
    {"waves", {"wave.normal_amplitude=0", "wave.binormal_amplitude=0"}, always},
    {"curls", {"curl.radius=0"}, always},
    {"frizz", {"frizz.amount=0"}, always},
    {"fly-aways", {"flyaway.share=0"}, always},
    {"clumps", {"clump.strength=0"}, always},
};

static const Count kCounts[] = {
    {"drawn strands", "interpolation.strands", 0.5, 250.0, 0.0, always, "look.width"},
    {"subdivisions", "smoothing.subdivisions", 0.5, 1.0, 30.0, draws},
    {"nodes", "strand.nodes", 2.0 / 3.0, 6.0, 64.0, always},
    // Finer than by default it does not tell more: grid.blur has spread hair wider than the voxels.
    {"grid", "grid.resolution", 0.5, 16.0, 64.0, has_grid},
    {"time steps", "solver.rate", 0.5, 60.0, 0.0, always},
    {"substeps at least", "solver.substeps", 0.5, 1.0, 0.0, direct},
    {"substeps", "solver.courant", 2.0, 1.8, 0.1, direct},
    {"sweeps", "solver.iterations", 0.5, 1.0, 1000.0, pbd},
};

static Hairstyle switched_off(Hairstyle style, const Switch& feature)
{
    for (const std::string off : feature.off)
        if (off == "collider")
            style.host.colliders.clear();
        else
            assign(style, off);
    return style;
}

static double number(const Hairstyle& style, const char* path)
{
    float value[kMostNumbers] = {};
    get_numbers(style.params, *find_param(path), value);
    return double(value[0]);
}

// The style with the parameter at `value`, within its range.
static void set_number(Hairstyle& style, const char* path, double value)
{
    const ParamInfo& info = *find_param(path);
    const double values[kMostNumbers] = {
        std::clamp(info.kind == Kind::INT ? std::round(value) : value, double(info.min), double(info.max))};
    set_numbers(style.params, info, values);
}

// One step of the count by `factor`, not beyond `end`; as it is where the end has been reached.
static Hairstyle stepped(Hairstyle style, const Count& count, double factor, double end)
{
    const double now = number(style, count.path);
    const double next = factor < 1.0 ? std::max(now * factor, end) : std::min(now * factor, end);
    if (factor < 1.0 ? next >= now : next <= now)
        return style;
    set_number(style, count.path, next);
    if (count.instead)
        set_number(style, count.instead, number(style, count.instead) * now / number(style, count.path));
    return style;
}

static bool same(const Hairstyle& a, const Hairstyle& b)
{
    return std::ranges::all_of(param_table(), [&](const ParamInfo& info) { return same_value(a, b, info); });
}

std::vector<Feature> used_features(const Hairstyle& style, bool windy)
{
    std::vector<Feature> features;
    const auto add = [&](const char* name, const Hairstyle& without)
    {
        if (!same(style, without))
            features.push_back({name, without});
    };
    for (const Count& count : kCounts)
        if (count.matters(style, windy))
            add(count.name, stepped(style, count, count.less, count.cheapest));
    for (const Switch& feature : kSwitches)
        if (feature.matters(style, windy))
            add(feature.name, switched_off(style, feature));
    return features;
}

std::vector<Feature> lacked_features(const Hairstyle& style, bool windy)
{
    std::vector<Feature> features;
    const auto add = [&](const char* name, const Hairstyle& with)
    {
        if (!same(style, with))
            features.push_back({name, with, true});
    };
    const Hairstyle defaults;
    for (const Switch& feature : kSwitches)
        if (feature.matters(style, windy) && same(style, switched_off(style, feature)))
            add(feature.name, with_changes(style, switched_off(defaults, feature), defaults));
    for (const Count& count : kCounts)
        if (count.dearest > 0.0 && count.matters(style, windy))
            add(count.name, stepped(style, count, 1.0 / count.less, count.dearest));
    return features;
}

Feature further(const Feature& feature)
{
    for (const Count& count : kCounts)
        if (feature.name == count.name && !feature.lacked)
            return {feature.name, stepped(feature.style, count, count.less, count.cheapest)};
    Feature next = feature;
    for (const Switch& off : kSwitches)
        if (feature.name == off.name && off.matters(feature.style, false) && !feature.lacked)
            next.style = switched_off(feature.style, off);
    return next;
}

Hairstyle with_changes(Hairstyle style, const Hairstyle& from, const Hairstyle& changed)
{
    for (const ParamInfo& info : param_table())
        if (!same_value(from, changed, info))
            copy_value(changed, style, info);
    return style;
}

std::string changes_text(const Hairstyle& from, const Hairstyle& changed)
{
    std::vector<std::string> changes;
    for (const ParamInfo& info : param_table())
        if (!same_value(from, changed, info))
            changes.push_back(fmt::format("{} = {}", info.path(), value_text(changed, info)));
    return fmt::format("{}", fmt::join(changes, ", "));
}

} // namespace coif

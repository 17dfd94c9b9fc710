#include "sim/params.h"

#include "sim/error.h"
#include "sim/hair_color.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>
#include <utility>

namespace coif
{

// A list has no name: its "" in params.def is none.
static constexpr const char* bare(const char* name) { return *name == '"' ? "" : name; }

// clang-format off
#define COIF_PARAM(group, kind, name, value, lo, hi, unit, scope, effect, read_by, labels, help)                       \
    {#group, #name, Kind::kind, Scope::scope, Effect::effect, ReadBy::read_by, offsetof(HairParams, group##_##name),   \
     lo, hi, unit, labels, help},
#define COIF_OFFSET_TEXT(group, name) offsetof(HostParams, group##_##name)
#define COIF_OFFSET_SHAPE(group, name) offsetof(HostParams, group##_##name)
#define COIF_OFFSET_LIST(group, name) offsetof(HostParams, group##s)
#define COIF_HOST(group, kind, name, value, scope, effect, help)                                                       \
    {#group, bare(#name), Kind::kind, Scope::scope, Effect::effect, ReadBy::ALL, COIF_OFFSET_##kind(group, name),      \
     0.0f, 0.0f, "", "", help},
// clang-format on

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof" // HostParams holds strings; its offsets are well defined here
static const ParamInfo kParams[] = {
#include "kernels/params.def"
};
#pragma GCC diagnostic pop

std::span<const ParamInfo> param_table() { return kParams; }

const char* kind_name(Kind kind)
{
    static const char* const names[] = {"number",  "whole number", "choice", "three numbers", "colour",
                                        "profile", "text",         "shape",  "list"};
    return names[int(kind)];
}

const char* scope_name(Scope scope)
{
    static const char* const names[] = {"global", "strand", "profile"};
    return names[int(scope)];
}

const char* effect_name(Effect effect)
{
    static const char* const names[] = {"live", "view", "regrow", "rebuild"};
    return names[int(effect)];
}

bool lit_by_kajiya_kay(const HairParams& params)
{
    return params.look_level == LOOK_KAJIYA_KAY || params.render_colors != 0;
}

bool is_read(const ParamInfo& info, const HairParams& params)
{
    const bool above = params.look_level != LOOK_KAJIYA_KAY, melanin = params.look_pigment != 0;
    switch (info.read_by)
    {
    case ReadBy::DIRECT:
        return params.solver_kind == 0;
    case ReadBy::PBD:
        return params.solver_kind == 1;
    case ReadBy::THESIS:
        return lit_by_kajiya_kay(params);
    case ReadBy::FIBRE:
        return above;
    case ReadBy::AUTO:
        return params.look_level == LOOK_AUTO;
    case ReadBy::MELANIN:
        return melanin;
    case ReadBy::AROUND:
        return above || melanin;
    default:
        return true;
    }
}

std::string only_reader(const ParamInfo& info)
{
    static const char* const readers[] = {"",
                                          "solver.kind is direct",
                                          "solver.kind is pbd",
                                          "look.level is kajiya_kay",
                                          "look.level is not kajiya_kay",
                                          "look.level is auto",
                                          "look.pigment is melanin",
                                          "look.level is not kajiya_kay, or look.pigment is melanin"};
    return readers[int(info.read_by)];
}

const ParamInfo* find_param(std::string_view path)
{
    for (const ParamInfo& info : param_table())
        if (path == info.path())
            return &info;
    return nullptr;
}

static int edit_distance(std::string_view a, std::string_view b)
{
    std::vector<int> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (size_t i = 1; i <= a.size(); ++i)
    {
        int diagonal = std::exchange(row[0], int(i));
        for (size_t j = 1; j <= b.size(); ++j)
        {
            const int change = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, change}));
        }
    }
    return row[b.size()];
}

std::string nearest_param(std::string_view path)
{
    // A hostile file may hold a key of megabytes; its head is enough to tell what was meant.
    path = path.substr(0, 100);
    std::string best;
    int least = INT32_MAX;
    for (const ParamInfo& info : param_table())
    {
        // A right key in a wrong group is the likelier slip: compare the bare name as well.
        const std::string known = info.path();
        const size_t dot = path.find('.');
        const std::string_view bare = dot == path.npos ? path : path.substr(dot + 1);
        const int distance = std::min(edit_distance(path, known), *info.name ? edit_distance(bare, info.name) + 2 : 99);
        if (distance < least)
        {
            least = distance;
            best = known;
        }
    }
    return best;
}

std::vector<std::string> split_labels(std::string_view all)
{
    std::vector<std::string> labels;
    for (size_t begin = 0; begin <= all.size();)
    {
        const size_t end = std::min(all.find('|', begin), all.size());
        labels.emplace_back(all.substr(begin, end - begin));
        begin = end + 1;
    }
    return labels;
}

std::vector<std::string> param_labels(const ParamInfo& info) { return split_labels(info.labels); }

void get_numbers(const HairParams& params, const ParamInfo& info, float out[kMostNumbers])
{
    const char* field = reinterpret_cast<const char*>(&params) + info.offset;
    if (info.kind == Kind::INT || info.kind == Kind::CHOICE)
    {
        int value;
        memcpy(&value, field, sizeof value);
        out[0] = float(value);
        return;
    }
    memcpy(out, field, size_t(info.components()) * sizeof(float));
}

void set_numbers(HairParams& params, const ParamInfo& info, const double values[kMostNumbers])
{
    float floats[kMostNumbers];
    for (int i = 0; i < info.components(); ++i)
    {
        if (!std::isfinite(values[i]))
            throw fail("{} is {}, but must be a finite number", info.path(), values[i]);
        floats[i] = float(values[i]);
        if (!(floats[i] >= info.min && floats[i] <= info.max))
        {
            // As a float, so that 0.1 is told as 0.1; but not where a float would round it to another number.
            const bool rounded = info.kind == Kind::INT || !std::isfinite(floats[i]);
            throw fail("{} is {}, but must lie in [{}, {}]{}{}", info.path(),
                       rounded ? fmt::format("{}", values[i]) : fmt::format("{}", floats[i]), info.min, info.max,
                       *info.unit ? " " : "", info.unit);
        }
    }
    char* field = reinterpret_cast<char*>(&params) + info.offset;
    if (info.kind == Kind::INT || info.kind == Kind::CHOICE)
    {
        const int value = int(values[0]);
        memcpy(field, &value, sizeof value);
    }
    else
        memcpy(field, floats, size_t(info.components()) * sizeof(float));
}

float linear_of_srgb(float c) { return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f); }

bool waves_are_shape(const HairParams& p)
{
    if (p.solver_kind != 0 || (p.wave_normal_amplitude <= 0.0f && p.wave_binormal_amplitude <= 0.0f))
        return false;
    const float frequency = std::max(p.wave_normal_amplitude > 0.0f ? p.wave_normal_frequency : 0.0f,
                                     p.wave_binormal_amplitude > 0.0f ? p.wave_binormal_frequency : 0.0f);
    return frequency > 0.0f && float(p.strand_nodes - 2) >= 8.0f * frequency * p.strand_length;
}

bool curls_are_shape(const HairParams& p)
{
    // The tightest curl turns once in the pitch that variation leaves of it: kernels/strand_curve.h.
    const float tightest = p.curl_pitch * (1.0f - 0.5f * p.curl_variation);
    return p.solver_kind == 0 && p.curl_radius > 0.0f && float(p.strand_nodes - 2) * tightest >= 8.0f * p.strand_length;
}

bool has_clumps(const HairParams& p) { return p.clump_strength > 0.0f; }

double profile_at(const float4& p, double along)
{
    const double t = 3.0 * std::clamp(along, 0.0, 1.0);
    return p.x + (double(p.y) - p.x) * std::min(t, 1.0) + (double(p.z) - p.y) * std::clamp(t - 1.0, 0.0, 1.0) +
           (double(p.w) - p.z) * std::max(t - 2.0, 0.0);
}

float most_of(const float4& p) { return std::max({p.x, p.y, p.z, p.w}); }
float least_of(const float4& p) { return std::min({p.x, p.y, p.z, p.w}); }

HairParams device_params(const HairParams& authored)
{
    HairParams params = authored;
    if (waves_are_shape(authored))
        params.wave_normal_amplitude = params.wave_binormal_amplitude = 0.0f; // nothing is left to lay on
    if (curls_are_shape(authored))
        params.curl_radius = 0.0f;
    for (const ParamInfo& info : param_table())
    {
        if (info.on_host() || info.kind == Kind::INT || info.kind == Kind::CHOICE)
            continue;
        float* value = reinterpret_cast<float*>(reinterpret_cast<char*>(&params) + info.offset);
        for (int i = 0; i < info.components(); ++i)
        {
            if (info.kind == Kind::COLOR)
                value[i] = linear_of_srgb(value[i]);
            else if (!strcmp(info.unit, "deg"))
                value[i] *= std::numbers::pi_v<float> / 180.0f;
        }
    }
    take_pigment(params);
    float4& light = params.look_light_direction;
    const float norm = std::sqrt(light.x * light.x + light.y * light.y + light.z * light.z);
    light = norm > 1e-6f ? F4(light.x / norm, light.y / norm, light.z / norm, 0.0f) : F4(0.0f, 1.0f, 0.0f, 0.0f);
    return params;
}

size_t list_size(const HostParams& host, const ParamInfo& info)
{
    return with_list(host, info, [](const auto& list) { return list.size(); });
}

std::string glsl_params_block()
{
    std::string text = "layout(std140) uniform HairParams {\n";
    for (const ParamInfo& info : param_table())
        if (!info.on_host())
            text += fmt::format("    {} {}_{};\n",
                                info.components() > 1                                 ? "vec4"
                                : info.kind == Kind::INT || info.kind == Kind::CHOICE ? "int"
                                                                                      : "float",
                                info.group, info.name);
    return text + "} params;\n";
}

} // namespace coif

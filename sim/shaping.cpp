#include "sim/shaping.h"

#include "sim/error.h"
#include "sim/shown.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

namespace
{
// A named part of a head: where `direction` . (p - centre) / radius of the scalp's sphere is at least `from`.
struct Area
{
    const char* name;
    glm::vec3 direction; // of unit length; +x is the head's left, +y up, +z the face
    float from;
};
} // namespace

static const Area kAreas[] = {
    {"top", {0.0f, 1.0f, 0.0f}, 0.55f},   {"front", {0.0f, 0.0f, 1.0f}, 0.5f},   {"back", {0.0f, 0.0f, -1.0f}, 0.35f},
    {"left", {1.0f, 0.0f, 0.0f}, 0.5f},   {"right", {-1.0f, 0.0f, 0.0f}, 0.5f},  {"sides", {1.0f, 0.0f, 0.0f}, 0.5f},
    {"nape", {0.0f, -0.8f, -0.6f}, 0.5f}, {"crown", {0.0f, 0.8f, -0.6f}, 0.85f},
};

const std::vector<std::string>& region_areas()
{
    static const std::vector<std::string> names = []
    {
        std::vector<std::string> all;
        for (const Area& area : kAreas)
            all.emplace_back(area.name);
        return all;
    }();
    return names;
}

bool varies(const HostParams& host) { return !host.maps.empty() || !host.regions.empty() || !host.partings.empty(); }

// Values of the authored scalp's vertices for those of the refined one, which follow them.
static std::vector<float> refined_values(const Scalp& scalp, std::vector<float> values, size_t of_each)
{
    for (const Between& between : scalp.between)
        for (size_t i = 0; i < of_each; ++i)
            values.push_back(between.shares.x * values[between.of.x * of_each + i] +
                             between.shares.y * values[between.of.y * of_each + i] +
                             between.shares.z * values[between.of.z * of_each + i]);
    return values;
}

// 1 where a vertex of the authored scalp carries a triangle of the group.
static std::vector<float> group_weights(const Scalp& scalp, const std::string& group)
{
    std::vector<float> weights(scalp.positions.size(), 0.0f);
    const auto found = scalp.groups.find(group);
    for (const unsigned vertex : found == scalp.groups.end() ? std::vector<unsigned>{} : found->second)
        if (vertex < weights.size())
            weights[vertex] = 1.0f;
    return weights;
}

static size_t values_of_each(const ScalpMap& map)
{
    const ParamInfo* info = find_param(map.of);
    return info && info->kind == Kind::COLOR ? 4 : 1;
}

Shaping shape_over(const HairParams& params, const HostParams& host, const Scalp& authored, const Scalp& scalp)
{
    Shaping shaping{params, host, scalp, {}, {}, {}};
    for (const ScalpMap& map : host.maps)
    {
        shaping.map_of.push_back(find_param(map.of));
        std::vector<float> values = map.values;
        values.resize(authored.positions.size() * values_of_each(map), map.how == MAP_FACTOR ? 1.0f : 0.0f);
        shaping.map_values.push_back(refined_values(scalp, values, values_of_each(map)));
    }
    for (const Region& region : host.regions)
    {
        std::vector<float>& weights = shaping.region_weights.emplace_back();
        if (!region.group.empty())
            weights = group_weights(authored, region.group);
        if (!region.weights.empty())
        {
            std::vector<float> painted = region.weights;
            painted.resize(authored.positions.size(), 0.0f);
            for (size_t i = 0; i < painted.size(); ++i)
                painted[i] *= weights.empty() ? 1.0f : weights[i];
            weights = painted;
        }
        if (!weights.empty())
            weights = refined_values(scalp, weights, 1);
    }
    return shaping;
}

ScalpPlace at_vertex(const Scalp& scalp, size_t vertex)
{
    return {scalp.positions[vertex], glm::uvec3(unsigned(vertex)), {1.0f, 0.0f, 0.0f}};
}

static float value_at(const std::vector<float>& values, const ScalpPlace& place, size_t of_each, size_t which)
{
    float sum = 0.0f;
    for (int k = 0; k < 3; ++k)
        sum += place.shares[k] * values[place.corners[k] * of_each + which];
    return sum;
}

// How deep a place lies within the region's rules, m; negative outside.
static float depth_within(const Region& region, const Scalp& scalp, glm::vec3 point)
{
    float depth = INFINITY;
    const glm::vec3 from_center = point - scalp.center;
    float any = -INFINITY;
    for (const Area& area : kAreas)
    {
        if (std::find(region.where.begin(), region.where.end(), area.name) == region.where.end())
            continue;
        const float along = glm::dot(from_center, area.direction);
        const bool both = area.name == std::string_view("sides");
        any = std::max(any, (both ? std::abs(along) : along) - area.from * scalp.radius);
    }
    if (!region.where.empty())
        depth = any;
    for (const glm::vec4& plane : region.planes)
    {
        const glm::vec3 n(plane);
        depth = std::min(depth, (glm::dot(n, point) - plane.w) / glm::length(n));
    }
    return depth;
}

float region_weight(const Shaping& shaping, size_t index, const ScalpPlace& place)
{
    const Region& region = shaping.host.regions[index];
    const float depth = depth_within(region, shaping.scalp, place.point);
    float weight = region.edge > 0.0f ? glm::smoothstep(-0.5f * region.edge, 0.5f * region.edge, depth)
                                      : (depth >= 0.0f ? 1.0f : 0.0f);
    if (const std::vector<float>& painted = shaping.region_weights[index]; !painted.empty())
        weight *= value_at(painted, place, 1, 0);
    if (region.edge <= 0.0f)
        weight = weight >= 0.5f ? 1.0f : 0.0f;
    return region.invert ? 1.0f - weight : weight;
}

static void blend(HairParams& params, const ParamInfo& info, const float* towards, float share)
{
    float* value = reinterpret_cast<float*>(reinterpret_cast<char*>(&params) + info.offset);
    for (int i = 0; i < info.components(); ++i)
        value[i] = share >= 1.0f ? towards[i] : value[i] + share * (towards[i] - value[i]);
}

HairParams params_at(const Shaping& shaping, const ScalpPlace& place)
{
    HairParams params = shaping.params;
    for (size_t r = 0; r < shaping.host.regions.size(); ++r)
        if (const float weight = region_weight(shaping, r, place); weight > 0.0f)
            for (const Setting& setting : shaping.host.regions[r].settings)
                blend(params, *setting.info, &setting.value.x, weight);
    for (size_t m = 0; m < shaping.host.maps.size(); ++m)
    {
        const ScalpMap& map = shaping.host.maps[m];
        const std::vector<float>& values = shaping.map_values[m];
        const ParamInfo& info = *shaping.map_of[m];
        if (info.kind == Kind::COLOR)
        {
            float over[4];
            for (size_t i = 0; i < 4; ++i)
                over[i] = std::clamp(value_at(values, place, 4, i), 0.0f, 1.0f);
            blend(params, info, over, over[3]);
            continue;
        }
        float* value = reinterpret_cast<float*>(reinterpret_cast<char*>(&params) + info.offset);
        const float by = value_at(values, place, 1, 0);
        *value = std::clamp(map.how == MAP_FACTOR ? *value * by : *value + by, info.min, info.max);
    }
    return params;
}

namespace
{
struct Nearest
{
    glm::vec3 point{0.0f}, along{0.0f}; // of the line; the way that it goes there
    float distance = INFINITY;          // m
    bool beside = false;                // and not beyond an end
};
} // namespace

static Nearest nearest_on(const Parting& parting, glm::vec3 p)
{
    Nearest best;
    const size_t last = parting.points.size() - 1;
    for (size_t i = 0; i < last; ++i)
    {
        const glm::vec3 a = parting.points[i], way = parting.points[i + 1] - a;
        const float at = glm::dot(p - a, way) / std::max(glm::dot(way, way), 1e-20f);
        const glm::vec3 point = a + std::clamp(at, 0.0f, 1.0f) * way;
        const float distance = glm::distance(p, point);
        if (distance < best.distance)
            best = {point, way, distance, (i > 0 || at >= 0.0f) && (i + 1 < last || at <= 1.0f)};
    }
    return best;
}

Sides sides_at(const Shaping& shaping, const ScalpPlace& place)
{
    Sides sides;
    for (size_t r = 0; r < shaping.host.regions.size(); ++r)
        if (shaping.host.regions[r].edge <= 0.0f && region_weight(shaping, r, place) >= 0.5f)
            sides.regions |= uint64_t(1) << r;
    for (size_t i = 0; i < shaping.host.partings.size(); ++i)
    {
        const Parting& parting = shaping.host.partings[i];
        const Nearest line = nearest_on(parting, place.point);
        if (!line.beside || line.distance > parting.reach)
            continue;
        const glm::vec3 side = glm::cross(line.along, place.point - shaping.scalp.center);
        (glm::dot(side, place.point - line.point) < 0.0f ? sides.left : sides.right) |= uint64_t(1) << i;
    }
    return sides;
}

glm::vec3 parted_flow(const Shaping& shaping, glm::vec3 point, glm::vec3 normal, glm::vec3 flow)
{
    for (const Parting& parting : shaping.host.partings)
    {
        const Nearest line = nearest_on(parting, point);
        const float share = 1.0f - glm::smoothstep(0.3f * parting.reach, parting.reach, line.distance);
        glm::vec3 away = point - line.point;
        away -= normal * glm::dot(away, normal);
        const float length = glm::length(away);
        if (!(share > 0.0f && length > 1e-6f))
            continue;
        const glm::vec3 mixed = glm::mix(flow, away / length, share);
        const float size = glm::length(mixed);
        flow = size > 1e-3f ? mixed / size : away / length;
    }
    return flow;
}

void check_entry(const HostParams& host, const ParamInfo& info, size_t index, const Scalp& scalp)
{
    if (info.group == std::string_view("map"))
    {
        const ScalpMap& map = host.maps[index];
        const size_t wanted = scalp.positions.size() * values_of_each(map);
        if (map.values.size() != wanted)
            throw fail("the map of {} has {} values, but the scalp's {} vertices need {}", map.of, map.values.size(),
                       scalp.positions.size(), wanted);
    }
    else if (info.group == std::string_view("tie"))
    {
        for (const std::string& name : host.ties[index].regions)
            if (std::none_of(host.regions.begin(), host.regions.end(), [&](const Region& r) { return r.name == name; }))
                throw fail("the tie '{}' gathers the hair of the region '{}', but no region is called that",
                           shown(host.ties[index].name), shown(name));
    }
    else if (info.group == std::string_view("region"))
    {
        const Region& region = host.regions[index];
        if (!region.weights.empty() && region.weights.size() != scalp.positions.size())
            throw fail("the region '{}' has {} weights, but the scalp {} vertices", shown(region.name),
                       region.weights.size(), scalp.positions.size());
        if (!region.group.empty() && !scalp.groups.contains(region.group))
        {
            std::string names;
            for (const auto& [name, vertices] : scalp.groups)
                names += (names.empty() ? "" : ", ") + shown(name);
            throw fail("the region '{}' names the group '{}', but the scalp's are: {}", shown(region.name),
                       shown(region.group), names.empty() ? "none" : names);
        }
        const HairParams params;
        const Shaping shaping = shape_over(params, host, scalp, scalp);
        for (size_t v = 0; v < scalp.positions.size(); ++v)
            if (region_weight(shaping, index, at_vertex(scalp, v)) > 0.0f)
                return;
        throw fail("the region '{}' selects none of the scalp's vertices", shown(region.name));
    }
}

} // namespace coif

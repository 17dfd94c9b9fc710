#include "app/brush.h"

#include "sim/shaping.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace coif
{

const char* brush_name(BrushKind kind)
{
    static const char* const names[kBrushKinds] = {"comb",  "length", "lift",   "wave", "density",
                                                   "color", "region", "smooth", "erase"};
    return names[int(kind)];
}

const char* brush_help(BrushKind kind)
{
    static const char* const help[kBrushKinds] = {
        "Turns roots and bends strands the way the brush goes.",
        "Grows or cuts strands to this length.",
        "Lifts roots off the scalp, or lays them down, to this angle.",
        "Lays waves of this height on straight or wavy hair.",
        "Thins hair out to this share, or lets it grow back.",
        "Dyes roots, tips or both.",
        "Makes roots a part of a region, or no part of it.\nWhat a region changes is set in the panel.",
        "Evens out what brushes have painted, but for regions.",
        "Takes away what brushes have painted, but for regions.",
    };
    return help[int(kind)];
}

float brush_weight(const Brush& brush, glm::vec3 at, glm::vec3 root)
{
    const float share = glm::distance(at, root) / std::max(brush.radius, 1e-6f);
    const float inner = 1.0f - brush.falloff;
    return share >= 1.0f ? 0.0f : brush.strength * (1.0f - glm::smoothstep(std::min(inner, 0.999f), 1.0f, share));
}

// The map of a parameter that brushes paint: the style's, or a fresh one that changes nothing.
static ScalpMap& painted_map(Hairstyle& style, const char* of, const Scalp& scalp)
{
    const ParamInfo& info = *find_param(of);
    const bool color = info.kind == Kind::COLOR;
    const int how = color ? MAP_OVER : MAP_OFFSET;
    for (ScalpMap& map : style.host.maps)
        if (map.of == of && map.how == how)
            return map;
    return style.host.maps.emplace_back(
        ScalpMap{of, how, std::vector<float>(scalp.positions.size() * (color ? 4 : 1), 0.0f), {}});
}

static bool painted(const ScalpMap& map)
{
    for (size_t i = 0; i < map.values.size(); ++i)
        if ((map.how != MAP_OVER || i % 4 == 3) && map.values[i] != (map.how == MAP_FACTOR ? 1.0f : 0.0f))
            return true;
    return false;
}

// Moves a number, as it is at each vertex, towards what `aim_at` says of that vertex.
template <typename Aim>
static bool paint_number(Hairstyle& style, const char* of, const Scalp& scalp, const std::vector<float>& weights,
                         Aim aim_at)
{
    ScalpMap& map = painted_map(style, of, scalp);
    const ParamInfo& info = *find_param(of);
    const Shaping shaping = shape_over(style.params, style.host, scalp, scalp);
    const ScalpMap before = map;
    for (size_t v = 0; v < weights.size(); ++v)
    {
        if (weights[v] <= 0.0f)
            continue;
        float now[4];
        get_numbers(params_at(shaping, at_vertex(scalp, v)), info, now);
        // Whole within what can be seen, so that a stroke comes to an end.
        const float span = info.max - info.min;
        const float by = weights[v] * (std::clamp(float(aim_at(v)), info.min, info.max) - now[0]);
        if (std::abs(by) > 1e-6f * span)
            map.values[v] = std::clamp(map.values[v] + by, -1000.0f, 1000.0f);
    }
    return map != before;
}

static bool paint_color(Hairstyle& style, const char* of, const Scalp& scalp, const std::vector<float>& weights,
                        glm::vec3 color)
{
    ScalpMap& map = painted_map(style, of, scalp);
    const ScalpMap before = map;
    for (size_t v = 0; v < weights.size(); ++v)
    {
        const float w = weights[v];
        if (w <= 0.0f)
            continue;
        float* over = &map.values[4 * v];
        // One layer over another: what covers is the sum of what each lets show.
        const float cover = w + over[3] * (1.0f - w);
        for (int i = 0; i < 3; ++i)
            over[i] = (w * color[i] + over[3] * (1.0f - w) * over[i]) / cover;
        over[3] = cover;
    }
    return map != before;
}

bool is_painted_only(const Region& region)
{
    return region.where.empty() && region.planes.empty() && region.group.empty() && !region.invert;
}

// The region of that name, as a painted map. One that is told by a rule stays what it is, as well as vertices can say.
static Region& painted_region(Hairstyle& style, const std::string& name, const Scalp& scalp)
{
    std::vector<Region>& regions = style.host.regions;
    const size_t index = size_t(std::ranges::find(regions, name, &Region::name) - regions.begin());
    if (index == regions.size())
    {
        Region& fresh = regions.emplace_back();
        fresh.name = name;
        fresh.weights.resize(scalp.positions.size(), 0.0f);
    }
    Region& region = regions[index];
    if (region.weights.size() == scalp.positions.size() && is_painted_only(region))
        return region;
    const Shaping shaping = shape_over(style.params, style.host, scalp, scalp);
    std::vector<float> weights;
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        weights.push_back(region_weight(shaping, index, at_vertex(scalp, v)));
    region.weights = weights;
    region.where.clear();
    region.planes.clear();
    region.group.clear();
    region.invert = false;
    return region;
}

static bool paint_region(Hairstyle& style, const Brush& brush, const Scalp& scalp, const std::vector<float>& weights)
{
    const bool there = std::ranges::find(style.host.regions, brush.region, &Region::name) != style.host.regions.end();
    if (brush.region.empty() || (!there && brush.weight <= 0.0f))
        return false;
    const std::vector<Region> before = style.host.regions;
    Region& region = painted_region(style, brush.region, scalp);
    for (size_t v = 0; v < weights.size(); ++v)
    {
        const float by = weights[v] * (std::clamp(brush.weight, 0.0f, 1.0f) - region.weights[v]);
        if (std::abs(by) > 1e-6f)
            region.weights[v] += by;
    }
    return style.host.regions != before;
}

static std::vector<std::vector<unsigned>> neighbors_of(const Scalp& scalp)
{
    std::vector<std::vector<unsigned>> near(scalp.positions.size());
    for (const glm::uvec3& t : scalp.triangles)
        for (int k = 0; k < 3; ++k)
            for (const unsigned other : {t[(k + 1) % 3], t[(k + 2) % 3]})
                if (std::ranges::find(near[t[k]], other) == near[t[k]].end())
                    near[t[k]].push_back(other);
    return near;
}

static bool smooth(Hairstyle& style, const Scalp& scalp, const std::vector<float>& weights)
{
    const auto near = neighbors_of(scalp);
    bool changed = false;
    for (ScalpMap& map : style.host.maps)
    {
        const size_t each = map.values.size() / std::max<size_t>(1, scalp.positions.size());
        const std::vector<float> before = map.values;
        for (size_t v = 0; v < weights.size() && each > 0; ++v)
            for (size_t i = 0; i < each && weights[v] > 0.0f && !near[v].empty(); ++i)
            {
                float mean = 0.0f;
                for (const unsigned n : near[v])
                    mean += before[n * each + i] / float(near[v].size());
                map.values[v * each + i] += weights[v] * (mean - before[v * each + i]);
            }
        changed |= map.values != before;
    }
    return changed;
}

static bool erase(Hairstyle& style, const std::vector<float>& weights)
{
    bool changed = false;
    for (ScalpMap& map : style.host.maps)
    {
        const float none = map.how == MAP_FACTOR ? 1.0f : 0.0f;
        const size_t each = map.values.size() / std::max<size_t>(1, weights.size());
        for (size_t v = 0; v < weights.size() && each > 0; ++v)
            for (size_t i = each == 4 ? 3 : 0; i < each; ++i)
            {
                float& value = map.values[v * each + i];
                const float before = value;
                value += weights[v] * (none - value);
                value = std::abs(value - none) < 1e-4f ? none : value;
                changed |= value != before;
            }
    }
    std::erase_if(style.host.maps, [](const ScalpMap& map) { return !painted(map); });
    return changed;
}

// The style's rest shape, or else the shapes that it rests in now; none where they are of another scalp.
static std::optional<StrandShapes> rest_of(const Hairstyle& style, const Scalp& scalp, const StrandShapes& now)
{
    const auto& own = style.host.groom_rest.shapes;
    if (own && size_t(own->strands()) == scalp.positions.size())
        return *own;
    if (size_t(now.strands()) == scalp.positions.size())
        return now;
    return std::nullopt;
}

static void keep_rest(Hairstyle& style, StrandShapes shapes)
{
    style.host.groom_rest = {style.host.groom_rest.file, std::make_shared<const StrandShapes>(std::move(shapes))};
}

// Gives a strand's segments other directions, by number from the root and as they are.
template <typename Turn> static void turn_segments(glm::vec3* p, size_t nodes, Turn turn)
{
    std::vector<glm::vec3> segments;
    for (size_t k = 1; k < nodes; ++k)
        segments.push_back(turn(k - 1, p[k] - p[k - 1]));
    p[0] = p[1] - segments[0];
    for (size_t k = 2; k < nodes; ++k)
        p[k] = p[k - 1] + segments[k - 1];
}

// Outer nodes turn less than roots.
static float fade_along(size_t segment, size_t nodes) { return 1.0f - 0.6f * float(segment) / float(nodes); }

// Turns each strand about its root's normal so that it goes where the brush goes; on the line between two mirrored
// halves, to neither side.
static bool comb(Hairstyle& style, const Scalp& scalp, const StrandShapes& rest, const std::vector<float>& weights,
                 glm::vec3 way_of_brush, bool mirror)
{
    const float way = glm::length(way_of_brush);
    std::optional<StrandShapes> shapes = rest_of(style, scalp, rest);
    if (!(way > 1e-5f) || !shapes)
        return false;
    const size_t nodes = size_t(shapes->nodes);
    bool changed = false;
    for (size_t v = 0; v < weights.size(); ++v)
    {
        const bool middle = mirror && std::abs(scalp.positions[v].x) < 1e-4f;
        const glm::vec3 along = way_of_brush * glm::vec3(middle ? 0.0f : 1.0f, 1.0f, 1.0f);
        const glm::vec3 n = scalp.normals[v], flat_way = along - n * glm::dot(along, n);
        if (weights[v] <= 0.0f || !(glm::length(flat_way) > 0.1f * way))
            continue;
        const glm::vec3 aim = glm::normalize(flat_way);
        // A stroke of two centimetres turns a strand all the way.
        const float share = std::min(1.0f, weights[v] * way / 0.02f);
        turn_segments(&shapes->position[v * nodes], nodes,
                      [&](size_t k, glm::vec3 segment)
                      {
                          const glm::vec3 flat = segment - n * glm::dot(segment, n);
                          const float size = glm::length(segment), level = glm::length(flat);
                          if (!(size > 1e-9f))
                              return segment;
                          const glm::vec3 from = level > 0.05f * size ? flat / level : 0.2f * aim;
                          const float by = share * fade_along(k, nodes);
                          const glm::vec3 to = glm::mix(from, aim, by);
                          if (!(glm::length(to) > 1e-6f))
                              return segment;
                          // Upright ones are laid over by and by; the others turn in the plane of the scalp.
                          const float lean = std::atan2(level, glm::dot(segment, n)), laid = glm::radians(75.0f);
                          const float leant = lean + 0.5f * by * std::max(0.0f, laid - lean);
                          return size * (n * std::cos(leant) + glm::normalize(to) * std::sin(leant));
                      });
        changed = true;
    }
    if (changed)
        keep_rest(style, std::move(*shapes));
    return changed;
}

// Lifts strands that have a rest shape, as root.lift (deg) does with the others.
static bool lift_rest(Hairstyle& style, const Scalp& scalp, const std::vector<float>& weights, float lift)
{
    StrandShapes shapes = *style.host.groom_rest.shapes;
    const size_t nodes = size_t(shapes.nodes);
    bool changed = false;
    for (size_t v = 0; v < weights.size(); ++v)
    {
        glm::vec3* p = &shapes.position[v * nodes];
        const glm::vec3 n = scalp.normals[v], first = p[1] - p[0], flat = first - n * glm::dot(first, n);
        if (weights[v] <= 0.0f || !(glm::length(flat) > 1e-3f * glm::length(first)))
            continue;
        const float now = std::atan2(glm::length(flat), glm::dot(first, n));
        const float by = weights[v] * (glm::radians(lift) - now);
        const glm::vec3 axis = glm::normalize(glm::cross(n, flat));
        turn_segments(p, nodes,
                      [&](size_t k, glm::vec3 segment)
                      { return glm::angleAxis(by * fade_along(k, nodes), axis) * segment; });
        changed |= std::abs(by) > 1e-4f;
    }
    if (changed)
        keep_rest(style, std::move(shapes));
    return changed;
}

bool apply_brush(Hairstyle& style, const Scalp& scalp, const StrandShapes& shapes, const Brush& brush,
                 const Touch& touch)
{
    const auto all = [](float aim) { return [aim](size_t) { return aim; }; };
    bool changed = false;
    for (const float side : {1.0f, -1.0f})
    {
        if (side < 0.0f && !brush.mirror)
            break;
        const glm::vec3 mirrored(side, 1.0f, 1.0f);
        std::vector<float> weights;
        const bool right = (touch.at.x < 0.0f) == (side > 0.0f); // the half that this touch is on
        for (const glm::vec3& root : scalp.positions)
            weights.push_back(
                brush.mirror && (root.x < 0.0f) != right ? 0.0f : brush_weight(brush, touch.at * mirrored, root));
        if (std::ranges::all_of(weights, [](float w) { return w <= 0.0f; }))
            continue;
        switch (brush.kind)
        {
        case BrushKind::COMB:
            changed |= comb(style, scalp, shapes, weights, touch.along * mirrored, brush.mirror);
            break;
        case BrushKind::LENGTH:
            changed |= paint_number(style, "strand.length", scalp, weights, all(brush.length));
            break;
        case BrushKind::LIFT:
            if (style.host.groom_rest.shapes && rest_of(style, scalp, {}))
                changed |= lift_rest(style, scalp, weights, brush.lift);
            else
                changed |= paint_number(style, "root.lift", scalp, weights, all(brush.lift));
            break;
        case BrushKind::WAVE:
            changed |= paint_number(style, "wave.normal_amplitude", scalp, weights, all(brush.wave));
            changed |= paint_number(style, "wave.binormal_amplitude", scalp, weights, all(brush.wave));
            break;
        case BrushKind::DENSITY:
            changed |= paint_number(style, "interpolation.density", scalp, weights, all(brush.density));
            break;
        case BrushKind::COLOR:
            if (brush.color_of != 1)
                changed |= paint_color(style, "look.root_color", scalp, weights, brush.color);
            if (brush.color_of != 0)
                changed |= paint_color(style, "look.tip_color", scalp, weights, brush.color);
            break;
        case BrushKind::REGION:
            changed |= paint_region(style, brush, scalp, weights);
            break;
        case BrushKind::SMOOTH:
            changed |= smooth(style, scalp, weights);
            break;
        case BrushKind::ERASE:
            changed |= erase(style, weights);
            break;
        }
    }
    return changed;
}

bool cut_at_plane(Hairstyle& style, const Scalp& scalp, const StrandShapes& shapes, glm::vec3 n, float d)
{
    if (size_t(shapes.strands()) != scalp.positions.size())
        return false;
    const size_t nodes = size_t(shapes.nodes);
    std::vector<float> cut(scalp.positions.size(), 0.0f), lengths = cut; // 1 where there is a cut; m
    for (size_t v = 0; v < scalp.positions.size(); ++v)
    {
        const glm::vec3* p = &shapes.position[v * nodes];
        for (size_t k = 2; k < nodes && cut[v] == 0.0f; ++k)
        {
            const float before = glm::dot(n, p[k - 1]) - d, after = glm::dot(n, p[k]) - d;
            const bool beyond = after > 0.0f;
            cut[v] = beyond ? 1.0f : 0.0f;
            lengths[v] +=
                glm::distance(p[k], p[k - 1]) * (beyond ? std::clamp(before / (before - after), 0.0f, 1.0f) : 1.0f);
        }
    }
    if (std::ranges::none_of(cut, [](float c) { return c > 0.0f; }))
        return false;
    return paint_number(style, "strand.length", scalp, cut, [&](size_t v) { return lengths[v]; });
}

void pick_value(Brush& brush, const Hairstyle& style, const Scalp& scalp, glm::vec3 at)
{
    size_t nearest = 0;
    for (size_t v = 1; v < scalp.positions.size(); ++v)
        if (glm::distance(scalp.positions[v], at) < glm::distance(scalp.positions[nearest], at))
            nearest = v;
    const Shaping shaping = shape_over(style.params, style.host, scalp, scalp);
    const HairParams p = params_at(shaping, at_vertex(scalp, nearest));
    for (size_t r = 0; r < style.host.regions.size(); ++r) // the last one has the last word on the hair too
        if (region_weight(shaping, r, at_vertex(scalp, nearest)) > 0.5f)
            brush.region = style.host.regions[r].name;
    brush.length = p.strand_length;
    brush.lift = p.root_lift;
    brush.wave = p.wave_normal_amplitude;
    brush.density = p.interpolation_density;
    const float4& color = brush.color_of == 1 ? p.look_tip_color : p.look_root_color;
    brush.color = {color.x, color.y, color.z};
}

} // namespace coif

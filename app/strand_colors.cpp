#include "app/strand_colors.h"

#include "sim/scatter.h"
#include "sim/shaping.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

enum Colors // as render.colors lists them
{
    HAIR,
    STRETCH,
    DENSITY,
    KIND,
    REGION,
    MAP
};

glm::vec3 ramp_color(float value)
{
    static const glm::vec3 stops[] = {{0.030f, 0.045f, 0.240f},
                                      {0.010f, 0.240f, 0.420f},
                                      {0.080f, 0.480f, 0.300f},
                                      {0.900f, 0.720f, 0.090f},
                                      {0.760f, 0.060f, 0.030f}};
    const float at = 4.0f * std::clamp(value, 0.0f, 1.0f);
    const int below = std::min(int(at), 3);
    return glm::mix(stops[below], stops[below + 1], at - float(below));
}

std::vector<float> guide_stretch(const Simulation& simulation, const float* guides)
{
    const Groom& groom = simulation.solver().groom();
    std::vector<float> stretch(size_t(groom.guides) * size_t(groom.nodes), 0.0f);
    for (int g = 0; g < groom.guides; ++g)
    {
        const double rest = double(groom.segment_length[size_t(g)]) * double(simulation.params().strand_spacing);
        for (int k = 2; k < groom.nodes; ++k)
        {
            const double length =
                glm::distance(vector_at(guides, g, k, groom.nodes), vector_at(guides, g, k - 1, groom.nodes));
            const double by = std::abs(length / rest - 1.0);
            stretch[size_t(g) * size_t(groom.nodes) + size_t(k)] = std::isfinite(by) ? float(by) : 1e9f;
        }
    }
    return stretch;
}

// A drawn strand is stretched as the guides that it is made of, each up to where it is cut.
static void tell_stretch(StrandColors& colors, const Simulation& simulation, const Mapped& guides)
{
    const Groom& groom = simulation.solver().groom();
    const std::vector<float> stretch = guide_stretch(simulation, guides.as<float>());
    const float worst = stretch.empty() ? 0.0f : *std::ranges::max_element(stretch);
    float top = 0.001f; // the scale ends at the power of ten that holds the worst
    while (top < worst && top < 1.0f)
        top *= 10.0f;
    const auto at = [&](int guide, float node)
    {
        const int below = std::clamp(int(node), 0, groom.nodes - 2);
        const float* values = &stretch[size_t(guide) * size_t(groom.nodes) + size_t(below)];
        return glm::mix(values[0], values[1], std::clamp(node - float(below), 0.0f, 1.0f));
    };
    for (size_t s = 0; s < groom.drawn.size(); ++s)
    {
        const DrawnStrand& strand = groom.drawn[s];
        const bool mixed = int(s) < groom.drawn_multi;
        for (int k = 0; k < groom.nodes; ++k)
        {
            const float node = 1.0f + float(k - 1) * strand.root.w;
            const float value = mixed ? strand.weights.x * at(strand.guide0, node) +
                                            strand.weights.y * at(strand.guide1, node) +
                                            strand.weights.z * at(strand.guide2, node)
                                      : at(strand.guide0, node);
            colors.value.push_back(std::clamp(value / top, 0.0f, 1.0f));
        }
    }
    colors.title = "stretch of the strands";
    colors.readings = {"0 %", fmt::format("{:.4g} %", 50.0f * top), fmt::format("{:.4g} %", 100.0f * top)};
}

// Metres of drawn strands in a cubic centimetre, from a grid of its own: every node adds its segment to the eight cells
// about it, and reads them again.
static void tell_density(StrandColors& colors, const Groom& groom, const float4* nodes)
{
    constexpr float kCell = 0.01f; // m
    constexpr int kMostCells = 128;
    const size_t count = groom.drawn.size() * size_t(groom.nodes);
    glm::vec3 low(INFINITY), high(-INFINITY);
    const auto point = [&](size_t i) { return glm::vec3(nodes[i].x, nodes[i].y, nodes[i].z); };
    const auto finite = [&](size_t i) { return std::isfinite(nodes[i].x + nodes[i].y + nodes[i].z); };
    for (size_t i = 0; i < count; ++i)
        if (finite(i))
        {
            low = glm::min(low, point(i));
            high = glm::max(high, point(i));
        }
    const glm::vec3 size = high - low;
    const float cell = std::max(kCell, std::max({size.x, size.y, size.z}) / float(kMostCells - 4));
    const glm::ivec3 cells = count ? glm::ivec3(size / cell) + 3 : glm::ivec3(1);
    std::vector<float> grid(size_t(cells.x) * size_t(cells.y) * size_t(cells.z), 0.0f);
    const auto each_corner = [&](size_t i, auto&& act)
    {
        const glm::vec3 at = (point(i) - low) / cell + 0.5f, floor = glm::floor(at), f = at - floor;
        for (int corner = 0; corner < 8; ++corner)
        {
            const glm::ivec3 up(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::ivec3 c = glm::ivec3(floor) + up;
            const glm::vec3 share = glm::mix(1.0f - f, f, glm::vec3(up));
            act(grid[size_t(c.x) + size_t(cells.x) * (size_t(c.y) + size_t(cells.y) * size_t(c.z))],
                share.x * share.y * share.z);
        }
    };
    for (size_t i = 0; i < count; ++i)
        if (i % size_t(groom.nodes) > 1 && finite(i) && finite(i - 1))
            each_corner(i, [&, length = glm::distance(point(i), point(i - 1))](float& value, float share)
                        { value += share * length; });
    const float volume = std::pow(100.0f * cell, 3.0f); // of a cell, cm^3
    float most = 0.0f;
    colors.value.assign(count, 0.0f);
    for (size_t i = 0; i < count; ++i)
        if (finite(i))
        {
            each_corner(i, [&](float& value, float share) { colors.value[i] += share * value / volume; });
            most = std::max(most, colors.value[i]);
        }
    for (float& value : colors.value)
        value = most > 0.0f ? value / most : 0.0f;
    colors.title = "metres of strand in a cm\xc2\xb3";
    colors.readings = {"0", fmt::format("{:.2g}", 0.5f * most), fmt::format("{:.2g}", most)};
}

static void tell_kind(StrandColors& colors, const Groom& groom)
{
    for (size_t s = 0; s < groom.drawn.size(); ++s)
        colors.value.insert(colors.value.end(), size_t(groom.nodes),
                            int(s) < groom.drawn_multi ? kMixedPlace : kCopyPlace);
    colors.title = "drawn strands";
    colors.readings = {"mixed of three guides", "copies of one"};
}

// A style over its scalp, as its guides stand on it.
template <typename Tell> static void tell_of_roots(StrandColors& colors, const Simulation& simulation, Tell tell)
{
    const Scalp scalp = guide_scalp(simulation.assets().scalp, simulation.params());
    const Shaping shaping = shape_over(simulation.params(), simulation.style().host, simulation.assets().scalp, scalp);
    std::vector<float> of_guide;
    for (size_t g = 0; g < scalp.positions.size(); ++g)
        of_guide.push_back(tell(shaping, at_vertex(scalp, g)));
    const Groom& groom = simulation.solver().groom();
    for (const DrawnStrand& strand : groom.drawn) // as the guide that it follows most
        colors.value.insert(colors.value.end(), size_t(groom.nodes), of_guide.at(size_t(strand.guide0)));
}

// The last region that each root belongs to more than not.
static void tell_region(StrandColors& colors, const Simulation& simulation)
{
    const std::vector<Region>& regions = simulation.style().host.regions;
    const bool one = regions.size() == 1; // two sorts, as kinds are
    const auto place = [&](size_t of)     // 0: none
    { return one ? (of ? kCopyPlace : kMixedPlace) : float(of) / float(std::max<size_t>(1, regions.size())); };
    tell_of_roots(colors, simulation,
                  [&](const Shaping& shaping, const ScalpPlace& root)
                  {
                      size_t last = 0;
                      for (size_t r = 0; r < regions.size(); ++r)
                          last = region_weight(shaping, r, root) > 0.5f ? r + 1 : last;
                      return place(last);
                  });
    colors.title = "regions";
    colors.readings = {"none"};
    for (const Region& region : regions)
        colors.readings.push_back(region.name);
    if (regions.empty())
        colors.readings.push_back("none");
}

// The newest map, from its least value to its greatest.
static void tell_map(StrandColors& colors, const Simulation& simulation)
{
    const std::vector<ScalpMap>& maps = simulation.style().host.maps;
    const bool color = !maps.empty() && maps.back().how == MAP_OVER; // then: how far it covers
    std::vector<float> values;
    tell_of_roots(colors, simulation,
                  [&](const Shaping& shaping, const ScalpPlace& root)
                  {
                      if (maps.empty())
                          return 0.0f;
                      const std::vector<float>& all = shaping.map_values.back();
                      values.push_back(color ? all[4 * root.corners.x + 3] : all[root.corners.x]);
                      return values.back();
                  });
    const auto [low, high] = std::ranges::minmax_element(values);
    const float least = values.empty() ? 0.0f : *low, span = values.empty() ? 0.0f : *high - least;
    for (float& value : colors.value)
        value = span > 0.0f ? (value - least) / span : 0.0f;
    colors.title = maps.empty() ? "no map yet" : "map of " + maps.back().of;
    colors.readings = {fmt::format("{:.3g}", least), fmt::format("{:.3g}", least + 0.5f * span),
                       fmt::format("{:.3g}", least + span)};
}

StrandColors strand_colors(const Simulation& simulation, const Mapped& drawn, const Mapped& guides)
{
    StrandColors colors;
    const Groom& groom = simulation.solver().groom();
    switch (simulation.params().render_colors)
    {
    case STRETCH:
        tell_stretch(colors, simulation, guides);
        break;
    case DENSITY:
        tell_density(colors, groom, drawn.as<float4>());
        break;
    case KIND:
        tell_kind(colors, groom);
        break;
    case REGION:
        tell_region(colors, simulation);
        break;
    case MAP:
        tell_map(colors, simulation);
        break;
    default:
        break;
    }
    return colors;
}

} // namespace coif

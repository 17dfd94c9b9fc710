// What a style's regions, maps and partings make of its parameters at one place of the scalp.
#pragma once
#include "sim/mesh.h"
#include "sim/params.h"

#include <cstdint>
#include <vector>

namespace coif
{

// A place on a scalp: between three of its vertices, in these shares (whose sum is 1).
struct ScalpPlace
{
    glm::vec3 point{0.0f}; // in the scalp's own units, m before head.scale
    glm::uvec3 corners{0};
    glm::vec3 shares{1.0f, 0.0f, 0.0f};
};

// A style over its scalp, ready to be asked. It refers to what it was made of.
struct Shaping
{
    const HairParams& params;
    const HostParams& host;
    const Scalp& scalp;                             // as refined
    std::vector<const ParamInfo*> map_of;           // what each map is of
    std::vector<std::vector<float>> map_values;     // of each map, vertex by vertex
    std::vector<std::vector<float>> region_weights; // of each region that is painted or a group; else empty
};

// Has this style anything that varies over the scalp, or parts it?
bool varies(const HostParams& host);

// Throws Error, without a place, for the entry `info`[`index`] of the lists that does not fit this scalp: a map of the
// wrong size, a region that selects none of its vertices, a group that it has not.
void check_entry(const HostParams& host, const ParamInfo& info, size_t index, const Scalp& scalp);

// `authored` is the scalp that maps speak of, `scalp` the same refined.
Shaping shape_over(const HairParams& params, const HostParams& host, const Scalp& authored, const Scalp& scalp);

ScalpPlace at_vertex(const Scalp& scalp, size_t vertex);

// How far a place belongs to a region, 0 to 1.
float region_weight(const Shaping& shaping, size_t region, const ScalpPlace& place);

// The parameters there, as authored: the style's, then what its regions say in their order, then the maps.
HairParams params_at(const Shaping& shaping, const ScalpPlace& place);

// Which hard regions a place belongs to, and on which side of each parting it lies. Hair of two places that differ in
// the former or lie across from each other is never mixed.
struct Sides
{
    uint64_t regions = 0, left = 0, right = 0; // a bit each
};
Sides sides_at(const Shaping& shaping, const ScalpPlace& place);
inline bool may_mix(const Sides& a, const Sides& b)
{
    return a.regions == b.regions && (a.left & b.right) == 0 && (a.right & b.left) == 0;
}

// The way along the scalp that hair goes at a place with this normal, where it would go `flow` without partings: away
// from the nearest line, the more the nearer.
glm::vec3 parted_flow(const Shaping& shaping, glm::vec3 point, glm::vec3 normal, glm::vec3 flow);

} // namespace coif

// The [[tables]] of a hairstyle: what an entry of each holds, and its fields, declared once. Reader, writer and panel
// walk fields(); `Entry` is const for those that only look.
#pragma once
#include "sim/tie.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <concepts>
#include <optional>
#include <string>
#include <vector>

namespace coif
{

struct ParamInfo;

// A sphere or a capsule that hair slides over.
struct Collider
{
    glm::vec3 center{0.0f};           // m, in the head's frame or in the world
    float radius = 0.05f;             // m
    bool on_head = false;             // moves with the head
    std::optional<glm::vec3> to = {}; // a capsule's second end; a sphere has none
    bool operator==(const Collider&) const = default;
};

// A parameter's numbers, as authored.
struct Setting
{
    const ParamInfo* info = nullptr;
    glm::vec4 value{0.0f};
    bool operator==(const Setting&) const = default;
};

// A part of the scalp, by rule, with values of its own. A root belongs to it as far as each of its rules says so.
struct Region
{
    std::string name;
    std::vector<std::string> where; // named parts of a head, region_areas()
    std::vector<glm::vec4> planes;  // n, d: the half-space n . p >= d of the head's frame, m
    std::string group;              // of the scalp's OBJ
    std::vector<float> weights;     // painted, 0 to 1: one for each vertex of the scalp
    std::string file;               // beside the style, where they lie if they are many
    bool invert = false;            // all but that
    float edge = 0.01f;             // m over which it fades; 0: hard, and no drawn strand mixes guides across it
    std::vector<Setting> settings;
    bool operator==(const Region&) const = default;
};

// A line on the scalp that hair is combed away from, to both sides. No drawn strand mixes guides across it.
struct Parting
{
    std::vector<glm::vec3> points; // along the scalp in the head's frame, m
    float reach = 0.06f;           // m from the line to where hair goes its own way
    bool operator==(const Parting&) const = default;
};

// What one parameter is multiplied with, moved by or covered with, vertex by vertex of the scalp.
struct ScalpMap
{
    std::string of; // a parameter that may vary over the scalp
    int how = 0;
    std::vector<float> values; // one a vertex, of a colour four: sRGB and how far it covers
    std::string file;          // beside the style, where the values lie if they are many
    bool operator==(const ScalpMap&) const = default;
};
enum MapKind
{
    MAP_FACTOR,
    MAP_OFFSET,
    MAP_OVER // colours
};

// One that is so far away that it comes from one direction.
struct Light
{
    std::string name;
    glm::vec3 direction{0.45f, 0.75f, 0.6f}; // towards it, in the world; of any length but 0
    glm::vec3 color{1.0f};                   // sRGB
    float irradiance = 2.6f;                 // of a surface that faces it: white is then as bright as this over pi
    float angle = 0.0f;                      // deg: radius of its disc in the sky
    bool operator==(const Light&) const = default;
};
constexpr size_t kMostLights = 16; // each costs a sweep through the hair

// The light from all around, of a file of lights: a style says its own as look.sky_*.
struct Sky
{
    glm::vec3 color{1.0f}; // sRGB
    float radiance = 0.0f; // how bright a white wall is in it
    bool operator==(const Sky&) const = default;
};

// As kernels/params.def calls them.
using light_entry = Light;
using collider_entry = Collider;
using region_entry = Region;
using parting_entry = Parting;
using map_entry = ScalpMap;
using tie_entry = Tie;

// What a number of an entry may be.
struct Limits
{
    float min, max;
    const char* unit;
};
constexpr Limits kPlaces = {-100.0f, 100.0f, "m"};
constexpr bool kNeeded = true;

template <typename Visitor, typename Entry>
requires std::same_as<std::remove_const_t<Entry>, Collider>
void fields(Visitor& visit, Entry& entry)
{
    visit.point("center", entry.center, kPlaces, kNeeded);
    visit.optional_point("to", entry.to, kPlaces);
    visit.number("radius", entry.radius, Limits{0.001f, 100.0f, "m"}, kNeeded);
    visit.choice("on", entry.on_head, "world|head");
}

template <typename Visitor, typename Entry>
requires std::same_as<std::remove_const_t<Entry>, Region>
void fields(Visitor& visit, Entry& entry)
{
    visit.text("name", entry.name, kNeeded);
    visit.texts("where", entry.where);
    visit.planes("planes", entry.planes, kPlaces);
    visit.text("group", entry.group);
    visit.numbers("weights", entry.weights, Limits{0.0f, 1.0f, ""});
    visit.text("file", entry.file);
    visit.flag("invert", entry.invert);
    visit.number("edge", entry.edge, Limits{0.0f, 1.0f, "m"});
    visit.settings(entry.settings);
}

template <typename Visitor, typename Entry>
requires std::same_as<std::remove_const_t<Entry>, Parting>
void fields(Visitor& visit, Entry& entry)
{
    visit.points("points", entry.points, kPlaces);
    visit.number("reach", entry.reach, Limits{0.001f, 1.0f, "m"});
}

template <typename Visitor, typename Entry>
requires std::same_as<std::remove_const_t<Entry>, Light>
void fields(Visitor& visit, Entry& entry)
{
    visit.text("name", entry.name);
    visit.point("direction", entry.direction, Limits{-1.0f, 1.0f, ""}, kNeeded);
    visit.color("color", entry.color);
    visit.number("irradiance", entry.irradiance, Limits{0.0f, 100.0f, ""});
    visit.number("angle", entry.angle, Limits{0.0f, 60.0f, "deg"});
}

template <typename Visitor, typename Entry>
requires std::same_as<std::remove_const_t<Entry>, Sky>
void fields(Visitor& visit, Entry& entry)
{
    visit.color("color", entry.color);
    visit.number("radiance", entry.radiance, Limits{0.0f, 100.0f, ""}, kNeeded);
}

template <typename Visitor, typename Entry>
requires std::same_as<std::remove_const_t<Entry>, ScalpMap>
void fields(Visitor& visit, Entry& entry)
{
    visit.text("of", entry.of, kNeeded);
    visit.choice("how", entry.how, "factor|offset|over");
    visit.numbers("values", entry.values, Limits{-1000.0f, 1000.0f, ""});
    visit.text("file", entry.file);
}

template <typename Visitor, typename Entry>
requires std::same_as<std::remove_const_t<Entry>, Tie>
void fields(Visitor& visit, Entry& entry)
{
    visit.text("name", entry.name);
    visit.point("at", entry.at, kPlaces);
    visit.point("axis", entry.axis, kPlaces);
    visit.texts("regions", entry.regions);
    visit.number("radius", entry.radius, Limits{0.002f, 0.2f, "m"});
    visit.number("puff", entry.puff, Limits{0.0f, 0.05f, "m"});
    visit.number("flare", entry.flare, Limits{0.0f, 60.0f, "deg"});
    visit.number("fullness", entry.fullness, Limits{0.2f, 10.0f, ""});
    visit.number("cohesion", entry.cohesion, Limits{0.0f, 1.0f, ""});
    visit.number("thickness", entry.thickness, Limits{0.0005f, 0.05f, "m"});
    visit.color("color", entry.color);
    visit.flag("braid", entry.braid);
    visit.number("braid_width", entry.braid_width, Limits{0.004f, 0.3f, "m"});
    visit.number("braid_pitch", entry.braid_pitch, Limits{0.01f, 1.0f, "m"});
}

// Does a direction say where to? A shorter one is lost in rounding.
bool points_somewhere(const glm::vec3& direction);

// Entries that a list may have, wherever they come from.
size_t most_entries(const ParamInfo& list);

// The named parts of a head that Region::where may say.
const std::vector<std::string>& region_areas();

} // namespace coif

// Ties: hair gathered through rings, as pony tails, bunches and braids are.
#pragma once
#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace coif
{

// A ring that hair of the head runs through: over the scalp to it, held, and free behind it.
struct Tie
{
    std::string name;
    std::vector<std::string> regions;    // whose hair it gathers; none: that of the whole scalp
    glm::vec3 at{0.0f, 0.07f, -0.105f};  // middle of the ring, in the head's frame, m, before head.scale
    glm::vec3 axis{0.0f, 0.2f, -1.0f};   // the way the hair leaves it; any length but zero
    float radius = 0.012f;               // of the ring, m
    float puff = 0.008f;                 // height at which hair that comes from furthest runs over the head, m
    float flare = 12.0f;                 // how far the outermost hair leans out behind the ring, deg
    float fullness = 2.0f;               // width of the tail where it is widest, in rings
    float cohesion = 0.7f;               // how far drawn hair keeps its place in the tail: 0 every strand for itself
    float thickness = 0.004f;            // of the ring itself, m
    glm::vec3 color{0.16f, 0.14f, 0.2f}; // of the ring, sRGB
    bool braid = false;                  // three plaits, woven from the ring on
    float braid_width = 0.034f;          // m
    float braid_pitch = 0.075f;          // m along the braid in which a plait goes over and back

    bool operator==(const Tie&) const = default;
};

} // namespace coif

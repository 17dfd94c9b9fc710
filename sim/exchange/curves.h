// Hair as it leaves and enters coif through files of other tools.
#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace coif
{

// Curves one after another, roots first, in coif's own frame: metres, y up, right handed. What a file or a pose does
// not know is empty; everything else is as long as its comment says.
struct Curves
{
    std::vector<uint32_t> count;     // [strand] points, at least 2
    std::vector<glm::vec3> position; // [point] m
    std::vector<float> width;        // [point] diameter, m
    std::vector<glm::vec3> color;    // [point] linear RGB
    std::vector<float> brightness;   // [strand] that its colours have been multiplied with
    std::vector<glm::vec2> root_uv;  // [strand] on the scalp, v up
    std::vector<int32_t> id;         // [strand]
    std::vector<uint8_t> guide;      // [strand] 1: simulated, 0: drawn
    std::vector<int32_t> group;      // [strand] index into `group_name`
    std::vector<std::string> group_name;

    size_t strands() const { return count.size(); }
    size_t points() const { return position.size(); }
};

} // namespace coif

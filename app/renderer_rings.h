#pragma once
#include <glm/vec3.hpp>

#include <vector>

namespace coif
{

struct FrameInput;

struct Band // a ring of cloth, m
{
    glm::vec3 center, axis;
    float radius, thickness;
};

struct Ring
{
    Band band;
    glm::vec3 color; // linear
    bool on_head;    // in the head's frame; else in the world's axes about its origin
};

// Those of the style's ties, and at the ends of their braids.
std::vector<Ring> rings_of(const FrameInput& frame);

// Corners of a band, seven floats each: position, normal and a 0.
std::vector<float> corners_of(const Band& band);
std::vector<glm::uvec3> band_triangles(); // between them

} // namespace coif

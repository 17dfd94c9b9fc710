// The solid things in a picture beside the head's mesh itself: how far the scalp's hair colours it, and the bands that
// gather hair.
#pragma once
#include "app/renderer.h"

#include <glm/vec3.hpp>

#include <vector>

namespace coif
{

// Of each vertex of the head's mesh the share that lies under the roots: within 4 mm of the scalp wholly, fading out at
// 14. Parameters as authored.
std::vector<float> shares_of_roots(const Assets& assets, const HairParams& params);

// A ring of cloth that hair runs through.
struct Band
{
    std::vector<glm::vec3> position, normal; // m
    glm::vec3 albedo;                        // linear
    bool on_head;                            // in the head's frame, else in the world's axes about the head's origin
};
// Those of the ties and of the ends of braids. All have the same triangles.
std::vector<Band> bands_of(const FrameInput& frame);
std::vector<glm::uvec3> band_triangles();

} // namespace coif

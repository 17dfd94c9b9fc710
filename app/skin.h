// The skin of a head's mesh as places that light is followed from: fewer than its vertices, and spread by area however
// it is cut into triangles.
#pragma once
#include "kernels/look.h"
#include "sim/simulation.h"

#include <vector>

namespace coif
{

struct SkinPlace
{
    glm::vec3 at{0.0f}; // m, in the head's frame, as it is scaled and offset there
    glm::vec3 normal{0.0f};
    float roots = 0.0f; // how much of it hair grows on
};

constexpr int kSkinPlaces = 2048; // a square centimetre each on a head

// The same for equal meshes and parameters; `roots` are those of shares_of_roots(). None where there is no mesh.
std::vector<SkinPlace> skin_places(const Assets& assets, const HairParams& params, const std::vector<float>& roots);

// As they are now, relative to the head's origin and without gloss. `params`: as the device reads them.
std::vector<LookSurface> skin_now(const std::vector<SkinPlace>& places, const HairParams& params,
                                  const glm::dquat& turn);

// One point for all that lies in each voxel of a volume: their mean. `in_voxel`: which it is of each voxel's; -1: none.
struct SkinInVoxels
{
    std::vector<LookSurface> points;
    std::vector<cl_int> in_voxel;
};
SkinInVoxels skin_in_voxels(const std::vector<LookSurface>& skin, const LookVolume& volume);

} // namespace coif

#pragma once
#include "sim/mesh.h"

#include <filesystem>
#include <vector>

namespace coif
{

// How far the surface of a mesh is, at samples on a lattice about it: what hair is kept out of a head with. In the
// mesh's own frame and unit; negative inside.
struct DistanceGrid
{
    glm::ivec3 size{0};          // samples along x, y, z; zero for a mesh that has no place or no extent
    glm::vec3 corner{0.0f};      // where the first sample is
    float voxel = 0.0f;          // between neighbours
    std::vector<float> distance; // [z][y][x]

    bool empty() const { return distance.empty(); }
};

// About this number cubed is how many samples a grid has, in cubic voxels: 5 mm for a head with shoulders.
constexpr int kDistanceResolution = 80;

// Where the samples lie, without distances: with a margin of an eighth of the mesh's longest side, so that 5 cm about a
// head have values.
DistanceGrid distance_lattice(const Mesh& mesh, int resolution = kDistanceResolution);

// The grid of a mesh. Right for what heads come as: open at the neck (the opening is closed, about flat), of several
// shells that may overlap, wound inconsistently or doubled. A cavity that a closed shell of its own surrounds is
// outside, as the mesh says. Distances: exact near the surface, by vector distance transform further away (Danielsson
// 1980). Sign: generalised winding numbers (Jacobson, Kavan, Sorkine-Hornung 2013; Barill, Dickson, Schmidt, Levin,
// Jacobson 2018).
DistanceGrid compute_distance_grid(const Mesh& mesh, int resolution = kDistanceResolution);

// The same, from `folder` where it has been computed before, and kept there. What is missing, damaged or of another
// version is computed; what cannot be written is not. An empty folder: neither read nor written.
DistanceGrid cached_distance_grid(const Mesh& mesh, const std::filesystem::path& folder,
                                  int resolution = kDistanceResolution);

// $XDG_CACHE_HOME/coif, else ~/.cache/coif (XDG Base Directory Specification); empty if the system names neither.
std::filesystem::path cache_folder();

// Trilinear between the eight samples about a point, and the gradient of just that. Outside of the grid, and where p is
// not a number, kFarOutside with no gradient.
struct DistanceAt
{
    float distance;
    glm::vec3 gradient; // as it is: about unit length, 0 at best in a crease
};
constexpr float kFarOutside = 1e9f;
DistanceAt distance_at(const DistanceGrid& grid, glm::vec3 p);

} // namespace coif

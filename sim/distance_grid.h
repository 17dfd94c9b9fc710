#pragma once
#include "sim/mesh.h"

#include <filesystem>
#include <memory>
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
    std::vector<glm::vec3> way;  // which way is out on the whole, unit length, at every second sample: size / 2 + 1
                                 // along each axis; only body_grid() tells

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

// What hair is to keep out of: the mesh with its hollows filled that no ball of that radius can enter (closing; Serra
// 1982), such as ears and what is behind them, where strands that are pushed out would part to all sides. And which way
// they are pushed: up the distances blurred over as much, so that neighbours go the same way though one be nearer to
// the front of an ear and the other to its back.
DistanceGrid body_grid(const DistanceGrid& grid, float radius);

// $XDG_CACHE_HOME/coif, else ~/.cache/coif (XDG Base Directory Specification); empty if the system names neither.
std::filesystem::path cache_folder();

// Trilinear between the eight samples about a point, and the gradient of just that, which is of about unit length, less
// in a crease. Outside of the grid, what its border has and the way there. kFarOutside where p is no point.
struct DistanceAt
{
    float distance;
    glm::vec3 gradient;
};
constexpr float kFarOutside = 1e9f;
DistanceAt distance_at(const DistanceGrid& grid, glm::vec3 p);

// A grid in the head's frame, m: what is at p in the mesh stands at scale p + offset. May have none.
struct PlacedGrid
{
    std::shared_ptr<const DistanceGrid> grid;
    float scale = 1.0f;
    glm::vec3 offset{0.0f};

    bool operator==(const PlacedGrid&) const = default;
};

// Of a point in the head's frame, m; kFarOutside if there is no grid.
float distance_to(const PlacedGrid& body, glm::vec3 p);

} // namespace coif

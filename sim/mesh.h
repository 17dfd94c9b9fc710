#pragma once
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace coif
{

// Triangles in the head's frame, m.
struct Mesh
{
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; // one a position, unit length
    std::vector<glm::uvec3> triangles;
};

// Where a vertex lies between three others, in these shares (whose sum is 1).
struct Between
{
    glm::uvec3 of{0};
    glm::vec3 shares{1.0f, 0.0f, 0.0f};
};

struct PlacedHair; // sim/exchange/place.h

// A scalp: vertex i carries guide i.
struct Scalp : Mesh
{
    glm::vec3 center{0.0f};                              // of the sphere that fits the vertices best, m
    float radius = 0.0f;                                 // of that sphere, m
    float extent = 0.0f;                                 // longest side of the vertices' bounding box, m
    std::map<std::string, std::vector<unsigned>> groups; // of the file: name -> vertices of its triangles
    std::vector<Between> between;           // of each vertex after the authored ones; only of those before it
    std::shared_ptr<const PlacedHair> hair; // of a file, that stands on it; null: none
};

constexpr size_t kMostVertices = 65536; // of a scalp

// An OBJ of triangles; its vertices keep their order. Throws Error with file and line for anything else: polygons,
// indices out of range, coordinates that are not finite, more than 65,536 vertices, no extent.
Scalp load_scalp(const std::filesystem::path& file);

// The scalp with each triangle cut in four at the middles of its sides, `times` over, as round as its normals say.
// Vertices keep their numbers, new ones follow. Throws Error when that would be more than 65,536 of them.
Scalp refined(const Scalp& scalp, int times);
int most_refinements(const Scalp& scalp); // that refined() takes, and interpolation.refine

// The scalp with a vertex more at each of these places between its own, as round as its normals say. Its triangles stay
// as they are.
Scalp strewn(const Scalp& scalp, const std::vector<Between>& places);

// A mesh as its file counts.
struct FileMesh : Mesh
{
    float unit = 1.0f; // of its numbers, m; 1 where the format says nothing
};

// Any mesh that assimp reads, with its nodes' transforms applied and its normals computed. Throws Error when it is no
// mesh, has no triangles, more than five million of them, or coordinates that are not finite.
FileMesh load_mesh(const std::filesystem::path& file);

// The mesh in metres with y up, by the choices head.unit and head.up.
Mesh upright(FileMesh mesh, int unit, int up);

// From the point of triangle abc that is nearest to p, to p, and how long that is, m. Ericson, Real-Time Collision
// Detection, 2005, section 5.1.5.
glm::vec3 from_triangle(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c);
float triangle_distance(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c);

// v at unit length; shorter than `least`, which has no direction to speak of, `otherwise`.
glm::vec3 unit_or(glm::vec3 v, glm::vec3 otherwise, float least = 1e-6f);

// Area-weighted normals of the positions; where triangles give none, the direction from `center`.
std::vector<glm::vec3> vertex_normals(const Mesh& mesh, glm::vec3 center);

} // namespace coif

// Distance grids on disk, so that a head is measured once. A file holds a header and the distances as the machine has
// them; whatever is not just so is measured again.
#include "sim/distance_grid.h"

#include "sim/cache_file.h"
#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/hash.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace coif
{

namespace fs = std::filesystem;

static constexpr uint32_t kVersion = 1;  // of the format, and of what compute_distance_grid() computes
static constexpr size_t kMostFiles = 64; // kept: an artist at work on a head saves it often

namespace
{
struct Header
{
    char magic[8] = {'c', 'o', 'i', 'f', 'd', 'i', 's', 't'};
    uint32_t version = kVersion;
    int32_t size[3] = {};
    float corner[3] = {};
    float voxel = 0.0f;
    uint64_t mesh[2] = {};
    uint64_t distances[2] = {};
};
static_assert(sizeof(Header) == 72);
} // namespace

static Hash hash_of(const Mesh& mesh, int resolution)
{
    Hash hash;
    hash.add(&resolution, sizeof resolution);
    hash.add(mesh.positions.data(), mesh.positions.size() * sizeof(glm::vec3));
    hash.add(mesh.triangles.data(), mesh.triangles.size() * sizeof(glm::uvec3));
    return hash;
}

static Header header_of(const DistanceGrid& grid, const Hash& mesh)
{
    Header header;
    for (int axis = 0; axis < 3; ++axis)
    {
        header.size[axis] = grid.size[axis];
        header.corner[axis] = grid.corner[axis];
    }
    header.voxel = grid.voxel;
    Hash distances;
    distances.add(grid.distance.data(), grid.distance.size() * sizeof(float));
    std::copy_n(mesh.word, 2, header.mesh);
    std::copy_n(distances.word, 2, header.distances);
    return header;
}

// What the file holds, if it is this grid; else empty. `grid` is the grid without its distances: with them known, a
// file can neither ask for memory nor put the grid elsewhere.
static DistanceGrid read_grid(const fs::path& file, DistanceGrid grid, const Hash& mesh)
try
{
    const size_t samples = size_t(grid.size.x) * size_t(grid.size.y) * size_t(grid.size.z);
    const std::string bytes = read_file(file, sizeof(Header) + samples * sizeof(float));
    if (bytes.size() != sizeof(Header) + samples * sizeof(float))
        return {};
    grid.distance.resize(samples);
    memcpy(grid.distance.data(), bytes.data() + sizeof(Header), samples * sizeof(float));
    const Header expected = header_of(grid, mesh);
    const float most = 4.0f * grid.voxel * float(grid.size.x + grid.size.y + grid.size.z);
    if (memcmp(bytes.data(), &expected, sizeof expected) ||
        !std::all_of(grid.distance.begin(), grid.distance.end(), [&](float d) { return std::abs(d) <= most; }))
        return {};
    return grid;
}
catch (const std::exception&)
{
    return {};
}

static void keep_grid(const fs::path& file, const DistanceGrid& grid, const Hash& mesh)
try
{
    const Header header = header_of(grid, mesh);
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
    bytes.append(reinterpret_cast<const char*>(grid.distance.data()), grid.distance.size() * sizeof(float));
    write_cache_file(file, bytes, kMostFiles);
}
catch (const std::exception&)
{
    // The next run measures again.
}

DistanceGrid cached_distance_grid(const Mesh& mesh, const fs::path& folder, int resolution)
{
    const DistanceGrid lattice = distance_lattice(mesh, resolution);
    if (folder.empty() || lattice.size.x == 0)
        return compute_distance_grid(mesh, resolution);
    const Hash hash = hash_of(mesh, resolution);
    const fs::path file = folder / fmt::format("{:016x}{:016x}.distances", hash.word[0], hash.word[1]);
    DistanceGrid grid = read_grid(file, lattice, hash);
    if (grid.empty())
    {
        grid = compute_distance_grid(mesh, resolution);
        keep_grid(file, grid, hash);
    }
    return grid;
}

fs::path cache_folder()
{
    // A relative path is none, says the specification.
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && fs::path(cache).is_absolute())
        return fs::path(cache) / "coif";
    if (const char* home = std::getenv("HOME"); home && fs::path(home).is_absolute())
        return fs::path(home) / ".cache" / "coif";
    return {};
}

} // namespace coif

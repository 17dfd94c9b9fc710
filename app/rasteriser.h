#pragma once
#include "app/passes.h"
#include "kernels/raster.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace coif
{

// What is seen, and from where. Relative to the head's origin, m; pixels from the lower left, as GL has them.
struct RasterView
{
    glm::mat4 view_projection;
    glm::vec3 eye;
    float pixel;     // metres that one covers at a distance of one metre
    float near, far; // m
    int width, height;
};

// Colours at places of the strands, as many on each segment: kernels/look_shade.cl.
struct ShadedStrands
{
    cl::Buffer colors;
    int pieces = 1;                   // on a segment
    float near = 0.0f;                // the share of light straight from suns that is not in them
    cl::Buffer straight, frame, suns; // what raster_near.h makes it of
};

// What is drawn: the solver's drawn strands as they lie on its device, and what else tells of them.
struct RasterStrands
{
    const Solver* solver = nullptr;
    HairParams params;                     // as the device reads them
    std::vector<float> waves;              // wave_table() of sim/wave.h
    std::vector<float4> braids;            // braid_values() of sim/tied_hair.h
    std::vector<float> values;             // one a node on the ramp; empty: the hair has its own colours
    std::vector<float4> ramp;              // RAMP colours
    float kept = 1.0f;                     // share of them that is drawn, each as much wider
    const ShadedStrands* shaded = nullptr; // colours in place of the hair's own, if they are worked out before
};

// Pixels that the strands which a solver has drawn last are wide on the whole, for parameters as the device reads them.
// Hangs on how far the head's middle is, and on nothing that jumps.
float mean_width(const Solver& solver, const HairParams& params, const RasterView& view);

// Of light that comes straight from suns, the share that is to be drawn as it is scattered at each place across strands
// so wide, where it begins at a width of `from` pixels; the rest is the mean over their width. It grows within a pixel,
// so that none of it shows at once.
inline float near_share(float width, float from) { return std::clamp(width - from, 0.0f, 1.0f); }

// Half floats, row by row: red, green, blue, alpha, linear and premultiplied. Only the part from (x, y) on is anything.
struct RasterPicture
{
    cl::Buffer pixels;
    size_t bytes = 0;
    int x = 0, y = 0, width = 0, height = 0;
};

// Draws strands without a GPU's pipeline: kernels/raster.h. Equal input gives equal bytes on a device. Its memory is
// bounded: strands that do not fit are drawn in batches, the nearer ones first.
class Rasteriser
{
  public:
    explicit Rasteriser(const Device& device);

    // Where the depth of what is solid is to be written before draw(), 0 to 1, row by row: on the device, or, valid
    // until then, on the host.
    const cl::Buffer& solid_buffer(int width, int height);
    float* solid_depth(int width, int height);
    // Looks where strands are seen: the pieces that each segment will be cut into, a byte a node, the first segment's
    // at the second node; 0: not seen, though the view move by a pixel. Before draw().
    const cl::Buffer& measure(const RasterStrands& strands, const RasterView& view);
    // What has been measured last.
    RasterPicture draw(const RasterStrands& strands);

    const Device& device() const { return passes_.device; }
    const Buffers& buffers() const { return passes_.buffers; } // for tests: by kernel argument
    // Of the last draw().
    int batches() const { return batches_; }
    size_t pieces() const { return pieces_; } // in tiles
    PassTimes take_times() { return passes_.take_times(); }

    // Strands that are thinner than so many pixels on the whole are drawn fewer and as much wider. 0: never.
    float least_width = 0.25f;
    // Where they are wider than so many, pixels put two strands that lie along each other in order: raster_compose.cl.
    float held_width = 2.0f;
    // Numbers that one batch may hold; tests make them small.
    size_t most_points = size_t(1) << 21, most_pieces = size_t(1) << 22;

  private:
    void draw_batch(const std::vector<RasterStrand>& listed, size_t begin, size_t end, int points_end,
                    const std::string& options);

    Passes passes_;
    RasterFrame frame_ = {};
    float* solid_ = nullptr; // mapped, or none
    bool held_ = false, near_ = false;
    int width_ = 0, height_ = 0, batches_ = 0;
    glm::ivec2 low_{0}, high_{0}; // what tiles with hair span
    size_t pieces_ = 0;
};

} // namespace coif

#include "app/rasteriser.h"

#include "sim/error.h"
#include "sim/wave.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace coif
{

// Rows of a tile that a work-item composes: all of them on CPUs, where its pixels stay in the nearest cache.
static int band(const Device& device) { return device.is_gpu ? 1 : TILE; }
static int chunks(const Device& device) { return device.is_gpu ? 1024 : 64; }

static float4 row_of(const glm::mat4& matrix, int row)
{
    const glm::vec4 r = glm::row(matrix, row);
    return F4(r.x, r.y, r.z, r.w);
}

float mean_width(const Solver& solver, const HairParams& params, const RasterView& view)
{
    const glm::vec3 center(solver.head().turn * glm::dvec3(solver.groom().center));
    const float pixel = view.pixel * std::max(glm::distance(view.eye, center), view.near); // m
    const float4 along = params.look_width_along;
    return params.look_width * 0.25f * (along.x + along.y + along.z + along.w) / pixel;
}

// Of all strands, that are drawn.
static float kept_share(float width, float least_width)
{
    return least_width > 0.0f ? std::clamp(width / least_width, 0.01f, 1.0f) : 1.0f;
}

static RasterFrame frame_of(const RasterStrands& strands, const RasterView& view, int chunk_count, float kept)
{
    RasterFrame frame = {};
    frame.clip_x = row_of(view.view_projection, 0);
    frame.clip_y = row_of(view.view_projection, 1);
    frame.clip_z = row_of(view.view_projection, 2);
    frame.clip_w = row_of(view.view_projection, 3);
    frame.eye = F4(view.eye.x, view.eye.y, view.eye.z, view.pixel);
    frame.near = view.near;
    frame.depth_at_infinity = 0.5f + 0.5f * (view.far + view.near) / (view.far - view.near);
    frame.depth_over = -view.far * view.near / (view.far - view.near);
    frame.kept = kept;
    frame.width = view.width;
    frame.height = view.height;
    frame.tiles_x = (view.width + TILE - 1) / TILE;
    frame.tiles_y = (view.height + TILE - 1) / TILE;
    frame.blocks_x = (view.width + BLOCK - 1) / BLOCK;
    frame.blocks_y = (view.height + BLOCK - 1) / BLOCK;
    frame.strands = int(strands.solver->groom().drawn.size());
    frame.braided = int(strands.braids.size() / 3);
    frame.chunks = chunk_count;
    return frame;
}

Rasteriser::Rasteriser(const Device& device)
    : passes_(device, fmt::format("-D WIDTH={} -D BAND={}", device.width, band(device)), "drawing the strands")
{
}

const cl::Buffer& Rasteriser::solid_buffer(int width, int height)
{
    constexpr size_t kBeyond = 16; // lanes may look past the last pixel
    width_ = width;
    height_ = height;
    return passes_.room_for("solid", (size_t(width) * size_t(height) + kBeyond) * sizeof(float));
}

float* Rasteriser::solid_depth(int width, int height)
{
    const size_t bytes = size_t(width) * size_t(height) * sizeof(float);
    solid_ = static_cast<float*>(
        passes_.device.queue.enqueueMapBuffer(solid_buffer(width, height), CL_TRUE, CL_MAP_WRITE, 0, bytes));
    return solid_;
}

void Rasteriser::draw_batch(const std::vector<RasterStrand>& listed, size_t begin, size_t end, int points_end,
                            const std::string& options)
{
    std::vector<RasterStrand> batch(listed.begin() + long(begin), listed.begin() + long(end));
    const int first = batch.front().first;
    for (RasterStrand& strand : batch)
        strand.first -= first;
    frame_.listed = int(batch.size());
    frame_.points = points_end - first;
    passes_.room_for("listed", batch.size() * sizeof(RasterStrand));
    passes_.room_for("points", size_t(frame_.points) * 8 * sizeof(float));
    if (near_)
        passes_.room_for("near_light", size_t(frame_.points) * NEAR_LIGHT * sizeof(cl_half));
    write(passes_.device, passes_.buffers["listed"], batch);
    write(passes_.device, passes_.buffers["frame"], std::vector<RasterFrame>(1, frame_));
    const size_t tiles = size_t(frame_.tiles_x) * size_t(frame_.tiles_y);
    passes_.launch("raster_points", options, batch.size());
    passes_.launch("raster_count", "", size_t(frame_.chunks));
    passes_.launch("raster_sum", "", tiles);
    passes_.launch("raster_scan", "", 1);
    const std::vector<int> begins = read<int>(passes_.device, passes_.buffers["tile_begin"], tiles + 1);
    const size_t pieces = size_t(begins.back());
    if (pieces > most_pieces && batch.size() > 1)
    {
        const size_t middle = begin + batch.size() / 2;
        draw_batch(listed, begin, middle, listed[middle].first, options);
        draw_batch(listed, middle, end, points_end, options);
        return;
    }
    if (pieces == 0)
        return;
    passes_.room_for("binned", pieces * sizeof(RasterPiece));
    passes_.room_for("half_sorted", pieces * sizeof(RasterPiece));
    passes_.launch("raster_fill", "", size_t(frame_.chunks));
    passes_.launch("raster_sort", "", tiles);
    passes_.launch("raster_compose", std::string(held_ ? "-D HELD" : "") + (near_ ? " -D NEAR_FIELD" : ""),
                   tiles * size_t(TILE / band(passes_.device)));
    frame_.later = 1;
    ++batches_;
    pieces_ += pieces;
    for (int tile = 0; tile < int(tiles); ++tile)
        if (begins[size_t(tile)] < begins[size_t(tile) + 1])
        {
            const int x = tile % frame_.tiles_x * TILE, y = tile / frame_.tiles_x * TILE;
            low_ = glm::min(low_, glm::ivec2(x, y));
            high_ = glm::max(high_, glm::min(glm::ivec2(x, y) + TILE, glm::ivec2(frame_.width, frame_.height)));
        }
}

static std::string strand_options(const Groom& groom)
{
    return fmt::format("-D NODES={}{}", groom.nodes, groom.looks.empty() ? "" : " -D VARIED");
}

const cl::Buffer& Rasteriser::measure(const RasterStrands& strands, const RasterView& view)
try
{
    assert(view.width == width_ && view.height == height_);
    if (solid_)
        passes_.device.queue.enqueueUnmapMemObject(passes_.buffers["solid"], std::exchange(solid_, nullptr));
    passes_.forget_times();
    const float width = mean_width(*strands.solver, strands.params, view);
    frame_ = frame_of(strands, view, chunks(passes_.device), strands.kept * kept_share(width, least_width));
    held_ = width > held_width;
    const Groom& groom = strands.solver->groom();
    const size_t count = size_t(frame_.strands), blocks = size_t(frame_.blocks_x) * size_t(frame_.blocks_y);
    const cl::Buffer& pieces = passes_.room_for("pieces", std::max<size_t>(count, 1) * size_t(groom.nodes));
    if (count == 0)
        return pieces;
    for (const char* shared : {"drawn_position", "drawn_frame", "looks", "strands"})
        passes_.buffers[shared] = strands.solver->buffers().at(shared);
    passes_.room_for("params", sizeof(HairParams));
    passes_.room_for("frame", sizeof(RasterFrame));
    passes_.room_for("braids", strands.braids.size() * sizeof(float4));
    passes_.room_for("wave_table", 2 * kWaveSamples * sizeof(float));
    passes_.room_for("farthest", blocks * sizeof(float));
    passes_.room_for("strand_points", count * sizeof(int));
    passes_.room_for("strand_depth", count * sizeof(float));
    write(passes_.device, passes_.buffers["params"], std::vector<HairParams>(1, strands.params));
    write(passes_.device, passes_.buffers["frame"], std::vector<RasterFrame>(1, frame_));
    write(passes_.device, passes_.buffers["braids"], strands.braids);
    write(passes_.device, passes_.buffers["wave_table"], strands.waves);
    passes_.launch("raster_solids", "", blocks);
    passes_.launch("raster_measure", strand_options(groom), count);
    return pieces;
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while measuring the strands", e.err(), e.what());
}

RasterPicture Rasteriser::draw(const RasterStrands& strands)
try
{
    batches_ = 0;
    pieces_ = 0;
    low_ = glm::ivec2(frame_.width, frame_.height);
    high_ = glm::ivec2(0);
    if (frame_.strands == 0)
        return {};
    const Groom& groom = strands.solver->groom();
    const size_t count = size_t(frame_.strands), pixels = size_t(frame_.width) * size_t(frame_.height);
    const size_t tiles = size_t(frame_.tiles_x) * size_t(frame_.tiles_y);
    passes_.room_for("counts", size_t(frame_.chunks) * tiles * sizeof(int));
    passes_.room_for("tile_count", tiles * sizeof(int));
    passes_.room_for("tile_begin", (tiles + 1) * sizeof(int));
    passes_.room_for("picture", pixels * 4 * sizeof(cl_half));
    near_ = strands.shaded && strands.shaded->near > 0.0f && strands.values.empty();
    std::string options = strand_options(groom);
    if (!strands.values.empty())
    {
        options += " -D VALUES";
        passes_.room_for("values", strands.values.size() * sizeof(float));
        passes_.room_for("ramp", strands.ramp.size() * sizeof(float4));
        write(passes_.device, passes_.buffers["values"], strands.values);
        write(passes_.device, passes_.buffers["ramp"], strands.ramp);
    }
    else if (strands.shaded)
    {
        options += fmt::format(" -D SHADED={}", strands.shaded->pieces);
        passes_.buffers["shaded"] = strands.shaded->colors;
        if (near_)
        {
            options += " -D NEAR_FIELD";
            passes_.buffers["straight_light"] = strands.shaded->straight;
            passes_.buffers["look_frame"] = strands.shaded->frame;
            passes_.buffers["rays"] = strands.shaded->suns;
        }
    }

    std::vector<RasterStrand> listed;
    const std::vector<int> points = read<int>(passes_.device, passes_.buffers["strand_points"], count);
    for (int s = 0; s < frame_.strands; ++s)
        if (points[size_t(s)] > 0)
            listed.push_back({s, 0});
    if (std::accumulate(points.begin(), points.end(), size_t(0)) > most_points)
    {
        const std::vector<float> depths = read<float>(passes_.device, passes_.buffers["strand_depth"], count);
        const auto depth = [&](const RasterStrand& s)
        { return std::isfinite(depths[size_t(s.strand)]) ? depths[size_t(s.strand)] : 0.0f; };
        std::ranges::stable_sort(listed, {}, depth);
    }
    for (size_t begin = 0, end = 0; begin < listed.size(); begin = end)
    {
        size_t sum = 0;
        for (; end < listed.size(); ++end)
        {
            const size_t own = size_t(points[size_t(listed[end].strand)]);
            if (end > begin && sum + own > most_points)
                break;
            listed[end].first = int(sum);
            sum += own;
        }
        draw_batch(listed, begin, end, int(sum), options);
    }
    if (batches_ == 0)
        return {};
    return {
        passes_.buffers["picture"], pixels * 4 * sizeof(cl_half), low_.x, low_.y, high_.x - low_.x, high_.y - low_.y};
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while drawing the strands", e.err(), e.what());
}

} // namespace coif

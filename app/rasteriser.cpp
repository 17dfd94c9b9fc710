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

// Of all strands, that are drawn. Hangs on how far the head's middle is, and on nothing that jumps.
static float kept_share(const RasterStrands& strands, const RasterView& view, float least_width)
{
    const Solver& solver = *strands.solver;
    const glm::vec3 center(solver.head().turn * glm::dvec3(solver.groom().center));
    const float pixel = view.pixel * std::max(glm::distance(view.eye, center), view.near); // m
    const float4 along = strands.params.look_width_along;
    const float width = strands.params.look_width * 0.25f * (along.x + along.y + along.z + along.w);
    return least_width > 0.0f ? std::clamp(width / (least_width * pixel), 0.01f, 1.0f) : 1.0f;
}

static RasterFrame frame_of(const RasterStrands& strands, const RasterView& view, int chunk_count, float least_width)
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
    frame.kept = strands.kept * kept_share(strands, view, least_width);
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

void Rasteriser::room_for(const std::string& name, size_t bytes)
{
    size_t& held = bytes_[name];
    if (buffers_.contains(name) && held >= bytes)
        return;
    buffers_.erase(name); // before the new one is asked for
    buffers_[name] = allocate(device_, bytes, "drawing the strands");
    held = bytes;
}

float* Rasteriser::solid_depth(int width, int height)
{
    constexpr size_t kBeyond = 16; // lanes may look past the last pixel
    const size_t bytes = (size_t(width) * size_t(height) + kBeyond) * sizeof(float);
    room_for("solid", bytes);
    width_ = width;
    height_ = height;
    solid_ = static_cast<float*>(device_.queue.enqueueMapBuffer(buffers_["solid"], CL_TRUE, CL_MAP_WRITE, 0, bytes));
    return solid_;
}

void Rasteriser::launch(const std::string& pass, const std::string& extra, size_t items)
{
    const std::string key = pass + extra;
    if (!kernels_.contains(key))
        kernels_[key] =
            load_kernel(device_, pass, fmt::format("-D WIDTH={} -D BAND={} {}", device_.width, band(device_), extra));
    // On CPUs each work-item is a group of its own, or PoCL would give few groups to one core.
    const size_t group = device_.is_gpu && items > 1 ? 64 : 1;
    launches_.emplace_back(pass, run(device_, kernels_[key], buffers_, cl::NDRange((items + group - 1) / group * group),
                                     cl::NDRange(group)));
}

void Rasteriser::draw_batch(RasterFrame& frame, const std::vector<RasterStrand>& listed, size_t begin, size_t end,
                            int points_end, const std::string& options)
{
    std::vector<RasterStrand> batch(listed.begin() + long(begin), listed.begin() + long(end));
    const int first = batch.front().first;
    for (RasterStrand& strand : batch)
        strand.first -= first;
    frame.listed = int(batch.size());
    frame.points = points_end - first;
    room_for("listed", batch.size() * sizeof(RasterStrand));
    room_for("points", size_t(frame.points) * 8 * sizeof(float));
    write(device_, buffers_["listed"], batch);
    write(device_, buffers_["frame"], std::vector<RasterFrame>(1, frame));
    const size_t tiles = size_t(frame.tiles_x) * size_t(frame.tiles_y);
    launch("raster_points", options, batch.size());
    launch("raster_count", "", size_t(frame.chunks));
    launch("raster_sum", "", tiles);
    launch("raster_scan", "", 1);
    const std::vector<int> begins = read<int>(device_, buffers_["tile_begin"], tiles + 1);
    const size_t pieces = size_t(begins.back());
    if (pieces > most_pieces && batch.size() > 1)
    {
        const size_t middle = begin + batch.size() / 2;
        draw_batch(frame, listed, begin, middle, listed[middle].first, options);
        draw_batch(frame, listed, middle, end, points_end, options);
        return;
    }
    if (pieces == 0)
        return;
    room_for("binned", pieces * sizeof(RasterPiece));
    room_for("half_sorted", pieces * sizeof(RasterPiece));
    launch("raster_fill", "", size_t(frame.chunks));
    launch("raster_sort", "", tiles);
    launch("raster_compose", "", tiles * size_t(TILE / band(device_)));
    frame.later = 1;
    ++batches_;
    pieces_ += pieces;
    for (int tile = 0; tile < int(tiles); ++tile)
        if (begins[size_t(tile)] < begins[size_t(tile) + 1])
        {
            const int x = tile % frame.tiles_x * TILE, y = tile / frame.tiles_x * TILE;
            low_ = glm::min(low_, glm::ivec2(x, y));
            high_ = glm::max(high_, glm::min(glm::ivec2(x, y) + TILE, glm::ivec2(frame.width, frame.height)));
        }
}

RasterPicture Rasteriser::draw(const RasterStrands& strands, const RasterView& view)
try
{
    assert(solid_ && view.width == width_ && view.height == height_);
    device_.queue.enqueueUnmapMemObject(buffers_["solid"], std::exchange(solid_, nullptr));
    launches_.clear();
    batches_ = 0;
    pieces_ = 0;
    low_ = glm::ivec2(view.width, view.height);
    high_ = glm::ivec2(0);
    RasterFrame frame = frame_of(strands, view, chunks(device_), least_width);
    if (frame.strands == 0)
        return {};
    const Groom& groom = strands.solver->groom();
    for (const char* shared : {"drawn_position", "drawn_frame", "looks", "strands"})
        buffers_[shared] = strands.solver->buffers().at(shared);
    const size_t count = size_t(frame.strands), pixels = size_t(view.width) * size_t(view.height);
    const size_t tiles = size_t(frame.tiles_x) * size_t(frame.tiles_y);
    const size_t blocks = size_t(frame.blocks_x) * size_t(frame.blocks_y);
    room_for("params", sizeof(HairParams));
    room_for("frame", sizeof(RasterFrame));
    room_for("braids", strands.braids.size() * sizeof(float4));
    room_for("wave_table", 2 * kWaveSamples * sizeof(float));
    room_for("farthest", blocks * sizeof(float));
    room_for("pieces", count * size_t(groom.nodes));
    room_for("strand_points", count * sizeof(int));
    room_for("strand_depth", count * sizeof(float));
    room_for("counts", size_t(frame.chunks) * tiles * sizeof(int));
    room_for("tile_count", tiles * sizeof(int));
    room_for("tile_begin", (tiles + 1) * sizeof(int));
    room_for("picture", pixels * 4 * sizeof(cl_half));
    write(device_, buffers_["params"], std::vector<HairParams>(1, strands.params));
    write(device_, buffers_["frame"], std::vector<RasterFrame>(1, frame));
    write(device_, buffers_["braids"], strands.braids);
    write(device_, buffers_["wave_table"], strands.waves);
    std::string options = fmt::format("-D NODES={}{}", groom.nodes, groom.looks.empty() ? "" : " -D VARIED");
    if (!strands.values.empty())
    {
        options += " -D VALUES";
        room_for("values", strands.values.size() * sizeof(float));
        room_for("ramp", strands.ramp.size() * sizeof(float4));
        write(device_, buffers_["values"], strands.values);
        write(device_, buffers_["ramp"], strands.ramp);
    }

    launch("raster_solids", "", blocks);
    launch("raster_measure", options, count);
    std::vector<RasterStrand> listed;
    const std::vector<int> points = read<int>(device_, buffers_["strand_points"], count);
    for (int s = 0; s < frame.strands; ++s)
        if (points[size_t(s)] > 0)
            listed.push_back({s, 0});
    if (std::accumulate(points.begin(), points.end(), size_t(0)) > most_points)
    {
        const std::vector<float> depths = read<float>(device_, buffers_["strand_depth"], count);
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
        draw_batch(frame, listed, begin, end, int(sum), options);
    }
    if (batches_ == 0)
        return {};
    return {Mapped(device_, buffers_["picture"], pixels * 4 * sizeof(cl_half)), low_.x, low_.y, high_.x - low_.x,
            high_.y - low_.y};
}
catch (const cl::Error& e)
{
    throw fail("OpenCL error {} from {} while drawing the strands", e.err(), e.what());
}

PassTimes Rasteriser::take_times()
{
    device_.queue.finish();
    PassTimes times;
    for (const auto& [pass, event] : launches_)
    {
        const double ms = 1e-6 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                        event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
        const auto known = std::ranges::find(times, pass, &PassTimes::value_type::first);
        if (known == times.end())
            times.emplace_back(pass, ms);
        else
            known->second += ms;
    }
    launches_.clear();
    return times;
}

} // namespace coif

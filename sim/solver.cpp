#include "sim/solver.h"

#include "sim/error.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace coif
{

static size_t grid_voxels(const HairParams& params)
{
    return size_t(params.grid_resolution) * size_t(params.grid_resolution) * size_t(params.grid_resolution);
}

// Voxels that a work-item of the grid's passes takes along x.
static int chunk(const Device& device, const HairParams& params)
{
    return params.grid_resolution % device.width == 0 ? device.width : 1;
}

Solver::Solver(const Device& device, const HairParams& params, const Groom& groom, const Pose& head) : device_(device)
{
    params_ = device_params(params);
    buffers_["params"] = allocate(device, sizeof(HairParams), "the parameters");
    buffers_["info"] = allocate(device, sizeof(StepInfo), "the step");
    buffers_["colliders"] = allocate(device, sizeof(Capsule), "the colliders");
    buffers_["body_distance"] = allocate(device, sizeof(float), "the head's distances");
    buffers_["body_way"] = allocate(device, sizeof(float), "the head's distances");
    head_ = head;
    set_groom(groom);
    set_params(params);
}

Solver::~Solver()
{
    try
    {
        device_.queue.finish();
    }
    catch (const cl::Error&)
    {
        // A device that is lost reads no more.
    }
}

void Solver::set_params(const HairParams& params)
{
    const HairParams wanted = device_params(params);
    if (!buffers_.contains("density") || wanted.grid_resolution != params_.grid_resolution)
    {
        const size_t voxels = grid_voxels(wanted);
        Buffers fresh = buffers_; // what cannot be allocated leaves everything as it was
        for (const char* name : {"density", "blurred", "occupied", "depth"})
            fresh[name] = allocate(device_, voxels * sizeof(int), "the density grid");
        fresh["gradient"] = allocate(device_, voxels * 3 * sizeof(float), "the density's gradient");
        for (const char* name : {"density", "blurred", "depth"})
            device_.queue.enqueueFillBuffer(fresh[name], 0, 0, voxels * sizeof(int));
        device_.queue.enqueueFillBuffer(fresh["gradient"], 0, 0, voxels * 3 * sizeof(float));
        buffers_ = fresh;
    }
    params_ = wanted;
    device_.queue.enqueueWriteBuffer(buffer("params"), CL_TRUE, 0, sizeof params_, &params_);
}

void Solver::set_groom(const Groom& groom)
{
    const bool same = groom.guides == groom_.guides && groom.nodes == groom_.nodes && !groom_.root_position.empty();
    const bool same_drawn = same && groom.drawn.size() == groom_.drawn.size();
    const size_t strands = size_t(groom.blocks) * LANES, values = strands * size_t(groom.nodes) * 3;
    const size_t drawn_nodes = groom.drawn.size() * size_t(groom.nodes);
    Buffers fresh = buffers_; // what cannot be allocated leaves everything as it was
    if (!same)
    {
        fresh["root_position"] = allocate(device_, strands * 3 * sizeof(float), "the roots");
        fresh["root_direction"] = allocate(device_, strands * 3 * sizeof(float), "the roots");
        fresh["segment_length"] = allocate(device_, strands * sizeof(float), "the roots");
        fresh["position"] = allocate(device_, values * sizeof(float), "the guides");
        fresh["velocity"] = allocate(device_, values * sizeof(float), "the guides");
        fresh["resets"] = allocate(device_, strands * sizeof(int), "the guides");
        device_.queue.enqueueFillBuffer(fresh["resets"], 0, 0, strands * sizeof(int));
    }
    if (!same_drawn)
    {
        fresh["strands"] = allocate(device_, groom.drawn.size() * sizeof(DrawnStrand), "the drawn strands");
        fresh["drawn_position"] = allocate(device_, drawn_nodes * sizeof(float4), "the drawn strands");
        fresh["drawn_frame"] = allocate(device_, drawn_nodes * sizeof(float4), "the drawn strands");
    }
    buffers_ = fresh;
    groom_ = groom;
    write(device_, buffer("root_position"), groom.root_position);
    write(device_, buffer("root_direction"), groom.root_direction);
    write(device_, buffer("segment_length"), groom.segment_length);
    write(device_, buffer("strands"), groom.drawn);
    if (!same)
        reset(head_);
}

void Solver::set_colliders(const std::vector<Collider>& colliders)
{
    if (colliders.size() > colliders_.size())
        buffers_["colliders"] = allocate(device_, colliders.size() * sizeof(Capsule), "the colliders");
    colliders_ = colliders;
}

void Solver::set_body(const PlacedGrid& body)
{
    if (body.grid && body.grid != body_.grid)
    {
        std::vector<float> in_voxels;
        for (const float distance : body.grid->distance)
            in_voxels.push_back(distance / body.grid->voxel);
        std::vector<float4> ways;
        for (const glm::vec3& way : body.grid->way)
            ways.push_back(F4(way.x, way.y, way.z, 0.0f));
        Buffers fresh = buffers_; // what cannot be allocated leaves everything as it was
        fresh["body_distance"] = allocate(device_, in_voxels.size() * sizeof(float), "the head's distances");
        fresh["body_way"] = allocate(device_, ways.size() * sizeof(float4), "the head's distances");
        write(device_, fresh["body_distance"], in_voxels);
        write(device_, fresh["body_way"], ways);
        buffers_ = fresh;
    }
    body_ = body;
}

std::vector<Capsule> Solver::placed_colliders() const
{
    std::vector<Capsule> placed;
    for (const Collider& c : colliders_)
    {
        const glm::dvec3 center = c.on_head ? head_.turn * glm::dvec3(c.center) : glm::dvec3(c.center) - head_.origin;
        const glm::dvec3 along = c.to ? glm::dvec3(*c.to) - glm::dvec3(c.center) : glm::dvec3(0.0);
        const glm::dvec3 axis = c.on_head ? head_.turn * along : along;
        // An axis that is short against the radius is none.
        const double squared = glm::dot(axis, axis), least = 1e-6 * double(c.radius) * double(c.radius);
        placed.push_back(
            {F4(float(center.x), float(center.y), float(center.z), c.radius),
             F4(float(axis.x), float(axis.y), float(axis.z), squared > least ? float(1.0 / squared) : 0.0f)});
    }
    return placed;
}

void Solver::reset(const Pose& head)
{
    head_ = head;
    head_velocity_ = glm::dvec3(0.0);
    std::vector<float> position(size_t(groom_.blocks) * LANES * size_t(groom_.nodes) * 3);
    const std::vector<float> velocity(position.size(), 0.0f);
    for (int s = 0; s < groom_.blocks * LANES; ++s)
    {
        glm::dvec3 root, direction;
        for (int axis = 0; axis < 3; ++axis)
        {
            root[axis] = groom_.root_position[size_t(strand_value(s, 0, axis, 1))];
            direction[axis] = groom_.root_direction[size_t(strand_value(s, 0, axis, 1))];
        }
        const double rest = double(groom_.segment_length[size_t(s)]) * params_.strand_spacing;
        for (int k = 0; k < groom_.nodes; ++k)
        {
            const glm::dvec3 p = head.turn * (root + direction * (rest * (k - 1)));
            for (int axis = 0; axis < 3; ++axis)
                position[size_t(strand_value(s, k, axis, groom_.nodes))] = float(p[axis]);
        }
    }
    write(device_, buffer("position"), position);
    write(device_, buffer("velocity"), velocity);
}

Kernel& Solver::kernel(const std::string& file, const std::string& extra)
{
    const std::string options = fmt::format("-D NODES={} -D RESOLUTION={} -D WIDTH={} -D CHUNK={} {}", groom_.nodes,
                                            params_.grid_resolution, device_.width, chunk(device_, params_), extra);
    const auto [found, fresh] = kernels_.try_emplace(file + " " + options);
    if (fresh)
        try
        {
            found->second = load_kernel(device_, file, options);
        }
        catch (...)
        {
            kernels_.erase(found);
            throw;
        }
    return found->second;
}

void Solver::launch(const std::string& pass, const std::string& extra, size_t items, size_t group)
{
    if (items == 0)
        return;
    launches_.emplace_back(pass, run(device_, kernel(pass, extra), buffers_, cl::NDRange(items),
                                     group ? cl::NDRange(group) : cl::NullRange));
}

void Solver::launch_strands(const std::string& pass, const std::string& extra, size_t strands)
{
    // On CPUs each work-item is a group of its own: left to itself PoCL makes one group of few work-items, on one core.
    // On GPUs whole groups: a number of strands that has no divisors would else be cut into groups of one.
    const size_t width = size_t(device_.width);
    const size_t most = kernel(pass, extra).handle.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_.device);
    const size_t group = width > 1 ? 1 : std::min<size_t>(64, most);
    const size_t items = (strands + width - 1) / width;
    launch(pass, extra, (items + group - 1) / group * group, group);
}

void Solver::upload(const StepInfo& info)
{
    info_ = info;
    // The queue reads what it is given later: kept until take_times() has waited for it.
    const auto send = [&](const std::string& name, const void* data, size_t bytes)
    {
        if (bytes == 0)
            return;
        const char* first = static_cast<const char*>(data);
        in_flight_.emplace_back(first, first + bytes);
        device_.queue.enqueueWriteBuffer(buffer(name), CL_FALSE, 0, bytes, in_flight_.back().data());
    };
    send("info", &info, sizeof info);
    const std::vector<Capsule> placed = placed_colliders();
    send("colliders", placed.data(), placed.size() * sizeof(Capsule));
}

bool Solver::has_shadow() const { return params_.look_self_shadow > 0.0f; }

void Solver::simulate(const StepInfo& info)
{
    const bool repels = params_.forces_repulsion > 0.0f, density = repels || has_shadow();
    if (info.last_substep && density)
        launch("clear_density", "", grid_voxels(params_));
    launch_strands("simulate_pbd",
                   fmt::format("{}{}{}{}", info.wind.w > 0.0f ? "-D WIND " : "", repels ? "-D REPULSION " : "",
                               density ? "-D DENSITY " : "", body_.grid ? "-D BODY_GRID " : ""),
                   size_t(groom_.blocks) * LANES);
}

void Solver::step(const std::vector<Substep>& wanted)
{
    std::vector<Substep> substeps;
    for (const Substep& substep : wanted)
        if (substep.seconds > 0.0f) // zero, negative or not a number: no step
            substeps.push_back(substep);
    if (substeps.empty())
        return;
    for (size_t i = 0; i < substeps.size(); ++i)
    {
        const Substep& now = substeps[i];
        const StepInfo info = make_step_info(params_, groom_, head_, head_velocity_, now, int(colliders_.size()),
                                             i + 1 == substeps.size(), body_);
        if (info.teleport)
            jumped_ += now.head.origin - head_.origin;
        else
            head_velocity_ = (now.head.origin - head_.origin) / double(now.seconds);
        head_ = now.head;
        time_ = now.time;
        upload(info);
        simulate(info);
    }
    const bool repels = params_.forces_repulsion > 0.0f;
    if (!repels && !has_shadow())
        return;
    const size_t chunks = grid_voxels(params_) / size_t(chunk(device_, params_));
    for (int pass = 0; pass < params_.grid_blur; ++pass)
        for (const char* axis : {"-D AXIS=0", "-D AXIS=1", "-D AXIS=2"})
        {
            launch("blur_density", axis, chunks);
            std::swap(buffers_["density"], buffers_["blurred"]);
        }
    if (repels)
        launch("density_gradient", "", chunks);
}

void Solver::draw()
{
    // Light, colliders and parameters as they are now, though time may stand still; the density is the last step's.
    StepInfo info = make_step_info(params_, groom_, head_, head_velocity_, {head_, time_, 1.0f / 60.0f},
                                   int(colliders_.size()), true, body_);
    upload(info);
    const std::string options =
        fmt::format("{}{}", has_shadow() ? "-D SHADOW " : "", body_.grid ? "-D BODY_GRID " : "");
    if (has_shadow())
    {
        const size_t side = size_t(params_.grid_resolution);
        device_.queue.enqueueCopyBuffer(buffer("density"), buffer("occupied"), 0, 0,
                                        grid_voxels(params_) * sizeof(int));
        if (!colliders_.empty())
            launches_.emplace_back("add_bodies", run(device_, kernel("add_bodies", ""), buffers_,
                                                     cl::NDRange(side, side, colliders_.size())));
        if (body_.grid)
            launches_.emplace_back(
                "add_head", run(device_, kernel("add_head", ""), buffers_,
                                cl::NDRange((side + size_t(device_.width) - 1) / size_t(device_.width), side, side)));
        launch("transmittance", "", side * side / size_t(chunk(device_, params_)));
    }
    launch_strands("interpolate_multi", options, size_t(groom_.drawn_multi));
    launch_strands("interpolate_single", options, groom_.drawn.size() - size_t(groom_.drawn_multi));
    launch_strands("transport_frames", "", groom_.drawn.size());
}

Mapped Solver::guide_positions() const
{
    return Mapped(device_, buffer("position"),
                  size_t(groom_.blocks) * LANES * size_t(groom_.nodes) * 3 * sizeof(float));
}

Mapped Solver::drawn_positions() const
{
    return Mapped(device_, buffer("drawn_position"), groom_.drawn.size() * size_t(groom_.nodes) * sizeof(float4));
}

Mapped Solver::drawn_frames() const
{
    return Mapped(device_, buffer("drawn_frame"), groom_.drawn.size() * size_t(groom_.nodes) * sizeof(float4));
}

Mapped Solver::optical_depth() const
{
    return Mapped(device_, buffer("depth"), has_shadow() ? grid_voxels(params_) * sizeof(float) : 0);
}

std::vector<int> Solver::resets() const { return read<int>(device_, buffer("resets"), size_t(groom_.guides)); }

PassTimes Solver::take_times()
{
    device_.queue.finish();
    in_flight_.clear();
    for (const auto& [pass, event] : launches_)
    {
        const double ms = double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                 event.getProfilingInfo<CL_PROFILING_COMMAND_START>()) *
                          1e-6;
        const auto found = std::find_if(times_.begin(), times_.end(), [&](const auto& t) { return t.first == pass; });
        if (found == times_.end())
            times_.emplace_back(pass, ms);
        else
            found->second += ms;
    }
    launches_.clear();
    return std::exchange(times_, {});
}

} // namespace coif

#include "sim/solver.h"

#include "sim/error.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace coif
{

static constexpr int kLookEvery = 16; // steps, when hair may be at rest

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
    buffers_["bodies"] = allocate(device, sizeof(Capsule), "the colliders");
    buffers_["path"] = allocate(device, sizeof(StepPath), "the step");
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
        for (const char* name : {"density", "blurred", "lit", "occupied", "depth"})
            fresh[name] = allocate(device_, voxels * sizeof(int), "the density grid");
        fresh["gradient"] = allocate(device_, voxels * 3 * sizeof(float), "the density's gradient");
        for (const char* name : {"density", "blurred", "depth"})
            device_.queue.enqueueFillBuffer(fresh[name], 0, 0, voxels * sizeof(int));
        device_.queue.enqueueFillBuffer(fresh["gradient"], 0, 0, voxels * 3 * sizeof(float));
        buffers_ = fresh;
    }
    // What the rest shape hangs on besides the groom.
    const auto shaping = [](const HairParams& p)
    {
        return std::tuple(p.strand_spacing, p.bending_droop, p.bending_modulus, p.bending_diameter,
                          p.bending_attenuation, p.forces_gravity);
    };
    const bool reshaped = shaping(wanted) != shaping(params_);
    changed_ |= memcmp(&wanted, &params_, sizeof wanted) != 0;
    params_ = wanted;
    if (reshaped)
        set_rest_shape();
    device_.queue.enqueueWriteBuffer(buffer("params"), CL_TRUE, 0, sizeof params_, &params_);
}

void Solver::set_groom(const Groom& groom)
{
    const bool same = groom.guides == groom_.guides && groom.nodes == groom_.nodes && !groom_.root_position.empty();
    const bool same_drawn = same && groom.drawn.size() == groom_.drawn.size();
    const size_t strands = size_t(groom.blocks) * LANES, values = strands * size_t(groom.nodes) * 3;
    const size_t drawn_nodes = groom.drawn.size() * size_t(groom.nodes);
    Buffers fresh = buffers_; // what cannot be allocated leaves everything as it was
    const size_t blocks = size_t(groom.blocks);
    if (!same)
    {
        fresh["rest_position"] = allocate(device_, values * sizeof(float), "the rest shape");
        fresh["rest_bend"] = allocate(device_, values * sizeof(float), "the rest shape");
        fresh["root_normal"] = allocate(device_, strands * 3 * sizeof(float), "the roots");
        fresh["multiplier"] = allocate(device_, strands * size_t(groom.nodes) * sizeof(float), "the guides");
        for (const char* name : {"tension", "tension_next"})
            fresh[name] = allocate(device_, strands * sizeof(float), "the guides");
        for (const char* name : {"pace", "pace_next"})
            fresh[name] = allocate(device_, blocks * sizeof(int), "the guides");
        fresh["moved"] = allocate(device_, strands * sizeof(float), "the guides");
        device_.queue.enqueueFillBuffer(fresh["moved"], 0.0f, 0, strands * sizeof(float));
        fresh["faults"] = allocate(device_, strands * sizeof(int), "the guides");
        device_.queue.enqueueFillBuffer(fresh["faults"], 0, 0, strands * sizeof(int));
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
    changed_ = true;
    write(device_, buffer("root_position"), groom.root_position);
    write(device_, buffer("root_direction"), groom.root_direction);
    write(device_, buffer("segment_length"), groom.segment_length);
    write(device_, buffer("strands"), groom.drawn);
    set_rest_shape();
    if (!same)
        reset(head_);
}

void Solver::set_colliders(const std::vector<Collider>& colliders)
{
    changed_ |= colliders != colliders_;
    if (colliders.size() > colliders_.size())
        for (const char* name : {"colliders", "bodies"})
            buffers_[name] = allocate(device_, colliders.size() * sizeof(Capsule), "the colliders");
    colliders_ = colliders;
}

void Solver::set_rest_shape()
{
    rest_ = make_rest_shape(params_, groom_);
    write(device_, buffer("rest_position"), rest_.position);
    write(device_, buffer("rest_bend"), rest_.bend);
    write(device_, buffer("root_normal"), rest_.normal);
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
    changed_ |= body != body_;
    body_ = body;
}

static Capsule capsule_of(glm::dvec3 center, glm::dvec3 axis, float radius)
{
    // An axis that is short against the radius is none.
    const double squared = glm::dot(axis, axis), least = 1e-6 * double(radius) * double(radius);
    return {F4(float(center.x), float(center.y), float(center.z), radius),
            F4(float(axis.x), float(axis.y), float(axis.z), squared > least ? float(1.0 / squared) : 0.0f)};
}

static glm::dvec3 axis_of(const Collider& c)
{
    return c.to ? glm::dvec3(*c.to) - glm::dvec3(c.center) : glm::dvec3(0.0);
}

std::vector<Capsule> Solver::placed_colliders() const
{
    std::vector<Capsule> placed;
    for (const Collider& c : colliders_)
        placed.push_back(c.on_head ? capsule_of(head_.turn * glm::dvec3(c.center), head_.turn * axis_of(c), c.radius)
                                   : capsule_of(glm::dvec3(c.center) - head_.origin, axis_of(c), c.radius));
    return placed;
}

void Solver::reset(const Pose& head)
{
    head_ = head;
    head_velocity_ = glm::dvec3(0.0);
    changed_ = true;
    std::vector<float> position = rest_.position;
    const std::vector<float> velocity(position.size(), 0.0f);
    for (int s = 0; s < groom_.blocks * LANES; ++s)
        for (int k = 0; k < groom_.nodes; ++k)
        {
            float* at = &position[size_t(strand_value(s, k, 0, groom_.nodes))];
            const glm::dvec3 p = head.turn * glm::dvec3(at[0], at[LANES], at[2 * LANES]);
            for (int axis = 0; axis < 3; ++axis)
                at[axis * LANES] = float(p[axis]);
        }
    write(device_, buffer("position"), position);
    write(device_, buffer("velocity"), velocity);
    write(device_, buffer("multiplier"), rest_.multiplier);
    const size_t strands = size_t(groom_.blocks) * LANES;
    device_.queue.enqueueFillBuffer(buffer("tension"), 0.0f, 0, strands * sizeof(float));
    device_.queue.enqueueFillBuffer(buffer("pace"), 0, 0, size_t(groom_.blocks) * sizeof(int));
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

// The queue reads what it is given later: kept until take_times() has waited for it.
void Solver::send(const std::string& name, const void* data, size_t bytes)
{
    if (bytes == 0)
        return;
    const char* first = static_cast<const char*>(data);
    in_flight_.emplace_back(first, first + bytes);
    device_.queue.enqueueWriteBuffer(buffer(name), CL_FALSE, 0, bytes, in_flight_.back().data());
}

void Solver::upload(const StepInfo& info)
{
    info_ = info;
    send("info", &info, sizeof info);
    const std::vector<Capsule> placed = placed_colliders();
    send("colliders", placed.data(), placed.size() * sizeof(Capsule));
}

// Bodies as kernels/bodies.h wants them: the head's own first, in its frame; the others against the path's origin.
void Solver::upload_direct(const StepPath& path, const Pose& before, bool teleport)
{
    send("path", &path, sizeof path);
    const glm::dvec3 origin = teleport ? head_.origin : before.origin;
    std::vector<Capsule> bodies;
    for (const bool on_head : {true, false})
        for (const Collider& c : colliders_)
            if (c.on_head == on_head)
                bodies.push_back(
                    capsule_of(glm::dvec3(c.center) - (on_head ? glm::dvec3(0.0) : origin), axis_of(c), c.radius));
    send("bodies", bodies.data(), bodies.size() * sizeof(Capsule));
}

bool Solver::has_shadow() const { return params_.look_self_shadow > 0.0f; }

void Solver::simulate(const StepInfo& info)
{
    const bool repels = params_.forces_repulsion > 0.0f, density = repels || has_shadow();
    if (info.last_substep && density)
        launch("clear_density", "", grid_voxels(params_));
    if (params_.solver_kind == 0)
        return simulate_direct(info);
    launch_strands("simulate_pbd",
                   fmt::format("{}{}{}{}", info.wind.w > 0.0f ? "-D WIND " : "", repels ? "-D REPULSION " : "",
                               density ? "-D DENSITY " : "", body_.grid ? "-D BODY_GRID " : ""),
                   size_t(groom_.blocks) * LANES);
}

void Solver::simulate_direct(const StepInfo& info)
{
    const bool repels = params_.forces_repulsion > 0.0f, density = repels || has_shadow();
    // Softer than this, what bending there is lies within half a segment of the root: not seen by the nodes.
    const double links = groom_.nodes - 2;
    const bool bending = params_.bending_modulus > 0.0f || params_.bending_droop < 4.0 * links * links;
    // And stiffer than this, it does not bend, but for a body that it meets.
    const bool contact = !colliders_.empty() || body_.grid;
    if (params_.bending_modulus == 0.0f && params_.bending_droop < 0.1f && !contact)
        return launch_strands("simulate_rigid", density ? "-D DENSITY " : "", size_t(groom_.blocks) * LANES);
    launch_strands("simulate_direct",
                   fmt::format("{}{}{}{}{}{}{}", bending ? "-D BENDING " : "",
                               bending && rest_.curled ? "-D CURLED " : "", info.wind.w > 0.0f ? "-D WIND " : "",
                               repels ? "-D REPULSION " : "", contact ? "-D CONTACT " : "",
                               body_.grid ? "-D BODY_GRID " : "", density ? "-D DENSITY " : ""),
                   size_t(groom_.blocks) * LANES);
    std::swap(buffers_["tension"], buffers_["tension_next"]);
    std::swap(buffers_["pace"], buffers_["pace_next"]);
}

double Solver::fastest()
{
    const size_t strands = size_t(groom_.blocks) * LANES;
    const std::vector<float> moved = read<float>(device_, buffer("moved"), strands);
    device_.queue.enqueueFillBuffer(buffer("moved"), 0.0f, 0, strands * sizeof(float));
    return double(*std::max_element(moved.begin(), moved.begin() + groom_.guides)) / std::max(watched_, 1e-9);
}

// Rest is two looks in a row, over half a second, in which no node moved by more than a two-hundredth of the longest
// strand a second.
void Solver::look_for_rest()
{
    calm_ = fastest() < 0.005 * double(groom_.longest) ? calm_ + 1 : 0;
    asleep_ = calm_ >= 3; // the first saw what was before, too
}

void Solver::step(const std::vector<Substep>& wanted)
{
    std::vector<Substep> substeps;
    for (const Substep& substep : wanted)
        if (substep.seconds > 0.0f) // zero, negative or not a number: no step
            substeps.push_back(substep);
    if (substeps.empty())
        return;
    const Pose& to = substeps.back().head;
    const bool outside = changed_ || to.origin != head_.origin || to.turn != head_.turn || to.wind != head_.wind ||
                         info_.wind.w > 0.0f || params_.solver_kind != 0;
    changed_ = false;
    quiet_ = outside ? 0 : quiet_ + 1;
    asleep_ &= !outside;
    drawn_asleep_ &= asleep_;
    if (asleep_)
        return;
    for (size_t i = 0; i < substeps.size(); ++i)
    {
        const Substep& now = substeps[i];
        StepInfo info = make_step_info(params_, groom_, head_, head_velocity_, now, int(colliders_.size()),
                                       i + 1 == substeps.size(), body_);
        if (info.teleport)
            jumped_ += now.head.origin - head_.origin;
        else
            head_velocity_ = (now.head.origin - head_.origin) / double(now.seconds);
        const Pose before = std::exchange(head_, now.head);
        time_ = now.time;
        if (params_.solver_kind == 0)
        {
            const StepPath path = make_step_path(params_, before, now, info.teleport, seconds_before_);
            const long on_head = std::count_if(colliders_.begin(), colliders_.end(), [](auto& c) { return c.on_head; });
            set_direct(info, path, groom_, rest_, int(on_head));
            upload_direct(path, before, info.teleport);
        }
        seconds_before_ = now.seconds;
        watched_ = double(now.seconds);
        upload(info);
        simulate(info);
    }
    if (quiet_ % kLookEvery == 0 && quiet_ > 0)
        look_for_rest();
    const bool repels = params_.forces_repulsion > 0.0f;
    if (!repels && !has_shadow())
        return;
    const size_t chunks = grid_voxels(params_) / size_t(chunk(device_, params_));
    const auto blur = [&](const char* box, int axis)
    {
        launch("blur_density", fmt::format("-D AXIS={} -D BOX={}", axis, box), chunks);
        std::swap(buffers_["density"], buffers_["blurred"]);
    };
    for (int axis = 0; axis < 3 && info_.light_box.w > 0.0f; ++axis)
        blur("light_box", axis);
    if (!repels)
        return;
    const bool further = info_.push_box.w > 0.0f;
    for (int axis = 0; axis < 3 && further; ++axis)
    {
        blur("push_box", axis);
        if (axis == 0) // light goes on reading what was there before
            std::swap(buffers_["blurred"], buffers_["lit"]);
    }
    launch("density_gradient", "", chunks);
    if (further)
        std::swap(buffers_["density"], buffers_["lit"]);
}

void Solver::draw()
{
    if (drawn_asleep_ && !changed_)
        return;
    drawn_asleep_ = asleep_ && !changed_;
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

std::vector<float> Solver::multipliers() const
{
    return read<float>(device_, buffer("multiplier"), size_t(groom_.blocks) * LANES * size_t(groom_.nodes));
}
std::vector<int> Solver::faults() const { return read<int>(device_, buffer("faults"), size_t(groom_.guides)); }
std::vector<int> Solver::resets() const { return read<int>(device_, buffer("resets"), size_t(groom_.guides)); }

double sum_of(const PassTimes& times)
{
    double ms = 0.0;
    for (const auto& [pass, spent] : times)
        ms += spent;
    return ms;
}

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

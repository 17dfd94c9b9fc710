// What the device does: the passes of a step and of a picture, in their order.
#include "sim/solver.h"

#include "sim/bodies.h"
#include "sim/error.h"
#include "sim/material.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace coif
{

static constexpr int kLookEvery = 16; // steps, when hair may be at rest

// Voxels that a work-item of the grid's passes takes along x.
static int chunk(const Device& device, const HairParams& params)
{
    return params.grid_resolution % device.width == 0 ? device.width : 1;
}

Kernel& Solver::kernel(const std::string& file, const std::string& extra, int nodes)
{
    const std::string options = fmt::format("-D NODES={} -D RESOLUTION={} -D WIDTH={} -D CHUNK={} {}", nodes,
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

void Solver::reload_kernels()
{
    std::map<std::string, Kernel> fresh;
    for (const auto& [key, old] : kernels_) // by file and options
        fresh[key] = load_kernel(device_, key.substr(0, key.find(' ')), key.substr(key.find(' ') + 1));
    device_.queue.finish();
    kernels_ = std::move(fresh);
    changed_ = true;
    grid_is_fresh_ = true;
    stood_.reset();
}

void Solver::launch(const std::string& pass, const std::string& extra, const cl::NDRange& items,
                    const cl::NDRange& group)
{
    launches_.emplace_back(pass, run(device_, kernel(pass, extra), buffers_, items, group));
}

void Solver::launch_strands(const std::string& pass, const std::string& extra, size_t strands)
{
    launch_strands(pass, extra, strands, groom_.nodes, buffers_);
}

void Solver::launch_strands(const std::string& pass, const std::string& extra, size_t strands, int nodes,
                            const Buffers& on)
{
    if (strands == 0)
        return;
    // On CPUs each work-item is a group of its own: left to itself PoCL makes one group of few work-items, on one core.
    // On GPUs whole groups: a number of strands that has no divisors would else be cut into groups of one.
    const size_t width = size_t(device_.width);
    Kernel& of = kernel(pass, extra, nodes);
    const size_t most = of.handle.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_.device);
    const size_t group = width > 1 ? 1 : std::min<size_t>(64, most);
    const size_t items = (strands + width - 1) / width;
    launches_.emplace_back(pass,
                           run(device_, of, on, cl::NDRange((items + group - 1) / group * group), cl::NDRange(group)));
}

// A work-item for each chunk of voxels. On CPUs a slice is a group, as far as that may be: left to itself PoCL makes a
// few large ones, some of which hold no hair.
void Solver::launch_grid(const std::string& pass, const std::string& extra)
{
    const size_t side = size_t(params_.grid_resolution), chunks = side / size_t(chunk(device_, params_));
    const size_t most = kernel(pass, extra).handle.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_.device);
    const cl::NDRange items(chunks, side, side);
    if (device_.is_gpu)
        launch(pass, extra, items);
    else
        launch(pass, extra, items, cl::NDRange(chunks, chunks * side <= most ? side : 1, 1));
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

void Solver::simulate(const StepInfo& info)
{
    const bool repels = params_.forces_repulsion > 0.0f, density = repels || has_shadow();
    const GridUse use = {repels, has_shadow(), info.light_box, info.push_box};
    if (grid_is_fresh_ || use != grid_use_)
        empty_grid();
    grid_is_fresh_ = false;
    grid_use_ = use;
    if (info.last_substep && density)
        launch_grid("clear_density");
    if (params_.solver_kind == 0)
        return simulate_direct(info);
    change_nodes({});
    launch_strands("simulate_pbd",
                   fmt::format("{}{}{}{}{}", info.wind.w > 0.0f ? "-D WIND " : "", repels ? "-D REPULSION " : "",
                               density ? "-D DENSITY " : "", body_.grid ? "-D BODY_GRID " : "",
                               groom_.held.empty() ? "" : "-D HELD "),
                   size_t(groom_.blocks) * LANES);
}

// Hair that weight and wind hardly bend goes with the head, if it stands clear of that and there is nothing else to
// meet.
bool Solver::stands_rigid(const StepInfo& info)
{
    constexpr double kStiff = 0.1, kWithin = 0.001; // droop number; m
    const double load = std::abs(double(info.gravity)) + double(info.wind.w) * (1.0 + double(info.gust_origin.w));
    const double softest =
        *std::min_element(groom_.bend_factor.begin(), groom_.bend_factor.end()) * least_of(params_.bending_along);
    if (params_.bending_modulus > 0.0f || params_.bending_droop * std::max(1.0, load / kGravity) >= kStiff * softest)
        return false;
    if (!rest_clear_)
    {
        rest_clear_ = std::all_of(colliders_.begin(), colliders_.end(), [](const Collider& c) { return c.on_head; });
        const std::vector<Capsule> bodies = placed_colliders();
        for (int s = 0; s < groom_.guides && *rest_clear_; ++s)
            for (int k = 2; k < groom_.nodes && *rest_clear_; ++k)
            {
                const glm::dvec3 rest = vector_at(rest_.position.data(), s, k, groom_.nodes);
                rest_clear_ = depth_in(bodies, body_, head_.turn, glm::vec3(head_.turn * rest)) < kWithin;
            }
    }
    return *rest_clear_;
}

void Solver::simulate_direct(const StepInfo& info)
{
    const bool repels = params_.forces_repulsion > 0.0f, density = repels || has_shadow();
    // Softer than this, what bending there is lies within half a segment of the root: not seen by the nodes.
    const double links = groom_.nodes - 2;
    const double stiffest =
        *std::max_element(groom_.bend_factor.begin(), groom_.bend_factor.end()) * most_of(params_.bending_along);
    const bool bending = params_.bending_modulus > 0.0f || params_.bending_droop < 4.0 * links * links * stiffest;
    const bool contact = !colliders_.empty() || body_.grid;
    const bool rigid = stands_rigid(info);
    change_nodes(rigid ? std::vector<int>{} : far_);
    if (rigid)
        return launch_strands("simulate_rigid", density ? "-D DENSITY " : "", size_t(groom_.blocks) * LANES);
    const auto features = [&](const RestShape& rest, bool dense)
    {
        return fmt::format("{}{}{}{}{}{}{}{}", bending ? "-D BENDING " : "", bending && rest.curled ? "-D CURLED " : "",
                           info.wind.w > 0.0f ? "-D WIND " : "", repels ? "-D REPULSION " : "",
                           contact ? "-D CONTACT " : "", body_.grid ? "-D BODY_GRID " : "", dense ? "-D DENSITY " : "",
                           groom_.held.empty() ? "" : "-D HELD ");
    };
    const int thin = blocks_thin();
    if (thin < groom_.blocks)
        launch_strands("simulate_direct", features(rest_, density) + (thin > 0 ? "-D THIN=0 " : ""),
                       size_t(groom_.blocks) * LANES);
    if (thin > 0)
        simulate_thin(info, features(*thin_rest_, false) + "-D THIN=1 ",
                      fmt::format("{}{}{}", contact ? "-D CONTACT " : "", body_.grid ? "-D BODY_GRID " : "",
                                  density ? "-D DENSITY " : ""));
    std::swap(buffers_["tension"], buffers_["tension_next"]);
    std::swap(buffers_["pace"], buffers_["pace_next"]);
    std::swap(buffers_["still"], buffers_["still_next"]);
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

// As the last step would have, had light been asked for then.
void Solver::make_density()
{
    empty_grid();
    launch_strands("deposit_density", "", size_t(groom_.guides));
    launch("grid_room", "", cl::NDRange(1), cl::NDRange(1));
    blur();
    dense_ = true;
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
    far_ = thin_error_ ? far_at(*thin_error_) : std::vector<int>{};
    if (asleep_ && comes_near())
    {
        asleep_ = false;
        calm_ = 0;
    }
    drawn_asleep_ &= asleep_;
    if (asleep_)
        return;
    if ((outside || !blocks_may_sleep_) && params_.solver_kind == 0) // all blocks are awake
        device_.queue.enqueueFillBuffer(buffer("still"), 0.0f, 0, size_t(groom_.blocks) * LANES * sizeof(float));
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
    dense_ = repels || has_shadow();
    if (!dense_)
        return;
    launch("grid_room", "", cl::NDRange(1), cl::NDRange(1));
    blur();
    if (repels)
    {
        launch_grid("density_gradient");
        if (info_.push_box.w > 0.0f)
            std::swap(buffers_["density"], buffers_["lit"]);
    }
}

// The passes of a step write to the part of the grid that hair is or was in (kernels/grid_room.cl) and count on zero
// beyond it, in buffers that change places.
void Solver::empty_grid()
{
    const size_t voxels = grid_voxels(params_);
    for (const char* name : {"density", "blurred", "lit"})
        device_.queue.enqueueFillBuffer(buffer(name), 0, 0, voxels * sizeof(int));
    device_.queue.enqueueFillBuffer(buffer("gradient"), 0, 0, voxels * 3 * sizeof(float));
    for (const char* name : {"touched", "touched_before"})
        device_.queue.enqueueFillBuffer(buffer(name), params_.grid_resolution, 0, 6 * sizeof(int)); // none
    device_.queue.enqueueFillBuffer(buffer("room"), 0, 0, 6 * sizeof(int));
}

// For light, and for repulsion further.
void Solver::blur()
{
    const auto along = [&](const char* box, int axis)
    {
        launch_grid("blur_density", fmt::format("-D AXIS={} -D BOX={}", axis, box));
        std::swap(buffers_["density"], buffers_["blurred"]);
    };
    for (int axis = 0; axis < 3 && info_.light_box.w > 0.0f; ++axis)
        along("light_box", axis);
    for (int axis = 0; axis < 3 && params_.forces_repulsion > 0.0f && info_.push_box.w > 0.0f; ++axis)
    {
        along("push_box", axis);
        if (axis == 0) // light goes on reading what was there before
            std::swap(buffers_["blurred"], buffers_["lit"]);
    }
}

// The head's share of the grid: as before as long as neither turns.
void Solver::stand_head()
{
    const auto placed = [](const StepInfo& info)
    {
        return std::tuple(info.head_row0, info.head_row1, info.head_row2, info.grid_corner, info.body_corner,
                          info.body_density);
    };
    if (stood_ && placed(*stood_) == placed(info_))
        return;
    device_.queue.enqueueFillBuffer(buffer("head_touched"), params_.grid_resolution, 0, 6 * sizeof(int)); // none
    const size_t bricks = (size_t(params_.grid_resolution) + 3) / 4, width = size_t(device_.width);
    launch("stand_head", "", cl::NDRange((bricks + width - 1) / width, bricks, bricks),
           device_.is_gpu ? cl::NullRange : cl::NDRange(1, bricks, 1));
    stood_ = info_;
}

void Solver::draw()
{
    if (drawn_asleep_ && !changed_)
        return;
    drawn_asleep_ = asleep_ && !changed_;
    ++drawings_;
    // Light, colliders and parameters as they are now, though time may stand still; the density is the last step's.
    StepInfo info = make_step_info(params_, groom_, head_, head_velocity_, {head_, time_, 1.0f / 60.0f},
                                   int(colliders_.size()), true, body_);
    upload(info);
    const std::string options =
        fmt::format("{}{}{}{}", has_shadow() ? "-D SHADOW " : "", body_.grid ? "-D BODY_GRID " : "",
                    groom_.looks.empty() ? "" : "-D VARIED ",
                    params_.flyaway_share > 0.0f && params_.flyaway_distance > 0.0f ? "-D FLYAWAY " : "");
    const bool braids = std::any_of(groom_.tails.begin(), groom_.tails.end(), [](auto& t) { return t.axis.w > 0.0f; });
    const std::string braided = braids ? "-D BRAIDED " : "";
    if (has_shadow())
    {
        if (!dense_)
            make_density();
        const size_t side = size_t(params_.grid_resolution);
        const size_t chunks = side / size_t(chunk(device_, params_));
        if (body_.grid)
            stand_head();
        launch("light_room", body_.grid ? "-D BODY_GRID" : "", cl::NDRange(1), cl::NDRange(1));
        if (body_.grid)
            launch_grid("add_head");
        else
            device_.queue.enqueueCopyBuffer(buffer("density"), buffer("occupied"), 0, 0,
                                            grid_voxels(params_) * sizeof(int));
        if (!colliders_.empty())
            launch("add_bodies", "", cl::NDRange(side, side, colliders_.size()));
        launch("transmittance", "", cl::NDRange(side * chunks),
               device_.is_gpu ? cl::NullRange : cl::NDRange(chunks)); // few and long: groups for all cores
    }
    launch_strands("interpolate_multi", options + (groom_.tied.empty() ? "" : "-D TIED " + braided),
                   size_t(groom_.drawn_multi));
    launch_strands("interpolate_single", options, groom_.drawn.size() - size_t(groom_.drawn_multi));
    if (has_clumps(params_))
        launch_strands("clump",
                       fmt::format("{}{}", body_.grid ? "-D BODY_GRID " : "", groom_.looks.empty() ? "" : "-D VARIED "),
                       groom_.drawn.size());
    launch_strands("transport_frames", braided + (has_clumps(params_) ? "-D CLUMPS " : ""), groom_.drawn.size());
}

Moment Solver::moment() const
{
    const Mapped guides = guide_positions();
    const float* x = guides.as<float>();
    return {head_, jumped_, std::vector<float>(x, x + guides.bytes() / sizeof(float))};
}

void Solver::show(const Moment& moment)
{
    send("position", moment.guides.data(), moment.guides.size() * sizeof(float));
    head_ = moment.head;
    jumped_ = moment.jumped;
    drawn_asleep_ = false;
}

Moment between(const Moment& a, const Moment& b, double share)
{
    if (a.jumped != b.jumped || a.guides.size() != b.guides.size())
        return share < 0.5 ? a : b;
    Moment m = b; // and its wind
    m.head.origin = a.head.origin + (b.head.origin - a.head.origin) * share;
    m.head.turn = a.head.turn == b.head.turn ? b.head.turn : glm::slerp(a.head.turn, b.head.turn, share);
    for (size_t i = 0; i < m.guides.size(); ++i)
        m.guides[i] = a.guides[i] + (b.guides[i] - a.guides[i]) * float(share);
    return m;
}

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

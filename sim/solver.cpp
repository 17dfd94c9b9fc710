// What the device holds, put there and looked at; sim/solver_step.cpp sets it in motion.
#include "sim/solver.h"

#include "kernels/sleep.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cstring>
#include <tuple>

namespace coif
{

size_t grid_voxels(const HairParams& params)
{
    return size_t(params.grid_resolution) * size_t(params.grid_resolution) * size_t(params.grid_resolution);
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

// But for what is only looked at: without shadows of their own steps and strands hang on none of it.
static bool same_hair(const HairParams& a, const HairParams& b)
{
    return std::ranges::all_of(param_table(),
                               [&](const ParamInfo& info)
                               {
                                   const std::string_view group = info.group;
                                   float of_a[kMostNumbers] = {}, of_b[kMostNumbers] = {};
                                   if (info.on_host() || group == "look" || group == "camera")
                                       return true;
                                   get_numbers(a, info, of_a);
                                   get_numbers(b, info, of_b);
                                   return std::ranges::equal(of_a, of_b);
                               });
}

void Solver::set_params(const HairParams& params)
{
    const HairParams wanted = device_params(params);
    const bool other_grid = !buffers_.contains("density") || wanted.grid_resolution != params_.grid_resolution;
    if (other_grid)
    {
        const size_t voxels = grid_voxels(wanted);
        Buffers fresh = buffers_; // what cannot be allocated leaves everything as it was
        for (const char* name : {"density", "blurred", "lit", "in_head", "occupied", "depth"})
            fresh[name] = allocate(device_, voxels * sizeof(int), "the density grid");
        fresh["gradient"] = allocate(device_, voxels * 3 * sizeof(float), "the density's gradient");
        for (const char* name : {"touched", "touched_before", "room", "head_touched"})
            fresh[name] = allocate(device_, 6 * sizeof(int), "the density grid");
        fresh["light_room"] = allocate(device_, 12 * sizeof(int), "the density grid");
        device_.queue.enqueueFillBuffer(fresh["light_room"], 0, 0, 12 * sizeof(int));
        for (const char* name : {"occupied", "depth"})
            device_.queue.enqueueFillBuffer(fresh[name], 0, 0, voxels * sizeof(int));
        buffers_ = fresh;
        stood_.reset();
    }
    // What the rest shape hangs on besides the groom.
    const auto shaping = [](const HairParams& p)
    {
        return std::tuple(p.strand_spacing, p.bending_droop, p.bending_modulus, p.bending_diameter,
                          p.bending_attenuation, p.bending_along, p.forces_gravity);
    };
    const bool reshaped = shaping(wanted) != shaping(params_);
    const bool shadow = has_shadow();
    const bool same = memcmp(&wanted, &params_, sizeof wanted) == 0, same_but_looks = same_hair(wanted, params_);
    params_ = wanted;
    if (other_grid)
        empty_grid();
    changed_ |= !same && (!same_but_looks || shadow || has_shadow());
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
        for (const char* name : {"moved", "still", "still_next"})
            fresh[name] = allocate(device_, strands * sizeof(float), "the guides");
        fresh["pushed"] = allocate(device_, strands * 3 * sizeof(float), "the guides");
        device_.queue.enqueueFillBuffer(fresh["moved"], 0.0f, 0, strands * sizeof(float));
        fresh["faults"] = allocate(device_, strands * sizeof(int), "the guides");
        device_.queue.enqueueFillBuffer(fresh["faults"], 0, 0, strands * sizeof(int));
        fresh["root_position"] = allocate(device_, strands * 3 * sizeof(float), "the roots");
        fresh["root_direction"] = allocate(device_, strands * 3 * sizeof(float), "the roots");
        fresh["segment_length"] = allocate(device_, strands * sizeof(float), "the roots");
        fresh["bend_factor"] = allocate(device_, strands * sizeof(float), "the guides");
        fresh["position"] = allocate(device_, values * sizeof(float), "the guides");
        fresh["velocity"] = allocate(device_, values * sizeof(float), "the guides");
        fresh["resets"] = allocate(device_, strands * sizeof(int), "the guides");
        device_.queue.enqueueFillBuffer(fresh["resets"], 0, 0, strands * sizeof(int));
    }
    if (!groom.held.empty() && (!same || groom_.held.empty()))
        fresh["held_nodes"] = allocate(device_, strands * sizeof(int), "the guides");
    if (groom.tied.size() != groom_.tied.size() || !fresh.contains("tied"))
        fresh["tied"] = allocate(device_, std::max<size_t>(groom.tied.size(), 1) * sizeof(TiedStrand), "the ties");
    if (groom.tails.size() != groom_.tails.size() || !fresh.contains("tails"))
        fresh["tails"] = allocate(device_, std::max<size_t>(groom.tails.size(), 1) * sizeof(Tail), "the ties");
    if (!same_drawn)
    {
        fresh["strands"] = allocate(device_, groom.drawn.size() * sizeof(DrawnStrand), "the drawn strands");
        fresh["drawn_position"] = allocate(device_, drawn_nodes * sizeof(float4), "the drawn strands");
        fresh["drawn_frame"] = allocate(device_, drawn_nodes * sizeof(float4), "the drawn strands");
    }
    if (groom.looks.size() != groom_.looks.size() || !fresh.contains("looks"))
        fresh["looks"] = allocate(device_, std::max<size_t>(1, groom.looks.size()) * sizeof(StrandLook), "their looks");
    buffers_ = fresh;
    groom_ = groom;
    changed_ = true;
    if (groom_.bend_factor.empty())
        groom_.bend_factor.resize(strands, 1.0f);
    write(device_, buffer("bend_factor"), groom_.bend_factor);
    write(device_, buffer("looks"), groom.looks);
    write(device_, buffer("root_position"), groom.root_position);
    write(device_, buffer("root_direction"), groom.root_direction);
    write(device_, buffer("segment_length"), groom.segment_length);
    write(device_, buffer("strands"), groom.drawn);
    if (!groom.held.empty())
        write(device_, buffer("held_nodes"), groom.held);
    write(device_, buffer("tied"), groom.tied);
    write(device_, buffer("tails"), groom.tails);
    set_rest_shape();
    if (!same)
        reset(head_);
}

void Solver::set_colliders(const std::vector<Collider>& colliders)
{
    if (colliders != colliders_)
    {
        changed_ = true;
        rest_clear_.reset();
    }
    if (colliders.size() > colliders_.size())
        for (const char* name : {"colliders", "bodies"})
            buffers_[name] = allocate(device_, colliders.size() * sizeof(Capsule), "the colliders");
    colliders_ = colliders;
}

void Solver::set_rest_shape()
{
    rest_ = make_rest_shape(params_, groom_);
    rest_clear_.reset();
    far_blocks_.clear();
    thin_rest_.reset();
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
    if (body != body_)
    {
        changed_ = true;
        stood_.reset();
        rest_clear_.reset();
    }
    body_ = body;
}

void Solver::reset(const Pose& head)
{
    head_ = head;
    head_velocity_ = glm::dvec3(0.0);
    changed_ = true;
    thin_now_.clear();
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
int Solver::blocks_awake() const
{
    if (asleep_ || params_.solver_kind != 0)
        return asleep_ ? 0 : groom_.blocks;
    const std::vector<float> still = read<float>(device_, buffer("still"), size_t(groom_.blocks) * LANES);
    int awake = 0;
    for (auto block = still.begin(); block != still.end(); block += LANES)
        awake += *std::min_element(block, block + LANES) < SLEEP_AFTER;
    return awake;
}
int Solver::blocks_thin() const { return int(std::ranges::count(thin_now_, 1)); }
bool Solver::has_shadow() const { return params_.look_self_shadow > 0.0f && lit_by_kajiya_kay(params_); }

} // namespace coif

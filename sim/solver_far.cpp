// Which blocks step with half their nodes, and how: sim/far.h.
#include "kernels/thin.h"
#include "sim/solver.h"

#include <algorithm>
#include <cstring>

namespace coif
{

// Of each block, whether it is far from where the head was; empty: none is.
std::vector<int> Solver::far_at(double error) const
{
    if (!view_ || !blocks_may_sleep_ || params_.solver_kind != 0 || params_.solver_far_tolerance <= 0.0f ||
        !may_thin(groom_))
        return {};
    if (far_blocks_.empty())
        far_blocks_ = far_blocks(params_, groom_);
    std::vector<int> far;
    for (size_t i = 0; i < far_blocks_.size(); ++i)
        far.push_back(is_far(far_blocks_[i], error, *view_, head_, params_.solver_far_tolerance,
                             !thin_now_.empty() && thin_now_[i]));
    if (std::ranges::count(far, 0) == std::ssize(far))
        far.clear();
    return far;
}

bool Solver::may_be_far() const
{
    constexpr double kLeast = 0.002; // less has not been seen
    return !far_at(kLeast).empty();
}

// Does a block that steps with few nodes ask for all?
bool Solver::comes_near() const
{
    for (size_t i = 0; i < thin_now_.size(); ++i)
        if (thin_now_[i] && (far_.empty() || !far_[i]))
            return true;
    return false;
}

// Takes the rest shape that thin chains have, and room for them; as it was where there is neither.
void Solver::make_thin()
{
    if (thin_rest_)
        return;
    const Groom few = thinned(groom_);
    RestShape rest = make_rest_shape(params_, few);
    const size_t values = rest.position.size() * sizeof(float), strands = few.segment_length.size() * sizeof(float);
    Buffers fresh = buffers_; // what cannot be allocated leaves everything as it was
    if (thin_now_.empty())
    {
        for (const char* name : {"thin_position", "thin_velocity", "thin_rest_position", "thin_rest_bend"})
            fresh[name] = allocate(device_, values, "far strands");
        fresh["thin_multiplier"] = allocate(device_, rest.multiplier.size() * sizeof(float), "far strands");
        fresh["thin_segment_length"] = allocate(device_, strands, "far strands");
        fresh["thin_info"] = allocate(device_, sizeof(StepInfo), "the step");
        fresh["thinned"] = allocate(device_, size_t(groom_.blocks) * sizeof(int), "far strands");
    }
    write(device_, fresh["thin_rest_position"], rest.position);
    write(device_, fresh["thin_rest_bend"], rest.bend);
    write(device_, fresh["thin_segment_length"], few.segment_length);
    buffers_ = fresh;
    thin_rest_ = std::move(rest);
}

// From now on blocks step as they are far or near.
void Solver::change_nodes(const std::vector<int>& far)
{
    if (!far.empty())
        make_thin();
    if (far == thin_now_)
        return;
    std::vector<int> change(size_t(groom_.blocks), 0);
    for (size_t i = 0; i < change.size(); ++i)
        change[i] = (!far.empty() && far[i] ? THIN_NOW : 0) | (!thin_now_.empty() && thin_now_[i] ? THIN_BEFORE : 0);
    send("thinned", change.data(), change.size() * sizeof(int));
    launch_strands("change_nodes", "", size_t(groom_.blocks) * LANES);
    thin_now_ = far;
}

// Their step is that of strands that were grown with so few nodes.
void Solver::simulate_thin(const StepInfo& info, const std::string& features, const std::string& filled)
{
    StepInfo thin = info;
    thin.bend_droop /= 8.0f; // goes with the cube of the links
    thin.bend_most = float(thin_rest_->bend_most);
    thin.turning_rate = float(thin_rest_->turning_rate);
    send("thin_info", &thin, sizeof thin);
    Buffers on = buffers_;
    for (const char* name :
         {"position", "velocity", "multiplier", "segment_length", "rest_position", "rest_bend", "info"})
        on[name] = buffer(std::string("thin_") + name);
    const size_t strands = size_t(groom_.blocks) * LANES;
    launch_strands("simulate_direct", features, strands, thin_nodes(groom_.nodes), on);
    launch_strands("fill_in", filled, strands);
}

} // namespace coif

#pragma once
#include "sim/device.h"
#include "sim/far.h"
#include "sim/rest_shape.h"
#include "sim/step_info.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coif
{

// Milliseconds that the device spent in a pass since the last take_times().
using PassTimes = std::vector<std::pair<std::string, double>>;
double sum_of(const PassTimes& times);

size_t grid_voxels(const HairParams& params); // of the density grid

// What is drawn of a step: for pictures between two.
struct Moment
{
    Pose head;
    glm::dvec3 jumped{0.0};
    std::vector<float> guides; // as Solver::guide_positions()
};
// In a straight line from one to the other, a share of the way; where the head leaps between them, the nearer one.
Moment between(const Moment& a, const Moment& b, double share);

// What the passes over the grid do: where it changes, what other ones left there must go.
struct GridUse
{
    bool repels, shades;
    float4 light_box, push_box;
    bool operator==(const GridUse&) const = default;
};

// Moves one groom in time, and makes its drawn strands. Data goes one way: parameters, groom, colliders and poses down,
// positions back; nothing in between touches the host. Throws Error for what the device refuses; where that is memory,
// all stays as it was.
class Solver
{
  public:
    // Starts at rest about `head`. `params` as authored.
    Solver(const Device& device, const HairParams& params, const Groom& groom, const Pose& head);

    void set_params(const HairParams& params);
    void
    reload_kernels(); // builds those in use anew from their files; where one fails, throws and all stay as they are
    // Takes new roots and weights. Strands keep their motion if guides and nodes are as many as before.
    void set_groom(const Groom& groom);
    Solver(const Solver&) = delete;
    ~Solver(); // waits: the queue may still read what it was sent

    // In the head's frame those on_head, in the world the others.
    void set_colliders(const std::vector<Collider>& colliders);
    // The distance grid that stands for the head, or none.
    void set_body(const PlacedGrid& body);

    void reset(const Pose& head); // all strands straight from their roots, at rest
    // One fixed step, cut into substeps (thesis, figure 4.1). A substep that is not longer than zero is none.
    void step(const std::vector<Substep>& substeps);
    void draw(); // drawn strands and light for the last finished step

    // Hair that has come to rest on a head at rest in still air sleeps: steps and draws cost nothing until something
    // changes.
    bool asleep() const { return asleep_; }
    // So do blocks of 16 strands alone, where they may: those of the direct solver that have come to rest.
    void let_blocks_sleep(bool may) { blocks_may_sleep_ = may; }
    int blocks_awake() const; // waits for the device
    // From where the hair is seen, and what half the nodes err by, rms as a share of the length: for
    // solver.far_tolerance. Without either nothing is far, nor while blocks may not sleep.
    void set_view(const std::optional<View>& view) { view_ = view; }
    void set_thin_error(std::optional<double> share) { thin_error_ = share; }
    bool may_be_far() const;                    // if half the nodes did hardly any harm
    int blocks_thin() const;                    // that step with half their nodes
    long drawings() const { return drawings_; } // that draw() has made anew
    void keep_awake() { changed_ = true; }      // for the next step and draw
    double fastest(); // node against the head's origin in the steps since the last call, m/s; waits for the device

    // Views of results; they wait for the device. Layouts: kernels/shared.h, drawn nodes strand after strand.
    Mapped guide_positions() const; // float, [block][node][axis][lane], relative to the head's origin, m
    Mapped drawn_positions() const; // float4 (position relative to the head's origin, share of light), [strand][node]
    Mapped drawn_frames() const;    // float4 (normal, length from the root), [strand][node]
    Mapped optical_depth() const;   // float, [slice][ray][ray] of light_grid.h
    std::vector<float> multipliers() const; // [block][node][lane], 1/s^2: tension over mass and length
    std::vector<int> resets() const;        // of each guide since the start
    std::vector<int> faults() const;        // of each guide: why it was last reset, FAULT_* of kernels/shared.h
    bool has_shadow() const;                // of strands on strands, as the thesis has it: light_grid.h

    const Device& device() const { return device_; }
    const Groom& groom() const { return groom_; }
    const StepInfo& info() const { return info_; }
    const Pose& head() const { return head_; }
    const std::vector<float>& rest_positions() const { return rest_.position; } // RestShape::position
    std::vector<Capsule> placed_colliders() const; // relative to the head's origin, at the last step
    const PlacedGrid& body() const { return body_; }
    const std::vector<Collider>& colliders() const { return colliders_; }
    glm::dvec3 jumped() const { return jumped_; } // sum of the head's teleports, m
    Moment moment() const;                        // as it is; waits for the device
    // For the next draw(). Before the next step the moment that was must be shown again.
    void show(const Moment& moment);
    PassTimes take_times();

    // Buffers by kernel argument; kernels in use, by file and options.
    const Buffers& buffers() const { return buffers_; }
    const std::map<std::string, Kernel>& kernels() const { return kernels_; }

  private:
    const cl::Buffer& buffer(const std::string& name) const { return buffers_.at(name); }
    Kernel& kernel(const std::string& file, const std::string& extra) { return kernel(file, extra, groom_.nodes); }
    Kernel& kernel(const std::string& file, const std::string& extra, int nodes);
    void launch(const std::string& pass, const std::string& extra, const cl::NDRange& items,
                const cl::NDRange& group = cl::NullRange);
    void launch_strands(const std::string& pass, const std::string& extra, size_t strands);
    void launch_strands(const std::string& pass, const std::string& extra, size_t strands, int nodes,
                        const Buffers& on);
    void launch_grid(const std::string& pass, const std::string& extra = {});
    void empty_grid();
    void blur();
    void stand_head();
    void set_rest_shape();
    bool stands_rigid(const StepInfo& info);
    void look_for_rest();
    void send(const std::string& name, const void* data, size_t bytes);
    void simulate(const StepInfo& info);
    void make_density();
    void simulate_direct(const StepInfo& info);
    std::vector<int> far_at(double error) const;
    bool comes_near() const;
    void make_thin();
    void change_nodes(const std::vector<int>& far);
    void simulate_thin(const StepInfo& info, const std::string& features, const std::string& filled);
    void upload(const StepInfo& info);
    void upload_direct(const StepPath& path, const Pose& before, bool teleport);

    const Device& device_;
    HairParams params_; // as the device reads them
    Groom groom_;
    Pose head_;
    RestShape rest_;
    std::optional<bool> rest_clear_; // of the bodies, none of which moves against the head; none: not looked at yet
    bool changed_ = true;            // anything but time since the last step
    bool asleep_ = false, drawn_asleep_ = false;
    bool blocks_may_sleep_ = false;
    std::optional<View> view_;
    std::optional<double> thin_error_;
    mutable std::vector<FarBlock> far_blocks_; // if anybody has asked since they last changed
    std::vector<int> far_, thin_now_;          // of each block: is it far, and does it step so; empty: none
    std::optional<RestShape> thin_rest_;
    bool dense_ = true; // is the density that of the last step?
    long drawings_ = 0;
    int quiet_ = 0;        // steps that nothing outside has moved the hair in
    double watched_ = 0.0; // s that `moved` is the greatest of
    int calm_ = 0;         // looks in a row that found no motion
    double time_ = 0.0;
    double seconds_before_ = 1.0 / 60.0; // of the last substep
    glm::dvec3 head_velocity_{0.0}, jumped_{0.0};
    std::vector<Collider> colliders_;
    PlacedGrid body_;
    StepInfo info_ = {};
    bool grid_is_fresh_ = true;       // its buffers hold anything
    std::optional<GridUse> grid_use_; // of the last step
    std::optional<StepInfo> stood_;   // what the head stood in the grid by
    Buffers buffers_;
    std::map<std::string, Kernel> kernels_; // by file and options
    // What the queue still reads from, and its launches: kept until the host next waits.
    std::vector<std::vector<char>> in_flight_;
    std::vector<std::pair<std::string, cl::Event>> launches_;
    PassTimes times_;
};

} // namespace coif

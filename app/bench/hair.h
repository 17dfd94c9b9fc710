// Hair whose frames are timed.
#pragma once
#include "app/bench/bench.h"
#include "sim/motion.h"
#include "sim/solver.h"

#include <memory>

namespace coif
{

// A preset with `sets` (group.key=value) on top, on a head that goes on shaking.
class BenchHair
{
  public:
    BenchHair(const Device& device, const std::string& preset, const std::vector<std::string>& sets,
              bool with_bodies = true);

    // Some frames of 1/60 s, with the drawn strands if `drawn`: ms of each pass in one of them and, first, of the whole
    // frame on the clock.
    PassTimes frames(int count, bool drawn);
    // The same on a head that stands still where it is, for so many seconds; hair may sleep.
    PassTimes rest(double seconds);

    // From now on all of it steps with half its nodes, as hair far away does where solver.far_tolerance allows it.
    void go_far();

    Solver& solver() { return *solver_; }
    int strands() const { return solver_->groom().guides; }

  private:
    Assets assets_;
    std::unique_ptr<Solver> solver_;
    Motion motion_;
    double time_ = 0.0;
};

// What a frame's passes have to read and write: each buffer that a kernel names, once, twice if it may be written to.
// Bytes, by pass.
std::map<std::string, double> traffic_of(const Solver& solver);

// What a frame's passes have to do on numbers at least, as counted in their source; those that are not counted are left
// out. Operations, by pass.
std::map<std::string, double> operations_of(const Solver& solver);

// How long each pass of each run took: medians and quartiles, as rows with nothing else said. All runs take turns.
std::vector<std::vector<BenchRow>> timed(const std::vector<std::function<PassTimes()>>& runs, int repeats);

} // namespace coif

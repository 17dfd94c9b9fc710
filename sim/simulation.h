#pragma once
#include "sim/distance_grid.h"
#include "sim/hairstyle.h"
#include "sim/lights.h"
#include "sim/mesh.h"
#include "sim/quality.h"
#include "sim/solver.h"
#include "sim/tied_hair.h"

#include <functional>
#include <memory>
#include <optional>

namespace coif
{

// What a style names by path, loaded.
struct Assets
{
    Scalp scalp;
    Mesh head;                                // m, y up; empty if the style names none
    std::vector<Collider> spheres;            // that stand for the head, unless its grid does
    std::optional<LightRig> lights;           // of a file, if the style names one
    DistanceGrid distances;                   // to the head's mesh, once a style has asked for them
    std::shared_ptr<const DistanceGrid> grid; // the same with hollows filled, as wide as head.mesh_scale asks
    float grid_scale = 0.0f;                  // that it asked for then
};

// Loads them; throws Error with the place in the style where a path is written.
Assets load_assets(const Hairstyle& style);

// The distance grid that stands for the head, scaled and offset as the style says; without a grid if head.contact is
// spheres or there is no mesh. Computed or read from the cache if these assets have none yet.
PlacedGrid head_grid(const Hairstyle& style, Assets& assets);

// What a scalp or a head of such a size may come of, as "the scalp is 180 m across"; empty where both are plausible.
// Most files do not say their unit, so it is no error.
std::string doubtful_size(const HairParams& params, const Assets& assets);

// The head's own spheres, scaled and offset as the style says, unless its grid stands for it; followed by the style's
// colliders.
std::vector<Collider> all_colliders(const Hairstyle& style, const Assets& assets, bool grid);

// The head that hair is tied over: its grid as head_grid() has it, or else its spheres.
TieGround tie_ground(const Hairstyle& style, const Assets& assets, const PlacedGrid& grid);

// The style's hair, grown on its scalp and tied. Throws Error as grow() and check_tie().
Groom grown(const Hairstyle& style, Assets& assets);

// Strands of ties that are too short to come through their rings, as "tie 'left': 12 of its 90 guides ..."; empty if
// none is.
std::string doubtful_ties(const Hairstyle& style, const Groom& groom);

// Told what share of the steps is done, at most, that hair takes to fall to rest: 0 as it begins, 1 as it ends. Of many
// guides that is minutes.
using Falling = std::function<void(double share)>;

// A hairstyle that lives: assets, groom and solver, and the time that runs in fixed steps whatever the frame rate.
class Simulation
{
  public:
    // Hair falls to rest here and where set_style() changes what it rests in; `falling` must outlive this. Throws Error
    // for what the style names and cannot be had.
    Simulation(const Device& device, Hairstyle style, Falling falling = {});

    const Hairstyle& style() const { return authored_; }
    const HairParams& params() const
    {
        return style_.params;
    } // as they are simulated: quality.tolerance and the lights have had their say
    Lighting lighting() const { return lighting_of(style_.params, style_.host); }
    const Quality& quality() const { return quality_; }
    const Assets& assets() const { return assets_; }
    Solver& solver() { return *solver_; }
    const Solver& solver() const { return *solver_; }

    // Takes changed values, doing only what they ask for (ParamInfo::effect). If that fails, the old state stays and
    // Error is thrown. `reload` loads the meshes again though their paths are the same.
    void set_style(const Hairstyle& style, bool reload = false);

    // From where it is seen, for solver.far_tolerance: measures, when that first matters, what half the nodes would
    // change.
    void set_view(const View& view);
    std::optional<double> thin_error() const { return thin_error_; } // a share of the length; if it was measured

    void reload_lights(); // the file of look.lights, if there is one; throws Error, and then nothing has changed

    void play(std::optional<Motion> motion); // from its beginning; none: stop where the head is
    bool playing() const { return motion_.has_value(); }
    std::string motion_name() const { return motion_ ? motion_->name : ""; }

    // One fixed step: the hand's pose moves to `hand`, the script goes on.
    void step(const Pose& hand);

    // As many steps as `seconds` asks for; what is over waits for the next call. At most `most` steps are taken and the
    // rest is dropped and counted. The hand arrives at `hand` with the last step. Returns the steps taken.
    int advance(double seconds, const Pose& hand, int most);

    // Steps without looking, so that hair hangs when it is first seen.
    void settle(double seconds);
    // The guides as they lie now, for groom.rest: those at the authored scalp's vertices.
    StrandShapes shapes() const;
    StrandShapes rest_shapes() const; // where they begin
    void reset();                     // hair to its rest shape, where the head is

    double step_seconds() const;
    double time() const { return time_; }
    long steps() const { return steps_; }
    long dropped() const { return dropped_; }
    const Pose& hand() const { return hand_; }
    glm::dvec3 jumped() const { return solver_->jumped(); } // how far teleports have carried the head, m

  private:
    void drape();
    void set_bodies(const Hairstyle& style);

    const Device& device_;
    Falling falling_;
    Hairstyle authored_, style_; // as written, and as simulated
    Quality quality_;
    std::optional<double> thin_error_;
    Assets assets_;
    std::unique_ptr<Solver> solver_;
    std::optional<Motion> motion_;
    double motion_time_ = 0.0;
    double time_ = 0.0, owed_ = 0.0; // s
    double rate_since_ = 0.0;        // s, and steps, when solver.rate last changed
    long steps_since_ = 0;
    long steps_ = 0, dropped_ = 0;
    Pose hand_;
};

} // namespace coif

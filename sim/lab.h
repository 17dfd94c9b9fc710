#pragma once
#include "sim/device.h"
#include "sim/solver.h"

#include <glm/vec3.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace coif
{

// One strand on its own, hung from a point that moves as told: what coif is compared with references by. Node 0 is that
// point; all further nodes are free, the strand begins straight and at rest.
struct LabStrand
{
    int nodes = 16;                // counting node 0; 2 to 256
    double length = 0.3;           // m
    double tip_mass = 0.5;         // of the last node against the others
    double angle = 0.0;            // rad, of the straight start from the downward vertical, towards +x
    std::optional<double> gamma;   // droop number, clamped along the start direction; none: no bending
    std::vector<glm::dvec3> start; // nodes 0 and up, m, where they do not begin straight along `angle`; segments of
                                   // equal length
    bool tip_held = false;         // the last node stays where it starts; not known to pbd
};

struct LabRun
{
    std::vector<double> times;                       // s
    std::vector<std::vector<glm::dvec3>> nodes;      // [time][node], m, in the coordinates of the root's path
    std::vector<std::vector<glm::dvec3>> velocities; // [time][node], m/s: the mean of the last substep
    double stretch = 0.0;                            // worst of any segment at any of these times, as a fraction
    double nanoseconds = 0.0;                        // a strand and frame, median over frames; of use with many copies
};

// Where the root is at a time, m.
using RootPath = std::function<glm::dvec3(double seconds)>;

// A strand hung up, to be moved frame by frame, `copies` of it side by side for the clock's sake. Steps are as long as
// a frame, or equal parts of it of at most 1/60 s. `params` as authored: solver, drag, gravity and so on; its strand.*
// and bending.* do not count. It never sleeps. Throws Error for what cannot be.
class Lab
{
  public:
    Lab(const Device& device, const HairParams& params, const LabStrand& strand, const RootPath& root, double fps,
        int copies = 1);

    double frame();              // ns a strand that the device took
    void look(LabRun& at) const; // adds the first strand as it is now

  private:
    const Device& device_;
    LabStrand strand_;
    RootPath root_;
    double fps_;
    int copies_;
    long frames_ = 0;
    Solver solver_;
};

// Moves the strand for `seconds` and looks at it `fps` times a second, 0 included; ten million nodes at most in all.
LabRun run_lab(const Device& device, const HairParams& params, const LabStrand& strand, const RootPath& root,
               double seconds, double fps, int copies = 1);

// A path through rows `t,x,y,z` (s, m; a first line that does not begin with a number is a header; times rise),
// Catmull-Rom between them (Catmull and Rom 1974, tangents for unequal times), at rest before the first and after the
// last. Throws Error with file and line.
struct RootRows
{
    std::vector<double> times;
    std::vector<glm::dvec3> points;
};
RootRows load_root(const std::filesystem::path& file);
glm::dvec3 root_at(const RootRows& rows, double seconds);

} // namespace coif

// Plain double-precision twins of the OpenCL passes, written from the thesis and the papers that the kernels cite, not
// from the kernels: one strand after the other, whole loops, no lanes, no shortcuts.
//
// What they take over from the kernels is what makes results comparable at all: the order of the constraints in a sweep
// (collisions, segments from node 2, segments from node 1, bending), the lattice hash of the gusts, the seeds' random
// numbers, and fixed-point units of density.
#pragma once
#include "kernels/shared.h"
#include "sim/distance_grid.h"

#include <glm/vec3.hpp>

#include <functional>
#include <vector>

namespace coif::oracle
{

using Vec = glm::dvec3;
inline Vec xyz(float4 v) { return {v.x, v.y, v.z}; }

struct Strands
{
    int nodes = 0;
    std::vector<Vec> position, velocity;            // [strand][node]
    std::vector<Vec> root_position, root_direction; // [strand], in the head's frame
    std::vector<double> segment_length;             // [strand]
    std::vector<int> resets;                        // [strand]
    std::vector<int> held;          // [strand]: nodes that are prescribed, at rest_position; empty: 2, by the root
    std::vector<Vec> rest_position; // [strand][node], in the head's frame; where strands are held, or start again

    int count() const { return int(segment_length.size()); }
};

struct Forces
{
    bool wind = false, repulsion = false;
};

// The head's distance grid as the kernels read it, in voxels: StepInfo places it. Without values there is none.
struct Body
{
    std::vector<float> distance; // [z][y][x]
    std::vector<glm::vec3> way;
};

// The eight samples about a point, with their trilinear weights and how those change from voxel to voxel in the head's
// frame; and how far the point is from the grid, in voxels.
struct BodyCorners
{
    struct
    {
        size_t sample;
        double weight;
        Vec slope;
    } at[8];
    double away;
};
BodyCorners body_corners(Vec p, const StepInfo& info, int stride = 1); // of every stride-th sample

// What Solver makes of a grid.
Body body_of(const DistanceGrid& grid);

// Trilinear distance at a point and the unit normal of its slope, m and along the world's axes.
struct Plane
{
    double distance;
    Vec normal;
};
Plane plane_at(const Body& body, Vec p, const StepInfo& info);

// The point of a collider's axis that is nearest to p.
Vec nearest_on_axis(const Capsule& collider, Vec p);

// The guides' substep: thesis 5.1.2. `gradient` is per voxel, in fixed-point units a voxel. `rounding`, if given, is
// added to every node that a constraint has moved: with the size of a float's rounding it shows how far the rounding of
// single operations may carry the result.
void simulate_pbd(Strands& strands, Forces forces, const std::vector<Vec>& gradient, int resolution,
                  const std::vector<Capsule>& colliders, const HairParams& params, const StepInfo& info,
                  const std::function<Vec()>& rounding = {}, const Body& body = {});

// Accelerations, m/s^2: the wind with its gusts at a point, what of it acts on a strand of this tangent (eq. 5.2), and
// what crowded hair adds.
Vec wind_at(Vec at, const StepInfo& info);
Vec across_wind(Vec wind, Vec tangent);
Vec repulsion_force(Vec at, const std::vector<Vec>& gradient, int resolution, const StepInfo& info);

// Nodes 1 and outwards, or of many strands an even part of them, shared out over eight voxels each, thesis 5.1.3. Not
// rounded; `shares` counts the nodes that had a share in a voxel, each of which may be rounded by a half.
struct Density
{
    std::vector<double> sum;
    std::vector<int> shares;
};
Density add_density(const Strands& strands, int resolution, const StepInfo& info);

// The least and the greatest voxel along each axis of those that are not zero.
std::pair<glm::ivec3, glm::ivec3> box_of(const std::vector<int>& grid, int resolution);

// One axis of a box blur, unrounded (`box` as in StepInfo), and the central difference (eq. 5.8); zero outside.
std::vector<double> blur_density(const std::vector<int>& density, int axis, int resolution, const float4& box);
std::vector<Vec> density_gradient(const std::vector<int>& density, int resolution);

// How far each voxel's centre lies inside the nearest collider's opaque body, in voxels; the body begins 0.7 voxels
// under the collider's surface.
std::vector<double> depth_in_bodies(const std::vector<Capsule>& colliders, int resolution, const StepInfo& info);

// Optical depth of every ray (i, j) in every slice: kernels/light_grid.h. Trapezoids from where the ray last came in.
std::vector<double> transmittance(const std::vector<int>& occupied, int resolution, const StepInfo& info);

// Optical depth at a point, half a voxel towards the light; trilinear among the rays.
double light_depth(const std::vector<float>& depth, Vec point, int resolution, const HairParams& params,
                   const StepInfo& info);

// How far each voxel's centre lies inside the head's opaque body, as above.
std::vector<double> depth_in_head(const Body& body, int resolution, const StepInfo& info);

// Out of the union of all colliders, with room to spare; and out of the head.
Vec out_of_union(Vec p, const std::vector<Capsule>& colliders, double room);
Vec out_of_body(Vec p, const Body& body, double room, const StepInfo& info);

// What a groom says of one drawn strand besides how it is mixed, where it says anything: the look that varies over the
// scalp, and the ring that it is tied in with what hangs out of that.
struct Besides
{
    const StrandLook* look = nullptr;
    const TiedStrand* tied = nullptr;
    const Tail* tail = nullptr;
};

// A drawn strand's nodes: guides' nodes mixed or turned (thesis 5.1.4), hung in tails, cut, let fly away if it is one
// that does (its number tells whether it leads a clump), out of the colliders. Light apart.
std::vector<Vec> interpolate_multi(const Strands& guides, const DrawnStrand& strand, int number,
                                   const HairParams& params, const std::vector<Capsule>& colliders,
                                   const StepInfo& info, const Body& body = {}, const Besides& besides = {});
std::vector<Vec> interpolate_single(const Strands& guides, const DrawnStrand& strand, int number,
                                    const HairParams& params, const std::vector<Capsule>& colliders,
                                    const StepInfo& info, const Body& body = {}, const Besides& besides = {});

// The part of interpolate_multi() that ties have: `node` as mixed at the strand's own root, which `shift` led to.
void hang_in_tail(std::vector<Vec>& node, Vec shift, const Strands& guides, const Besides& besides,
                  const StepInfo& info);

// A strand drawn towards the one that leads its clump, as clump.along and the others say; and how much of
// the leader's light it gets at each node.
struct Clumped
{
    std::vector<Vec> node;
    std::vector<double> share;
};
Clumped clump(const std::vector<Vec>& own, const std::vector<Vec>& leader, const DrawnStrand& strand, int number,
              double leaders_cut, const HairParams& params, const std::vector<Capsule>& colliders, const StepInfo& info,
              const Body& body = {}, const StrandLook* look = nullptr);

// Room that a drawn strand's node keeps from colliders, m: clearance, its layer, what is laid on it; in a braid, that
// of the whole braid.
double room_at(int node, int nodes, const DrawnStrand& strand, const HairParams& params, const StepInfo& info,
               const Besides& besides = {});

// Parallel transport of a normal, Bergou et al. 2008, by Rodrigues' rotations; and the length up to each node. In a
// braid it begins anew at the ring; `cut` as in DrawnStrand.
struct FrameNode
{
    Vec normal;
    double length;
    double told; // 1 + cosine of the sharpest turn that the normal has been carried through
};
std::vector<FrameNode> transport_frames(const std::vector<Vec>& nodes, const StepInfo& info,
                                        const Besides& besides = {}, double cut = 1.0);

// The smallest rotation that takes the unit vector a to b, applied to v.
Vec carried_over(Vec v, Vec a, Vec b);
Vec to_world(const StepInfo& info, Vec v); // a direction or a place in the head's frame

// kernels/strand_curve.h in double.
void curve_weights(int curve, double t, double weights[4]);
double wave_onset(double along, double begin);
double strand_random(int seed, int purpose);
double wave_place(int seed, double distance, double frequency, double randomness);
double profile_at(const float4& profile, double along);
struct Across // a strand, along its frame's normal and binormal
{
    double normal, binormal;
};
Across curl_at(int together, double begin, double distance, double pitch, double variation, int hand);
Across frizz_at(int seed, double distance, double frequency);
double braid_share(double behind, double pitch);
Vec braid_offset(double behind, Vec place, double pitch, double swing, double depth, double plait, double bound);

} // namespace coif::oracle

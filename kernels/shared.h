// The contract between host and device: read by C++ and by every kernel, depending on neither.
//
// Only float, int and float4 cross the border: they have the same size and alignment in C++, in OpenCL C and in a
// std140 block, so one struct serves all three without packing. tests/test_layout.cpp asks all three compilers.
#ifndef COIF_SHARED_H
#define COIF_SHARED_H

#define COIF_TYPE_FLOAT float
#define COIF_TYPE_INT int
#define COIF_TYPE_CHOICE int
#define COIF_TYPE_VECTOR float4
#define COIF_TYPE_COLOR float4
#define COIF_TYPE_PROFILE float4
#define COIF_HOST(group, kind, name, value, scope, effect, help)

#ifdef __cplusplus
#define COIF_PARAM(group, kind, name, value, lo, hi, unit, scope, effect, read_by, labels, help)                       \
    COIF_TYPE_##kind group##_##name = value;
namespace coif
{
struct alignas(16) float4
{
    float x, y, z, w;
    bool operator==(const float4&) const = default;
};
constexpr float4 F4(float x, float y, float z, float w) { return {x, y, z, w}; }
#else
#define COIF_PARAM(group, kind, name, value, lo, hi, unit, scope, effect, read_by, labels, help)                       \
    COIF_TYPE_##kind group##_##name;
#endif

// What the artist authored; on the device with angles in radians, colours linear and directions of unit length.
typedef struct HairParams
{
#include "params.def"
} HairParams;
#undef COIF_PARAM
#undef COIF_HOST

// What one substep needs besides, filled by make_step_info() of sim/step_info.h and nowhere else. Positions are
// relative to the head's origin along the world's axes (m), velocities the world's (m/s).
typedef struct StepInfo
{
    float4 head_row0; // rotation of the head at the end of the substep, row by row: world = row . local
    float4 head_row1;
    float4 head_row2;
    float4 turn_row0; // rotation of the head in a teleport, new pose against old; identity otherwise
    float4 turn_row1;
    float4 turn_row2;
    float4 origin_move;   // of the head's origin during the substep, m
    float4 head_velocity; // of the head's origin before the substep, m/s
    float4 head_center;   // centre of the scalp's sphere in the head's frame, m
    float4 wind;          // m/s^2; w: its length
    float4 gust_origin; // offset into the turbulence at this time, in cells of the noise; w: size of the gusts against
                        // the wind
    // First sample of the head's distance grid in the head's frame, m; w: between samples, m.
    float4 body_corner;
    float4 grid_corner; // lowest corner of the grid, m; w: side of a voxel, m
    float4 sweep;     // light's sweep: cells moved along (u, v) a slice, length of a ray between slices (m), extinction
                      // per fixed-point unit of density (1/m)
    float4 light_box; // what blurs the density for light, in voxels: whole ones to each side, the weight of each of
                      // them and of the two ends beyond them; w: variance
    float4 push_box;  // what blurs it further for repulsion
    float substep;    // duration, s
    float drag_keep;  // exp(-drag h)
    float drag_gain;  // integral of exp(-drag t) over the substep, s
    float gravity;    // m/s^2, along y
    float stretch;    // of a sweep, eq. 5.5
    float relax;      // over-relaxation factor of all sweeps but the last
    float bend;       // of a sweep, eq. 5.5, before attenuation
    float clearance;  // that drawn strands keep from colliders, m
    float parting;    // m that guides may part before they are no longer mixed
    float repulsion;  // m/s^2 for a density gradient of one guide strand's node a voxel, per fixed-point unit
    float bend_droop; // bending stiffness over mass times the segment's length, m/s^2, from the droop number
    float bend_modulus; // the same times its fourth power, m^4/s^2, from the modulus; one of the two is zero
    float bend_most;    // 1/s^2: curls stiffer than that, over mass, are taken to be of that
    float turning_rate; // 1/s: curls ask for substeps of at most its inverse
    float tip_mass;     // of the last node against the others; infinite: it is held where it is
    float acceleration; // that strands may hang in: gravity, wind and the roots' own, at most, m/s^2
    float push_out;     // m/s at which hair that starts inside a body is let out
    int guides;         // simulated strands, without those that fill the last block
    int drawn_multi;    // drawn strands mixed of three guides; they come first
    int drawn;          // all drawn strands
    int colliders;
    int head_colliders; // that are fixed to the head; they come first
    int teleport;       // the head has just jumped: strands are carried along rigidly
    int last_substep;   // of its step: then the nodes are added to the density
    int body_density;   // of what no light passes, in fixed-point units
    int density_stride; // of each strand's nodes one in so many feeds the density
    int density_unit;   // what such a node adds, in fixed-point units: the sum is that of all nodes
    int sweep_axis;     // 0, 1, 2: main axis of the light's sweep
    int sweep_from;     // first slice of the sweep
    int sweep_sign;     // -1 or +1: from slice to slice
    int body_x;         // samples of the head's distance grid along its axes; 0 without one
    int body_y;
    int body_z;
} StepInfo;

// The paces of the direct solver: into 1, 2, 3, 4, 6, 8, 12 or 16 substeps of equal length a step is cut.
#define MOST_SUBSTEPS 16
#define PACES 8
static inline int substeps_of(int pace) { return pace < 1 ? 1 : pace % 2 ? 2 << (pace / 2) : 3 << (pace / 2 - 1); }

// The head on its way through one step, where any of those substeps begins or ends; and what drag leaves of the
// velocity, for each pace before and now.
#define STEP_PARTS 48
#define DRAG_WITHIN (PACES + 1)
typedef struct StepPath
{
    float4 row[3 * (STEP_PARTS + 1)]; // rows of its rotation; w: its origin along that axis, against the step's begin
    // keep, gain (s): [0: at the start; 1 + pace of the last step; DRAG_WITHIN: of this one][pace now]
    float4 drag[(PACES + 2) * PACES];
} StepPath;

// Why a strand was reset.
#define FAULT_POSITION 1 // a position was not finite before the step
#define FAULT_VELOCITY 2 // a velocity or a tension was not
#define FAULT_FORCES 3   // they were, but not after it: its forces

// One node adds this much to the density, shared out over eight voxels: fixed point, so that the order of the additions
// does not matter and equal input gives equal bytes.
#define DENSITY_ONE 4096

// At most about so many nodes feed the density: adding 1.6 million takes longer than moving them, and a grid of 64^3
// voxels cannot tell the difference.
#define DENSITY_NODES 65536

// The first node of a strand that feeds the density, from 1 to `stride`. From strand to strand it moves on by the
// golden section of the stride, which spreads any number of neighbours evenly (Weyl's sequence).
static inline int density_first(int strand, int stride)
{
    const unsigned part = ((unsigned)strand * 2654435769u) >> 16;
    return 1 + (int)((part * (unsigned)stride) >> 16);
}

// A body that hair stays outside of: all within a radius of a stretch, which for a sphere has no length. Relative to
// the head's origin along the world's axes, m.
typedef struct Capsule
{
    float4 center; // one end of the stretch; w: radius
    float4 axis;   // from there to the other end; w: 1 / its length squared, 0 for a sphere
} Capsule;

// Colliders that a style and its head may have together.
#define MOST_COLLIDERS 512

// Guides lie in blocks of 16, lane by lane, so that one vector or one work-group moves 16 strands at once.
#define LANES 16
static inline int strand_value(int strand, int node, int axis, int nodes)
{
    return ((strand / LANES * nodes + node) * 3 + axis) * LANES + strand % LANES;
}

// How one drawn strand is made of guides; kept apart from HairParams because it differs from strand to strand.
typedef struct DrawnStrand
{
    float4 root;    // on the scalp, in the head's frame, m; w: share of the guides' length at which it is cut
    float4 weights; // of the three guides, or the two angles (rad) that turn a copy; w: m on along its leader's way
    int guide0, guide1, guide2;
    int seed;   // of what the kernels draw at random for this strand
    int leader; // the drawn strand that its clump gathers about; one that leads, or is in no clump, has itself
} DrawnStrand;

// What of a drawn strand's look varies over the scalp. LOOK_TEXELS of these rows make one.
#define LOOK_TEXELS 4
typedef struct StrandLook
{
    float4 root_color; // linear; w: width, m
    float4 tip_color;  // linear; w: opacity
    float4 wave;       // along the normal: amplitude (m), frequency (1/m); along the binormal the same
    float4 own;        // seed; radius of its curl, frizz (m); w unused
} StrandLook;
// What ties make of a drawn strand (sim/tied_hair.h), beside its DrawnStrand.
typedef struct TiedStrand
{
    float4 place; // of a tail: in its cross-section, along side and front, in its radii; of a braid: in that of its
                  // plait, in the plait's radii, and z: the plait's phase, rad
    float ring;   // where along the whole strand the tie's ring is, in nodes; 0: it is not tied
    int tail;     // that it hangs in
    int unused0, unused1;
} TiedStrand;

// What hangs out of a tie's ring, about the line of one guide: a tail, or three plaits (kernels/strand_curve.h,
// braid_offset()).
typedef struct Tail
{
    float4 axis;    // the way out of the ring, unit length, in the head's frame; w: m along a braid in which a plait
                    // goes over and back, 0: a tail
    float4 side;    // across it, unit length; w: m that plaits swing to either side
    float depth;    // m that they swing to front and back
    float plait;    // radius of a plait, m
    float bound;    // m behind the ring, where a braid is bound; it is loose beyond
    float length;   // m behind the ring to the tips
    float ring;     // where along the guide the ring is, in nodes
    float radius;   // of a tail at the ring, m
    float fullest;  // of a tail where it is widest, m
    float together; // how far the strands of a tail keep their places about that line, 0 to 1
    int guide;
    int unused0, unused1, unused2;
} Tail;

#ifdef __cplusplus
} // namespace coif
#endif
#endif

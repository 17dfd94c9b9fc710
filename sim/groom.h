#pragma once
#include "sim/mesh.h"
#include "sim/params.h"

#include <vector>

namespace coif
{

struct Shaping;

// The rest shape of all strands, grown on a scalp. Guides lie in blocks of 16 lanes (kernels/shared.h); the lanes that
// fill the last block are copies of guide 0 that nothing reads.
struct Groom
{
    int nodes = 0;                     // of a strand
    int guides = 0;                    // simulated strands
    int blocks = 0;                    // of 16 guides
    std::vector<float> root_position;  // [block][axis][lane], node 1, in the head's frame, m
    std::vector<float> root_direction; // [block][axis][lane], from node 0 to node 1, unit length, in the head's frame
    std::vector<float> segment_length; // [block][lane], m
    // Shapes, [block][node][axis][lane], in the head's frame, m: only the directions of their segments count.
    std::vector<float> natural_position; // where nothing weighs on the strands; empty: straight
    std::vector<float> rest_position;    // where they begin, at rest under gravity; empty: the natural one
    std::vector<float> rest_multiplier;  // [block][node][lane], 1/s^2: tensions there, where known (bodies bear weight)
    // [block][lane]: nodes from the root on that are prescribed, at rest_position and with the head: those of strands
    // that a tie holds (sim/tie.h). At least 2 and at most nodes - 1; empty: 2 everywhere.
    std::vector<int> held;
    float hold = 1.0f;              // of rest_position, that the strands take as their own
    float tip_mass = 0.5f;          // of the last node: it stands for half a segment
    std::vector<float> bend_factor; // [block][lane], stiffness over what the parameters say; empty: 1
    std::vector<DrawnStrand> drawn; // mixed ones first
    std::vector<StrandLook> looks;  // of each drawn strand; empty where they are all as the parameters say
    int drawn_multi = 0;
    std::vector<TiedStrand> tied;   // of each mixed strand; empty without ties
    std::vector<Tail> tails;        // of each tie; of no length if no strand comes through
    std::vector<int> short_of_ring; // of each tie: guides that are its own and too short to reach it
    float longest = 0.0f;           // strand, m
    float extent = 0.0f;            // of the scalp, m
    glm::vec3 center{0.0f};         // of the scalp's sphere, in the head's frame, m
    glm::vec3 middle{0.0f};         // of the roots' bounding box, in the head's frame, m
    float farthest = 0.0f;          // root from the middle, m
};

inline int held_nodes(const Groom& groom, int strand) { return groom.held.empty() ? 2 : groom.held[size_t(strand)]; }

// Grows the hair that `params` (as authored) describes. Thesis 5.1.1 for roots, 5.1.4 for the drawn strands: mixed ones
// are spread over the triangles by area, copies equally over the guides. Everything random hangs on
// params.interpolation_seed. What varies over the scalp is `host`'s: lengths and stiffness of guides are those at their
// roots, lengths and looks of drawn strands those at theirs. Throws Error where interpolation.refine asks for too many.
Groom grow(const HairParams& params, const Scalp& scalp, const HostParams& host = {});
Groom grow(const Shaping& shaping); // the same, where the scalp is already refined and the style laid over it

// A vector of values laid out [block][node][axis][lane], as guides' positions are.
inline glm::dvec3 vector_at(const float* values, int strand, int node, int nodes)
{
    const float* at = values + strand_value(strand, node, 0, nodes);
    return {at[0], at[LANES], at[2 * LANES]};
}

inline void put_vector(std::vector<float>& values, int strand, int node, int nodes, const glm::dvec3& v)
{
    for (int axis = 0; axis < 3; ++axis)
        values[size_t(strand_value(strand, node, axis, nodes))] = float(v[axis]);
}

// Cosine between root directions: roots that lean further apart lie on two sides of a parting.
constexpr float kSameWay = 0.85f;

// A strand mixed of three guides, in these shares (whose sum is not zero), as grow() mixes them; the root and the rest
// are left to the caller. `directions` are all guides' root directions.
DrawnStrand mixed_of(const std::vector<glm::vec3>& directions, const glm::uvec3& guides, glm::vec3 weights);

// A uniform number in [0, 1) that depends on nothing but its arguments. PCG output of a hashed state, O'Neill 2014.
float random01(int seed, int index, int channel);
float random_sign(int seed, int index, int channel); // the same from -1 to 1

} // namespace coif

// What ties make of a groom.
#pragma once
#include "sim/distance_grid.h"
#include "sim/groom.h"
#include "sim/shaping.h"
#include "sim/tie.h"

#include <vector>

namespace coif
{

// Which tie each root belongs to, by its number; -1: none.
struct TieRoots
{
    std::vector<int> guides;
    std::vector<int> drawn; // of each drawn strand; empty: that of the guide it mostly follows
};

// Every guide to the nearest of the ties that gather the hair of its region; drawn strands to the nearest of those that
// their guides belong to, so that what lies between two ties parts in a line.
TieRoots tie_roots(const Groom& groom, const Shaping& shaping);

// What hair runs over on its way to a ring: the distance grid of the head, or the spheres fixed to it. In the head's
// frame, m, scaled by head.scale as Solver has them.
struct TieGround
{
    PlacedGrid grid;
    std::vector<Collider> spheres;
};

// Throws Error "tie 'left' has its ring 12 mm inside the head ...", for a ring or an axis that is no such thing, and
// for a tie that no root belongs to.
void check_tie(const Groom& groom, const Shaping& shaping, size_t tie, const TieRoots& roots, const TieGround& ground);

// Gathers the hair of a groom, as grow() has made it of `shaping`, in rings, which check_tie() must know. Each tied
// guide runs from its root over the ground to a place of its own in the ring, neighbours beside each other and hair
// from further away above, and leaves along the axis; up to there it is held (groom.held, natural_position), the rest
// keeps the shape that grow() gave it. Guides too short to come through are left as they are and counted. Drawn strands
// mix guides of one tie only, and copies of tied guides become mixes; length_variation cuts what hangs out of the ring.
void tie_hair(Groom& groom, const Shaping& shaping, const TieRoots& roots, const TieGround& ground);

// Guides that lie in rings as `groom` says and elsewhere go the way they went in `old`, where that had rest shapes:
// what set_groom() goes on with when a ring is moved.
void keep_rest(Groom& groom, const Groom& old);

// The place at this height above the ground that is about nearest to `at`, and the way out of the ground there. All in
// the head's frame, m.
struct RingPlace
{
    glm::vec3 at, out;
};
RingPlace ring_place(const TieGround& ground, glm::vec3 at, float height);
float height_above(const TieGround& ground, glm::vec3 at); // negative inside

// Three values a mixed strand for kernels/ribbon.h's Braid, or none: its place in its plait and m behind the ring at
// its root; m behind the ring from root to tip, pitch, swing, depth; radius of a plait and where it is bound.
std::vector<float4> braid_values(const Groom& groom);

} // namespace coif

// Hair of a file on a scalp: what groom.import makes of it.
#pragma once
#include "sim/exchange/read.h"
#include "sim/mesh.h"
#include "sim/params.h"

namespace coif
{

struct Groom;

// How a file's numbers become the head's frame: turned upright, times `scale`, then moved.
struct HairFrame
{
    float scale = 1.0f; // m, of the file's unit
    HairUp up = HAIR_UP_Y;
    glm::vec3 offset{0.0f}; // m
};

// Strands that stand on a scalp.
struct PlacedHair
{
    std::vector<Between> place;      // [strand] its root, on the authored scalp
    std::vector<size_t> first;       // [strand], and one more: into position
    std::vector<glm::vec3> position; // [point] the root at 0, in the head's frame, m before head.scale
    // Numbers of the strands that are simulated, those first that stand for most of the others.
    std::vector<unsigned> guides;
    bool drawn = false; // each strand is drawn, and not only those mixed of the guides
    // For the report.
    std::string said;                                   // of what, and how its unit and axes are known
    std::vector<std::string> remark;                    // what was left out, and why
    float shortest = 0.0f, mean = 0.0f, longest = 0.0f; // of the strands, m
    float farthest = 0.0f;                              // root from the scalp, m
    size_t strands() const { return place.size(); }
    float length(size_t strand) const; // m
};

// What groom.import_scale, _up and _offset say of a file or, where they leave it open, what the file says or a guess:
// more than 10 across counts centimetres, more than 200 millimetres; up is what is high on a standing figure, or else
// the axis by which the roots lie closest to the scalp. `said` tells which.
HairFrame hair_frame(const HairFile& file, const Scalp& scalp, const HairParams& params, std::string& said);

// The offset that brings the roots' middle to the scalp's; 0 where the roots lie on it already.
glm::vec3 fitting_offset(const HairFile& file, const HairFrame& frame, const Scalp& scalp);

// Strands on the nearest triangles. Those whose roots lie farther from the scalp than a quarter of its extent are
// dropped; throws Error where that is most of them. At most groom.import_guides are simulated.
PlacedHair place_hair(const HairFile& file, const Scalp& scalp, const HairParams& params);

// Which of the strands are simulated: with interpolation.guides all of them, else those chosen.
std::vector<unsigned> simulated_strands(const PlacedHair& hair, const HairParams& params);

// A strand's curve in `links` straight pieces of one length, that begin and end on it: their corners, from the root on.
// Returns that length. The fewer pieces, the shorter they are in all.
float resampled(const glm::vec3* curve, size_t points, int links, std::vector<glm::vec3>& corners);

// Gives a groom, grown on guide_scalp(), the placed hair for its rest shape, to be held whole: the strands after those
// of the authored vertices are the file's, and those of the vertices copies of the nearest. `length_factor` is of each
// guide.
void take_hair(Groom& groom, const Scalp& scalp, const HairParams& params, const std::vector<float>& length_factor);

// What came of it, in lines.
std::string import_report(const PlacedHair& hair, const HairParams& params);

} // namespace coif

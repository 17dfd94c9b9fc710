// Brushes: what a stroke over the scalp does to a hairstyle.
#pragma once
#include "sim/hairstyle.h"
#include "sim/mesh.h"

#include <string>

namespace coif
{

enum class BrushKind
{
    COMB,   // turns roots and bends the rest shape the way the stroke goes
    LENGTH, // grows or cuts to a length
    LIFT,
    WAVE,
    DENSITY,
    COLOR,
    REGION, // what belongs to a region
    SMOOTH, // evens out what other brushes have painted, regions excepted
    ERASE   // takes it back
};
constexpr int kBrushKinds = 9;
const char* brush_name(BrushKind kind);
const char* brush_help(BrushKind kind);

struct Brush
{
    BrushKind kind = BrushKind::COMB;
    float radius = 0.03f;              // m on the scalp
    float strength = 0.5f;             // 0 to 1: share of the way to the aim that a touch goes
    float falloff = 0.7f;              // 0: as strong to the rim, 1: fades from the centre on
    bool mirror = false;               // on the head's other side as well
    float length = 0.1f;               // m, that LENGTH aims at
    float lift = 45.0f;                // deg
    float wave = 0.005f;               // m, amplitude
    float density = 0.0f;              // share
    glm::vec3 color{0.8f, 0.3f, 0.2f}; // sRGB
    int color_of = 2;                  // 0 roots, 1 tips, 2 both
    std::string region;                // that REGION paints, by name; it begins one where none is called so
    float weight = 1.0f;               // how far roots are to belong to it
};

// One touch: a place on the scalp and how far the mouse has gone since the last, both in the head's frame, m before
// head.scale.
struct Touch
{
    glm::vec3 at{0.0f}, along{0.0f};
};

// How strongly a touch at `at` works on a root at `root`, 0 to the brush's strength.
float brush_weight(const Brush& brush, glm::vec3 at, glm::vec3 root);

// Does it; with a mirror each half of the head has a touch of its own. `shapes` are the strands as they rest, which
// COMB begins from where the style has no rest shape of its own. Returns whether anything changed.
bool apply_brush(Hairstyle& style, const Scalp& scalp, const StrandShapes& shapes, const Brush& brush,
                 const Touch& touch);

// Has a region no rule beside what is painted? A brush makes one of any that it paints.
bool is_painted_only(const Region& region);

// Cuts all hair where it reaches beyond the plane n . p = d of the head's frame: each strand to where it crosses that,
// as it rests in `shapes`. Returns whether anything was cut.
bool cut_at_plane(Hairstyle& style, const Scalp& scalp, const StrandShapes& shapes, glm::vec3 n, float d);

// The value under the brush, taken into it: what the style has at that place, and the region that it belongs to.
void pick_value(Brush& brush, const Hairstyle& style, const Scalp& scalp, glm::vec3 at);

} // namespace coif

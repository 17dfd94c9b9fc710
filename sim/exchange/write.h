// Writers of hair for other tools, one a format. They write the curves as they are given: axes and units are the
// business of sim/exchange/targets.h, which also refuses what a format cannot hold.
#pragma once
#include "sim/exchange/curves.h"
#include "sim/exchange/new_file.h"

#include <functional>

namespace coif
{

enum class Through // what runs through the points
{
    LINES,
    CATMULL_ROM // that passes both ends; beyond them it goes on as if mirrored there
};

// What a file says beside the curves.
struct FileWords
{
    Through through = Through::LINES;
    std::string units = "metres", axes = "y up"; // where a format has room for a remark
};

// Curves that move: frame after frame the same points elsewhere.
struct Cache
{
    int first = 0, count = 1; // frames; frame n is n / fps seconds after the motion began
    double fps = 30.0;
    // As Curves::position; asked for once a frame, in their order. What it throws ends the writing.
    std::function<void(int frame, std::vector<glm::vec3>& position)> positions;
};

// The strands that lie together in one object of a file.
struct Part
{
    std::string name;             // of their group; empty: the hair has no groups
    int group = 0;                // its number
    bool guides = false;          // simulated strands, where they are kept apart
    std::vector<uint32_t> strand; // rising
};
std::vector<Part> parts_of(const Curves& curves, bool guides_apart);

std::vector<size_t> first_points(const Curves& curves); // [strand]
inline int32_t id_of(const Curves& curves, size_t strand)
{
    return curves.id.empty() ? int32_t(strand) : curves.id[strand];
}

// The whole hair's name in files.
constexpr const char* kHairName = "hair";

// OpenUSD text, BasisCurves with the groom schema's attributes; a prim a group.
void write_usda(NewFile& file, const Curves& curves, const FileWords& words, const Cache* cache = nullptr);
// Alembic 1.8, Ogawa core, Curves with the groom schema's attributes; an object a group, guides in their own.
void write_abc(NewFile& file, const Curves& curves, const FileWords& words, const Cache* cache = nullptr);
// Cem Yuksel's HAIR.
void write_hair(NewFile& file, const Curves& curves, const FileWords& words);
// AMD TressFX 4. All strands get so many points, at equal lengths where they do not have as many already.
void write_tfx(NewFile& file, const Curves& curves, int points);
// Wavefront OBJ: pairs of points, not polylines, which several importers cut short.
void write_obj(NewFile& file, const Curves& curves, const FileWords& words);
// Stanford PLY, binary: vertices and edges.
void write_ply(NewFile& file, const Curves& curves, const FileWords& words);
// glTF 2.0, binary: lines.
void write_glb(NewFile& file, const Curves& curves);
// USC HairSalon's strands.
void write_data(NewFile& file, const Curves& curves);
// pbrt-v4, to Include in a scene: a Bezier chain a strand.
void write_pbrt(NewFile& file, const Curves& curves, const FileWords& words);
// Mitsuba 3, text of linearcurve; what is no line is cut into pieces.
void write_mitsuba(NewFile& file, const Curves& curves, const FileWords& words);

} // namespace coif

// Hair out of files of other tools. Every reader takes its bytes for hostile: a count is bounded by the file's size
// before memory is taken for it, and nothing is followed without limit. Errors say file, place and remedy.
#pragma once
#include "sim/exchange/curves.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace coif
{

enum HairUp // groom.import_up
{
    HAIR_UP_AUTO, // the file does not say
    HAIR_UP_Y,
    HAIR_UP_Z,
    HAIR_UP_UNREAL // z, and left-handed
};

// What a file of hair holds, as it counts.
struct HairFile
{
    Curves curves; // in the file's own unit and axes; their widths too
    std::string format;
    float unit = 0.0f;               // of the file's numbers, m; 0: it does not say
    HairUp up = HAIR_UP_AUTO;        // that the file says
    std::vector<std::string> remark; // what of the file was left out, and why
};

// By the file's first bytes and, for those that have no mark, its suffix. Throws Error for what is no file of hair or
// holds no strand.
HairFile read_hair_file(const std::filesystem::path& file);
HairFile parse_hair_file(std::string_view bytes, const std::string& name, std::string suffix);

// One format each, of the whole file's bytes; `name` is told in errors. Strands may yet have less than two points or
// numbers that are not finite.
HairFile read_abc(std::string_view bytes, const std::string& name);  // Alembic, Ogawa core
HairFile read_hair(std::string_view bytes, const std::string& name); // Yuksel, cemyuksel.com/research/hairmodels
HairFile read_usda(std::string_view bytes, const std::string& name); // USD's text
HairFile read_tfx(std::string_view bytes, const std::string& name);  // TressFX 4
HairFile read_data(std::string_view bytes, const std::string& name); // Hu et al., USC-HairSalon, 2015

// Drops strands that are none, with a remark for each kind: single points, numbers that are not finite or beyond a
// million, no length.
void drop_bad_strands(HairFile& file);

} // namespace coif

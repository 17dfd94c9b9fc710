// Where hair is going: the formats, and the tools that read them. A format is known by its suffix, a tool says in what
// axes and units it wants it; both are one row of a table.
#pragma once
#include "sim/exchange/write.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace coif
{

enum class Format
{
    USDA,
    ABC,
    HAIR,
    TFX,
    OBJ,
    PLY,
    GLB,
    DATA,
    PBRT,
    MITSUBA
};

struct FormatInfo
{
    Format format;
    const char* suffix; // ".usda"
    const char* name;
    bool says_axes;         // the file tells its axes and units, or a specification does: metres, y up
    bool curves, caches;    // knows Catmull-Rom curves; frames
    Through through;        // what is written where nothing is asked for
    const char* leaves_out; // of a style, in words
};
std::span<const FormatInfo> formats();
// By the end of its name. Throws Error naming them all.
const FormatInfo& format_of(const std::filesystem::path& file);

enum class Axes
{
    Y_UP,      // ours, right handed
    Z_UP,      // right handed
    Z_UP_LEFT, // left handed
};

struct Target
{
    const char* name;   // as --for says it
    const char* reads;  // suffixes of the formats that it takes hair from, in the order of preference
    Axes axes;          // of files that do not tell
    float per_metre;    // units of such files
    const char* advice; // how to open them there
};
std::span<const Target> targets();
// "" is none: metres, y up. Throws Error naming them all.
const Target* find_target(const std::string& name);

// How curves go into a file.
struct Placement
{
    Axes axes = Axes::Y_UP;
    float per_metre = 1.0f;
};
Placement placement_of(const FormatInfo& format, const Target* target);
void place(std::vector<glm::vec3>& points, const Placement& placement);
void place(Curves& curves, const Placement& placement); // points and widths
FileWords words_of(const Placement& placement, Through through);

// The same polyline with so many points at equal lengths, first and last where they were. At least 2 of both.
std::vector<glm::vec3> resampled(const std::vector<glm::vec3>& points, int count);

// Points a strand that a .tfx may have: 4, 8, 16, 32 or 64; the least that holds so many.
int tfx_points(uint32_t points);

// Throws Error, a whole sentence with the strand and the remedy, for curves that the format cannot hold or a reader
// would choke on.
void check_curves(const Curves& curves, const FormatInfo& format);
// The same of the positions of one frame, which the sentence names where there are frames.
void check_positions(const Curves& curves, const std::vector<glm::vec3>& position, std::optional<int> frame = {});

// Into any format, placed already.
void write_curves(NewFile& file, const FormatInfo& format, const Curves& curves, const FileWords& words,
                  const Cache* cache = nullptr);

struct FileSize
{
    uint64_t bytes = 0;
    bool exact = true;
};
// What write_curves() would make, found by doing it without a disk; of caches one frame is taken for all.
FileSize size_of(const FormatInfo& format, const Curves& curves, const FileWords& words, const Cache* cache = nullptr);
std::string size_text(const FileSize& size); // "12.3 MB", "about 1.2 GB"

// Throws Error where the disk has no such room.
void check_room(const std::filesystem::path& file, const FileSize& size);

} // namespace coif

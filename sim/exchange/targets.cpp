#include "sim/exchange/targets.h"

#include "sim/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

namespace fs = std::filesystem;

static constexpr FormatInfo kFormats[] = {
    {Format::USDA, ".usda", "OpenUSD", true, true, true, Through::CATMULL_ROM, ""},
    {Format::ABC, ".abc", "Alembic", false, true, true, Through::LINES, ""},
    {Format::HAIR, ".hair", "Cem Yuksel's HAIR", false, false, false, Through::LINES,
     "root UVs, groups and which strands are guides"},
    {Format::TFX, ".tfx", "TressFX 4", false, false, false, Through::LINES,
     "widths, colours, groups and which strands are guides"},
    {Format::OBJ, ".obj", "Wavefront OBJ", false, false, false, Through::LINES,
     "widths, root UVs and which strands are guides"},
    {Format::PLY, ".ply", "Stanford PLY", false, false, false, Through::LINES,
     "root UVs, groups and which strands are guides"},
    {Format::GLB, ".glb", "glTF 2.0", true, false, false, Through::LINES, "groups and which strands are guides"},
    {Format::DATA, ".data", "USC HairSalon", false, false, false, Through::LINES,
     "widths, colours, root UVs, groups and which strands are guides"},
    {Format::PBRT, ".pbrt", "pbrt-v4", true, true, false, Through::CATMULL_ROM,
     "colours but those at the roots, widths between root and tip, root UVs, groups and which strands are guides"},
    {Format::MITSUBA, ".mitsuba.txt", "Mitsuba 3", true, true, false, Through::LINES,
     "colours, root UVs, groups and which strands are guides"},
};
std::span<const FormatInfo> formats() { return kFormats; }

const FormatInfo& format_of(const fs::path& file)
{
    std::string name = file.filename().string(), known;
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    for (const FormatInfo& format : kFormats)
    {
        if (name.size() > std::string_view(format.suffix).size() && name.ends_with(format.suffix))
            return format;
        known += (known.empty() ? "" : ", ") + std::string(format.suffix);
    }
    throw fail("-o {}: the end of the name says what is written; coif writes {}", file.string(), known);
}

// What each of them is known to read, and how: the README's chapter on export.
static constexpr Target kTargets[] = {
    {"unreal", ".usda .abc", Axes::Z_UP_LEFT, 100.0f,
     "import it with the plugins Groom and Alembic Groom Importer on; leave rotation and scale as they are"},
    {"unity", ".abc", Axes::Y_UP, 100.0f,
     "make a Hair Asset of it; leave Scale Factor (0.01) and Swap Handedness as they are"},
    {"blender", ".usda .abc .obj .ply .glb", Axes::Y_UP, 1.0f, "File > Import, with nothing changed"},
    {"maya", ".abc .usda .obj", Axes::Y_UP, 100.0f, "Cache > Import Alembic, then XGen's Curves to Guides"},
    {"houdini", ".usda .abc .obj .ply", Axes::Y_UP, 1.0f, "a File or Alembic node reads it as it is"},
};
std::span<const Target> targets() { return kTargets; }

const Target* find_target(const std::string& name)
{
    if (name.empty())
        return nullptr;
    std::string known;
    for (const Target& target : kTargets)
    {
        if (name == target.name)
            return &target;
        known += (known.empty() ? "" : ", ") + std::string(target.name);
    }
    throw fail("--for {}: expected one of {}", name, known);
}

Placement placement_of(const FormatInfo& format, const Target* target)
{
    if (format.says_axes || !target)
        return {};
    // Blender turns what comes from other formats, but takes a PLY's axes for its own.
    if (format.format == Format::PLY && std::string_view(target->name) == "blender")
        return {Axes::Z_UP, target->per_metre};
    return {target->axes, target->per_metre};
}

void place(std::vector<glm::vec3>& points, const Placement& placement)
{
    for (glm::vec3& p : points)
    {
        if (placement.axes == Axes::Z_UP_LEFT)
            p = {p.x, p.z, p.y};
        else if (placement.axes == Axes::Z_UP)
            p = {p.x, -p.z, p.y};
        p *= placement.per_metre;
    }
}

void place(Curves& curves, const Placement& placement)
{
    place(curves.position, placement);
    for (float& width : curves.width)
        width *= placement.per_metre;
}

FileWords words_of(const Placement& placement, Through through)
{
    return {through, placement.per_metre == 1.0f ? "metres" : "centimetres",
            placement.axes == Axes::Y_UP   ? "y up"
            : placement.axes == Axes::Z_UP ? "z up"
                                           : "z up, left handed"};
}

std::vector<glm::vec3> resampled(const std::vector<glm::vec3>& points, int count)
{
    std::vector<double> along = {0.0}; // m
    for (size_t k = 1; k < points.size(); ++k)
        along.push_back(along.back() + glm::distance(glm::dvec3(points[k - 1]), glm::dvec3(points[k])));
    std::vector<glm::vec3> out;
    size_t piece = 0;
    for (int i = 0; i < count; ++i)
    {
        const double wanted = along.back() * i / (count - 1);
        while (piece + 2 < points.size() && along[piece + 1] < wanted)
            ++piece;
        const double length = along[piece + 1] - along[piece];
        const double t = length > 0.0 ? std::clamp((wanted - along[piece]) / length, 0.0, 1.0) : 0.0;
        out.push_back(glm::mix(glm::dvec3(points[piece]), glm::dvec3(points[piece + 1]), t));
    }
    return out;
}

int tfx_points(uint32_t points)
{
    int least = 4;
    while (least < 64 && uint32_t(least) < points)
        least *= 2;
    return least;
}

static std::string at_frame(std::optional<int> frame) { return frame ? fmt::format("frame {}: ", *frame) : ""; }

void check_positions(const Curves& curves, const std::vector<glm::vec3>& position, std::optional<int> frame)
{
    if (position.size() != curves.points())
        throw fail("{}it has {} points and the first {}; a cache keeps their number, so leave the style's nodes as "
                   "they are",
                   at_frame(frame), position.size(), curves.points());
    size_t i = 0;
    for (size_t s = 0; s < curves.strands(); ++s)
        for (uint32_t k = 0; k < curves.count[s]; ++k, ++i)
            if (!std::isfinite(position[i].x) || !std::isfinite(position[i].y) || !std::isfinite(position[i].z))
                throw fail("{}strand {}, point {} is not a finite number, which no tool can read; `coif report` says "
                           "what went wrong with the strand",
                           at_frame(frame), s, k);
}

static void check_name(const std::string& name, const FormatInfo& format)
{
    const auto letter = [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    if (format.format == Format::USDA &&
        (name.empty() || digit(name[0]) || !std::ranges::all_of(name, [&](char c) { return letter(c) || digit(c); })))
        throw fail("group '{}': USD allows only the letters a to z, digits and _ in a name, and no digit first; give "
                   "the style's region another name",
                   name);
    // The control characters would end a line of a text, and a slash ends a name.
    if (name.empty() || name.size() > 200 ||
        std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '/' || c == '"'; }))
        throw fail("group '{}': a name in such a file is neither empty nor longer than 200 letters and has no '/' or "
                   "'\"' in it; give the style's region another name",
                   name);
}

static void check_counts(const Curves& curves, const FormatInfo& format)
{
    const uint64_t points = curves.points(), strands = curves.strands();
    const auto most = [&](uint64_t number, uint64_t limit, const char* what)
    {
        if (number > limit)
            throw fail("{} {} are more than the {} that a {} can number; write fewer strands or --points, or .usda",
                       number, what, limit, format.suffix);
    };
    if (format.format == Format::HAIR)
        for (size_t s = 0; s < strands; ++s)
            if (curves.count[s] - 1 > 65535)
                throw fail("strand {} has {} segments, and a .hair holds 65,535 a strand; ask for fewer with --points, "
                           "or write .usda or .abc",
                           s, curves.count[s] - 1);
    const bool is_signed = format.format == Format::PLY || format.format == Format::DATA ||
                           format.format == Format::ABC || format.format == Format::USDA;
    most(points, is_signed ? INT32_MAX : UINT32_MAX, "points");
    if (format.format == Format::TFX)
        most(160 + 16 * uint64_t(tfx_points(*std::ranges::max_element(curves.count))) * strands, UINT32_MAX, "bytes");
    if (format.format == Format::GLB)
        most(strands, uint64_t(1) << 24, "strands"); // _STRAND is a float
}

void check_curves(const Curves& curves, const FormatInfo& format)
{
    if (curves.strands() == 0)
        throw fail("there is no hair to write; raise interpolation.strands");
    size_t total = 0;
    for (size_t s = 0; s < curves.strands(); ++s)
    {
        if (curves.count[s] < 2)
            throw fail("strand {} has {} point; a curve takes two or more", s, curves.count[s]);
        total += curves.count[s];
    }
    if (curves.points() != total || curves.width.size() != total || curves.color.size() != total ||
        curves.root_uv.size() != curves.strands())
        throw fail("the curves are not whole: {} points, {} widths, {} colours and {} root UVs for {} strands of {} "
                   "points in all",
                   curves.points(), curves.width.size(), curves.color.size(), curves.root_uv.size(), curves.strands(),
                   total);
    check_counts(curves, format);
    check_positions(curves, curves.position);
    size_t i = 0;
    for (size_t s = 0; s < curves.strands(); i += curves.count[s], ++s)
    {
        for (uint32_t k = 0; k < curves.count[s]; ++k)
        {
            const float width = curves.width[i + k];
            const glm::vec3& color = curves.color[i + k];
            if (!std::isfinite(width) || width < 0.0f || !std::isfinite(color.x + color.y + color.z))
                throw fail("strand {}, point {} has a width or a colour that is no such thing; see the style's [look]",
                           s, k);
        }
        if (!(curves.width[i] > 0.0f)) // Unity then drops all widths
            throw fail("strand {} is not wider than 0 at its root, where readers take all widths for missing; raise "
                       "look.width or the first number of look.width_along",
                       s);
        if (!std::isfinite(curves.root_uv[s].x + curves.root_uv[s].y))
            throw fail("strand {} has a root UV that is not a finite number", s);
    }
    for (const std::string& name : curves.group_name)
        check_name(name, format);
}

void write_curves(NewFile& file, const FormatInfo& format, const Curves& curves, const FileWords& words,
                  const Cache* cache)
{
    switch (format.format)
    {
    case Format::USDA:
        return write_usda(file, curves, words, cache);
    case Format::ABC:
        return write_abc(file, curves, words, cache);
    case Format::HAIR:
        return write_hair(file, curves, words);
    case Format::TFX:
        return write_tfx(file, curves, tfx_points(*std::ranges::max_element(curves.count)));
    case Format::OBJ:
        return write_obj(file, curves, words);
    case Format::PLY:
        return write_ply(file, curves, words);
    case Format::GLB:
        return write_glb(file, curves);
    case Format::DATA:
        return write_data(file, curves);
    case Format::PBRT:
        return write_pbrt(file, curves, words);
    case Format::MITSUBA:
        return write_mitsuba(file, curves, words);
    }
}

FileSize size_of(const FormatInfo& format, const Curves& curves, const FileWords& words, const Cache* cache)
{
    const auto bytes = [&](int frames)
    {
        NewFile counted{NewFile::Counted()};
        Cache standing;
        standing.count = frames;
        standing.positions = [&](int frame, std::vector<glm::vec3>& position)
        {
            position = curves.position;
            if (frame) // a point of each part elsewhere, or an archive would keep one frame for all
                for (glm::vec3& p : position)
                    p.x = std::nextafter(p.x, INFINITY);
        };
        write_curves(counted, format, curves, words, cache ? &standing : nullptr);
        return counted.size();
    };
    if (!cache)
        return {bytes(1), true};
    const uint64_t one = bytes(1), frame = bytes(2) - one;
    return {one + frame * uint64_t(cache->count - 1), false};
}

std::string size_text(const FileSize& size)
{
    const char* about = size.exact ? "" : "about ";
    const double bytes = double(size.bytes);
    if (bytes < 1e6)
        return fmt::format("{}{:.3g} kB", about, std::max(bytes / 1e3, 0.1));
    return bytes < 1e9 ? fmt::format("{}{:.3g} MB", about, bytes / 1e6)
                       : fmt::format("{}{:.3g} GB", about, bytes / 1e9);
}

void check_room(const fs::path& file, const FileSize& size)
{
    std::error_code error;
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const fs::space_info space = fs::space(folder, error);
    if (!error && space.available < size.bytes)
        throw fail("{}: takes {}, and its disk has {} left; make room, save elsewhere, or write fewer --points",
                   file.string(), size_text(size), size_text({space.available, true}));
}

} // namespace coif

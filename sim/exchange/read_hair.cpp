// Cem Yuksel's HAIR: a header of 128 bytes, then the arrays that it says are there.
#include "sim/exchange/bytes.h"
#include "sim/exchange/read.h"

namespace coif
{

static constexpr uint64_t kHeader = 128;

enum Array : uint32_t
{
    SEGMENTS = 1,
    POINTS = 2,
    THICKNESS = 4,
    TRANSPARENCY = 8,
    COLORS = 16
};

HairFile read_hair(std::string_view all, const std::string& name)
{
    const Bytes bytes{all, name};
    bytes.need(0, 1, kHeader, "header of 128 bytes");
    if (!all.starts_with("HAIR"))
        throw fail("{}: at byte 0: is no .hair file: it does not begin with HAIR", name);
    const auto strands = bytes.value<uint32_t>(4, "header"), points = bytes.value<uint32_t>(8, "header"),
               arrays = bytes.value<uint32_t>(12, "header"), segments = bytes.value<uint32_t>(16, "header");
    if (!(arrays & POINTS))
        throw fail("{}: at byte 12: says that it holds no points; write it again with points", name);
    HairFile file;
    file.format = ".hair";
    uint64_t at = kHeader, sum = 0;
    if (arrays & SEGMENTS)
    {
        for (const uint16_t of_strand : bytes.values<uint16_t>(at, strands, "segments of each strand"))
        {
            file.curves.count.push_back(of_strand + 1u);
            sum += of_strand + 1u;
        }
        at += 2 * uint64_t(strands);
    }
    else
        sum = strands * (uint64_t(segments) + 1);
    if (sum != points)
        throw fail("{}: at byte 8: says {} points, but its {} strands have {}: it is damaged", name, points, strands,
                   sum);
    file.curves.position = bytes.values<glm::vec3>(at, points, "points");
    at += 12 * uint64_t(points);
    if (!(arrays & SEGMENTS))
        file.curves.count.assign(strands, segments + 1);
    if (arrays & THICKNESS)
    {
        file.curves.width = bytes.values<float>(at, points, "thicknesses");
        at += 4 * uint64_t(points);
    }
    else if (const float width = bytes.value<float>(20, "header"); width > 0.0f)
        file.curves.width.assign(points, width);
    if (arrays & TRANSPARENCY)
        at += 4 * uint64_t(points);
    if (arrays & COLORS)
        file.curves.color = bytes.values<glm::vec3>(at, points, "colours");
    else
        file.curves.color.assign(points, bytes.value<glm::vec3>(28, "header"));
    // The format has no place for it, so that coif writes it where there is one for words (words_of()).
    const std::string_view info = all.substr(40, 88);
    const auto says = [&](std::string_view word) { return info.find(word) != info.npos; };
    if (says("; metres"))
        file.unit = 1.0f;
    else if (says("; centimetres"))
        file.unit = 0.01f;
    if (says("; y up"))
        file.up = HAIR_UP_Y;
    else if (says("; z up, left handed"))
        file.up = HAIR_UP_UNREAL;
    else if (says("; z up"))
        file.up = HAIR_UP_Z;
    return file;
}

} // namespace coif

// Cem Yuksel's HAIR, cemyuksel.com/research/hairmodels: a header of 128 bytes, then what its third number lists, each
// array whole.
#include "sim/exchange/write.h"

#include <fmt/format.h>

#include <algorithm>

namespace coif
{

static constexpr uint32_t kSegments = 1, kPoints = 2, kThickness = 4, kColors = 16; // arrays that the file has

void write_hair(NewFile& file, const Curves& curves, const FileWords& words)
{
    const uint32_t count = curves.count[0];
    const bool alike = std::ranges::all_of(curves.count, [&](uint32_t n) { return n == count; });
    const uint32_t arrays = kPoints | kThickness | kColors | (alike ? 0 : kSegments);
    const std::string said = fmt::format("coif; {}; {}; thickness is diameter", words.units, words.axes);
    char info[88] = {};
    said.copy(info, sizeof info - 1);
    file.add("HAIR");
    for (const uint32_t number : {uint32_t(curves.strands()), uint32_t(curves.points()), arrays, alike ? count - 1 : 0})
        file.put(number);
    file.put(curves.width[0]); // the default thickness, transparency and colour
    file.put(0.0f);
    file.put(curves.color[0]);
    file.put(info);
    if (!alike)
        for (const uint32_t points : curves.count)
            file.put(uint16_t(points - 1));
    for (const glm::vec3& point : curves.position)
        file.put(point);
    for (const float width : curves.width)
        file.put(width);
    for (const glm::vec3& color : curves.color)
        file.put(color);
}

} // namespace coif

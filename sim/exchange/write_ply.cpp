// Stanford PLY, binary: a vertex a point, an edge a segment. Blender reads the edges, and CloudCompare the properties.
#include "sim/exchange/write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coif
{

static uint8_t srgb_byte(float linear) // IEC 61966-2-1
{
    const double c = std::clamp(double(linear), 0.0, 1.0);
    return uint8_t(std::lround(255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055)));
}

void write_ply(NewFile& file, const Curves& curves, const FileWords& words)
{
    std::string axes = words.axes;
    std::ranges::replace(axes, ' ', '-');
    file.add(fmt::format("ply\nformat binary_little_endian 1.0\ncomment coif {} {}\nelement vertex {}\n", words.units,
                         axes, curves.points()));
    for (const char* name : {"x", "y", "z", "width"})
        file.add(fmt::format("property float {}\n", name));
    for (const char* name : {"red", "green", "blue"})
        file.add(fmt::format("property uchar {}\n", name));
    file.add(
        fmt::format("property int strand\nelement edge {}\nproperty int vertex1\nproperty int vertex2\nend_header\n",
                    curves.points() - curves.strands()));
    size_t i = 0;
    for (size_t s = 0; s < curves.strands(); ++s)
        for (uint32_t k = 0; k < curves.count[s]; ++k, ++i)
        {
            file.put(curves.position[i]);
            file.put(curves.width[i]);
            for (int channel = 0; channel < 3; ++channel)
                file.put(srgb_byte(curves.color[i][channel]));
            file.put(int32_t(s));
        }
    i = 0;
    for (const uint32_t count : curves.count)
    {
        for (uint32_t k = 1; k < count; ++k)
        {
            file.put(int32_t(i + k - 1));
            file.put(int32_t(i + k));
        }
        i += count;
    }
}

} // namespace coif

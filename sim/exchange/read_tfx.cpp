// TressFX 4: a header of 160 bytes; positions of four numbers, the last of them an inverse mass; root UVs with v down.
#include "sim/exchange/bytes.h"
#include "sim/exchange/read.h"

namespace coif
{

HairFile read_tfx(std::string_view all, const std::string& name)
{
    const Bytes bytes{all, name};
    const float version = bytes.value<float>(0, "header of 160 bytes");
    if (version != 4.0f)
        throw fail("{}: at byte 0: is not TressFX of version 4 but {}: export it again for TressFX 4 or 5", name,
                   version);
    bytes.need(0, 1, 160, "header of 160 bytes");
    const auto strands = bytes.value<uint32_t>(4, "header"), points = bytes.value<uint32_t>(8, "header"),
               positions = bytes.value<uint32_t>(12, "header"), uvs = bytes.value<uint32_t>(16, "header");
    const uint64_t all_points = uint64_t(strands) * points;
    if (points < 2)
        throw fail("{}: at byte 8: says {} points a strand, but a strand has at least 2", name, points);
    bytes.need(positions, all_points, 16, "positions");
    HairFile file;
    file.format = "TressFX";
    file.curves.count.assign(strands, points);
    file.curves.position.reserve(all_points);
    for (uint64_t i = 0; i < all_points; ++i)
        file.curves.position.push_back(bytes.value<glm::vec3>(positions + 16 * i, "positions"));
    if (uvs != 0)
        for (const glm::vec2& uv : bytes.values<glm::vec2>(uvs, strands, "root UVs"))
            file.curves.root_uv.emplace_back(uv.x, 1.0f - uv.y);
    return file;
}

} // namespace coif

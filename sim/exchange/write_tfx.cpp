// AMD TressFX 4 (TressFXFileFormat.h): a header of 160 bytes, positions, root UVs. Its loader reads the UVs whether
// they are there or not, and neither thickness nor colours.
#include "sim/exchange/targets.h"
#include "sim/exchange/write.h"

namespace coif
{

void write_tfx(NewFile& file, const Curves& curves, int points)
{
    const uint32_t header = 160, strands = uint32_t(curves.strands());
    file.put(4.0f); // version
    for (const uint32_t number : {strands, uint32_t(points), header, header + 16 * uint32_t(points) * strands})
        file.put(number);
    for (uint32_t at = 20; at < header; at += 4)
        file.put(uint32_t(0));
    const std::vector<size_t> first = first_points(curves);
    std::vector<glm::vec3> strand;
    for (size_t s = 0; s < strands; ++s)
    {
        const auto begin = curves.position.begin() + std::ptrdiff_t(first[s]);
        strand.assign(begin, begin + curves.count[s]);
        if (strand.size() != size_t(points))
            strand = resampled(strand, points);
        for (int k = 0; k < points; ++k)
        {
            file.put(strand[size_t(k)]);
            file.put(k < 2 ? 0.0f : 1.0f); // inverse mass: the first two are held
        }
    }
    for (const glm::vec2& uv : curves.root_uv)
        file.put(glm::vec2(uv.x, 1.0f - uv.y)); // v goes down there
}

} // namespace coif

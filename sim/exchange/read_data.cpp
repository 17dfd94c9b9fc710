// Strands of hair reconstructions: their number, then of each the number of its points and those.
#include "sim/exchange/bytes.h"
#include "sim/exchange/read.h"

namespace coif
{

HairFile read_data(std::string_view all, const std::string& name)
{
    const Bytes bytes{all, name};
    const auto strands = bytes.value<int32_t>(0, "number of strands");
    if (strands < 0)
        throw fail("{}: at byte 0: says {} strands: it is no .data file of hair", name, strands);
    bytes.need(4, uint64_t(strands), 4, "strands");
    HairFile file;
    file.format = ".data";
    uint64_t at = 4;
    for (int32_t s = 0; s < strands; ++s)
    {
        const auto points = bytes.value<int32_t>(at, "strands");
        if (points < 0)
            throw fail("{}: at byte {}: strand {} says {} points: it is damaged, or no .data file of hair", name, at, s,
                       points);
        const auto own = bytes.values<glm::vec3>(at + 4, uint64_t(points), "strands");
        file.curves.count.push_back(uint32_t(points));
        file.curves.position.insert(file.curves.position.end(), own.begin(), own.end());
        at += 4 + 12 * uint64_t(points);
    }
    if (at != all.size())
        throw fail("{}: at byte {}: {} bytes are left after its strands: it is no .data file of hair", name, at,
                   all.size() - at);
    return file;
}

} // namespace coif

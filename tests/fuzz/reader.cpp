// One of the readers of hair, fed by libFuzzer: whatever the bytes, hair or an Error, and sound hair at that. Built
// once for each reader, as READER.
#include "sim/error.h"
#include "sim/exchange/read.h"

#include <cstdlib>

static void require(bool holds)
{
    if (!holds)
        abort();
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size)
{
    using namespace coif;
    static const std::string kName = "fuzzed";
    HairFile file;
    try
    {
        file = READER({reinterpret_cast<const char*>(data), size}, kName);
        drop_bad_strands(file);
    }
    catch (const Error&)
    {
        return 0;
    }
    const Curves& c = file.curves;
    size_t points = 0;
    for (const uint32_t count : c.count)
    {
        require(count >= 2);
        points += count;
    }
    require(points == c.points());
    for (const glm::vec3& p : c.position)
        require(p.x * p.x + p.y * p.y + p.z * p.z <= 4e12f);
    require(c.width.empty() || c.width.size() == points);
    require(c.color.empty() || c.color.size() == points);
    require(c.root_uv.empty() || c.root_uv.size() == c.strands());
    require(c.id.empty() || c.id.size() == c.strands());
    require(c.guide.empty() || c.guide.size() == c.strands());
    require(c.group.empty() || c.group.size() == c.strands());
    return 0;
}

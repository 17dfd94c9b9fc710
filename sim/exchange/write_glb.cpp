// glTF 2.0, binary: one primitive of lines. Width and strand go as attributes of our own, which viewers leave alone.
#include "sim/error.h"
#include "sim/exchange/write.h"

#include <glm/common.hpp>

namespace coif
{

enum GltfNumbers // of the specification, which are OpenGL's
{
    OF_UNSIGNED = 5125,
    OF_FLOAT = 5126,
    FOR_VERTICES = 34962,
    FOR_INDICES = 34963
};

void write_glb(NewFile& file, const Curves& curves)
{
    const uint64_t points = curves.points(), indices = 2 * (points - curves.strands());
    glm::vec3 low = curves.position[0], high = low;
    for (const glm::vec3& p : curves.position)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    uint64_t bytes = 0;
    int view = 0;
    std::string views, accessors;
    const auto describe =
        [&](const char* type, uint64_t size, uint64_t count, int component, int target, const std::string& more)
    {
        views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{},"target":{}}})", view ? "," : "", bytes,
                             size * count, target);
        accessors += fmt::format(R"({}{{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})",
                                 view ? "," : "", view, component, count, type, more);
        ++view;
        bytes += size * count;
    };
    describe("VEC3", 12, points, OF_FLOAT, FOR_VERTICES,
             fmt::format(R"(,"min":[{},{},{}],"max":[{},{},{}])", low.x, low.y, low.z, high.x, high.y, high.z));
    describe("VEC4", 16, points, OF_FLOAT, FOR_VERTICES, "");
    describe("VEC2", 8, points, OF_FLOAT, FOR_VERTICES, "");
    describe("SCALAR", 4, points, OF_FLOAT, FOR_VERTICES, "");
    describe("SCALAR", 4, points, OF_FLOAT, FOR_VERTICES, "");
    describe("SCALAR", 4, indices, OF_UNSIGNED, FOR_INDICES, "");
    std::string json =
        fmt::format(R"({{"asset":{{"version":"2.0","generator":"coif"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
                    R"("nodes":[{{"name":"{0}","mesh":0}}],"meshes":[{{"name":"{0}","primitives":[{{"attributes":)"
                    R"({{"POSITION":0,"COLOR_0":1,"TEXCOORD_0":2,"_WIDTH":3,"_STRAND":4}},"indices":5,"mode":1}}]}}],)"
                    R"("buffers":[{{"byteLength":{1}}}],"bufferViews":[{2}],"accessors":[{3}]}})",
                    kHairName, bytes, views, accessors);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const uint64_t total = 28 + json.size() + bytes;
    if (total > UINT32_MAX)
        throw fail("a .glb holds 4 GB at most and this hair takes {} bytes; take fewer --points, or .usda or .abc",
                   total);
    file.add("glTF");
    file.put(uint32_t(2));
    file.put(uint32_t(total));
    file.put(uint32_t(json.size()));
    file.add("JSON");
    file.add(json);
    file.put(uint32_t(bytes));
    file.add({"BIN\0", 4});
    for (const glm::vec3& p : curves.position)
        file.put(p);
    for (const glm::vec3& color : curves.color)
    {
        file.put(color);
        file.put(1.0f);
    }
    for (size_t s = 0; s < curves.strands(); ++s)
        for (uint32_t k = 0; k < curves.count[s]; ++k)
            file.put(glm::vec2(curves.root_uv[s].x, 1.0f - curves.root_uv[s].y)); // v goes down there
    for (const float width : curves.width)
        file.put(width);
    for (size_t s = 0; s < curves.strands(); ++s)
        for (uint32_t k = 0; k < curves.count[s]; ++k)
            file.put(float(s));
    uint32_t at = 0;
    for (const uint32_t count : curves.count)
    {
        for (uint32_t k = at; k + 1 < at + count; ++k)
        {
            file.put(k);
            file.put(k + 1);
        }
        at += count;
    }
}

} // namespace coif

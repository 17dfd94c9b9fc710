// OpenUSD text. `pinned`, for `nonperiodic` would need two points more that readers take for hair; widths `vertex`, for
// readers differ over how many `varying` ones there are. The groom schema stands once, on the Xform.
#include "sim/exchange/write.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <memory>

namespace coif
{

static void add_tuple(NewFile& file, const float* values, int count)
{
    for (int i = 0; i < count; ++i)
    {
        file.add(i ? ", " : "(");
        file.number(values[i]);
    }
    file.add(")");
}
static void add_value(NewFile& file, const glm::vec3& v) { add_tuple(file, &v.x, 3); }
static void add_value(NewFile& file, const glm::vec2& v) { add_tuple(file, &v.x, 2); }
static void add_value(NewFile& file, float v) { file.number(v); }
static void add_value(NewFile& file, int64_t v) { file.number(v); }

namespace
{
struct Prim
{
    NewFile& file;
    const Curves& curves;
    const Part& part;
    const std::vector<size_t>& first;

    // [value of each strand, ...]
    template <typename Of> void of_strands(Of of) const
    {
        file.add("[");
        for (const uint32_t& s : part.strand)
        {
            file.add(&s == part.strand.data() ? "" : ", ");
            add_value(file, of(s));
        }
        file.add("]");
    }
    template <typename T> void of_points(NewFile& to, const std::vector<T>& values) const
    {
        to.add("[");
        for (const uint32_t& s : part.strand)
            for (size_t i = first[s]; i < first[s] + curves.count[s]; ++i)
            {
                to.add(&s == part.strand.data() && i == first[s] ? "" : ", ");
                add_value(to, values[i]);
            }
        to.add("]");
    }
    void extent(NewFile& to, const std::vector<glm::vec3>& position) const
    {
        glm::vec3 low(INFINITY), high(-INFINITY);
        float widest = 0.0f;
        for (const uint32_t s : part.strand)
            for (size_t i = first[s]; i < first[s] + curves.count[s]; ++i)
            {
                low = glm::min(low, position[i]);
                high = glm::max(high, position[i]);
                widest = std::max(widest, curves.width[i]);
            }
        to.add("[");
        add_value(to, low - 0.5f * widest);
        to.add(", ");
        add_value(to, high + 0.5f * widest);
        to.add("]");
    }
    void begin(const char* type, const char* name) const { file.add(fmt::format("        {}[] {} = ", type, name)); }
    void end(const char* interpolation) const
    {
        file.add(fmt::format(" (\n            interpolation = \"{}\"\n        )\n", interpolation));
    }
};
} // namespace

// Frames come one after another, prims lie one behind another: what the later prims hold of a frame waits in files of
// their own.
struct Moving
{
    std::unique_ptr<NewFile> points, extents;
};

static void add_static(const Prim& prim, const FileWords& words)
{
    const bool cubic = words.through == Through::CATMULL_ROM;
    prim.file.add(fmt::format("\n    def BasisCurves \"{}\"\n    {{\n        uniform token type = \"{}\"\n        "
                              "uniform token basis = \"catmullRom\"\n        uniform token wrap = \"{}\"\n",
                              prim.part.name.empty() ? "strands" : prim.part.name, cubic ? "cubic" : "linear",
                              cubic ? "pinned" : "nonperiodic"));
    prim.begin("int", "curveVertexCounts");
    prim.of_strands([&](uint32_t s) { return int64_t(prim.curves.count[s]); });
    prim.file.add("\n");
}

static void add_attributes(const Prim& prim)
{
    const Curves& curves = prim.curves;
    const auto mean_color = [&](uint32_t s)
    {
        glm::dvec3 sum(0.0);
        for (size_t i = prim.first[s]; i < prim.first[s] + curves.count[s]; ++i)
            sum += glm::dvec3(curves.color[i]);
        return glm::vec3(sum / double(curves.count[s]));
    };
    const auto uv = [&](uint32_t s) { return curves.root_uv[s]; };
    prim.begin("float", "widths");
    prim.of_points(prim.file, curves.width);
    prim.end("vertex");
    prim.begin("color3f", "primvars:displayColor");
    prim.of_strands(mean_color);
    prim.end("uniform");
    prim.begin("texCoord2f", "primvars:st");
    prim.of_strands(uv);
    prim.end("uniform");
    prim.begin("float2", "primvars:groom_root_uv");
    prim.of_strands(uv);
    prim.end("uniform");
    prim.begin("float3", "primvars:groom_color");
    prim.of_points(prim.file, curves.color);
    prim.end("vertex");
    prim.begin("int", "primvars:groom_id");
    prim.of_strands([&](uint32_t s) { return int64_t(id_of(curves, s)); });
    prim.end("uniform");
    prim.begin("int", "primvars:groom_guide");
    prim.of_strands([&](uint32_t s) { return int64_t(!curves.guide.empty() && curves.guide[s]); });
    prim.end("uniform");
    if (!prim.part.name.empty())
        prim.file.add(
            fmt::format("        int primvars:groom_group_id = {}\n        string primvars:groom_group_name = "
                        "\"{}\"\n",
                        prim.part.group, prim.part.name));
    prim.file.add("    }\n");
}

void write_usda(NewFile& file, const Curves& curves, const FileWords& words, const Cache* cache)
{
    file.add(
        fmt::format("#usda 1.0\n(\n    defaultPrim = \"{}\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n", kHairName));
    if (cache)
        file.add(fmt::format("    startTimeCode = {}\n    endTimeCode = {}\n    timeCodesPerSecond = {}\n    "
                             "framesPerSecond = {}\n",
                             cache->first, cache->first + cache->count - 1, cache->fps, cache->fps));
    file.add(fmt::format(")\n\ndef Xform \"{}\" (\n    kind = \"component\"\n    prepend apiSchemas = [\"GroomAPI\"]\n"
                         ")\n{{\n    custom int groom_version_major = 1\n    custom int groom_version_minor = 5\n    "
                         "custom string groom_tool = \"coif\"\n",
                         kHairName));
    const std::vector<size_t> first = first_points(curves);
    const std::vector<Part> parts = parts_of(curves, false);
    std::vector<Prim> prims;
    for (const Part& part : parts)
        prims.push_back({file, curves, part, first});
    std::vector<Moving> moving;
    if (cache)
    {
        add_static(prims[0], words);
        file.add("        point3f[] points.timeSamples = {");
        for (size_t p = 0; p < prims.size(); ++p)
            moving.push_back({p ? file.scratch() : nullptr, file.scratch()});
        std::vector<glm::vec3> position;
        for (int frame = cache->first; frame < cache->first + cache->count; ++frame)
        {
            cache->positions(frame, position);
            for (size_t p = 0; p < prims.size(); ++p)
            {
                const std::string time = fmt::format("{}{}: ", frame == cache->first ? "" : ", ", frame);
                NewFile& points = p ? *moving[p].points : file;
                points.add(time);
                prims[p].of_points(points, position);
                moving[p].extents->add(time);
                prims[p].extent(*moving[p].extents, position);
            }
        }
    }
    for (size_t p = 0; p < prims.size(); ++p)
    {
        if (!cache || p > 0)
            add_static(prims[p], words);
        if (cache)
        {
            if (p > 0)
            {
                file.add("        point3f[] points.timeSamples = {");
                file.add_all_of(*moving[p].points);
            }
            file.add("}\n        float3[] extent.timeSamples = {");
            file.add_all_of(*moving[p].extents);
            file.add("}\n");
            moving[p] = {};
        }
        else
        {
            prims[p].begin("point3f", "points");
            prims[p].of_points(file, curves.position);
            file.add("\n");
            prims[p].begin("float3", "extent");
            prims[p].extent(file, curves.position);
            file.add("\n");
        }
        add_attributes(prims[p]);
    }
    file.add("}\n");
}

} // namespace coif

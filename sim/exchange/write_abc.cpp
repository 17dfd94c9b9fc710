// Alembic as its Ogawa core lies in a file: groups of offsets, data behind a size, children before parents. A sample is
// a digest of what it holds and the values; equal ones lie there once.
#include "sim/exchange/write.h"
#include "sim/hash.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <map>
#include <span>

namespace coif
{

namespace
{

enum Pod
{
    U8 = 1,
    I16 = 4,
    I32 = 6,
    F32 = 10,
    F64 = 11,
    TEXT = 12
};

constexpr uint64_t kData = uint64_t(1) << 63; // of an offset; alone: no bytes

// A property, whose samples are in the file already.
struct Property
{
    std::string name, meta;
    Pod pod = U8;
    int extent = 1;
    bool array = true;
    int times = 0;                 // time sampling
    size_t declared = 1;           // samples that it is said to have
    size_t values = 1;             // in each of them
    std::vector<uint64_t> samples; // offsets; one where all are the same
    std::vector<uint64_t> sizes;   // of texts: offsets of how many they are
    bool compound = false;
    std::vector<Property> inner;
};

struct Archive
{
    NewFile& file;
    std::map<std::pair<uint64_t, uint64_t>, uint64_t> seen; // digest -> offset
    std::vector<std::string> metas;
    Hash all; // of every sample so far

    uint64_t data(std::string_view bytes)
    {
        if (bytes.empty())
            return kData;
        const uint64_t at = file.size();
        file.put(uint64_t(bytes.size()));
        file.add(bytes);
        return at | kData;
    }
    uint64_t group(std::span<const uint64_t> children)
    {
        if (children.empty())
            return 0;
        const uint64_t at = file.size();
        file.put(uint64_t(children.size()));
        for (const uint64_t child : children)
            file.put(child);
        return at;
    }
    uint64_t sample(std::string_view bytes)
    {
        Hash digest;
        digest.add(bytes.data(), bytes.size());
        all.add(digest.word, sizeof digest.word);
        const auto [place, is_new] = seen.try_emplace({digest.word[0], digest.word[1]}, file.size() | kData);
        if (is_new)
        {
            file.put(uint64_t(sizeof digest.word + bytes.size()));
            file.put(digest.word);
            file.add(bytes);
        }
        return place->second;
    }
    uint8_t meta(const std::string& text)
    {
        if (text.empty())
            return 0;
        if (const auto known = std::ranges::find(metas, text); known != metas.end())
            return uint8_t(known - metas.begin() + 1);
        metas.push_back(text);
        return uint8_t(metas.size());
    }

    Property property(const std::string& name, const std::string& meta_text, Pod pod, int extent, bool array,
                      std::string_view bytes, size_t values)
    {
        Property p{name, meta_text, pod, extent, array, 0, 1, values, {sample(bytes)}, {}, false, {}};
        if (array && pod == TEXT)
        {
            const uint64_t count = values;
            p.sizes.push_back(data({reinterpret_cast<const char*>(&count), sizeof count}));
        }
        return p;
    }
    template <typename T>
    Property of(const std::string& name, const std::string& meta_text, Pod pod, int extent, bool array,
                const std::vector<T>& values)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        return property(name, meta_text, pod, extent, array,
                        {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)}, values.size());
    }
};

struct Object
{
    std::string name, meta;
    std::vector<Property> properties;
    std::vector<Object> children;
};

template <typename T> void append(std::string& to, const T& value)
{
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

} // namespace

static uint64_t write_compound(Archive& archive, const std::vector<Property>& properties)
{
    std::vector<uint64_t> children;
    std::string headers;
    for (const Property& p : properties)
    {
        const uint32_t meta = uint32_t(archive.meta(p.meta)) << 20;
        if (p.compound)
        {
            children.push_back(write_compound(archive, p.inner));
            append(headers, meta);
            append(headers, uint8_t(p.name.size()));
            headers += p.name;
            continue;
        }
        std::vector<uint64_t> samples;
        for (const uint64_t sample : p.samples)
        {
            samples.push_back(sample);
            if (p.array)
                samples.push_back(p.sizes.empty() ? kData : p.sizes[0]);
        }
        children.push_back(archive.group(samples));
        const bool constant = p.samples.size() == 1;
        const uint32_t size_hint = p.declared < 256 ? 0 : p.declared < 65536 ? 1 : 2;
        const auto number = [&](size_t value)
        {
            for (int byte = 0; byte < 1 << size_hint; ++byte)
                headers += char(value >> 8 * byte & 255);
        };
        const uint32_t kind = !p.array ? 1 : p.values == 1 ? 3 : 2;
        append(headers, kind | size_hint << 2 | uint32_t(p.pod) << 4 | uint32_t(p.times > 0) << 8 | 1u << 10 |
                            uint32_t(constant) << 11 | uint32_t(p.extent) << 12 | meta);
        number(p.declared);
        if (p.times > 0)
            number(size_t(p.times));
        number(p.name.size());
        headers += p.name;
    }
    if (children.empty())
        return 0;
    children.push_back(archive.data(headers));
    return archive.group(children);
}

static uint64_t write_object(Archive& archive, const Object& object)
{
    std::vector<uint64_t> children = {write_compound(archive, object.properties)};
    std::string headers;
    for (const Object& child : object.children)
    {
        children.push_back(write_object(archive, child));
        append(headers, uint32_t(child.name.size()));
        headers += child.name;
        headers += char(archive.meta(child.meta));
    }
    append(headers, archive.all.word); // what readers compare, to see whether something has changed
    append(headers, uint64_t(children.size()));
    append(headers, uint64_t(0));
    children.push_back(archive.data(headers));
    return archive.group(children);
}

static std::string of_geometry(const char* scope, int extent, const char* pod, const char* interpretation = "")
{
    return fmt::format("arrayExtent=1;geoScope={};{}{}{}isGeomParam=true;podExtent={};podName={}", scope,
                       *interpretation ? "interpretation=" : "", interpretation, *interpretation ? ";" : "", extent,
                       pod);
}

namespace
{
// What of one part is written frame by frame.
struct Frames
{
    std::vector<uint64_t> points, boxes;
};
} // namespace

static void write_frame(Archive& archive, const Curves& curves, const Part& part, const std::vector<size_t>& first,
                        const std::vector<glm::vec3>& position, Frames& frames)
{
    std::vector<glm::vec3> points;
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const uint32_t s : part.strand)
        for (size_t i = first[s]; i < first[s] + curves.count[s]; ++i)
        {
            points.push_back(position[i]);
            low = glm::min(low, glm::dvec3(position[i]));
            high = glm::max(high, glm::dvec3(position[i]));
        }
    const glm::dvec3 box[2] = {low, high};
    frames.points.push_back(
        archive.sample({reinterpret_cast<const char*>(points.data()), points.size() * sizeof points[0]}));
    frames.boxes.push_back(archive.sample({reinterpret_cast<const char*>(box), sizeof box}));
}

static Object object_of(Archive& archive, const Curves& curves, const Part& part, const std::vector<size_t>& first,
                        const FileWords& words, Frames frames, int times)
{
    const size_t declared = frames.points.size();
    std::vector<int32_t> count, id;
    std::vector<float> width;
    std::vector<glm::vec2> uv, root_uv;
    std::vector<glm::vec3> color;
    for (const uint32_t s : part.strand)
    {
        count.push_back(int32_t(curves.count[s]));
        id.push_back(id_of(curves, s));
        root_uv.push_back(curves.root_uv[s]);
        for (size_t i = first[s]; i < first[s] + curves.count[s]; ++i)
        {
            width.push_back(curves.width[i]);
            color.push_back(curves.color[i]);
            uv.push_back(curves.root_uv[s]);
        }
    }
    const auto moving = [&](const char* name, const char* meta, Pod pod, int extent, bool array,
                            std::vector<uint64_t> samples, size_t values)
    {
        if (std::ranges::all_of(samples, [&](uint64_t at) { return at == samples[0]; }))
            samples.resize(1);
        return Property{name, meta, pod, extent, array, times, declared, values, std::move(samples), {}, false, {}};
    };
    std::vector<Property> geometry = {
        moving(".selfBnds", "interpretation=box", F64, 6, false, frames.boxes, 1),
        moving("P", "geoScope=vtx;interpretation=point", F32, 3, true, frames.points, width.size())};
    const bool cubic = words.through == Through::CATMULL_ROM;
    // Type (cubic 0, linear 1), wrap (0: neither closed nor with phantom points), basis twice (Catmull-Rom 3).
    const std::vector<uint8_t> type = {uint8_t(cubic ? 0 : 1), 0, uint8_t(cubic ? 3 : 0), uint8_t(cubic ? 3 : 0)};
    geometry.push_back(archive.of("nVertices", "", I32, 1, true, count));
    geometry.push_back(archive.of("curveBasisAndType", "", U8, 4, false, type));
    for (Property& p : std::span(geometry).last(2))
    {
        p.times = times;
        p.declared = declared;
    }
    geometry.push_back(archive.of("width", of_geometry("vtx", 1, "float32_t"), F32, 1, true, width));
    geometry.push_back(archive.of("uv", of_geometry("vtx", 2, "float32_t", "vector"), F32, 2, true, uv));

    Property more;
    more.name = ".arbGeomParams";
    more.compound = true;
    const auto constant = [&](const char* name, int32_t value)
    {
        more.inner.push_back(
            archive.of(name, of_geometry("con", 1, "int32_t"), I32, 1, true, std::vector<int32_t>{value}));
    };
    more.inner.push_back(
        archive.of("groom_root_uv", of_geometry("uni", 2, "float32_t", "vector"), F32, 2, true, root_uv));
    more.inner.push_back(archive.of("groom_color", of_geometry("vtx", 3, "float32_t", "rgb"), F32, 3, true, color));
    more.inner.push_back(archive.of("groom_id", of_geometry("uni", 1, "int32_t"), I32, 1, true, id));
    constant("groom_guide", part.guides);
    constant("groom_group_id", part.group);
    const std::string group = (part.name.empty() ? kHairName : part.name) + std::string(1, '\0');
    more.inner.push_back(
        archive.property("groom_group_name", of_geometry("con", 1, "string"), TEXT, 1, true, group, 1));
    geometry.push_back(std::move(more));

    Property geom;
    geom.name = ".geom";
    geom.meta = "schema=AbcGeom_Curve_v2;schemaBaseType=AbcGeom_GeomBase_v1";
    geom.compound = true;
    geom.inner = std::move(geometry);
    const std::string name =
        part.name.empty() ? (part.guides ? "guides" : "strands") : part.name + (part.guides ? "_guides" : "");
    return {name, geom.meta + ";schemaObjTitle=AbcGeom_Curve_v2:.geom", {geom}, {}};
}

static Object hair_of(Archive& archive)
{
    Property user, transform;
    user.name = ".userProperties";
    user.compound = true;
    user.inner = {archive.of("groom_version_major", "", I16, 1, false, std::vector<int16_t>{1}),
                  archive.of("groom_version_minor", "", I16, 1, false, std::vector<int16_t>{5}),
                  archive.property("groom_tool", "", TEXT, 1, false, {"coif\0", 5}, 1)};
    transform.name = ".xform";
    transform.meta = "schema=AbcGeom_Xform_v3";
    transform.compound = true;
    transform.inner = {user};
    return {kHairName, "schema=AbcGeom_Xform_v3;schemaObjTitle=AbcGeom_Xform_v3:.xform", {transform}, {}};
}

void write_abc(NewFile& file, const Curves& curves, const FileWords& words, const Cache* cache)
{
    file.add({"Ogawa\0\0\1", 8}); // byte 5: not whole yet
    file.put(uint64_t(0));
    Archive archive{file, {}, {}, {}};
    const std::vector<size_t> first = first_points(curves);
    const std::vector<Part> parts = parts_of(curves, true);
    std::vector<Frames> frames(parts.size());
    std::vector<glm::vec3> position;
    for (int frame = 0; frame < (cache ? cache->count : 1); ++frame)
    {
        if (cache)
            cache->positions(cache->first + frame, position);
        for (size_t p = 0; p < parts.size(); ++p)
            write_frame(archive, curves, parts[p], first, cache ? position : curves.position, frames[p]);
    }
    Object hair = hair_of(archive);
    for (size_t p = 0; p < parts.size(); ++p)
        hair.children.push_back(
            object_of(archive, curves, parts[p], first, words, std::move(frames[p]), cache ? 1 : 0));
    const uint64_t top = write_object(archive, {"", "", {}, {hair}});

    std::string times, metas;
    const auto sampling = [&](uint32_t samples, double cycle, double start)
    {
        append(times, samples);
        append(times, cycle);
        append(times, uint32_t(1));
        append(times, start);
    };
    sampling(1, 1.0, 0.0); // what stands still, which every archive has
    if (cache)
        sampling(uint32_t(cache->count), 1.0 / cache->fps, cache->first / cache->fps);
    for (const std::string& meta : archive.metas)
        metas += char(meta.size()) + meta;
    const int32_t zero = 0, library = 10803; // of the layout
    const auto bytes_of = [](const int32_t& v)
    { return std::string_view(reinterpret_cast<const char*>(&v), sizeof v); };
    std::vector<uint64_t> root = {archive.data(bytes_of(zero)), archive.data(bytes_of(library)), top};
    root.push_back(archive.data("_ai_AlembicVersion=Alembic 1.8.3;_ai_Application=coif;_ai_Description=hair"));
    root.push_back(archive.data(times));
    root.push_back(archive.data(metas));
    const uint64_t at = archive.group(root);
    file.put_back(8, {reinterpret_cast<const char*>(&at), sizeof at});
    file.put_back(5, "\xff"); // whole
}

} // namespace coif

// Alembic: the curves of all objects in the archive, first sample, under their transforms.
#include "sim/exchange/curve_set.h"
#include "sim/exchange/ogawa.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <map>

namespace coif
{

static constexpr size_t kMostDepth = 64; // of objects

namespace
{
struct Reader
{
    Ogawa archive;
    const std::string& name;
    HairFile file;
    uint64_t most_points;              // that a file of this size can mean
    std::map<std::string, int> others; // schemas that are no hair: objects
};
} // namespace

static const OgawaProperty* find(const std::vector<OgawaProperty>& among, std::string_view name)
{
    for (const OgawaProperty& property : among)
        if (property.name == name)
            return &property;
    return nullptr;
}

template <typename T> static std::vector<T> values_of(std::string_view bytes)
{
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty())
        memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

// A parameter of the curves, of one of two types: an array, or a compound of values and indices of them. Of any other
// type or size it is left out.
template <typename T>
static std::vector<T> parameter(Reader& reader, const std::vector<OgawaProperty>& among, std::string_view name,
                                std::initializer_list<OgawaPod> pods)
{
    const OgawaProperty* property = find(among, name);
    if (!property)
        return {};
    const auto fits = [&](const OgawaProperty& array)
    {
        constexpr int kParts = sizeof(T) / 4; // a vector may also be that many values each
        return std::ranges::find(pods, OgawaPod(array.pod)) != pods.end() &&
               (array.extent == kParts || array.extent == 1);
    };
    if (!property->compound)
        return fits(*property) ? values_of<T>(reader.archive.first_sample(*property)) : std::vector<T>{};
    const std::vector<OgawaProperty> parts = reader.archive.properties(*property);
    const OgawaProperty *values = find(parts, ".vals"), *indices = find(parts, ".indices");
    if (!values || !fits(*values))
        return {};
    const std::vector<T> all = values_of<T>(reader.archive.first_sample(*values));
    if (!indices)
        return all;
    std::vector<T> indexed;
    for (const uint32_t index : values_of<uint32_t>(reader.archive.first_sample(*indices)))
    {
        if (index >= all.size())
            throw fail("{}: an index of '{}' is {}, but it has {} values: it is damaged", reader.name, name, index,
                       all.size());
        indexed.push_back(all[index]);
    }
    return indexed;
}

// Of an Xform, with its parents' if it inherits them. Operations are listed outermost first; matrices are of rows.
static glm::dmat4 transform(Reader& reader, const OgawaObject& object, const glm::dmat4& parent)
{
    const std::vector<OgawaProperty> own = reader.archive.properties(object);
    const OgawaProperty* xform = find(own, ".xform");
    if (!xform)
        return parent;
    const std::vector<OgawaProperty> parts = reader.archive.properties(*xform);
    const OgawaProperty *ops = find(parts, ".ops"), *vals = find(parts, ".vals"), *inherits = find(parts, ".inherits");
    const std::string_view inherited = inherits ? reader.archive.first_sample(*inherits) : std::string_view{};
    glm::dmat4 matrix = inherited.empty() || inherited[0] ? parent : glm::dmat4(1.0);
    if (!ops)
        return matrix;
    const std::vector<double> values =
        vals && vals->pod == POD_F64 ? values_of<double>(reader.archive.first_sample(*vals)) : std::vector<double>{};
    size_t at = 0;
    const auto take = [&](size_t count)
    {
        if (values.size() - at < count)
            throw fail("{}: the transform '{}' has fewer values than its operations ask for: it is damaged",
                       reader.name, object.name);
        at += count;
        return &values[at - count];
    };
    for (const uint8_t op : values_of<uint8_t>(reader.archive.first_sample(*ops)))
    {
        const int kind = op >> 4;
        if (kind == 0 || kind == 1)
        {
            const double* v = take(3);
            matrix = kind == 0 ? glm::scale(matrix, {v[0], v[1], v[2]}) : glm::translate(matrix, {v[0], v[1], v[2]});
        }
        else if (kind == 2)
        {
            const double* v = take(4);
            const glm::dvec3 axis(v[0], v[1], v[2]);
            if (glm::dot(axis, axis) > 0.0)
                matrix = glm::rotate(matrix, glm::radians(v[3]), axis);
        }
        else if (kind == 3)
        {
            const double* v = take(16);
            glm::dmat4 rows;
            for (int i = 0; i < 16; ++i)
                rows[i / 4][i % 4] = v[i]; // a row of theirs is a column of ours
            matrix = matrix * rows;
        }
        else if (kind <= 6)
        {
            const glm::dvec3 axis(kind == 4, kind == 5, kind == 6);
            matrix = glm::rotate(matrix, glm::radians(*take(1)), axis);
        }
        else
            throw fail("{}: the transform '{}' has an operation {} that Alembic does not have: it is damaged",
                       reader.name, object.name, kind);
    }
    return matrix;
}

static void read_curves(Reader& reader, const OgawaObject& object, const glm::dmat4& place)
{
    const std::vector<OgawaProperty> own = reader.archive.properties(object);
    const OgawaProperty* geometry = find(own, ".geom");
    if (!geometry)
        return;
    const std::vector<OgawaProperty> parts = reader.archive.properties(*geometry);
    CurveSet set;
    set.place = place;
    set.name = object.name;
    set.position = parameter<glm::vec3>(reader, parts, "P", {POD_F32});
    uint64_t sum = 0;
    for (const int32_t count : parameter<int32_t>(reader, parts, "nVertices", {POD_I32, POD_U32}))
    {
        if (count < 0)
            throw fail("{}: the curves '{}' hold one of {} points: it is damaged", reader.name, object.name, count);
        set.count.push_back(uint32_t(count));
        sum += uint32_t(count);
    }
    if (sum != set.position.size())
        throw fail("{}: the curves '{}' say {} points, but hold {}: it is damaged", reader.name, object.name, sum,
                   set.position.size());
    if (reader.file.curves.points() + sum > reader.most_points ||
        reader.file.curves.strands() + set.count.size() > reader.most_points)
        throw fail("{}: its curves are one another again and again: it is damaged", reader.name);
    const OgawaProperty* type = find(parts, "curveBasisAndType");
    const std::string_view told = type ? reader.archive.first_sample(*type) : std::string_view{};
    if (told.size() >= 4)
    {
        if (told[1] == 1)
        {
            reader.file.remark.push_back(
                fmt::format("its curves '{}' are closed, and are dropped: hair has a root and a tip", object.name));
            return;
        }
        // Alembic has no word for pinned, and whoever writes hair means all of its points.
        if (told[0] == 0)
            set.basis = told[2] == 1   ? CurveBasis::BEZIER
                        : told[2] == 2 ? CurveBasis::BSPLINE
                        : told[2] == 3 ? CurveBasis::CATMULL_ROM
                                       : CurveBasis::LINEAR;
    }
    set.width = parameter<float>(reader, parts, "width", {POD_F32});
    set.root_uv = parameter<glm::vec2>(reader, parts, "uv", {POD_F32});
    if (const OgawaProperty* more = find(parts, ".arbGeomParams"))
    {
        const std::vector<OgawaProperty> arb = reader.archive.properties(*more);
        if (set.width.empty())
            set.width = parameter<float>(reader, arb, "groom_width", {POD_F32});
        if (auto uv = parameter<glm::vec2>(reader, arb, "groom_root_uv", {POD_F32}); !uv.empty())
            set.root_uv = std::move(uv);
        set.color = parameter<glm::vec3>(reader, arb, "groom_color", {POD_F32});
        set.id = parameter<int32_t>(reader, arb, "groom_id", {POD_I32, POD_U32});
        set.guide = parameter<int32_t>(reader, arb, "groom_guide", {POD_I32, POD_U32});
        if (set.guide.empty()) // others write it as a short
            if (const OgawaProperty* narrow = find(arb, "groom_guide"); narrow && !narrow->compound && narrow->pod <= 4)
                for (const char c : reader.archive.first_sample(*narrow).substr(0, 1))
                    set.guide.push_back(c != 0);
        if (const OgawaProperty* group = find(arb, "groom_group_name"); group && group->pod == POD_STRING)
            if (const std::string_view text = reader.archive.first_sample(*group); !text.empty())
                set.name = text.substr(0, std::min(text.find('\0'), size_t(256)));
    }
    add_curve_set(reader.file, set);
}

HairFile read_abc(std::string_view bytes, const std::string& name)
{
    // Samples may be shared between objects, so that there may be more points than fit into the file; but not many.
    Reader reader{Ogawa(bytes, name), name, {}, bytes.size() / 3, {}};
    reader.file.format = "Alembic";
    struct Open
    {
        OgawaObject object;
        glm::dmat4 place{1.0};
        size_t depth = 0;
    };
    std::vector<Open> open = {{OgawaObject{{}, {}, reader.archive.top()}, glm::dmat4(1.0), 0}};
    while (!open.empty())
    {
        const Open here = open.back();
        open.pop_back();
        if (here.depth > kMostDepth)
            throw fail("{}: its objects lie more than {} deep: it is damaged", name, kMostDepth);
        const std::vector<OgawaObject> children = reader.archive.children(here.object);
        for (size_t i = children.size(); i-- > 0;) // the first one's curves first
        {
            Open next{children[i], here.place, here.depth + 1};
            const std::string_view schema = next.object.metadata;
            if (schema.find("schema=AbcGeom_Xform") != schema.npos)
                next.place = transform(reader, next.object, here.place);
            open.push_back(std::move(next));
        }
        const std::string_view schema = here.object.metadata;
        if (schema.find("schema=AbcGeom_Curve") != schema.npos)
            read_curves(reader, here.object, here.place);
        else if (const size_t at = schema.find("schema=AbcGeom_"); at != schema.npos && at + 15 < schema.size())
            if (const std::string_view kind = schema.substr(at + 15, schema.find('_', at + 15) - at - 15);
                kind != "Xform" && kind.size() < 32)
                ++reader.others[std::string(kind)];
    }
    for (const auto& [kind, count] : reader.others)
        reader.file.remark.push_back(fmt::format("its {} {} objects are no hair, and are not read", count, kind));
    finish_curve_sets(reader.file);
    return std::move(reader.file);
}

} // namespace coif

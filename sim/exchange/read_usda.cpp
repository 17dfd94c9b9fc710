// USD's text: the BasisCurves of all prims, first sample, under their transforms.
#include "sim/error.h"
#include "sim/exchange/curve_set.h"
#include "sim/exchange/usd_text.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace coif
{

// The turn about one axis that 'X', 'Y' or 'Z' names.
static glm::dmat4 turn(char axis, double degrees)
{
    return glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(axis == 'X', axis == 'Y', axis == 'Z'));
}

// One operation by its name: "xformOp:rotateXYZ:name". Its values are as many as it asks for.
static glm::dmat4 operation(std::string_view name, const std::vector<double>& v, const std::string& file)
{
    constexpr std::string_view kPrefix = "xformOp:";
    const std::string_view kind = name.substr(kPrefix.size(), name.find(':', kPrefix.size()) - kPrefix.size());
    const auto need = [&](size_t count)
    {
        if (v.size() != count)
            throw fail("{}: {} has {} numbers instead of {}", file, name, v.size(), count);
    };
    if (kind == "translate" || kind == "scale")
    {
        need(3);
        const glm::dvec3 by(v[0], v[1], v[2]);
        return kind == "scale" ? glm::scale(glm::dmat4(1.0), by) : glm::translate(glm::dmat4(1.0), by);
    }
    if (kind == "transform")
    {
        need(16);
        glm::dmat4 rows;
        for (int i = 0; i < 16; ++i)
            rows[i / 4][i % 4] = v[size_t(i)]; // a row of theirs is a column of ours
        return rows;
    }
    if (kind == "orient")
    {
        need(4);
        const glm::dquat q(v[0], v[1], v[2], v[3]);
        const double size = glm::length(q);
        return size > 0.0 ? glm::mat4_cast(q / size) : glm::dmat4(1.0);
    }
    if (kind.size() == 7 && kind.starts_with("rotate"))
    {
        need(1);
        return turn(kind[6], v[0]);
    }
    if (kind.size() == 9 && kind.starts_with("rotate")) // XYZ: about X first
    {
        need(3);
        glm::dmat4 all(1.0);
        for (int i = 0; i < 3; ++i)
            if (const char axis = kind[size_t(6 + i)]; axis >= 'X' && axis <= 'Z')
                all = turn(axis, v[size_t(axis - 'X')]) * all;
        return all;
    }
    throw fail("{}: {} is no operation that USD has", file, name);
}

// Of a prim under its parent's, in the order that it says, outermost first.
static glm::dmat4 transform(const UsdText& text, const UsdPrim& prim, glm::dmat4 parent, const std::string& file)
{
    const UsdAttribute* order = text.find(prim, "xformOpOrder");
    if (!order)
        return parent;
    constexpr size_t kMost = 256;
    const std::vector<std::string_view> names = text.texts(*order);
    if (names.size() > kMost)
        throw fail("{}: the prim '{}' has {} operations, more than the {} that coif follows", file, prim.name,
                   names.size(), kMost);
    for (std::string_view name : names)
    {
        if (name == "!resetXformStack!")
        {
            parent = glm::dmat4(1.0);
            continue;
        }
        constexpr std::string_view kInvert = "!invert!";
        const bool inverse = name.starts_with(kInvert);
        if (inverse)
            name.remove_prefix(kInvert.size());
        const UsdAttribute* found = name.starts_with("xformOp:") ? text.find(prim, name) : nullptr;
        if (!found)
            throw fail("{}: the prim '{}' orders {}, which it does not have", file, prim.name, name);
        const glm::dmat4 own = operation(name, text.numbers(*found), file);
        parent = parent * (inverse ? glm::inverse(own) : own);
    }
    return parent;
}

// An attribute's vectors of N numbers; with indices beside it, those that they name.
template <typename T>
static std::vector<T> vectors(const UsdText& text, const UsdPrim& prim, std::string_view name, const std::string& file)
{
    const UsdAttribute* found = text.find(prim, name);
    if (!found)
        return {};
    constexpr size_t kParts = sizeof(T) / sizeof(float);
    const std::vector<float> numbers = text.floats(*found);
    if (numbers.size() % kParts != 0)
        throw fail("{}: {} of the prim '{}' has {} numbers, which are no vectors of {}", file, name, prim.name,
                   numbers.size(), kParts);
    std::vector<T> all(numbers.size() / kParts);
    if (!all.empty())
        memcpy(static_cast<void*>(all.data()), numbers.data(), numbers.size() * sizeof(float));
    const UsdAttribute* indices = text.find(prim, std::string(name) + ":indices");
    if (!indices)
        return all;
    std::vector<T> indexed;
    for (const double index : text.numbers(*indices))
    {
        if (!(index >= 0.0 && index < double(all.size())))
            throw fail("{}: {} of the prim '{}' has {} values, but an index of {}", file, name, prim.name, all.size(),
                       index);
        indexed.push_back(all[size_t(index)]);
    }
    return indexed;
}

static std::vector<int32_t> whole(const UsdText& text, const UsdPrim& prim, std::string_view name)
{
    std::vector<int32_t> all;
    if (const UsdAttribute* found = text.find(prim, name))
        for (const double number : text.numbers(*found))
            all.push_back(std::abs(number) < 2e9 ? int32_t(number) : -1);
    return all;
}

static std::string_view word(const UsdText& text, const UsdPrim& prim, std::string_view name,
                             std::string_view otherwise)
{
    const UsdAttribute* found = text.find(prim, name);
    const std::vector<std::string_view> words = found ? text.texts(*found) : std::vector<std::string_view>{};
    return words.empty() ? otherwise : words[0];
}

static void read_curves(const UsdText& text, const UsdPrim& prim, const glm::dmat4& place, const std::string& file,
                        HairFile& hair)
{
    CurveSet set;
    set.place = place;
    set.name = word(text, prim, "primvars:groom_group_name", prim.name);
    const std::string_view type = word(text, prim, "type", "cubic"), basis = word(text, prim, "basis", "bezier"),
                           wrap = word(text, prim, "wrap", "nonperiodic");
    if (wrap == "periodic")
    {
        hair.remark.push_back(
            fmt::format("its curves '{}' are closed, and are dropped: hair has a root and a tip", prim.name));
        return;
    }
    if (type == "cubic")
        set.basis = basis == "bspline"      ? CurveBasis::BSPLINE
                    : basis == "catmullRom" ? CurveBasis::CATMULL_ROM
                                            : CurveBasis::BEZIER;
    set.pinned = wrap == "pinned";
    uint64_t sum = 0;
    for (const int32_t count : whole(text, prim, "curveVertexCounts"))
    {
        if (count < 0)
            throw fail("{}: the curves '{}' hold one of {} points", file, prim.name, count);
        set.count.push_back(uint32_t(count));
        sum += uint32_t(count);
    }
    set.position = vectors<glm::vec3>(text, prim, "points", file);
    if (sum != set.position.size())
        throw fail("{}: the curves '{}' say {} points, but hold {}: the file is damaged", file, prim.name, sum,
                   set.position.size());
    set.width = vectors<float>(text, prim, "widths", file);
    if (set.width.empty())
        set.width = vectors<float>(text, prim, "primvars:widths", file);
    for (const char* name : {"primvars:groom_color", "primvars:displayColor"})
        if (set.color.empty())
            set.color = vectors<glm::vec3>(text, prim, name, file);
    for (const char* name : {"primvars:groom_root_uv", "primvars:st", "primvars:uv"})
        if (set.root_uv.empty())
            set.root_uv = vectors<glm::vec2>(text, prim, name, file);
    set.id = whole(text, prim, "primvars:groom_id");
    set.guide = whole(text, prim, "primvars:groom_guide");
    add_curve_set(hair, set);
}

HairFile read_usda(std::string_view bytes, const std::string& name)
{
    const UsdText text(bytes, name);
    HairFile hair;
    hair.format = "USD";
    hair.unit = text.meters_per_unit() > 0.0 ? float(text.meters_per_unit()) : 0.01f; // what USD says where nobody does
    hair.up = text.up_axis() == "Z" ? HAIR_UP_Z : HAIR_UP_Y;
    std::vector<glm::dmat4> places;
    for (const UsdPrim& prim : text.prims())
    {
        const glm::dmat4 parent = prim.parent < 0 ? glm::dmat4(1.0) : places[size_t(prim.parent)];
        places.push_back(transform(text, prim, parent, name));
        if (prim.type == "BasisCurves" && !prim.abstract)
            read_curves(text, prim, places.back(), name, hair);
    }
    if (text.references() > 0)
        hair.remark.push_back(
            fmt::format("it has {} references to other files or variants, which are not read", text.references()));
    finish_curve_sets(hair);
    return hair;
}

} // namespace coif

#include "sim/strand_shapes.h"

#include "sim/error.h"
#include "sim/groom.h"
#include "sim/hairstyle.h"
#include "sim/shown.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace coif
{

StrandShapes read_shapes(const std::filesystem::path& file)
{
    return parse_shapes(read_file(file, 256 << 20), shown_file(file));
}

StrandShapes parse_shapes(const std::string& text, const std::string& name)
{
    size_t line = 0, begin = 0;
    const auto next_line = [&]
    {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view found = std::string_view(text).substr(begin, end - begin);
        begin = std::min(end + 1, text.size());
        ++line;
        return found.ends_with('\r') ? found.substr(0, found.size() - 1) : found;
    };
    if (next_line() != "coif rest 1")
        throw fail("{}:1: is no file of strand shapes: it does not begin with 'coif rest 1'", name);
    int strands = 0, nodes = 0;
    if (std::sscanf(std::string(next_line()).c_str(), "strands %d nodes %d", &strands, &nodes) != 2 || strands < 1 ||
        strands > 65536 || nodes < 3 || nodes > 64)
        throw fail("{}:2: must say 'strands N nodes M' with 1 to 65536 strands of 3 to 64 nodes", name);
    if (text.size() / 6 + 1 < size_t(strands) * size_t(nodes)) // before memory is taken for them
        throw fail("{}: ends before its {} strands of {} nodes", name, strands, nodes);
    StrandShapes shapes;
    shapes.nodes = nodes;
    shapes.position.reserve(size_t(strands) * size_t(nodes));
    while (shapes.position.size() < size_t(strands) * size_t(nodes))
    {
        if (begin >= text.size())
            throw fail("{}: ends before its {} strands of {} nodes", name, strands, nodes);
        const std::string_view words = next_line();
        glm::vec3 p(0.0f);
        const char *at = words.data(), *end = at + words.size();
        for (int axis = 0; axis < 3; ++axis)
        {
            while (at < end && *at == ' ')
                ++at;
            const auto [after, error] = std::from_chars(at, end, p[axis]);
            if (error != std::errc() || !(std::abs(p[axis]) <= 100.0f))
                throw fail("{}:{}: must be three numbers within 100 m", name, line);
            at = after;
        }
        if (at != end)
            throw fail("{}:{}: must be three numbers within 100 m", name, line);
        shapes.position.push_back(p);
    }
    return shapes;
}

std::string shapes_text(const StrandShapes& shapes)
{
    std::string text = fmt::format("coif rest 1\nstrands {} nodes {}\n", shapes.strands(), shapes.nodes);
    for (const glm::vec3& p : shapes.position)
        text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    return text;
}

// The point of a strand's curve at this length from its root, m; beyond its tip straight on.
static glm::vec3 along(const glm::vec3* strand, int nodes, float length)
{
    for (int k = 2; k < nodes; ++k)
    {
        const float segment = glm::distance(strand[k], strand[k - 1]);
        if (length <= segment || k == nodes - 1)
            return strand[k - 1] + (strand[k] - strand[k - 1]) * (segment > 1e-9f ? length / segment : 0.0f);
        length -= segment;
    }
    return strand[1];
}

static size_t authored_vertices(const Scalp& scalp) { return scalp.positions.size() - scalp.between.size(); }

void check_shapes(const StrandShapes& shapes, const Scalp& scalp)
{
    if (size_t(shapes.strands()) != authored_vertices(scalp))
        throw fail("groom.rest holds {} strands, but the scalp has {} vertices: freeze the hair on this scalp again",
                   shapes.strands(), authored_vertices(scalp));
}

void take_shapes(Groom& groom, const StrandShapes& shapes, const Scalp& scalp, float head_scale)
{
    check_shapes(shapes, scalp);
    const size_t authored = authored_vertices(scalp), nodes = size_t(shapes.nodes);
    // Each strand against its root.
    std::vector<glm::vec3> all;
    for (size_t s = 0; s < authored; ++s)
        for (size_t k = 0; k < nodes; ++k)
            all.push_back((shapes.position[s * nodes + k] - shapes.position[s * nodes + 1]) * head_scale);
    for (const Between& between : scalp.between)
        for (size_t k = 0; k < nodes; ++k)
            all.push_back(between.shares.x * all[between.of.x * nodes + k] +
                          between.shares.y * all[between.of.y * nodes + k] +
                          between.shares.z * all[between.of.z * nodes + k]);

    groom.hold = 1.0f;
    groom.rest_position.assign(size_t(groom.blocks) * LANES * size_t(groom.nodes) * 3, 0.0f);
    groom.rest_multiplier.clear();
    for (int s = 0; s < groom.blocks * LANES; ++s)
    {
        const glm::vec3* strand = &all[size_t(s < groom.guides ? s : 0) * nodes];
        const glm::vec3 inward = strand[1] - strand[0];
        const float size = glm::length(inward);
        glm::vec3 direction;
        for (int axis = 0; axis < 3; ++axis)
        {
            float& told = groom.root_direction[size_t(strand_value(s, 0, axis, 1))];
            told = size > 1e-9f ? inward[axis] / size : told;
            direction[axis] = told;
        }
        const float segment = groom.segment_length[size_t(s)];
        for (int k = 0; k < groom.nodes; ++k)
        {
            const glm::vec3 from_root =
                k == 0 ? -direction * segment : along(strand, shapes.nodes, segment * float(k - 1));
            put_vector(groom.rest_position, s, k, groom.nodes,
                       vector_at(groom.root_position.data(), s, 0, 1) + glm::dvec3(from_root));
        }
    }
}

StrandShapes shapes_of(const std::vector<float>& position, const Groom& groom, float head_scale)
{
    StrandShapes shapes;
    shapes.nodes = groom.nodes;
    // To a hundredth of a millimetre: less is not seen, and the file is half as long.
    for (int s = 0; s < groom.guides; ++s)
        for (int k = 0; k < groom.nodes; ++k)
        {
            const glm::dvec3 p = vector_at(position.data(), s, k, groom.nodes) / double(head_scale);
            shapes.position.push_back(glm::vec3(glm::round(p * 1e5) / 1e5));
        }
    return shapes;
}

} // namespace coif

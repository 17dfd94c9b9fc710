// Shapes of strands kept in a file beside a hairstyle: the rest shape that its author combed or froze.
#pragma once
#include <glm/vec3.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace coif
{

struct Groom;
struct Scalp;

// One strand for each vertex of the scalp; its first node lies under the scalp, the second is the root.
struct StrandShapes
{
    int nodes = 0;                   // of a strand
    std::vector<glm::vec3> position; // strand after strand, in the head's frame, m before head.scale
    int strands() const { return nodes > 0 ? int(position.size()) / nodes : 0; }
    bool operator==(const StrandShapes&) const = default;
};

// As a parameter of a hairstyle.
struct StoredShape
{
    std::string file; // beside the style; empty: none, or not saved yet
    std::shared_ptr<const StrandShapes> shapes;
    bool operator==(const StoredShape& other) const
    {
        return file == other.file && (shapes == other.shapes || (shapes && other.shapes && *shapes == *other.shapes));
    }
};

// A text file: "coif rest 1", "strands N nodes M", then three numbers for each node. Throws Error with file and line.
StrandShapes read_shapes(const std::filesystem::path& file);
StrandShapes parse_shapes(const std::string& text, const std::string& name);
std::string shapes_text(const StrandShapes& shapes);

// Throws Error where there are not as many strands as the authored scalp has vertices; `scalp` may be refined.
void check_shapes(const StrandShapes& shapes, const Scalp& scalp);

// Gives a groom these shapes for its rest shape, to be held whole: its strands follow their curves as far as they are
// long, and go on straight where they are longer. Vertices between others, of a refined scalp, take the mean of their
// shapes. Throws Error as check_shapes().
void take_shapes(Groom& groom, const StrandShapes& shapes, const Scalp& scalp, float head_scale);

// Guides as they lie, [block][node][axis][lane] in the head's frame (in_head_frame()), of a groom whose scalp is not
// refined.
StrandShapes shapes_of(const std::vector<float>& position, const Groom& groom, float head_scale);

} // namespace coif

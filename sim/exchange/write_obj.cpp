// Wavefront OBJ as lines. Pairs without texture indices: Blender 3 and MeshLab keep two indices of a longer line, and
// stumble over `1/1`. Colours follow the coordinates, which some readers take.
#include "sim/exchange/write.h"

namespace coif
{

static void add_point(NewFile& file, const char* word, const glm::vec3& at)
{
    file.add(word);
    for (int axis = 0; axis < 3; ++axis)
    {
        file.add(" ");
        file.number(at[axis]);
    }
}

void write_obj(NewFile& file, const Curves& curves, const FileWords& words)
{
    file.add("# coif; " + words.units + "; " + words.axes + "\n");
    for (size_t i = 0; i < curves.points(); ++i)
    {
        add_point(file, "v", curves.position[i]);
        add_point(file, "", curves.color[i]);
        file.add("\n");
    }
    const std::vector<size_t> first = first_points(curves);
    for (const Part& part : parts_of(curves, false))
    {
        file.add("o " + (part.name.empty() ? kHairName : part.name) + "\n");
        for (const uint32_t s : part.strand)
            for (size_t k = first[s] + 1; k < first[s] + curves.count[s]; ++k)
            {
                file.add("l ");
                file.number(k);
                file.add(" ");
                file.number(k + 1);
                file.add("\n");
            }
    }
}

} // namespace coif

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
    const std::vector<size_t> first = first_points(curves);
    size_t before = 0; // points in the file
    for (const Part& part : parts_of(curves, false))
    {
        file.add("o " + (part.name.empty() ? kHairName : part.name) + "\n");
        for (const uint32_t s : part.strand)
            for (size_t i = first[s]; i < first[s] + curves.count[s]; ++i)
            {
                add_point(file, "v", curves.position[i]);
                add_point(file, "", curves.color[i]);
                file.add("\n");
            }
        for (const uint32_t s : part.strand)
        {
            for (size_t k = before + 1; k < before + curves.count[s]; ++k) // they count from 1
            {
                file.add("l ");
                file.number(k);
                file.add(" ");
                file.number(k + 1);
                file.add("\n");
            }
            before += curves.count[s];
        }
    }
}

} // namespace coif

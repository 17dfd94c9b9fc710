// pbrt-v4: a curve a strand, under a hair material of its colour at the root.
#include "sim/exchange/write.h"

namespace coif
{

static void add_vector(NewFile& file, const glm::vec3& v)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        file.add(axis ? " " : "");
        file.number(v[axis]);
    }
}

void write_pbrt(NewFile& file, const Curves& curves, const FileWords& words)
{
    file.add("# pbrt-v4, Include this; " + words.units + ", " + words.axes + "\n");
    const std::vector<size_t> first = first_points(curves);
    for (size_t s = 0; s < curves.strands(); ++s)
    {
        const glm::vec3* p = &curves.position[first[s]];
        const size_t last = curves.count[s] - 1;
        // The tangent at a point, times the parameter's step: at the ends the mirrored neighbour makes it the chord.
        const auto slope = [&](size_t k) {
            return k == 0 ? p[1] - p[0] : k == last ? p[last] - p[last - 1] : 0.5f * (p[k + 1] - p[k - 1]);
        };
        file.add("AttributeBegin\nMaterial \"hair\" \"rgb reflectance\" [");
        add_vector(file, curves.color[first[s]]);
        file.add("]\nShape \"curve\" \"string type\" \"cylinder\" \"string basis\" \"bezier\" \"integer degree\" 3 "
                 "\"point3 P\" [");
        add_vector(file, p[0]);
        for (size_t k = 0; k < last; ++k)
        {
            const bool straight = words.through == Through::LINES;
            const glm::vec3 out = straight ? p[k + 1] - p[k] : slope(k), in = straight ? out : slope(k + 1);
            for (const glm::vec3& point : {p[k] + out / 3.0f, p[k + 1] - in / 3.0f, p[k + 1]})
            {
                file.add("  ");
                add_vector(file, point);
            }
        }
        file.add("] \"float width0\" ");
        file.number(curves.width[first[s]]);
        file.add(" \"float width1\" ");
        file.number(curves.width[first[s] + last]);
        file.add("\nAttributeEnd\n");
    }
}

} // namespace coif

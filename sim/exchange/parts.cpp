#include "sim/exchange/write.h"

namespace coif
{

std::vector<size_t> first_points(const Curves& curves)
{
    std::vector<size_t> first;
    first.reserve(curves.strands());
    size_t next = 0;
    for (const uint32_t count : curves.count)
    {
        first.push_back(next);
        next += count;
    }
    return first;
}

std::vector<Part> parts_of(const Curves& curves, bool guides_apart)
{
    std::vector<Part> parts;
    const size_t groups = curves.group.empty() ? 1 : curves.group_name.size();
    for (size_t g = 0; g < groups; ++g)
        for (const bool guides : {false, true})
        {
            Part part{curves.group.empty() ? "" : curves.group_name[g], int(g), guides && guides_apart, {}};
            for (uint32_t s = 0; s < curves.strands(); ++s)
            {
                const bool here = curves.group.empty() || size_t(curves.group[s]) == g;
                const bool guide = guides_apart && !curves.guide.empty() && curves.guide[s];
                if (here && guide == guides)
                    part.strand.push_back(s);
            }
            if (!part.strand.empty())
                parts.push_back(std::move(part));
        }
    return parts;
}

} // namespace coif

// The strands of USC HairSalon and of Hair Photobooth: their number, then of each its points.
#include "sim/exchange/write.h"

namespace coif
{

void write_data(NewFile& file, const Curves& curves)
{
    file.put(int32_t(curves.strands()));
    size_t at = 0;
    for (const uint32_t count : curves.count)
    {
        file.put(int32_t(count));
        for (uint32_t k = 0; k < count; ++k)
            file.put(curves.position[at++]);
    }
}

} // namespace coif

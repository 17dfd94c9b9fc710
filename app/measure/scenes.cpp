// The suite: which scenes there are. accuracy.md numbers them A1 to A15; those without a number are sweeps of one knob.
#include "app/measure/measure.h"

namespace coif
{

const std::vector<Scene>& scenes()
{
    static const std::vector<Scene> all = {
        {"A12", "Hair that follows guides against hair that is simulated", measure_interpolation},
        {"A13", "Repulsion against where the grid lies", measure_voxels},
        {"ratio", "Share of turned copies among the drawn strands", measure_ratio},
        {"grid", "Resolution of the density grid", measure_grid},
        {"picture", "Pictures against one with everything simulated", measure_picture},
    };
    return all;
}

std::string solver_name(const HairParams& params)
{
    const ParamInfo* kind = find_param("solver.kind");
    if (!kind)
        return "pbd";
    float index[3];
    get_numbers(params, *kind, index);
    return param_labels(*kind)[size_t(index[0])];
}

} // namespace coif

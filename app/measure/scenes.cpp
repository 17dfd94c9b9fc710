// The suite: which scenes there are. accuracy.md numbers them A1 to A15; those without a number are sweeps of one knob.
#include "app/measure/measure.h"

namespace coif
{

const std::vector<Scene>& scenes()
{
    static const std::vector<Scene> all = {
        {"A1", "Free fall", measure_fall},
        {"A2", "Pendulum", measure_pendulum},
        {"A3", "Small swings of a chain", measure_modes},
        {"A4", "Decay in drag", measure_decay},
        {"A5", "Motion against references", measure_motion},
        {"A5m", "A small swing against its reference", measure_small_swing},
        {"A6", "Hanging at rest", measure_hang},
        {"A7", "Angle in the wind", measure_wind},
        {"A8", "Droop of a cantilever", measure_cantilever},
        {"A9", "Catenary", measure_catenary},
        {"A10", "Order of convergence", measure_order},
        {"A11", "Energy", measure_energy},
        {"A12", "Hair that follows guides against hair that is simulated", measure_interpolation},
        {"A13", "Repulsion against where the grid lies", measure_voxels},
        {"A14", "Float against double precision", measure_twin},
        {"sag", "Presets, ten seconds still", measure_sag},
        {"solver", "Solvers and models: error against price", measure_solvers},
        {"iterations", "Sweeps of pbd", measure_iterations},
        {"substeps", "Substeps of the direct solver", measure_substeps},
        {"courant", "Substeps by tension", measure_courant},
        {"rate", "Steps a second", measure_rate},
        {"nodes", "Nodes of a strand", measure_nodes},
        {"ratio", "Share of turned copies among the drawn strands", measure_ratio},
        {"grid", "Resolution of the density grid", measure_grid},
        {"picture", "Pictures against one with everything simulated", measure_picture},
        {"look", "Levels of the look against traced light", measure_look},
    };
    return all;
}

std::string solver_name(const HairParams& params)
{
    const ParamInfo* kind = find_param("solver.kind");
    if (!kind)
        return "pbd";
    float index[kMostNumbers];
    get_numbers(params, *kind, index);
    return param_labels(*kind)[size_t(index[0])];
}

} // namespace coif

// Does a hairstyle look after ten seconds as it looked at first? The presets on a head that is still.
#include "app/measure/measure.h"
#include "sim/simulation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{

namespace
{
// How far guides' tips went, as a share of each guide's length below the scalp.
struct Sag
{
    double worst = 0.0, mean = 0.0;
};
} // namespace

static std::vector<glm::dvec3> tips(const Solver& solver)
{
    const Groom& groom = solver.groom();
    const Mapped view = solver.guide_positions();
    std::vector<glm::dvec3> all;
    for (int g = 0; g < groom.guides; ++g)
        all.push_back(vector_at(view.as<float>(), g, groom.nodes - 1, groom.nodes));
    return all;
}

static Sag sag_of(Simulation& simulation, double seconds)
{
    const Solver& solver = simulation.solver();
    const std::vector<glm::dvec3> before = tips(solver);
    const int steps = int(std::lround(seconds * double(simulation.params().solver_rate)));
    for (int i = 0; i < steps; ++i)
    {
        simulation.step(simulation.hand());
        if (i % 16 == 0)
            simulation.solver().take_times(); // lets the queue's uploads go
    }
    const std::vector<glm::dvec3> after = tips(solver);
    const Groom& groom = solver.groom();
    Sag sag;
    for (size_t g = 0; g < before.size(); ++g)
    {
        const double length =
            double(groom.segment_length[g]) * double(simulation.params().strand_spacing) * (groom.nodes - 2);
        const double moved = glm::distance(before[g], after[g]) / std::max(length, 1e-6);
        sag.worst = std::max(sag.worst, moved);
        sag.mean += moved / double(before.size());
    }
    return sag;
}

std::vector<Row> measure_sag(const Measuring& with)
{
    std::vector<Row> rows;
    int number = 0;
    for (const std::filesystem::path& file : preset_files())
    {
        if (with.quick && number++ % 7 != 0)
            continue;
        const Hairstyle style = load_hairstyle(file);
        with.progress(fmt::format("{}, still", style.name()));
        Simulation simulation(with.device, style);
        const Sag sag = sag_of(simulation, 10.0);
        const float4 wind = style.params.forces_wind;
        const bool blown = wind.x != 0.0f || wind.y != 0.0f || wind.z != 0.0f; // then it is to move
        for (const auto& [metric, value] : {std::pair("tips, worst", sag.worst), {"tips, mean", sag.mean}})
        {
            Row row;
            row.scene = "sag";
            row.setting = style.name() + (blown ? ", in its wind" : "");
            row.metric = metric;
            row.solver = solver_name(style.params);
            row.error = value;
            row.unit = "L";
            row.reference = "where it was ten seconds before";
            if (!blown)
                row.pass = 0.01;
            rows.push_back(row);
        }
    }
    return rows;
}

} // namespace coif

// What light in hair costs: two suns and a sky on 4096 strands of some 32 places, and what each level of the look makes
// of them. A level's row is all that its picture needs before anything is drawn: the volume, the sweeps, the colours.
#include "app/bench/hair.h"
#include "app/look_level.h"
#include "app/renderer.h"
#include "sim/source.h"

#include <fmt/format.h>

namespace coif
{

// What is wanted of a level: all of it, ms, and its colours, ns a place and light.
static double wanted_ms(int level) { return level == LOOK_DUAL_SCATTERING ? 15.0 : NAN; }
static double wanted_ns(int level)
{
    return level == LOOK_DUAL_SCATTERING ? 40.0 : level == LOOK_FAR_FIELD ? 15.0 : NAN;
}

std::vector<BenchRow> bench_look(const Benching& with)
{
    Options options;
    options.style = "bob";
    options.sets = {"interpolation.strands=4096", "look.lights=rim.toml"}; // two suns and a sky
    const Hairstyle style = load_style(options);
    Simulation simulation(with.device, style);
    simulation.solver().draw();
    const LitScene scene = lit_scene(simulation);
    const glm::vec3 eye(camera_of(style.params).position() - simulation.solver().head().origin);
    Shading shading(with.device);

    std::vector<std::function<PassTimes()>> runs;
    for (int level = LOOK_KARIS; level <= LOOK_DUAL_SCATTERING; ++level)
        runs.push_back(
            [&, level]
            {
                with.progress(level_name(level));
                return time_level(shading, scene, eye, level);
            });
    const std::vector<std::vector<BenchRow>> times = timed(runs, with.quick ? 5 : 15);
    const int strands = shading.volume().strands, places = shading.volume().places,
              suns = int(scene.lighting.suns.size());
    std::vector<BenchRow> rows;
    for (size_t i = 0; i < times.size(); ++i)
    {
        const int level = LOOK_KARIS + int(i);
        const double shadings = double(strands) * places * suns;
        for (BenchRow row : times[i])
        {
            const bool all = row.what == "frame", shade = row.what == "look_shade";
            if (level != LOOK_KARIS && !all && !shade)
                continue; // light is the same for all levels
            row.note = all || shade ? level_name(level) : "any level";
            if (all)
                row.most_ms = wanted_ms(level);
            if (shade)
            {
                row.note += fmt::format(", {} places, {} suns and sky: {:.0f} ns a place and sun", places, suns,
                                        row.ms * 1e6 / shadings);
                row.most_ms = wanted_ns(level) * shadings * 1e-6;
            }
            row.strands = strands;
            row.cores = with.machine.compute_units;
            rows.push_back(row);
        }
    }
    return rows;
}

} // namespace coif

#include "app/report_look.h"

#include "app/gl.h"
#include "app/json.h"
#include "sim/source.h"

#include <fmt/format.h>

#include <algorithm>

namespace coif
{

// Each level's picture against one that is traced, in the style's own light and camera.
static void hold_against_truth(LookReport& look, Simulation& simulation, int samples, const Progress& progress)
{
    const SmallPicture small;
    const Window window(16, 16, Window::HIDDEN);
    Renderer renderer(data_folder() / "shaders");
    Camera camera = camera_of(simulation.params());
    camera.target += simulation.jumped();
    HairParams shown = simulation.params();
    shown.look_level = LOOK_DUAL_SCATTERING; // all through one display transform
    progress.say("follows light through the strands");
    const Tracer tracer(truth_scene(simulation, camera));
    TruthLimits limits;
    limits.samples = samples;
    look.truth = look_truth(tracer, small, limits);
    for (LevelReport& level : look.levels)
        level.like = likeness(light_at_level(renderer, simulation, camera, level.level, small), look.truth.light,
                              look.truth.hair, shown);
}

LookReport report_look(Simulation& simulation, int samples, const Progress& progress)
{
    LookReport look;
    const LitScene scene = lit_scene(simulation);
    Shading shading(simulation.solver().device());
    const glm::vec3 eye(camera_of(simulation.params()).position() - simulation.solver().head().origin);
    shading.light(scene);
    const std::vector<LevelError> errors = level_errors(shading);
    look.chosen = chosen_level(simulation.params(), errors);
    look.levels.push_back({});
    for (const LevelError& error : errors)
        look.levels.push_back({error.level, cost_of_level(shading, scene, eye, error.level), error.left_out});
    if (samples > 0)
        hold_against_truth(look, simulation, samples, progress);
    return look;
}

std::string text_of(const LookReport& look)
{
    std::string text = fmt::format("  look         {}\n", level_name(look.chosen));
    text += fmt::format("    light               {:.2f} ms, whatever the level above kajiya_kay\n",
                        look.levels.back().cost.light_ms);
    for (const LevelReport& level : look.levels)
    {
        const std::string cost =
            std::isnan(level.cost.shade_ms) ? "drawn with the strands" : fmt::format("{:.2f} ms", level.cost.shade_ms);
        const std::string error =
            look.truth.samples > 0 ? likeness_text(level.like)
            : std::isnan(level.left_out)
                ? "not held against traced light"
                : fmt::format("leaves out about {:.0f} % of the light in the hair", 100.0 * level.left_out);
        text += fmt::format("    {:<19} {}, {}\n", level_name(level.level), cost, error);
    }
    if (look.truth.samples > 0)
        text += fmt::format("    against {} samples a pixel, traced in {:.1f} s: red, green, blue; root mean square\n",
                            look.truth.samples, look.truth.seconds);
    return text;
}

std::string json_of(const LookReport& look)
{
    std::vector<std::string> levels;
    for (const LevelReport& level : look.levels)
    {
        const Likeness& like = level.like;
        const bool traced = look.truth.samples > 0;
        const auto measured = [&](double value) { return json_number(traced ? value : NAN); };
        levels.push_back(fmt::format("{{\"level\": {}, \"ms_light\": {}, \"ms_shade\": {}, \"left_out\": {}, "
                                     "\"radiance\": [{}, {}, {}], \"off\": {}, \"locks\": {}}}",
                                     json_text(level_name(level.level)), json_number(level.cost.light_ms),
                                     json_number(level.cost.shade_ms), json_number(level.left_out),
                                     measured(like.radiance[0]), measured(like.radiance[1]), measured(like.radiance[2]),
                                     measured(like.roughly), measured(like.locks)));
    }
    return fmt::format("{{\"level\": {}, \"samples_traced\": {}, \"s_traced\": {}, \"levels\": [{}]}}",
                       json_text(level_name(look.chosen)), look.truth.samples, json_number(look.truth.seconds),
                       fmt::join(levels, ", "));
}

std::string row_of(const LookReport& look, bool untimed)
{
    const LevelReport& level = *std::ranges::find(look.levels, look.chosen, &LevelReport::level);
    const auto number = [](double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value); };
    const auto measured = [&](double value) { return number(look.truth.samples > 0 ? value : NAN); };
    return fmt::format("{},{},{},{},{},{}", level_name(look.chosen), untimed ? "" : number(level.cost.ms()),
                       measured(level.like.radiance[0]), measured(level.like.radiance[1]),
                       measured(level.like.radiance[2]), measured(level.like.roughly));
}

} // namespace coif

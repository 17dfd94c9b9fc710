#include "app/look_level.h"

#include "app/root_shares.h"
#include "sim/median.h"
#include "sim/tied_hair.h"
#include "sim/wave.h"

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>

namespace coif
{

LitScene lit_scene(const Simulation& simulation)
{
    const Assets& assets = simulation.assets();
    const HairParams& p = simulation.params();
    return lit_scene(simulation, wave_table(p), skin_places(assets, p, shares_of_roots(assets, p)));
}

LitScene lit_scene(const Simulation& simulation, std::vector<float> waves, const std::vector<SkinPlace>& skin)
{
    const HairParams& p = simulation.params();
    const Solver& solver = simulation.solver();
    LitScene scene;
    scene.solver = &solver;
    scene.params = device_params(p);
    scene.waves = std::move(waves);
    scene.braids = braid_values(solver.groom());
    scene.lighting = simulation.lighting();
    scene.skin = skin_now(skin, scene.params, solver.head().turn);
    scene.low = glm::vec3(INFINITY);
    scene.high = glm::vec3(-INFINITY);
    glm::vec3 low(INFINITY), high(-INFINITY); // of the head's mesh in its own frame
    for (const glm::vec3& at : simulation.assets().head.positions)
    {
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    const glm::vec3 offset(p.head_offset.x, p.head_offset.y, p.head_offset.z);
    for (int corner = 0; corner < 8 && !simulation.assets().head.positions.empty(); ++corner)
    {
        const glm::vec3 at(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z);
        const glm::vec3 placed(solver.head().turn * glm::dvec3((at * p.head_mesh_scale + offset) * p.head_scale));
        scene.low = glm::min(scene.low, placed);
        scene.high = glm::max(scene.high, placed);
    }
    return scene;
}

std::vector<LevelError> level_errors(Shading& shading)
{
    constexpr double kFit = 0.19; // Karis' fit has so much less than the far field: brown bob, coif measure --look
    const double handed = shading.handed_on_share();
    return {{LOOK_KARIS, std::min(handed + kFit, 1.0)}, {LOOK_FAR_FIELD, handed}, {LOOK_DUAL_SCATTERING, 0.0}};
}

int chosen_level(const HairParams& params, const std::vector<LevelError>& errors)
{
    if (params.look_level != LOOK_AUTO)
        return params.look_level;
    for (const LevelError& error : errors)
        if (error.left_out <= 0.01 * double(params.look_tolerance))
            return error.level;
    return LOOK_DUAL_SCATTERING;
}

PassTimes time_level(Shading& shading, const LitScene& scene, glm::vec3 eye, int level)
{
    shading.take_times();
    shading.light(scene);
    PassTimes times = shading.take_times();
    const double light = sum_of(times);
    shading.shade(eye, level, 1.0f);
    const double shade = sum_of(shading.take_times());
    times.insert(times.begin(), {{"frame", light + shade}, {"look_shade", shade}});
    return times;
}

LevelCost cost_of_level(Shading& shading, const LitScene& scene, glm::vec3 eye, int level)
{
    constexpr int kTimes = 5;
    if (level == LOOK_KAJIYA_KAY)
        return {};
    std::vector<double> light, shade;
    for (int i = 0; i <= kTimes; ++i)
    {
        const PassTimes times = time_level(shading, scene, eye, level);
        if (i == 0)
            continue; // it compiles
        shade.push_back(times[1].second);
        light.push_back(times[0].second - times[1].second);
    }
    return {median(light), median(shade)};
}

const char* level_name(int level)
{
    const char* const names[] = {"auto", "kajiya_kay", "karis", "far_field", "dual_scattering"};
    return names[level];
}

} // namespace coif

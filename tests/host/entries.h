// Entries for the lists of a style, as tests that walk over all parameters want them.
#pragma once
#include "sim/hairstyle.h"

#include <random>

namespace coif::test
{

inline void add_entry(std::vector<Collider>& list, std::mt19937& random)
{
    list.push_back({{float(random() % 200) - 100.0f, 0.01f * float(random() % 100), -1e-6f * float(random() % 9)},
                    0.002f + 0.1f * float(random() % 900),
                    random() % 2 == 0});
    if (random() % 2)
        list.back().to = glm::vec3(0.1f, -0.25f, float(random() % 7));
}

inline void add_entry(std::vector<Region>& list, std::mt19937& random)
{
    Region region;
    region.name = "part \"" + std::to_string(list.size()) + "\" of " + std::to_string(random() % 100);
    for (unsigned long i = random() % 3; i > 0; --i)
        region.where.push_back(region_areas()[random() % region_areas().size()]);
    for (unsigned long i = random() % 3; i > 0; --i)
        region.planes.emplace_back(1.0f, 0.5f * float(random() % 5), -0.25f, 0.01f * float(random() % 9));
    for (unsigned long i = random() % 4; i > 0; --i)
        region.weights.push_back(float(random() % 101) / 100.0f);
    region.group = random() % 2 ? "fringe" : "";
    region.invert = random() % 2;
    region.edge = 0.005f * float(random() % 5);
    for (const ParamInfo& info : param_table())
        if (info.scope == Scope::STRAND && !info.on_host() && random() % 4 == 0)
        {
            region.settings.push_back({&info, glm::vec4(0.0f)});
            for (int i = 0; i < info.components(); ++i)
                region.settings.back().value[i] = random() % 2 ? info.min : info.max;
        }
    list.push_back(region);
}

inline void add_entry(std::vector<Parting>& list, std::mt19937& random)
{
    Parting parting;
    for (unsigned long i = 2 + random() % 3; i > 0; --i)
        parting.points.emplace_back(0.01f * float(i), 0.1f, -0.001f * float(random() % 100));
    parting.reach = 0.01f + 0.01f * float(random() % 9);
    list.push_back(parting);
}

inline void add_entry(std::vector<ScalpMap>& list, std::mt19937& random)
{
    const bool color = random() % 2;
    ScalpMap map{color ? "look.tip_color" : "strand.length", color ? MAP_OVER : int(random() % 2), {}, {}};
    for (unsigned long i = 4 * (1 + random() % 3); i > 0; --i)
        map.values.push_back(float(random() % 1001) / 1000.0f);
    list.push_back(map);
}

inline void add_entry(std::vector<Tie>& list, std::mt19937& random)
{
    Tie tie;
    tie.name = random() % 2 ? "tail" : "";
    tie.at = {0.01f * float(random() % 9), 0.125f, -0.1f};
    tie.axis = {0.0f, -0.5f, 1.0f + float(random() % 3)};
    tie.radius = 0.01f + 0.001f * float(random() % 9);
    tie.color = {0.25f, float(random() % 256) / 255.0f, 1.0f};
    tie.braid = random() % 2;
    list.push_back(tie);
}

inline void add_entry(std::vector<Light>& list, std::mt19937& random)
{
    Light light;
    light.name = random() % 2 ? "key" : "";
    light.direction = {0.01f * float(random() % 201) - 1.0f, 0.25f, -0.001f * float(random() % 1000)};
    light.color = {1.0f, float(random() % 256) / 255.0f, 0.125f * float(random() % 9)};
    light.irradiance = 0.1f * float(random() % 60);
    light.angle = 0.5f * float(random() % 100);
    list.push_back(light);
}

inline void add_entry(Hairstyle& style, const ParamInfo& info, std::mt19937& random)
{
    with_list(style.host, info, [&](auto& list) { add_entry(list, random); });
}

} // namespace coif::test

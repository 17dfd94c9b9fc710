#include "sim/lights.h"

#include <glm/geometric.hpp>

#include <numbers>

namespace coif
{

static glm::vec3 linear(glm::vec3 srgb)
{
    return {linear_of_srgb(srgb.x), linear_of_srgb(srgb.y), linear_of_srgb(srgb.z)};
}

Lighting lighting_of(const HairParams& authored, const HostParams& host)
{
    const auto rgb = [](const float4& c) { return glm::vec3(c.x, c.y, c.z); };
    const HairParams device = device_params(authored);
    Lighting lighting;
    lighting.sky = device.look_sky_radiance * rgb(device.look_sky_color);
    if (host.lights.empty())
        lighting.suns.push_back(
            {rgb(device.look_light_direction), device.look_light_irradiance * rgb(device.look_light_color), 0.0f});
    for (const Light& light : host.lights)
    {
        const float length = glm::length(light.direction);
        lighting.suns.push_back({length > 1e-6f ? light.direction / length : glm::vec3(0.0f, 1.0f, 0.0f),
                                 light.irradiance * linear(light.color),
                                 light.angle * std::numbers::pi_v<float> / 180.0f});
    }
    return lighting;
}

} // namespace coif

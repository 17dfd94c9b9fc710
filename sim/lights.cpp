#include "sim/lights.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static glm::vec3 linear(glm::vec3 srgb)
{
    return {linear_of_srgb(srgb.x), linear_of_srgb(srgb.y), linear_of_srgb(srgb.z)};
}

static float srgb(float linear) // IEC 61966-2-1
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

static float most(glm::vec3 color) { return std::max({color.x, color.y, color.z}); }

// Of a light on what faces it, by Rec. 709.
static float luminance(const Light& light)
{
    return light.irradiance * glm::dot(linear(light.color), glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

Hairstyle lit(Hairstyle style, const std::optional<LightRig>& shared)
{
    if (shared)
        set_own_lights(style, *shared);
    const auto key = std::ranges::max_element(style.host.lights, {}, luminance); // the first of equals
    if (key == style.host.lights.end())
        return style;
    HairParams& p = style.params;
    const glm::vec3 direction = key->direction, color = linear(key->color);
    glm::vec3 bright = key->color;
    if (most(key->color) > 0.0f && most(key->color) < 1.0f)
        for (int i = 0; i < 3; ++i)
            bright[i] = std::min(srgb(color[i] / most(color)), 1.0f);
    p.look_light_direction = F4(direction.x, direction.y, direction.z, 0.0f);
    p.look_light_color = key->irradiance > 0.0f ? F4(bright.x, bright.y, bright.z, 1.0f) : F4(0.0f, 0.0f, 0.0f, 1.0f);
    p.look_light_irradiance = key->irradiance * most(color);
    return style;
}

Lighting lighting_of(const HairParams& authored, const HostParams& host)
{
    const auto rgb = [](const float4& c) { return glm::vec3(c.x, c.y, c.z); };
    const HairParams device = device_params(authored);
    Lighting lighting;
    lighting.sky = device.look_sky_radiance * rgb(device.look_sky_color);
    const auto add = [&](glm::vec3 direction, glm::vec3 irradiance, float radius)
    {
        if (most(irradiance) > 0.0f)
            lighting.suns.push_back({direction, irradiance, radius});
    };
    if (host.lights.empty())
        add(rgb(device.look_light_direction), device.look_light_irradiance * rgb(device.look_light_color), 0.0f);
    for (const Light& light : host.lights)
        add(points_somewhere(light.direction) ? glm::normalize(light.direction) : glm::vec3(0.0f, 1.0f, 0.0f),
            light.irradiance * linear(light.color), light.angle * std::numbers::pi_v<float> / 180.0f);
    return lighting;
}

} // namespace coif

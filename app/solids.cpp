#include "app/solids.h"

#include "sim/tied_hair.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr int kAround = 96, kAcross = 16; // corners of a band

std::vector<float> shares_of_roots(const Assets& assets, const HairParams& p)
{
    const glm::vec3 offset(p.head_offset.x, p.head_offset.y, p.head_offset.z);
    const Scalp& scalp = assets.scalp;
    const float near = 0.02f * scalp.extent, far = 0.07f * scalp.extent;
    std::vector<glm::vec4> balls; // about each triangle, to skip those out of reach
    for (const glm::uvec3& t : scalp.triangles)
    {
        const glm::vec3 middle = (scalp.positions[t.x] + scalp.positions[t.y] + scalp.positions[t.z]) / 3.0f;
        float radius = 0.0f;
        for (int k = 0; k < 3; ++k)
            radius = std::max(radius, glm::distance(middle, scalp.positions[t[k]]));
        balls.emplace_back(middle, radius);
    }
    std::vector<float> shares;
    shares.reserve(assets.head.positions.size());
    for (const glm::vec3& position : assets.head.positions)
    {
        const glm::vec3 at = position * p.head_mesh_scale + offset;
        float nearest = far;
        for (size_t t = 0; t < balls.size(); ++t)
        {
            if (glm::distance(at, glm::vec3(balls[t])) - balls[t].w > nearest)
                continue;
            const glm::uvec3 corner = scalp.triangles[t];
            nearest = std::min(nearest, triangle_distance(at, scalp.positions[corner.x], scalp.positions[corner.y],
                                                          scalp.positions[corner.z]));
        }
        shares.push_back(1.0f - glm::smoothstep(near, far, nearest));
    }
    return shares;
}

namespace
{
struct Ring // m
{
    glm::vec3 center, axis;
    float radius, thickness;
};
} // namespace

// Pleated like cloth over a rubber band, wider than it is thick.
static Band band_of(const Ring& ring, const Tie& tie, bool on_head)
{
    const glm::vec3 t = glm::normalize(ring.axis);
    const glm::vec3 side =
        glm::normalize(std::abs(t.x) > 0.6f ? glm::vec3(-t.z, 0.0f, t.x) : glm::vec3(0.0f, t.z, -t.y));
    const glm::vec3 up = glm::cross(t, side);
    const float turn = 2.0f * std::numbers::pi_v<float>;
    const auto at = [&](float u, float v) // shares of a turn around the band, and across it
    {
        const float pleat = 1.0f + 0.16f * std::sin(turn * 13.0f * u + 2.0f * std::sin(turn * v)) +
                            0.06f * std::sin(turn * 5.0f * u + 1.0f);
        const glm::vec3 out = side * std::cos(turn * u) + up * std::sin(turn * u);
        return ring.center + out * (ring.radius + ring.thickness * pleat * std::cos(turn * v)) +
               t * (1.5f * ring.thickness * pleat * std::sin(turn * v));
    };
    Band band;
    band.albedo = {linear_of_srgb(tie.color.x), linear_of_srgb(tie.color.y), linear_of_srgb(tie.color.z)};
    band.on_head = on_head;
    for (int i = 0; i <= kAround; ++i)
        for (int j = 0; j <= kAcross; ++j)
        {
            const float u = float(i) / kAround, v = float(j) / kAcross, little = 1e-3f;
            band.position.push_back(at(u, v));
            band.normal.push_back(glm::normalize(
                glm::cross(at(u, v + little) - at(u, v - little), at(u + little, v) - at(u - little, v))));
        }
    return band;
}

// About the guide that a braid follows, where it is bound; in the world's axes about the head's origin.
static Ring end_of(const FrameInput& frame, const Tail& braid, float thickness)
{
    const Groom& groom = frame.simulation->solver().groom();
    const float at = braid.ring + (float(groom.nodes - 1) - braid.ring) *
                                      std::min(1.0f, braid.bound / std::max(braid.length, 1e-6f));
    const int node = std::clamp(int(at), 1, groom.nodes - 2);
    const auto of = [&](int k)
    { return glm::vec3(vector_at(frame.guide_positions.as<float>(), braid.guide, k, groom.nodes)); };
    const glm::vec3 a = of(node), b = of(node + 1);
    return {glm::mix(a, b, at - float(node)), b - a + glm::vec3(0.0f, 1e-9f, 0.0f), 0.75f * braid.plait, thickness};
}

std::vector<Band> bands_of(const FrameInput& frame)
{
    const Groom& groom = frame.simulation->solver().groom();
    const std::vector<Tie>& ties = frame.simulation->style().host.ties;
    std::vector<Band> bands;
    for (size_t i = 0; i < ties.size(); ++i)
    {
        const Tie& tie = ties[i];
        bands.push_back(band_of({tie.at * frame.params.head_scale, tie.axis, tie.radius, tie.thickness}, tie, true));
        if (tie.braid && groom.tails[i].length > 0.0f)
            bands.push_back(band_of(end_of(frame, groom.tails[i], 0.6f * tie.thickness), tie, false));
    }
    return bands;
}

std::vector<glm::uvec3> band_triangles()
{
    std::vector<glm::uvec3> triangles;
    for (unsigned i = 0; i < kAround; ++i)
        for (unsigned j = 0; j < kAcross; ++j)
        {
            const unsigned a = i * (kAcross + 1) + j, b = a + kAcross + 1;
            triangles.emplace_back(a, a + 1, b);
            triangles.emplace_back(b, a + 1, b + 1);
        }
    return triangles;
}

} // namespace coif

// The rings that gather hair, and the bands at the ends of braids.
#include "app/renderer_rings.h"

#include "app/renderer.h"

#include "sim/tied_hair.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr int kAround = 96, kAcross = 16; // corners of a ring

// Corners of a band, as attributes lie in Renderer: pleated like cloth over a rubber band, wider than it is thick.
std::vector<float> corners_of(const Band& band)
{
    const glm::vec3 t = glm::normalize(band.axis);
    const glm::vec3 side =
        glm::normalize(std::abs(t.x) > 0.6f ? glm::vec3(-t.z, 0.0f, t.x) : glm::vec3(0.0f, t.z, -t.y));
    const glm::vec3 up = glm::cross(t, side);
    const float turn = 2.0f * std::numbers::pi_v<float>;
    const auto at = [&](float u, float v) // shares of a turn around the band, and across it
    {
        const float pleat = 1.0f + 0.16f * std::sin(turn * 13.0f * u + 2.0f * std::sin(turn * v)) +
                            0.06f * std::sin(turn * 5.0f * u + 1.0f);
        const glm::vec3 out = side * std::cos(turn * u) + up * std::sin(turn * u);
        return band.center + out * (band.radius + band.thickness * pleat * std::cos(turn * v)) +
               t * (1.5f * band.thickness * pleat * std::sin(turn * v));
    };
    std::vector<float> corners;
    for (int i = 0; i <= kAround; ++i)
        for (int j = 0; j <= kAcross; ++j)
        {
            const float u = float(i) / kAround, v = float(j) / kAcross, little = 1e-3f;
            const glm::vec3 p = at(u, v);
            const glm::vec3 n = glm::normalize(
                glm::cross(at(u + little, v) - at(u - little, v), at(u, v + little) - at(u, v - little)));
            corners.insert(corners.end(), {p.x, p.y, p.z, n.x, n.y, n.z, 0.0f});
        }
    return corners;
}

std::vector<glm::uvec3> band_triangles()
{
    std::vector<glm::uvec3> triangles;
    for (unsigned i = 0; i < kAround; ++i)
        for (unsigned j = 0; j < kAcross; ++j)
        {
            const unsigned a = i * (kAcross + 1) + j, b = a + kAcross + 1;
            triangles.emplace_back(a, b, a + 1);
            triangles.emplace_back(b, b + 1, a + 1);
        }
    return triangles;
}

// About the guide that a braid follows, where it is bound; in the world's axes about the head's origin.
static Band end_of(const FrameInput& frame, const Tail& braid, float thickness)
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

std::vector<Ring> rings_of(const FrameInput& frame)
{
    const Groom& groom = frame.simulation->solver().groom();
    const std::vector<Tie>& ties = frame.simulation->style().host.ties;
    std::vector<Ring> rings;
    for (size_t i = 0; i < ties.size(); ++i)
    {
        const Tie& tie = ties[i];
        const glm::vec3 color(linear_of_srgb(tie.color.x), linear_of_srgb(tie.color.y), linear_of_srgb(tie.color.z));
        rings.push_back({{tie.at * frame.params.head_scale, tie.axis, tie.radius, tie.thickness}, color, true});
        if (tie.braid && groom.tails[i].length > 0.0f)
            rings.push_back({end_of(frame, groom.tails[i], 0.6f * tie.thickness), color, false});
    }
    return rings;
}

void Renderer::draw_rings(const FrameInput& frame, const ShaderProgram& program)
{
    glUniform4f(program.uniform("place"), 0.0f, 0.0f, 0.0f, 1.0f);
    glUniform3f(program.uniform("stretch"), 0.0f, 0.0f, 0.0f);
    glBindVertexArray(ring_array_);
    for (const Ring& ring : rings_of(frame))
    {
        const std::vector<float> corners = corners_of(ring.band);
        glUniform4f(program.uniform("albedo"), ring.color.x, ring.color.y, ring.color.z, 0.0f);
        glUniform1i(program.uniform("on_head"), ring.on_head);
        next_colors(corners.size() / 7);
        glBindBuffer(GL_ARRAY_BUFFER, ring_buffer_);
        glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(corners.size() * sizeof(float)), corners.data(), GL_STREAM_DRAW);
        glDrawElements(GL_TRIANGLES, ring_index_count_, GL_UNSIGNED_INT, nullptr);
    }
}

void Renderer::upload_braids(const FrameInput& frame)
{
    std::vector<float4> values = braid_values(frame.simulation->solver().groom());
    braided_ = GLint(values.size() / 3);
    values.resize(std::max<size_t>(values.size(), 1));
    glBindBuffer(GL_TEXTURE_BUFFER, braid_buffer_);
    glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(values.size() * sizeof(float4)), values.data(), GL_STREAM_DRAW);
}

void Renderer::make_rings()
{
    const std::vector<glm::uvec3> faces = band_triangles();
    glBindVertexArray(ring_array_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, ring_indices_);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(faces.size() * sizeof(glm::uvec3)), faces.data(), GL_STATIC_DRAW);
    ring_index_count_ = GLsizei(3 * faces.size());
    glGenTextures(1, &braid_texture_);
    glBindTexture(GL_TEXTURE_BUFFER, braid_texture_);
    glBindBuffer(GL_TEXTURE_BUFFER, braid_buffer_);
    glBufferData(GL_TEXTURE_BUFFER, sizeof(float4), nullptr, GL_STREAM_DRAW);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, braid_buffer_);
}

} // namespace coif

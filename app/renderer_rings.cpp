// The rings that gather hair, and the bands at the ends of braids.
#include "app/renderer.h"

#include "app/solids.h"
#include "sim/tied_hair.h"

#include <algorithm>

namespace coif
{

void Renderer::draw_rings(const FrameInput& frame, const ShaderProgram& program)
{
    glUniform4f(program.uniform("place"), 0.0f, 0.0f, 0.0f, 1.0f);
    glUniform3f(program.uniform("stretch"), 0.0f, 0.0f, 0.0f);
    glBindVertexArray(ring_array_);
    std::vector<float> corners; // as attributes lie in Renderer
    for (const Band& band : bands_of(frame))
    {
        corners.clear();
        for (size_t i = 0; i < band.position.size(); ++i)
        {
            const glm::vec3 p = band.position[i], n = band.normal[i];
            corners.insert(corners.end(), {p.x, p.y, p.z, n.x, n.y, n.z, 0.0f});
        }
        glUniform4f(program.uniform("albedo"), band.albedo.x, band.albedo.y, band.albedo.z, 0.0f);
        glUniform1i(program.uniform("on_head"), band.on_head);
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

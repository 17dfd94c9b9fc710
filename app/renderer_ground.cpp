// The plain ground under the head. It lies still in the world, though a leap of the head takes it along as it does the
// camera.
#include "app/renderer.h"

#include <utility>

namespace coif
{

static constexpr int kSquares = 128; // a side; light is found at corners, so they are smaller where shadows fall

void Renderer::upload_ground(const FrameInput& frame)
{
    const std::optional<Ground> before = std::exchange(ground_, ground_of(frame));
    if (!ground_)
        return;
    const float height = ground_->height, radius = ground_->radius;
    if (before && before->height == height && before->radius == radius)
        return;
    const auto across = [radius](int i)
    {
        const float u = 2.0f * float(i) / kSquares - 1.0f;
        return radius * (0.25f * u + 0.75f * u * u * u);
    };
    std::vector<unsigned> faces;
    ground_corners_.clear();
    for (int i = 0; i <= kSquares; ++i)
        for (int j = 0; j <= kSquares; ++j)
        {
            ground_corners_.insert(ground_corners_.end(), {across(i), height, across(j)});
            const unsigned a = unsigned(i * (kSquares + 1) + j), b = a + kSquares + 1;
            if (i < kSquares && j < kSquares)
                faces.insert(faces.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    ground_index_count_ = GLsizei(faces.size());
    glBindVertexArray(ground_array_);
    glBindBuffer(GL_ARRAY_BUFFER, ground_buffer_);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(ground_corners_.size() * sizeof(float)), ground_corners_.data(),
                 GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, ground_indices_);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(faces.size() * sizeof(unsigned)), faces.data(), GL_STATIC_DRAW);
}

// Before all else, for it fades into the backdrop towards its rim. From below there is nothing: it would hide the head.
void Renderer::draw_ground(const ShaderProgram& program, glm::vec3 eye)
{
    if (!ground_)
        return;
    const glm::vec3 moved = ground_->moved, albedo = ground_->albedo;
    glBindVertexArray(ground_array_);
    next_colors(ground_corners_.size() / 3);
    if (eye.y <= ground_->height + moved.y)
        return;
    glUseProgram(program.id());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, depth_texture_);
    glUniform1i(program.uniform("optical_depth"), 0);
    glUniform3f(program.uniform("albedo"), albedo.x, albedo.y, albedo.z);
    glUniform3f(program.uniform("moved"), moved.x, moved.y, moved.z);
    glUniform1f(program.uniform("rim"), ground_->radius);
    glUniform1i(program.uniform("worked_out"), shaded_);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDrawElements(GL_TRIANGLES, ground_index_count_, GL_UNSIGNED_INT, nullptr);
    glDisable(GL_BLEND);
}

} // namespace coif

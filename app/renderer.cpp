#include "app/renderer.h"

#include "app/display.h"
#include "app/lens.h"
#include "app/rasteriser.h"
#include "app/shading.h"
#include "app/solids.h"
#include "sim/error.h"

#include <SDL.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

// Mirrors shaders/frame.glsl.
struct FrameBlock
{
    glm::mat4 view_projection;
    float4 camera_position, head_row0, head_row1, head_row2, grid_corner, sweep;
    int slices[4];
};

struct Renderer::Programs
{
    ShaderProgram strand, surface, ground, guide, background, add;
    ShaderProgram show[3]; // neutral, agx, none: for display.choice from 1 on
    explicit Programs(const std::filesystem::path& folder)
        : strand(folder, "strand"), surface(folder, "surface"), ground(folder, "ground"), guide(folder, "guide"),
          background(folder, "background", "screen"),
          add(folder, "add", "screen"), show{{folder, "show_neutral", "screen"},
                                             {folder, "show_agx", "screen"},
                                             {folder, "show_none", "screen"}}
    {
    }
};

glm::dvec3 Camera::position() const
{
    return target +
           distance * glm::dvec3(std::cos(pitch) * std::sin(yaw), std::sin(pitch), std::cos(pitch) * std::cos(yaw));
}

View view_of(const Camera& camera, int height)
{
    const glm::dvec3 eye = camera.position();
    return {eye, (camera.target - eye) / camera.distance, 0.5 * height / std::tan(0.5 * camera.fov)};
}

Camera camera_of(const HairParams& authored)
{
    const HairParams p = device_params(authored); // radians
    Camera camera;
    camera.target = {p.camera_target.x, p.camera_target.y, p.camera_target.z};
    camera.yaw = p.camera_yaw;
    camera.pitch = p.camera_pitch;
    camera.fov = p.camera_fov;
    camera.distance = p.camera_distance;
    return camera;
}

void keep_camera(const Camera& camera, HairParams& params)
{
    const double degrees = 180.0 / std::numbers::pi;
    const auto rounded = [](double value, double unit) { return float(std::round(value / unit) * unit); };
    params.camera_yaw = rounded(std::remainder(camera.yaw * degrees, 360.0), 0.1);
    params.camera_pitch = rounded(camera.pitch * degrees, 0.1);
    params.camera_fov = rounded(camera.fov * degrees, 0.1);
    params.camera_distance = rounded(camera.distance, 1e-3);
    params.camera_target =
        F4(rounded(camera.target.x, 1e-3), rounded(camera.target.y, 1e-3), rounded(camera.target.z, 1e-3), 0.0f);
}

int FrameInput::light_resolution() const
{
    return int(std::lround(std::cbrt(double(optical_depth.bytes()) / sizeof(float))));
}

FrameInput frame_input(const Simulation& simulation, const Camera& camera)
{
    FrameInput frame;
    frame.simulation = &simulation;
    const Solver& solver = simulation.solver();
    frame.drawn_positions = solver.drawn_positions();
    frame.guide_positions = solver.guide_positions();
    frame.optical_depth = solver.optical_depth();
    frame.params = simulation.params();
    frame.lighting = simulation.lighting();
    frame.camera = camera;
    frame.colors = strand_colors(simulation, frame.drawn_positions, frame.guide_positions);
    return frame;
}

static GLuint make_buffer()
{
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    return buffer;
}

static GLuint make_array()
{
    GLuint array = 0;
    glGenVertexArrays(1, &array);
    return array;
}

static void attribute(GLuint index, GLint size, GLsizei stride, size_t offset)
{
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, stride, reinterpret_cast<const void*>(offset));
}

Renderer::Renderer(const std::filesystem::path& shader_folder)
    : shader_folder_(shader_folder), programs_(std::make_unique<Programs>(shader_folder))
{
    for (GLuint* buffer : {&frame_block_, &params_block_, &color_buffer_, &index_buffer_, &mesh_buffer_, &mesh_indices_,
                           &sphere_buffer_, &sphere_indices_, &guide_buffer_, &ring_buffer_, &ring_indices_,
                           &braid_buffer_, &ground_buffer_, &ground_indices_, &solid_colors_})
        *buffer = make_buffer();
    for (GLuint* array :
         {&strand_array_, &mesh_array_, &sphere_array_, &ring_array_, &ground_array_, &guide_array_, &empty_array_})
        *array = make_array();

    const std::pair<GLuint, size_t> blocks[] = {{frame_block_, sizeof(FrameBlock)},
                                                {params_block_, sizeof(HairParams)}};
    for (GLuint i = 0; i < 2; ++i)
    {
        glBindBuffer(GL_UNIFORM_BUFFER, blocks[i].first);
        glBufferData(GL_UNIFORM_BUFFER, GLsizeiptr(blocks[i].second), nullptr, GL_DYNAMIC_DRAW);
    }

    glBindVertexArray(strand_array_);
    glBindBuffer(GL_ARRAY_BUFFER, positions_.id());
    attribute(0, 4, 0, 0);
    glBindBuffer(GL_ARRAY_BUFFER, frames_.id());
    attribute(1, 4, 0, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);

    glBindVertexArray(mesh_array_);
    glBindBuffer(GL_ARRAY_BUFFER, mesh_buffer_);
    attribute(0, 3, 7 * sizeof(float), 0);
    attribute(1, 3, 7 * sizeof(float), 3 * sizeof(float));
    attribute(2, 1, 7 * sizeof(float), 6 * sizeof(float));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh_indices_);

    glBindVertexArray(guide_array_);
    glBindBuffer(GL_ARRAY_BUFFER, guide_buffer_);
    attribute(0, 3, 4 * sizeof(float), 0);
    attribute(3, 1, 4 * sizeof(float), 3 * sizeof(float));

    // A sphere for obstacles: rings of latitude.
    std::vector<float> sphere;
    std::vector<unsigned> faces;
    const unsigned rings = 24, sides = 36;
    for (unsigned i = 0; i <= rings; ++i)
        for (unsigned j = 0; j <= sides; ++j)
        {
            const float theta = std::numbers::pi_v<float> * float(i) / rings;
            const float phi = 2.0f * std::numbers::pi_v<float> * float(j) / sides;
            const float p[3] = {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
            sphere.insert(sphere.end(), {p[0], p[1], p[2], p[0], p[1], p[2], 0.0f});
            const unsigned a = i * (sides + 1) + j, b = a + sides + 1;
            if (i < rings && j < sides)
                faces.insert(faces.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    glBindVertexArray(sphere_array_);
    glBindBuffer(GL_ARRAY_BUFFER, sphere_buffer_);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(sphere.size() * sizeof(float)), sphere.data(), GL_STATIC_DRAW);
    attribute(0, 3, 7 * sizeof(float), 0);
    attribute(1, 3, 7 * sizeof(float), 3 * sizeof(float));
    attribute(2, 1, 7 * sizeof(float), 6 * sizeof(float));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, sphere_indices_);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(faces.size() * sizeof(unsigned)), faces.data(), GL_STATIC_DRAW);
    sphere_index_count_ = GLsizei(faces.size());
    sphere_vertices_ = sphere;

    glBindVertexArray(ring_array_);
    glBindBuffer(GL_ARRAY_BUFFER, ring_buffer_);
    attribute(0, 3, 7 * sizeof(float), 0);
    attribute(1, 3, 7 * sizeof(float), 3 * sizeof(float));
    attribute(2, 1, 7 * sizeof(float), 6 * sizeof(float));
    make_rings();

    glBindVertexArray(ground_array_);
    glBindBuffer(GL_ARRAY_BUFFER, ground_buffer_);
    attribute(0, 3, 0, 0);

    glGenTextures(1, &depth_texture_);
    glBindTexture(GL_TEXTURE_3D, depth_texture_);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_T, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    glGenTextures(1, &looks_texture_);
    glBindTexture(GL_TEXTURE_2D, looks_texture_);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    glGenTextures(1, &wave_texture_);
    glBindTexture(GL_TEXTURE_1D, wave_texture_);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_WRAP_S, GL_REPEAT);

    std::vector<glm::vec3> ramp;
    for (int i = 0; i < RAMP; ++i)
        ramp.push_back(ramp_color((float(i) + 0.5f) / float(RAMP)));
    glGenTextures(1, &ramp_texture_);
    glBindTexture(GL_TEXTURE_1D, ramp_texture_);
    glTexImage1D(GL_TEXTURE_1D, 0, GL_RGB16F, GLsizei(ramp.size()), 0, GL_RGB, GL_FLOAT, ramp.data());
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);

    glGenTextures(1, &rastered_texture_);
    for (GLuint* texture : {&shades_texture_, &across_texture_})
    {
        glGenTextures(1, texture);
        glBindTexture(GL_TEXTURE_2D, *texture);
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    }

    const int nobody = 0;
    glGenBuffers(1, &leader_buffer_);
    glBindBuffer(GL_TEXTURE_BUFFER, leader_buffer_);
    glBufferData(GL_TEXTURE_BUFFER, sizeof nobody, &nobody, GL_STATIC_DRAW);
    glGenTextures(1, &leader_texture_);
    glBindTexture(GL_TEXTURE_BUFFER, leader_texture_);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_R32I, leader_buffer_);
}

Renderer::~Renderer()
{
    for (Target* target : {&scene_, &single_, &sum_})
    {
        glDeleteFramebuffers(1, &target->framebuffer);
        glDeleteRenderbuffers(1, &target->color);
        glDeleteRenderbuffers(1, &target->depth);
        glDeleteTextures(1, &target->texture);
    }
    for (GLuint buffer : {frame_block_, params_block_, color_buffer_, index_buffer_, mesh_buffer_, mesh_indices_,
                          sphere_buffer_, sphere_indices_, guide_buffer_, leader_buffer_, ring_buffer_, ring_indices_,
                          braid_buffer_, ground_buffer_, ground_indices_, solid_colors_})
        glDeleteBuffers(1, &buffer);
    for (GLuint array :
         {strand_array_, mesh_array_, sphere_array_, ring_array_, ground_array_, guide_array_, empty_array_})
        glDeleteVertexArrays(1, &array);
    for (GLuint texture : {depth_texture_, wave_texture_, looks_texture_, ramp_texture_, leader_texture_,
                           braid_texture_, rastered_texture_, shades_texture_, across_texture_})
        glDeleteTextures(1, &texture);
}

void Renderer::reload_shaders()
{
    programs_ = std::make_unique<Programs>(shader_folder_);
    rasteriser_.reset(); // its kernels are compiled anew when they are next asked for
    shading_.reset();
    lit_by_.clear();
}

Method Renderer::method_of(const HairParams& params)
{
    if (params.render_method != BY_ITSELF)
        return Method(params.render_method);
    return is_software_renderer() ? BY_OPENCL : BY_GEOMETRY;
}

std::string Renderer::name() const { return reinterpret_cast<const char*>(glGetString(GL_RENDERER)); }

// A texture of one sample a pixel, or a renderbuffer of several.
void Renderer::prepare(Target& target, int width, int height, int samples, GLenum format, GLenum depth_format)
{
    if (target.width == width && target.height == height && target.samples == samples &&
        target.depth_format == depth_format)
        return;
    glDeleteFramebuffers(1, &target.framebuffer);
    glDeleteRenderbuffers(1, &target.color);
    glDeleteRenderbuffers(1, &target.depth);
    glDeleteTextures(1, &target.texture);
    target = {};
    glGenFramebuffers(1, &target.framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    if (samples > 0)
    {
        glGenRenderbuffers(1, &target.color);
        glBindRenderbuffer(GL_RENDERBUFFER, target.color);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.color);
    }
    else
    {
        glGenTextures(1, &target.texture);
        glBindTexture(GL_TEXTURE_2D, target.texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GLint(format), width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture, 0);
    }
    if (depth_format)
    {
        glGenRenderbuffers(1, &target.depth);
        glBindRenderbuffer(GL_RENDERBUFFER, target.depth);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, depth_format, width, height);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth);
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw fail("the driver cannot draw a picture of {} x {} pixels", width, height);
    target.width = width;
    target.height = height;
    target.samples = samples;
    target.depth_format = depth_format;
}

void Renderer::draw_solids(const FrameInput& frame, glm::vec3 eye)
{
    const ShaderProgram& program = programs_->surface;
    const HairParams params = device_params(frame.params);
    glUseProgram(program.id());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_3D, depth_texture_);
    glUniform1i(program.uniform("optical_depth"), 0);
    glUniform1i(program.uniform("worked_out"), shaded_);

    const float4 skin = params.head_color;
    glUniform4f(program.uniform("albedo"), skin.x, skin.y, skin.z, params.head_scalp_tint);
    glUniform4f(program.uniform("place"), 0.0f, 0.0f, 0.0f, params.head_scale);
    glUniform1i(program.uniform("on_head"), 1);
    glUniform3f(program.uniform("stretch"), 0.0f, 0.0f, 0.0f);
    glBindVertexArray(mesh_array_);
    next_colors(mesh_vertices_.size() / 7);
    // From outside, what looks away is hidden by what does not.
    if (mesh_facing_ != 0 && glm::length(eye) > mesh_radius_ * params.head_scale)
        glEnable(GL_CULL_FACE);
    glCullFace(mesh_facing_ > 0 ? GL_BACK : GL_FRONT);
    glDrawElements(GL_TRIANGLES, mesh_index_count_, GL_UNSIGNED_INT, nullptr);
    glDisable(GL_CULL_FACE);

    glUniform4f(program.uniform("albedo"), kObstacleAlbedo.x, kObstacleAlbedo.y, kObstacleAlbedo.z, 0.0f);
    glUniform1i(program.uniform("on_head"), 0);
    glBindVertexArray(sphere_array_);
    // The head's own colliders come first and stand for its mesh; the style's obstacles after them are shown.
    const std::vector<Capsule> placed = frame.simulation->solver().placed_colliders();
    for (size_t i = placed.size() - frame.simulation->style().host.colliders.size(); i < placed.size(); ++i)
    {
        const float4 c = placed[i].center, axis = placed[i].axis;
        glUniform4f(program.uniform("place"), c.x, c.y, c.z, c.w);
        glUniform3f(program.uniform("stretch"), axis.x, axis.y, axis.z);
        next_colors(sphere_vertices_.size() / 7);
        glDrawElements(GL_TRIANGLES, sphere_index_count_, GL_UNSIGNED_INT, nullptr);
    }
    draw_rings(frame, program);
}

void Renderer::draw_strands(const FrameInput& frame)
{
    const ShaderProgram& program = programs_->strand;
    glUseProgram(program.id());
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_1D, wave_texture_);
    glUniform1i(program.uniform("wave"), 0);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, looks_texture_);
    glUniform1i(program.uniform("looks"), 1);
    glUniform1i(program.uniform("varied"), !frame.simulation->solver().groom().looks.empty());
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_1D, ramp_texture_);
    glUniform1i(program.uniform("ramp"), 2);
    glActiveTexture(GL_TEXTURE3);
    glBindTexture(GL_TEXTURE_BUFFER, leader_texture_);
    glUniform1i(program.uniform("leaders"), 3);
    glActiveTexture(GL_TEXTURE4);
    glBindTexture(GL_TEXTURE_BUFFER, braid_texture_);
    glUniform1i(program.uniform("braids"), 4);
    glActiveTexture(GL_TEXTURE5);
    glBindTexture(GL_TEXTURE_2D, shades_texture_);
    glUniform1i(program.uniform("shades"), 5);
    glUniform1i(program.uniform("shaded_pieces"), shaded_ ? shaded_pieces_ : 0);
    glActiveTexture(GL_TEXTURE6);
    glBindTexture(GL_TEXTURE_2D, across_texture_);
    glUniform1i(program.uniform("near_light"), 6);
    glUniform1i(program.uniform("near_places"), shaded_ ? near_places_ : 0);
    glActiveTexture(GL_TEXTURE0);
    glUniform1i(program.uniform("braided"), braided_);
    glUniform1f(program.uniform("widening"), 1.0f / frame.kept);
    glUniform1i(program.uniform("nodes"), frame.simulation->solver().groom().nodes);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(strand_array_);
    glDrawElements(GL_LINES_ADJACENCY, strand_index_count_, GL_UNSIGNED_INT, nullptr);
    glDisable(GL_BLEND);
}

// What the rasteriser makes of the strands, with the depth of all that has been drawn so far, over it.
void Renderer::compose_strands(const FrameInput& frame, const RasterView& view, GLuint framebuffer)
{
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    const auto read_depth = [&](float* to)
    { glReadPixels(0, 0, view.width, view.height, GL_DEPTH_COMPONENT, GL_FLOAT, to); };
    if (!raster_depth_.pack(rasteriser_->device(), rasteriser_->solid_buffer(view.width, view.height),
                            size_t(view.width) * size_t(view.height) * sizeof(float), [&] { read_depth(nullptr); }))
        read_depth(rasteriser_->solid_depth(view.width, view.height));
    shade_strands(frame, view, rasteriser_->measure(*rastered_, view));
    const RasterPicture picture = rasteriser_->draw(*rastered_);
    if (picture.width == 0)
        return;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, rastered_texture_);
    if (rastered_size_ != glm::ivec2(view.width, view.height))
    {
        rastered_size_ = {view.width, view.height};
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, view.width, view.height, 0, GL_RGBA, GL_HALF_FLOAT, nullptr);
        for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
            glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, view.width);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, picture.x);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, picture.y);
    raster_pixels_.unpack(rasteriser_->device(), picture.pixels, picture.bytes,
                          [&](uintptr_t pixels)
                          {
                              glTexSubImage2D(GL_TEXTURE_2D, 0, picture.x, picture.y, picture.width, picture.height,
                                              GL_RGBA, GL_HALF_FLOAT, reinterpret_cast<const void*>(pixels));
                          });
    for (const GLenum back : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS})
        glPixelStorei(back, 0);
    glViewport(0, 0, view.width, view.height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(picture.x, picture.y, picture.width, picture.height);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glUseProgram(programs_->add.id());
    glUniform1i(programs_->add.uniform("picture"), 0);
    glUniform1f(programs_->add.uniform("share"), 1.0f);
    glBindVertexArray(empty_array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
}

void Renderer::draw_guides(const FrameInput& frame)
{
    const Groom& groom = frame.simulation->solver().groom();
    const float* x = frame.guide_positions.as<float>();
    std::vector<float> lines;
    for (int g = 0; g < groom.guides; ++g)
        for (int k = 1; k < groom.nodes; ++k)
            for (const int node : {k - 1, k})
            {
                for (int axis = 0; axis < 3; ++axis)
                    lines.push_back(x[strand_value(g, node, axis, groom.nodes)]);
                lines.push_back(float(node) / float(groom.nodes - 1));
            }
    glUseProgram(programs_->guide.id());
    glBindVertexArray(guide_array_);
    glBindBuffer(GL_ARRAY_BUFFER, guide_buffer_);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(lines.size() * sizeof(float)), lines.data(), GL_STREAM_DRAW);
    glDrawArrays(GL_LINES, 0, GLsizei(lines.size() / 4));
}

void Renderer::draw(const FrameInput& frame, int whole_width, int whole_height, Part part, glm::vec2 jitter,
                    glm::vec2 lens)
{
    const Solver& solver = frame.simulation->solver();
    const StepInfo& info = solver.info();
    const glm::vec3 middle(frame.camera.position() - solver.head().origin);
    const glm::vec3 target(frame.camera.target - solver.head().origin);
    const glm::vec3 forward = glm::normalize(target - middle);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
    const glm::vec3 aside = lens.x * right + lens.y * glm::cross(right, forward), eye = middle + aside;
    const float near = float(frame.camera.distance) * 0.02f, far = float(frame.camera.distance) * 4.0f + 20.0f;
    const float tangent = std::tan(0.5f * float(frame.camera.fov));
    // The part of the whole picture's frustum, moved by the jitter in pixels, and sheared so that from all of the lens
    // the same is seen where it is in focus.
    const float pixel = 2.0f * tangent / float(whole_height); // at a distance of one
    const float focus = frame.params.camera_focus > 0.0f ? frame.params.camera_focus : float(frame.camera.distance);
    const float left = (float(part.x) + jitter.x - 0.5f * float(whole_width)) * pixel - lens.x / focus;
    const float bottom = (float(part.y) + jitter.y - 0.5f * float(whole_height)) * pixel - lens.y / focus;
    const glm::mat4 projection = glm::frustum(left * near, (left + float(part.width) * pixel) * near, bottom * near,
                                              (bottom + float(part.height) * pixel) * near, near, far);
    const RasterView view = {projection * glm::lookAt(eye, target + aside, glm::vec3(0, 1, 0)),
                             eye,
                             pixel,
                             near,
                             far,
                             part.width,
                             part.height};
    shade(frame, view);
    FrameBlock block;
    block.view_projection = view.view_projection;
    block.camera_position = F4(eye.x, eye.y, eye.z, pixel);
    block.head_row0 = info.head_row0;
    block.head_row1 = info.head_row1;
    block.head_row2 = info.head_row2;
    block.grid_corner = info.grid_corner;
    block.sweep = info.sweep;
    const int slices[4] = {info.sweep_axis, info.sweep_from, info.sweep_sign, frame.light_resolution()};
    std::copy(slices, slices + 4, block.slices);
    glBindBuffer(GL_UNIFORM_BUFFER, frame_block_);
    glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof block, &block);

    glBindFramebuffer(GL_FRAMEBUFFER, scene_.framebuffer);
    glViewport(0, 0, part.width, part.height);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    if (!frame.transparent)
    {
        glUseProgram(programs_->background.id());
        glUniform4f(programs_->background.uniform("part"), float(part.x) / float(whole_width),
                    float(part.y) / float(whole_height), float(part.width) / float(whole_width),
                    float(part.height) / float(whole_height));
        glBindVertexArray(empty_array_);
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }
    glEnable(GL_DEPTH_TEST);
    colors_at_ = 0;
    draw_ground(programs_->ground, eye);
    draw_solids(frame, eye);
    const bool strands = frame.params.render_show != 1, rasterised = method_of(frame.params) == BY_OPENCL;
    if (strands && !rasterised)
    {
        if (lens != glm::vec2(0.0f))
            upload_order(frame, eye, forward); // the head hides other strands from here
        draw_strands(frame);
    }
    if (frame.params.render_show != 0)
        draw_guides(frame);
    glDisable(GL_DEPTH_TEST);
    if (scene_.samples > 0)
    {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, scene_.framebuffer);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, single_.framebuffer);
        glBlitFramebuffer(0, 0, part.width, part.height, 0, 0, part.width, part.height,
                          GL_COLOR_BUFFER_BIT | (rasterised ? GL_DEPTH_BUFFER_BIT : 0), GL_NEAREST);
    }
    if (strands && rasterised)
        compose_strands(frame, view, scene_.samples > 0 ? single_.framebuffer : scene_.framebuffer);
}

// Samples of a choice: auto, off, 2x, 4x, 8x, within what the driver gives.
static int multisamples(int choice)
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    const int wanted = choice == 0 ? (is_software_renderer() ? 0 : 4) : choice == 1 ? 0 : 1 << (choice - 1);
    return std::min(wanted, int(most));
}

const Renderer::Target& Renderer::accumulate(const FrameInput& frame, int whole_width, int whole_height, Part part)
{
    strands_seen_from_.clear();
    const int samples = multisamples(frame.params.render_multisample);
    const bool depth_is_read = method_of(frame.params) == BY_OPENCL;
    const GLenum depth_format = depth_is_read ? GL_DEPTH_COMPONENT32F : GL_DEPTH_COMPONENT24;
    prepare(scene_, part.width, part.height, samples, GL_RGBA16F, depth_format);
    if (samples > 0)
        prepare(single_, part.width, part.height, 0, GL_RGBA16F, depth_is_read ? depth_format : 0);
    const Target& one_sample = samples > 0 ? single_ : scene_;
    if (frame.samples == 1 && frame.before == 0 && frame.first < 0)
    {
        draw(frame, whole_width, whole_height, part, glm::vec2(0.0f), glm::vec2(0.0f));
        return one_sample;
    }
    prepare(sum_, part.width, part.height, 0, GL_RGBA32F);
    if (frame.before == 0)
    {
        glBindFramebuffer(GL_FRAMEBUFFER, sum_.framebuffer);
        glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    const float all = float(frame.before + frame.samples), lens = float(lens_radius(frame.params));
    for (int i = 0; i < frame.samples; ++i)
    {
        const int n = std::max(frame.first, 0) + frame.before + i;
        draw(frame, whole_width, whole_height, part, place_in_pixel(n), lens * place_on_disc(n));
        glBindFramebuffer(GL_FRAMEBUFFER, sum_.framebuffer);
        glEnable(GL_BLEND);
        glBlendColor(0.0f, 0.0f, 0.0f, i == 0 ? float(frame.before) / all : 1.0f); // what is there gives way once
        glBlendFunc(GL_ONE, GL_CONSTANT_ALPHA);
        glUseProgram(programs_->add.id());
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, one_sample.texture);
        glUniform1i(programs_->add.uniform("picture"), 0);
        glUniform1f(programs_->add.uniform("share"), 1.0f / all);
        glBindVertexArray(empty_array_);
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glDisable(GL_BLEND);
    }
    return sum_;
}

// Reads what the bound framebuffer holds into its place of the whole picture.
template <typename Picture> static void put_part(GLenum type, int x, int y, int width, int height, Picture& picture)
{
    const auto values = [](int w, int h) { return size_t(4) * size_t(w) * size_t(h); };
    picture.pixels.resize(values(picture.width, picture.height));
    decltype(picture.pixels) part(values(width, height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, type, part.data());
    for (int row = 0; row < height; ++row) // GL's first row is the lowest
        std::copy_n(&part[values(row, width)], values(1, width),
                    &picture.pixels[values(picture.height - 1 - y - row, picture.width) + values(x, 1)]);
}

void Renderer::resolve(const FrameInput& frame, const Target& light, GLuint framebuffer, Part part, int left)
{
    const Display display = display_of(frame.params);
    const ShaderProgram& program = programs_->show[display.choice - 1];
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(left, 0, part.width, part.height);
    glUseProgram(program.id());
    glUniform1i(program.uniform("left"), left);
    glUniform1f(program.uniform("gain"), display.gain);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, light.texture);
    glUniform1i(program.uniform("picture"), 0);
    glBindVertexArray(empty_array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::show(const FrameInput& frame, int width, int height, int left)
{
    upload(frame);
    const Part all = {0, 0, width, height};
    resolve(frame, accumulate(frame, width, height, all), 0, all, left);
}

void Renderer::draw_parts(const FrameInput& frame, int width, int height, const TakePart& take)
{
    if (width < 1 || height < 1 || width > 8192 || height > 8192)
        throw fail("a picture of {} x {} pixels cannot be drawn; each side must lie in [1, 8192]", width, height);
    upload(frame);
    const int most = 2048; // pixels a side of a tile, which bounds the memory
    for (int y = 0; y < height; y += most)
        for (int x = 0; x < width; x += most)
        {
            const Part part = {x, y, std::min(most, width - x), std::min(most, height - y)};
            take(accumulate(frame, width, height, part), part);
        }
}

Image Renderer::picture(const FrameInput& frame, int width, int height)
{
    Image image{width, height, {}};
    Target bytes;
    const auto take = [&](const Target& light, Part part)
    {
        prepare(bytes, part.width, part.height, 0, GL_RGBA8);
        resolve(frame, light, bytes.framebuffer, part);
        put_part(GL_UNSIGNED_BYTE, part.x, part.y, part.width, part.height, image);
    };
    draw_parts(frame, width, height, take);
    glDeleteFramebuffers(1, &bytes.framebuffer);
    glDeleteTextures(1, &bytes.texture);
    return image;
}

LinearImage Renderer::linear_picture(const FrameInput& frame, int width, int height)
{
    LinearImage image{width, height, {}};
    const auto take = [&](const Target& light, Part part)
    {
        glBindFramebuffer(GL_FRAMEBUFFER, light.framebuffer);
        put_part(GL_FLOAT, part.x, part.y, part.width, part.height, image);
    };
    draw_parts(frame, width, height, take);
    return image;
}

} // namespace coif

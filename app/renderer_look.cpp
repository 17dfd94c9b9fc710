// The picture's light for the levels above Kajiya-Kay: worked out by app/shading.h, and carried to the driver as
// colours.
#include "app/renderer.h"

#include "app/look_level.h"
#include "app/rasteriser.h"
#include "app/renderer_rings.h"
#include "app/solids.h"
#include "sim/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace coif
{

static constexpr int kShadesInRow = 4096;
static constexpr GLuint kColor = 5; // as ShaderProgram binds it

template <typename T> static void append(std::vector<char>& key, const T& value)
{
    const char* bytes = reinterpret_cast<const char*>(&value);
    key.insert(key.end(), bytes, bytes + sizeof value);
}

// As draw_solids() draws them, one thing after the other.
std::vector<LookSurface> Renderer::solid_points(const FrameInput& frame) const
{
    const HairParams p = device_params(frame.params);
    const StepInfo& info = frame.simulation->solver().info();
    const auto turned = [&](glm::vec3 v)
    {
        const auto by = [&](const float4& row) { return row.x * v.x + row.y * v.y + row.z * v.z; };
        return glm::vec3(by(info.head_row0), by(info.head_row1), by(info.head_row2));
    };
    std::vector<LookSurface> points;
    const auto add = [&](glm::vec3 at, glm::vec3 n, float gloss, glm::vec3 albedo, float under_skin)
    {
        points.push_back(
            {F4(at.x, at.y, at.z, 1.0f), F4(n.x, n.y, n.z, gloss), F4(albedo.x, albedo.y, albedo.z, under_skin)});
    };
    const auto rgb = [](const float4& c) { return glm::vec3(c.x, c.y, c.z); };
    const auto normalized = [](glm::vec3 n)
    { return glm::dot(n, n) > 1e-20f ? glm::normalize(n) : glm::vec3(0.0f, 1.0f, 0.0f); };
    const auto triple = [](const std::vector<float>& from, size_t i)
    { return glm::vec3(from[i], from[i + 1], from[i + 2]); };
    if (ground_)
        for (size_t i = 0; i < ground_corners_.size(); i += 3)
            add(triple(ground_corners_, i) + ground_->moved, glm::vec3(0.0f, 1.0f, 0.0f), 0.0f, ground_->albedo, 0.0f);
    for (size_t i = 0; i < mesh_vertices_.size(); i += 7)
    {
        const float roots = mesh_vertices_[i + 6];
        add(turned(triple(mesh_vertices_, i) * p.head_scale), normalized(turned(triple(mesh_vertices_, i + 3))),
            1.0f - roots, skin_albedo(p, roots), 1.0f);
    }
    const std::vector<Capsule> placed = frame.simulation->solver().placed_colliders();
    for (size_t k = placed.size() - frame.simulation->style().host.colliders.size(); k < placed.size(); ++k)
        for (size_t i = 0; i < sphere_vertices_.size(); i += 7)
        {
            const glm::vec3 out = triple(sphere_vertices_, i), axis = rgb(placed[k].axis);
            add(out * placed[k].center.w + rgb(placed[k].center) +
                    (glm::dot(out, axis) > 0.0f ? axis : glm::vec3(0.0f)),
                out, 0.0f, kObstacleAlbedo, 0.0f);
        }
    for (const Ring& ring : rings_of(frame))
    {
        const std::vector<float> corners = corners_of(ring.band);
        for (size_t i = 0; i < corners.size(); i += 7)
        {
            const glm::vec3 at = triple(corners, i), n = triple(corners, i + 3);
            add(ring.on_head ? turned(at) : at, normalized(ring.on_head ? turned(n) : n), 0.0f, ring.color, 0.0f);
        }
    }
    return points;
}

// Follows the light anew where anything but the camera has changed.
void Renderer::light(const FrameInput& frame, const std::vector<float>& waves)
{
    shaded_ = !lit_by_kajiya_kay(frame.params);
    if (!shaded_)
    {
        look_ = {LOOK_KAJIYA_KAY, 0.0, 0.0, look_.followed};
        chosen_by_.clear();
        return;
    }
    const Solver& solver = frame.simulation->solver();
    if (!shading_ || shading_->device().context() != solver.device().context())
    {
        shading_ = std::make_unique<Shading>(solver.device());
        lit_by_.clear();
    }
    HairParams params = device_params(frame.params);
    HairParams of_light = params;
    of_light.camera_yaw = of_light.camera_pitch = of_light.camera_distance = of_light.camera_fov = 0.0f;
    of_light.camera_target = F4(0, 0, 0, 0);
    of_light.camera_aperture = of_light.camera_focus = of_light.camera_shutter = of_light.look_exposure = 0.0f;
    std::vector<char> key;
    append(key, of_light);
    append(key, &solver);
    for (const Sun& sun : frame.lighting.suns)
        append(key, sun);
    append(key, frame.lighting.sky);
    const std::vector<char> of_style = key;
    append(key, solver.drawings());
    append(key, frame.coarse_light);
    if (frame.coarse_light)
        params.look_volume = std::max(params.look_volume / 2, int(find_param("look.volume")->min));
    seen_from_.clear();
    if (key == lit_by_)
        return;
    lit_by_.clear(); // what is there is lost if this fails
    LitScene scene = lit_scene(*frame.simulation, waves);
    scene.params = params;
    scene.lighting = frame.lighting;
    shading_->light(scene);
    look_.light_ms = sum_of(shading_->take_times());
    ++look_.followed;
    lit_by_ = key;
    choose_level(frame.params, of_style);
}

// Anew only where the style or its lights change: hair that moves would go to and fro between two levels.
void Renderer::choose_level(const HairParams& params, const std::vector<char>& of_style)
{
    if (of_style == chosen_by_)
        return;
    const std::vector<LevelError> errors = level_errors(*shading_);
    look_.level = chosen_level(params, errors);
    look_.left_out = std::ranges::find(errors, look_.level, &LevelError::level)->left_out;
    chosen_by_ = of_style;
}

// Colours as they are seen from the eye: of what is solid, and of the strands for the geometry shader.
void Renderer::shade(const FrameInput& frame, glm::vec3 eye)
{
    if (!shaded_)
        return;
    std::vector<char> from;
    append(from, eye);
    append(from, frame.kept);
    if (from == seen_from_)
        return;
    if (frame.params.render_show != 1 && method_of(frame.params) != BY_OPENCL)
    {
        shaded_pieces_ = shading_->shade(eye, look_.level, frame.kept).pieces;
        upload_shades();
    }
    const std::vector<float4> colors = shading_->lit(solid_points(frame), eye);
    glBindBuffer(GL_ARRAY_BUFFER, solid_colors_);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(colors.size() * sizeof(float4)), colors.data(), GL_STREAM_DRAW);
    look_.shade_ms = sum_of(shading_->take_times());
    seen_from_ = from;
    strands_seen_from_.clear();
}

// Of the strands for the rasteriser, once for all samples of a part of the picture: only those that it has found are
// seen there.
void Renderer::shade_strands(const FrameInput& frame, glm::vec3 eye, const cl::Buffer& pieces)
{
    if (!shaded_)
        return;
    const float near = rastered_->values.empty() ? rasteriser_->near_share() : 0.0f;
    std::vector<char> from;
    append(from, eye);
    append(from, frame.kept);
    append(from, near);
    if (from == strands_seen_from_)
        return;
    rastered_->shaded = &shading_->shade(eye, look_.level, frame.kept, &pieces, near);
    look_.shade_ms += sum_of(shading_->take_times());
    strands_seen_from_ = from;
}

// For the geometry shader: rows of kShadesInRow colours.
void Renderer::upload_shades()
{
    const LookVolume& volume = shading_->volume();
    const size_t count = size_t(volume.strands) * size_t(volume.places);
    const int rows = std::max(1, int((count + kShadesInRow - 1) / kShadesInRow));
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (rows > most || kShadesInRow > most)
        throw fail("this driver's textures hold too few colours for {} strands; set render.method to opencl",
                   volume.strands);
    constexpr size_t kTexel = 8; // bytes: halves of red, green, blue and nothing
    const int whole = int(count / kShadesInRow), rest = int(count % kShadesInRow);
    glBindTexture(GL_TEXTURE_2D, shades_texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, kShadesInRow, rows, 0, GL_RGBA, GL_HALF_FLOAT, nullptr);
    shades_.unpack(shading_->device(), shading_->buffers().at("shaded"), count * kTexel,
                   [&](uintptr_t colors)
                   {
                       const auto put = [&](int row, int width, int height)
                       {
                           const uintptr_t at = colors + size_t(row) * kShadesInRow * kTexel;
                           glTexSubImage2D(GL_TEXTURE_2D, 0, 0, row, width, height, GL_RGBA, GL_HALF_FLOAT,
                                           reinterpret_cast<const void*>(at));
                       };
                       put(0, kShadesInRow, whole);
                       if (rest > 0)
                           put(whole, rest, 1);
                   });
}

// Points the bound array's colours at those of the next thing that is drawn, which has so many points.
void Renderer::next_colors(size_t points)
{
    if (!shaded_)
        return glDisableVertexAttribArray(kColor);
    glBindBuffer(GL_ARRAY_BUFFER, solid_colors_);
    glEnableVertexAttribArray(kColor);
    glVertexAttribPointer(kColor, 3, GL_FLOAT, GL_FALSE, sizeof(float4),
                          reinterpret_cast<const void*>(colors_at_ * sizeof(float4)));
    colors_at_ += points;
}

} // namespace coif

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
static constexpr int kAcrossInRow = 85; // PLACES_IN_ROW of shaders/strand.frag
static constexpr GLuint kColor = 5;     // as ShaderProgram binds it

// Places of strands as a texture has them.
struct PlaceRows
{
    size_t places;
    int in_row, texels; // of a place
    size_t texel_bytes;
    GLint internal;
    GLenum format;
};

static int rows_of(size_t places, int in_row)
{
    return std::max(1, int((places + size_t(in_row) - 1) / size_t(in_row)));
}

static size_t places_of(const LookVolume& volume) { return size_t(volume.strands) * size_t(volume.places); }

static GLint largest_texture()
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    return most;
}

template <typename T> static void append(std::vector<char>& key, const T& value)
{
    const char* bytes = reinterpret_cast<const char*>(&value);
    key.insert(key.end(), bytes, bytes + sizeof value);
}

// What colours hang on, for the same light.
static std::vector<char> seen_key(glm::vec3 eye, float kept, float near)
{
    std::vector<char> key;
    append(key, eye);
    append(key, kept);
    append(key, near);
    return key;
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
            {F4(at.x, at.y, at.z, LIT_ABOVE), F4(n.x, n.y, n.z, gloss), F4(albedo.x, albedo.y, albedo.z, under_skin)});
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
    LitScene scene = lit_scene(*frame.simulation, waves, skin_);
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

// Of the light straight from suns, that is drawn across the strands; none of it where colours tell a value.
float Renderer::across_share(const FrameInput& frame, const RasterView& view) const
{
    const float width = mean_width(frame.simulation->solver(), device_params(frame.params), view);
    return frame.colors.value.empty() ? near_share(width, near_width) : 0.0f;
}

// Colours as they are seen from the eye: of what is solid, and of the strands for the geometry shader.
void Renderer::shade(const FrameInput& frame, const RasterView& view)
{
    if (!shaded_)
        return;
    const bool strands = frame.params.render_show != 1 && method_of(frame.params) != BY_OPENCL;
    float near = strands ? across_share(frame, view) : 0.0f;
    if (near > 0.0f && rows_of(places_of(shading_->volume()), kAcrossInRow) > largest_texture())
        near = 0.0f;
    const std::vector<char> from = seen_key(view.eye, frame.kept, near);
    if (from == seen_from_)
        return;
    if (strands)
    {
        const ShadedStrands& shaded = shading_->shade(view.eye, look_.level, frame.kept, nullptr, near);
        shaded_pieces_ = shaded.pieces;
        upload_shades(shaded.near > 0.0f);
    }
    const std::vector<float4> colors = shading_->lit(solid_points(frame), view.eye);
    glBindBuffer(GL_ARRAY_BUFFER, solid_colors_);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(colors.size() * sizeof(float4)), colors.data(), GL_STREAM_DRAW);
    look_.shade_ms = sum_of(shading_->take_times());
    seen_from_ = from;
    strands_seen_from_.clear();
}

// Of the strands for the rasteriser, once for all samples of a part of the picture: only those that it has found are
// seen there.
void Renderer::shade_strands(const FrameInput& frame, const RasterView& view, const cl::Buffer& pieces)
{
    if (!shaded_)
        return;
    const float near = across_share(frame, view);
    const std::vector<char> from = seen_key(view.eye, frame.kept, near);
    if (from == strands_seen_from_)
        return;
    rastered_->shaded = &shading_->shade(view.eye, look_.level, frame.kept, &pieces, near);
    look_.shade_ms += sum_of(shading_->take_times());
    strands_seen_from_ = from;
}

// A texture of rows of so many places, from a buffer that has them one after the other.
static void upload_rows(SharedBuffer& by, const Device& device, const cl::Buffer& from, const PlaceRows& rows)
{
    const size_t texels = size_t(rows.in_row) * size_t(rows.texels), bytes = texels * rows.texel_bytes;
    const int whole = int(rows.places / size_t(rows.in_row)), rest = int(rows.places % size_t(rows.in_row));
    glTexImage2D(GL_TEXTURE_2D, 0, rows.internal, GLsizei(texels), rows_of(rows.places, rows.in_row), 0, rows.format,
                 GL_HALF_FLOAT, nullptr);
    by.unpack(device, from, rows.places * size_t(rows.texels) * rows.texel_bytes,
              [&](uintptr_t values)
              {
                  const auto put = [&](int row, size_t width, int height)
                  {
                      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, row, GLsizei(width), height, rows.format, GL_HALF_FLOAT,
                                      reinterpret_cast<const void*>(values + size_t(row) * bytes));
                  };
                  put(0, texels, whole);
                  if (rest > 0)
                      put(whole, size_t(rest) * size_t(rows.texels), 1);
              });
}

// For the geometry shader: colours, and where strands are wide the light across them.
void Renderer::upload_shades(bool across)
{
    const LookVolume& volume = shading_->volume();
    const size_t places = places_of(volume);
    if (std::max(rows_of(places, kShadesInRow), kShadesInRow) > largest_texture())
        throw fail("this driver's textures hold too few colours for {} strands; set render.method to opencl",
                   volume.strands);
    glBindTexture(GL_TEXTURE_2D, shades_texture_);
    // Halves of red, green, blue and nothing.
    upload_rows(shades_, shading_->device(), shading_->buffers().at("shaded"),
                {places, kShadesInRow, 1, 8, GL_RGBA16F, GL_RGBA});
    near_places_ = across ? volume.places : 0;
    if (across)
    {
        const cl::Buffer& cells = shading_->across();
        glBindTexture(GL_TEXTURE_2D, across_texture_);
        upload_rows(across_, shading_->device(), cells, {places, kAcrossInRow, NEAR_LIGHT, 2, GL_R16F, GL_RED});
    }
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

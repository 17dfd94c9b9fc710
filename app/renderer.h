#pragma once
#include "app/gl.h"
#include "app/gl_sharing.h"
#include "app/ground.h"
#include "app/image.h"
#include "app/skin.h"
#include "app/strand_colors.h"
#include "sim/lights.h"
#include "sim/simulation.h"

#include <glm/mat4x4.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace coif
{

class Rasteriser;
class Shading;
struct LookSurface;
struct RasterStrands;
struct Ring;
struct RasterView;

// From where a picture is taken, in the world.
struct Camera
{
    glm::dvec3 target{0.0};                   // m
    double yaw = 0.0, pitch = 0.0, fov = 0.5; // rad; yaw 0 looks at the face, fov is vertical
    double distance = 1.0;                    // m

    glm::dvec3 position() const;
};
// What strands far away are told by, in a picture of so many lines.
View view_of(const Camera& camera, int height);

// The camera that a style keeps. Parameters as authored.
Camera camera_of(const HairParams& params);
void keep_camera(const Camera& camera, HairParams& params);

// All that one picture depends on: equal inputs give equal pictures, on screen or headless.
struct FrameInput
{
    const Simulation* simulation = nullptr; // meshes, colliders and style; the views below are of its last draw()
    Mapped drawn_positions, guide_positions, optical_depth;
    HairParams params; // as authored
    Lighting lighting;
    Camera camera;
    StrandColors colors;       // instead of the hair's own, where render.colors asks for them
    bool transparent = false;  // no backdrop: alpha instead
    int samples = 1;           // jittered pictures that are averaged
    int before = 0;            // pictures of the same input and size that show() has drawn last, averaged in as well
    int first = -1;            // of the places in pixel and lens (app/lens.h), which of many pictures this is; -1: the
                               // only one, so that one sample alone is in the middle of both
    float kept = 1.0f;         // share of the strands that are drawn, each as much wider
    bool coarse_light = false; // through half as fine a volume

    int light_resolution() const; // side of optical_depth; 0 without shadow
};

// Takes the views; waits for the device.
FrameInput frame_input(const Simulation& simulation, const Camera& camera);

// How the light of the last picture was worked out.
struct LookCost
{
    int level = 0;                         // of look.level
    double light_ms = 0.0, shade_ms = 0.0; // when either was last needed
    long followed = 0;                     // pictures that light was followed anew for
    double left_out = 0.0;                 // share of the light in the hair that this level is expected to leave out
};

// What can draw the strands, as render.method lists it.
enum Method
{
    BY_ITSELF,
    BY_GEOMETRY,
    BY_OPENCL
};

class Renderer
{
  public:
    // Needs a current GL context. Throws Error when a shader does not compile.
    explicit Renderer(const std::filesystem::path& shader_folder);
    ~Renderer();

    // Draws into the current window's own framebuffer, from its `left` pixel on and as wide and high as said.
    void show(const FrameInput& frame, int width, int height, int left = 0);
    // Draws apart from any window. At most 8192 x 8192; large pictures are put together of tiles.
    Image picture(const FrameInput& frame, int width, int height);
    // The same picture's light, before exposure and display transform.
    LinearImage linear_picture(const FrameInput& frame, int width, int height);

    // Compiles all shaders anew; throws, and keeps the old ones, when one fails.
    void reload_shaders();
    // What the driver calls itself.
    std::string name() const;
    const LookCost& look() const { return look_; }
    Rasteriser* rasteriser() { return rasteriser_.get(); } // none before it has drawn
    // What draws the strands where that is left to a rule: the geometry shader where there is a graphics card for it.
    static Method method_of(const HairParams& params);

    // Where strands are wider than so many pixels on the whole, it is seen how they are lit from side to side; tests
    // change it.
    float near_width = 3.0f;

  private:
    struct Programs;
    struct Target // a picture to draw into
    {
        GLuint framebuffer = 0, color = 0, depth = 0, texture = 0;
        int width = 0, height = 0, samples = -1;
        GLenum depth_format = 0;
    };
    struct Part // of the whole picture
    {
        int x, y, width, height;
    };

    void upload(const FrameInput& frame);
    void upload_mesh(const FrameInput& frame);
    void upload_braids(const FrameInput& frame);
    void make_rings();
    void upload_looks(const std::vector<StrandLook>& looks);
    void upload_nodes(const FrameInput& frame);
    void upload_colors(const FrameInput& frame);
    void upload_shades(bool across);
    void upload_order(const FrameInput& frame, glm::vec3 eye, glm::vec3 forward);
    void upload_ground(const FrameInput& frame);
    // From a place in the pixel, and on the lens, m.
    void draw(const FrameInput& frame, int whole_width, int whole_height, Part part, glm::vec2 jitter, glm::vec2 lens);
    void draw_solids(const FrameInput& frame, glm::vec3 eye);
    void draw_rings(const FrameInput& frame, const ShaderProgram& surface);
    // For the levels above Kajiya-Kay: renderer_look.cpp.
    void light(const FrameInput& frame, const std::vector<float>& waves);
    void choose_level(const HairParams& params, const std::vector<char>& of_style);
    float across_share(const FrameInput& frame, const RasterView& view) const;
    void shade(const FrameInput& frame, const RasterView& view);
    void shade_strands(const FrameInput& frame, const RasterView& view, const cl::Buffer& pieces);
    std::vector<LookSurface> solid_points(const FrameInput& frame) const;
    void next_colors(size_t points);
    void draw_ground(const ShaderProgram& program, glm::vec3 eye);
    void draw_strands(const FrameInput& frame);
    void compose_strands(const FrameInput& frame, const RasterView& view, GLuint framebuffer);
    void draw_guides(const FrameInput& frame);
    // All samples of a part, averaged. Returns what holds them.
    const Target& accumulate(const FrameInput& frame, int whole_width, int whole_height, Part part);
    // Each part of a picture in turn, drawn.
    using TakePart = std::function<void(const Target&, Part)>;
    void draw_parts(const FrameInput& frame, int width, int height, const TakePart& take);
    void resolve(const FrameInput& frame, const Target& light, GLuint framebuffer, Part part, int left = 0);
    void prepare(Target& target, int width, int height, int samples, GLenum format, GLenum depth_format = 0);

    std::filesystem::path shader_folder_;
    std::unique_ptr<Programs> programs_;
    std::unique_ptr<Rasteriser> rasteriser_;                   // none until it is asked for
    std::unique_ptr<Shading> shading_;                         // none until a level asks for it
    std::vector<char> lit_by_, seen_from_, strands_seen_from_; // what it has worked out last
    std::vector<char> chosen_by_;
    LookCost look_;
    bool shaded_ = false;                                // are colours worked out for this picture?
    int shaded_pieces_ = 0;                              // places on a segment that the texture of colours has; 0: none
    int near_places_ = 0;                                // of a strand, that the texture of light across has; 0: none
    std::vector<float> mesh_vertices_, sphere_vertices_; // as they are uploaded
    std::vector<SkinPlace> skin_;                        // of the same mesh
    size_t colors_at_ = 0;                               // of the next thing drawn, in solid_colors_
    std::unique_ptr<RasterStrands> rastered_;            // what it draws
    glm::ivec2 rastered_size_{0};                        // of its texture
    Target scene_, single_, sum_; // multisampled or not; one sample a pixel; all samples added up
    SharedBuffer positions_, frames_, shades_, across_, raster_depth_, raster_pixels_;
    GLuint frame_block_ = 0, params_block_ = 0;
    GLuint strand_array_ = 0, color_buffer_ = 0, index_buffer_ = 0;
    GLuint mesh_array_ = 0, mesh_buffer_ = 0, mesh_indices_ = 0;
    GLuint sphere_array_ = 0, sphere_buffer_ = 0, sphere_indices_ = 0;
    GLuint ring_array_ = 0, ring_buffer_ = 0, ring_indices_ = 0, braid_buffer_ = 0, braid_texture_ = 0;
    GLint braided_ = 0; // strands that may be
    GLuint ground_array_ = 0, ground_buffer_ = 0, ground_indices_ = 0;
    GLuint guide_array_ = 0, guide_buffer_ = 0, empty_array_ = 0, solid_colors_ = 0, shades_texture_ = 0,
           across_texture_ = 0;
    GLuint depth_texture_ = 0, wave_texture_ = 0, looks_texture_ = 0, ramp_texture_ = 0;
    GLuint leader_texture_ = 0, leader_buffer_ = 0, rastered_texture_ = 0;
    int depth_resolution_ = 0; // that the texture has room for
    GLsizei strand_index_count_ = 0, mesh_index_count_ = 0, sphere_index_count_ = 0, ring_index_count_ = 0,
            ground_index_count_ = 0;
    const void* mesh_of_ = nullptr; // which head is uploaded, and with which scale and offset
    std::vector<float> mesh_key_;
    std::optional<Ground> ground_;
    std::vector<float> ground_corners_; // in the world as long as the head has not leapt, m
    int mesh_facing_ = 0;               // mesh_order.h
    float mesh_radius_ = 0.0f;          // about the head's origin, m, before head.scale
    float enclosed_ = 0.0f;             // radius of a ball inside the head, m, before head.scale
    std::vector<std::pair<float, unsigned>> order_;
    std::vector<unsigned> indices_;
};

} // namespace coif

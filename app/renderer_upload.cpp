// What the renderer sends to the driver before it draws: parameters, grids, the head, the strands and their order.
#include "app/renderer.h"

#include "app/mesh_order.h"
#include "app/rasteriser.h"
#include "app/root_shares.h"
#include "sim/tied_hair.h"
#include "sim/wave.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace coif
{

// The largest ball about the scalp's centre that the head wholly encloses: what lies behind it is hidden. Zero for a
// mesh that does not close around the centre (van Oosterom, Strackee. The solid angle of a plane triangle. 1983).
static float enclosed_radius(const std::vector<float>& vertices, const std::vector<glm::uvec3>& triangles,
                             glm::vec3 center)
{
    const auto corner = [&](unsigned i)
    { return glm::dvec3(vertices[i * 7], vertices[i * 7 + 1], vertices[i * 7 + 2]) - glm::dvec3(center); };
    double solid_angle = 0.0;
    float nearest = INFINITY;
    for (const glm::uvec3& t : triangles)
    {
        const glm::dvec3 a = corner(t.x), b = corner(t.y), c = corner(t.z);
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        solid_angle += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                        la * lb * lc + glm::dot(a, b) * lc + glm::dot(a, c) * lb + glm::dot(b, c) * la);
        nearest = std::min(nearest, triangle_distance(glm::vec3(0.0f), glm::vec3(a), glm::vec3(b), glm::vec3(c)));
    }
    return std::abs(std::abs(solid_angle) - 4.0 * std::numbers::pi) < 0.01 ? nearest : 0.0f;
}

// Is the sight from the eye to the point blocked by a ball? The points of which that is true form a convex set, so a
// segment between two of them is hidden too.
static bool is_hidden(glm::vec3 eye, glm::vec3 point, glm::vec3 center, float radius)
{
    const glm::vec3 sight = point - eye, to_center = center - eye;
    const float t = glm::clamp(glm::dot(to_center, sight) / std::max(glm::dot(sight, sight), 1e-12f), 0.0f, 1.0f);
    const glm::vec3 away = to_center - t * sight;
    return glm::dot(away, away) < radius * radius;
}

void Renderer::upload_mesh(const FrameInput& frame)
{
    const Assets& assets = frame.simulation->assets();
    const HairParams& p = frame.params;
    const std::vector<float> key = {p.head_mesh_scale,
                                    p.head_offset.x,
                                    p.head_offset.y,
                                    p.head_offset.z,
                                    float(assets.head.positions.size()),
                                    float(assets.scalp.positions.size())};
    if (mesh_of_ == assets.head.positions.data() && mesh_key_ == key)
        return;
    mesh_of_ = assets.head.positions.data();
    mesh_key_ = key;
    const glm::vec3 offset(p.head_offset.x, p.head_offset.y, p.head_offset.z);
    const std::vector<float> roots = shares_of_roots(assets, p);
    skin_ = skin_places(assets, p, roots);
    std::vector<float>& vertices = mesh_vertices_;
    vertices.clear();
    vertices.reserve(assets.head.positions.size() * 7);
    for (size_t i = 0; i < assets.head.positions.size(); ++i)
    {
        const glm::vec3 at = assets.head.positions[i] * p.head_mesh_scale + offset, n = assets.head.normals[i];
        vertices.insert(vertices.end(), {at.x, at.y, at.z, n.x, n.y, n.z, roots[i]});
    }
    glBindVertexArray(mesh_array_);
    glBindBuffer(GL_ARRAY_BUFFER, mesh_buffer_);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size() * sizeof(float)), vertices.data(), GL_STATIC_DRAW);
    const std::vector<glm::uvec3> triangles = along_curve(assets.head.positions, assets.head.triangles);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(triangles.size() * sizeof(glm::uvec3)), triangles.data(),
                 GL_STATIC_DRAW);
    mesh_facing_ = facing(assets.head.positions, triangles);
    mesh_radius_ = 0.0f;
    for (size_t i = 0; i < vertices.size(); i += 7)
        mesh_radius_ = std::max(mesh_radius_, std::hypot(vertices[i], vertices[i + 1], vertices[i + 2]));
    mesh_index_count_ = GLsizei(assets.head.triangles.size() * 3);
    enclosed_ = enclosed_radius(vertices, assets.head.triangles, assets.scalp.center);
}

// What is put in order: a whole strand, or of a tied one what lies before and behind its ring, which go other ways.
enum Piece : unsigned
{
    kWhole,
    kToRing,
    kBehindRing,
    kPieces
};

// Strands from far to near, by their middle node, so that their soft edges blend over what lies behind them. Segments
// that the head hides are left out.
void Renderer::upload_order(const FrameInput& frame, glm::vec3 eye, glm::vec3 forward)
{
    const Groom& groom = frame.simulation->solver().groom();
    const unsigned nodes = unsigned(groom.nodes), strands = unsigned(groom.drawn.size());
    const float4* p = frame.drawn_positions.as<float4>();
    const auto at_ring = [&](unsigned s) // the first node behind it, or 0
    {
        if (s >= groom.tied.size() || groom.tied[s].ring == 0.0f)
            return 0u;
        const float cut = std::max(groom.drawn[s].root.w, 1e-3f);
        return std::clamp(unsigned(2.0f + (groom.tied[s].ring - 1.0f) / cut), 2u, nodes - 1);
    };
    order_.clear();
    const auto add = [&](unsigned s, Piece piece, unsigned node, float later)
    {
        const float4 at = p[s * nodes + node];
        const float depth = at.x * forward.x + at.y * forward.y + at.z * forward.z - later;
        order_.emplace_back(std::isfinite(depth) ? -depth : 0.0f, s * kPieces + piece);
    };
    for (unsigned s = 0; s < strands; ++s)
        if (STRAND_TURN(s) >= frame.kept)
            continue;
        else if (const unsigned ring = at_ring(s))
        {
            const TiedStrand& tied = groom.tied[s];
            const Tail& tail = groom.tails[size_t(tied.tail)];
            add(s, kToRing, (1 + ring) / 2, 0.0f);
            // The nodes of a braid are its middle's: what lies inside of a plait first.
            const float later = tail.axis.w > 0.0f ? tail.plait * std::hypot(tied.place.x, tied.place.y) : 0.0f;
            add(s, kBehindRing, (ring + nodes) / 2, later);
        }
        else
            add(s, kWhole, (nodes + 1) / 2, 0.0f);
    std::sort(order_.begin(), order_.end());
    const Solver& solver = frame.simulation->solver();
    const StepInfo& info = solver.info();
    const auto turned = [&](const float4& row)
    { return row.x * groom.center.x + row.y * groom.center.y + row.z * groom.center.z; };
    const glm::vec3 center(turned(info.head_row0), turned(info.head_row1), turned(info.head_row2));
    // Room for what is laid on and for the curve that bulges between the nodes.
    const HairParams& params = frame.params;
    float laid_on =
        params.wave_normal_amplitude + params.wave_binormal_amplitude + params.curl_radius + params.frizz_amount;
    for (const StrandLook& look : groom.looks)
        laid_on = std::max(laid_on, look.wave.x + look.wave.z + look.own.y + look.own.z);
    const float radius = enclosed_ * params.head_scale - laid_on * most_of(params.wave_along) - 0.005f;
    const auto hidden = [&](unsigned s, unsigned k)
    {
        const float4 at = p[s * nodes + k];
        return radius > 0.0f && is_hidden(eye, {at.x, at.y, at.z}, center, radius);
    };
    indices_.clear();
    indices_.reserve(size_t(strands) * (nodes - 2) * 4);
    for (const auto& [depth, piece] : order_)
    {
        const unsigned s = piece / kPieces, part = piece % kPieces;
        const unsigned begin = part == kBehindRing ? at_ring(s) : 1; // the segment under the scalp is not drawn
        const unsigned end = part == kToRing ? at_ring(s) + 1 : nodes;
        bool near_hidden = hidden(s, begin);
        for (unsigned k = begin; k + 1 < end; ++k)
        {
            const bool far_hidden = hidden(s, k + 1);
            if (!std::exchange(near_hidden, far_hidden) || !far_hidden)
                for (const unsigned node : {k - 1, k, k + 1, std::min(k + 2, nodes - 1)})
                    indices_.push_back(s * nodes + node);
        }
    }
    glBindVertexArray(strand_array_);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices_.size() * sizeof(unsigned)), indices_.data(),
                 GL_STREAM_DRAW);
    strand_index_count_ = GLsizei(indices_.size());
}

// As shaders/look.glsl reads them.
void Renderer::upload_looks(const std::vector<StrandLook>& looks)
{
    constexpr size_t kInRow = 512;
    static_assert(sizeof(StrandLook) == LOOK_TEXELS * 4 * sizeof(float));
    std::vector<StrandLook> rows = looks;
    rows.resize((std::max<size_t>(1, looks.size()) + kInRow - 1) / kInRow * kInRow);
    glBindTexture(GL_TEXTURE_2D, looks_texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, LOOK_TEXELS * kInRow, GLsizei(rows.size() / kInRow), 0, GL_RGBA,
                 GL_FLOAT, rows.data());
}

// Where the drawn nodes are, and how they are turned.
void Renderer::upload_nodes(const FrameInput& frame)
{
    const Solver& solver = frame.simulation->solver();
    const auto fill = [](const SharedBuffer& buffer, const Mapped& nodes)
    {
        glBindBuffer(GL_ARRAY_BUFFER, buffer.id());
        glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(nodes.bytes()), nodes.as<float>(), GL_STREAM_DRAW);
    };
    const size_t bytes = frame.drawn_positions.bytes();
    if (!positions_.take(solver.device(), solver.buffers().at("drawn_position"), bytes))
        fill(positions_, frame.drawn_positions);
    if (!frames_.take(solver.device(), solver.buffers().at("drawn_frame"), bytes))
        fill(frames_, solver.drawn_frames());
}

// One value a drawn node, or, where the hair has its own colours, none at all.
void Renderer::upload_colors(const FrameInput& frame)
{
    constexpr GLuint kValue = 4; // as ShaderProgram binds it
    glBindVertexArray(strand_array_);
    if (frame.colors.value.empty())
    {
        glDisableVertexAttribArray(kValue);
        glVertexAttrib1f(kValue, -1.0f);
        return;
    }
    glBindBuffer(GL_ARRAY_BUFFER, color_buffer_);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(frame.colors.value.size() * sizeof(float)), frame.colors.value.data(),
                 GL_STREAM_DRAW);
    glEnableVertexAttribArray(kValue);
    glVertexAttribPointer(kValue, 1, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void Renderer::upload(const FrameInput& frame)
{
    const HairParams params = device_params(frame.params);
    // Bound anew each time: another renderer of the same context has its own.
    glBindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, frame_block_);
    glBindBufferBase(GL_UNIFORM_BUFFER, kParamsBinding, params_block_);
    glBindBuffer(GL_UNIFORM_BUFFER, params_block_);
    glBufferSubData(GL_UNIFORM_BUFFER, 0, sizeof params, &params);

    const std::vector<float> waves = wave_table(frame.params);
    glBindTexture(GL_TEXTURE_1D, wave_texture_);
    glTexImage1D(GL_TEXTURE_1D, 0, GL_RG32F, kWaveSamples, 0, GL_RG, GL_FLOAT, waves.data());

    glBindTexture(GL_TEXTURE_3D, depth_texture_);
    const int resolution = std::max(1, frame.light_resolution());
    const float nothing = 0.0f;
    const float* depths = resolution > 1 ? frame.optical_depth.as<float>() : &nothing;
    if (depth_resolution_ != resolution)
        glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, resolution, resolution, resolution, 0, GL_RED, GL_FLOAT, depths);
    else
        glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, resolution, resolution, resolution, GL_RED, GL_FLOAT, depths);
    depth_resolution_ = resolution;

    if (params.curl_radius > 0.0f && has_clumps(params))
    {
        std::vector<int> leaders;
        for (const DrawnStrand& strand : frame.simulation->solver().groom().drawn)
            leaders.push_back(strand.leader);
        glBindBuffer(GL_TEXTURE_BUFFER, leader_buffer_);
        glBufferData(GL_TEXTURE_BUFFER, GLsizeiptr(leaders.size() * sizeof(int)), leaders.data(), GL_STREAM_DRAW);
    }

    upload_mesh(frame);
    upload_ground(frame);
    light(frame, waves);
    if (params.render_show == 1)
        return;
    if (method_of(params) == BY_OPENCL)
    {
        const Solver& solver = frame.simulation->solver();
        if (!rasteriser_ || rasteriser_->device().context() != solver.device().context())
            rasteriser_ = std::make_unique<Rasteriser>(solver.device());
        rastered_ = std::make_unique<RasterStrands>(RasterStrands{
            &solver, params, waves, braid_values(solver.groom()), frame.colors.value, {}, frame.kept, nullptr});
        for (int i = 0; i < RAMP && !rastered_->values.empty(); ++i)
        {
            const glm::vec3 color = ramp_color((float(i) + 0.5f) / float(RAMP));
            rastered_->ramp.push_back(F4(color.x, color.y, color.z, 1.0f));
        }
    }
    else
    {
        upload_braids(frame);
        upload_looks(frame.simulation->solver().groom().looks);
        upload_nodes(frame);
        upload_colors(frame);
        upload_order(frame, glm::vec3(frame.camera.position() - frame.simulation->solver().head().origin),
                     glm::vec3(glm::normalize(frame.camera.target - frame.camera.position())));
    }
}

} // namespace coif

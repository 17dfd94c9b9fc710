#include "app/traced/scene.h"

#include "app/ground.h"
#include "app/renderer_rings.h"
#include "app/root_shares.h"
#include "app/solids.h"
#include "sim/drawn_curve.h"
#include "sim/hair_color.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static glm::vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

static void add_strands(TracedScene& scene, const FrameInput& frame, const HairParams& params)
{
    constexpr float kThinnest = 1e-7f; // m: of a curve that tapers to a point
    const Simulation& simulation = *frame.simulation;
    Taken finely = taken(simulation, false, 0);
    if (params.smoothing_curve != 3) // Catmull-Rom curves through the nodes are drawn; others stray from them
        finely.pieces = std::max(finely.pieces, 4);
    Curves curves = curves_of(simulation, finely);
    if (curves.strands() == 0)
        return;
    const glm::vec3 origin(simulation.solver().head().origin);
    const size_t n = scene.points = curves.count[0];
    const std::vector<StrandLook>& looks = simulation.solver().groom().looks;
    scene.curve.reserve(curves.strands() * (n + 2));
    scene.absorption = std::move(curves.color);
    for (size_t s = 0; s < curves.strands(); ++s)
    {
        const float bright = std::max(curves.brightness[s], 1e-6f);
        const double opacity = looks.empty() ? params.look_opacity : looks[s].tip_color.w;
        const auto point = [&](size_t k)
        {
            const double covers = opacity * profile_at(params.look_opacity_along, double(k) / double(n - 1));
            const float radius = 0.5f * curves.width[s * n + k] * float(covers);
            return glm::vec4(curves.position[s * n + k] - origin, std::max(kThinnest, radius));
        };
        const glm::vec4 first = point(0), last = point(n - 1);
        scene.curve.emplace_back(2.0f * glm::vec3(first) - glm::vec3(point(1)), first.w);
        for (size_t k = 0; k < n; ++k)
        {
            scene.curve.push_back(point(k));
            // Colour goes about with the root of absorption, so that this makes a strand as much brighter.
            glm::vec3& at = scene.absorption[s * n + k];
            at = absorption_of_color(at / bright, params.look_azimuthal_roughness) / (bright * bright);
        }
        scene.curve.push_back(last); // as the renderer has it
    }
}

static void add_triangles(TracedScene& scene, const std::vector<glm::uvec3>& triangles)
{
    const unsigned first = unsigned(scene.position.size());
    for (const glm::uvec3& t : triangles)
        scene.triangles.push_back(t + first);
}

static void add_head(TracedScene& scene, const FrameInput& frame, const HairParams& params, const glm::mat3& turn)
{
    const Assets& assets = frame.simulation->assets();
    const std::vector<float> roots = shares_of_roots(assets, frame.params);
    add_triangles(scene, assets.head.triangles);
    for (size_t i = 0; i < assets.head.positions.size(); ++i)
    {
        const glm::vec3 at = assets.head.positions[i] * params.head_mesh_scale + vec(params.head_offset);
        scene.position.push_back(turn * (at * params.head_scale));
        scene.normal.push_back(turn * assets.head.normals[i]);
        scene.albedo.push_back(skin_albedo(params, roots[i]));
        scene.gloss.push_back(1.0f - roots[i]);
    }
}

// Balls, and capsules as balls of which one half is moved away.
static void add_obstacles(TracedScene& scene, const FrameInput& frame)
{
    constexpr unsigned kRings = 64, kSides = 96;
    const std::vector<Capsule> placed = frame.simulation->solver().placed_colliders();
    std::vector<glm::uvec3> triangles;
    for (unsigned i = 0; i < kRings; ++i)
        for (unsigned j = 0; j < kSides; ++j)
        {
            const unsigned a = i * (kSides + 1) + j, b = a + kSides + 1;
            triangles.emplace_back(a, a + 1, b);
            triangles.emplace_back(b, a + 1, b + 1);
        }
    // The head's own come first, and its mesh stands for them.
    for (size_t c = placed.size() - frame.simulation->style().host.colliders.size(); c < placed.size(); ++c)
    {
        add_triangles(scene, triangles);
        for (unsigned i = 0; i <= kRings; ++i)
            for (unsigned j = 0; j <= kSides; ++j)
            {
                const float theta = std::numbers::pi_v<float> * float(i) / kRings;
                const float phi = 2.0f * std::numbers::pi_v<float> * float(j) / kSides;
                const glm::vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
                const glm::vec3 axis = vec(placed[c].axis);
                scene.position.push_back(vec(placed[c].center) + n * placed[c].center.w +
                                         (glm::dot(n, axis) > 0.0f ? axis : glm::vec3(0.0f)));
                scene.normal.push_back(n);
                scene.albedo.push_back(kObstacleAlbedo);
            }
    }
}

TracedScene traced_scene(const FrameInput& frame)
{
    TracedScene scene;
    const HairParams params = device_params(frame.params);
    scene.fibre = {params.look_roughness, params.look_azimuthal_roughness, params.look_scale_tilt, params.look_ior};
    scene.lighting = frame.lighting;
    add_strands(scene, frame, params);

    const StepInfo& info = frame.simulation->solver().info();
    const glm::mat3 turn = glm::transpose(glm::mat3(vec(info.head_row0), vec(info.head_row1), vec(info.head_row2)));
    add_head(scene, frame, params, turn);
    add_obstacles(scene, frame);
    for (const Ring& ring : rings_of(frame))
    {
        const std::vector<float> corners = corners_of(ring.band);
        const glm::mat3 on = ring.on_head ? turn : glm::mat3(1.0f);
        add_triangles(scene, band_triangles());
        for (size_t i = 0; i < corners.size(); i += 7)
        {
            scene.position.push_back(on * glm::vec3(corners[i], corners[i + 1], corners[i + 2]));
            scene.normal.push_back(on * glm::vec3(corners[i + 3], corners[i + 4], corners[i + 5]));
            scene.albedo.push_back(ring.color);
        }
    }

    scene.gloss.resize(scene.position.size(), 0.0f); // skin alone is glossy

    if (const std::optional<Ground> ground = ground_of(frame))
        scene.ground = {glm::dvec3(ground->moved + glm::vec3(0.0f, ground->height, 0.0f)), ground->radius,
                        ground->albedo};

    const glm::dvec3 origin = frame.simulation->solver().head().origin;
    scene.eye = frame.camera.position() - origin;
    scene.forward = glm::normalize(frame.camera.target - frame.camera.position());
    scene.right = glm::normalize(glm::cross(scene.forward, glm::dvec3(0, 1, 0)));
    scene.up = glm::cross(scene.right, scene.forward);
    scene.tangent = std::tan(0.5 * frame.camera.fov);
    scene.lens = 0.5e-3 * params.camera_aperture;
    scene.focus = params.camera_focus > 0.0f ? double(params.camera_focus) : frame.camera.distance;
    return scene;
}

Hash hash_of(const TracedScene& scene)
{
    Hash hash;
    const auto add = [&](const auto& values) { hash.add(values.data(), values.size() * sizeof(values[0])); };
    add(scene.curve);
    add(scene.absorption);
    add(scene.position);
    add(scene.normal);
    add(scene.albedo);
    add(scene.gloss);
    add(scene.triangles);
    for (const Sun& sun : scene.lighting.suns)
        add(std::vector<float>{sun.direction.x, sun.direction.y, sun.direction.z, sun.irradiance.x, sun.irradiance.y,
                               sun.irradiance.z, sun.radius});
    const glm::vec3 sky = scene.lighting.sky;
    const FibreLook& f = scene.fibre;
    add(std::vector<double>{double(scene.points), f.roughness, f.azimuthal, f.tilt, f.ior, sky.x, sky.y, sky.z});
    for (const glm::dvec3& v :
         {scene.eye, scene.right, scene.up, scene.forward, scene.ground.middle, scene.ground.albedo})
        add(std::vector<double>{v.x, v.y, v.z});
    add(std::vector<double>{scene.tangent, scene.lens, scene.focus, scene.ground.radius});
    return hash;
}

} // namespace coif

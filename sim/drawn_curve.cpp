#include "sim/drawn_curve.h"

#include "sim/exchange/targets.h"
#include "sim/scatter.h"
#include "sim/shaping.h"
#include "sim/tied_hair.h"
#include "sim/wave.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

// kernels/ribbon.h in C++: what the renderer lays on a strand is said once for all languages.
namespace ribbon
{
using glm::clamp, glm::max, glm::mix, glm::smoothstep, glm::step;
using std::cos, std::exp, std::floor, std::sin, std::sqrt;

static float wave_at(const std::vector<float>& table, size_t side, float place)
{
    const float at = (place - floor(place)) * float(kWaveSamples) - 0.5f, below = floor(at);
    const size_t first = size_t(int(below) & (kWaveSamples - 1)), second = (first + 1) & (kWaveSamples - 1);
    return mix(table[2 * first + side], table[2 * second + side], at - below);
}

#define CURVE_FUNCTION [[maybe_unused]] static inline
#define REAL float
#define REAL4 float4
#define WHOLE int
#define BITS uint32_t
#define FLOAT4(x, y, z, w) F4(x, y, z, w)
#define TO_INT(v) int(v)
#define TO_UINT(v) uint32_t(v)
#define TO_FLOAT(v) float(v)
#define STRUCT(name) struct name
#define WITH_STYLE const HairParams &params, const std::vector<float>&wave_table,
#define STYLE(name) params.name
#define POWER(x, y) std::pow(x, y)
#define WAVE_NORMAL(place) wave_at(wave_table, 0, place)
#define WAVE_BINORMAL(place) wave_at(wave_table, 1, place)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include "kernels/ribbon.h"
#pragma GCC diagnostic pop

struct Look
{
    float4 root_color, tip_color; // linear
    float width;                  // m
    Waves laid;
    Braid braid;
};
} // namespace ribbon

namespace
{
// All drawn strands of a moment, in the host's hands.
struct DrawnNow
{
    explicit DrawnNow(const Simulation& simulation)
        : groom(simulation.solver().groom()), params(device_params(simulation.params())),
          waves(wave_table(simulation.params())), braids(braid_values(groom)),
          positions(simulation.solver().drawn_positions()), frames(simulation.solver().drawn_frames())
    {
    }
    const Groom& groom;
    const HairParams params;
    const std::vector<float> waves;
    const std::vector<float4> braids;
    const Mapped positions, frames;
};

// A place along a strand.
struct Place
{
    int segment; // from this node to the next
    float t;
    float along; // 0 at the root, 1 at the tip
};
} // namespace

static glm::vec3 vec(const float4& v) { return {v.x, v.y, v.z}; }

static ribbon::Look look_of(const DrawnNow& now, size_t strand)
{
    const HairParams& p = now.params;
    ribbon::Look look = {p.look_root_color, p.look_tip_color, p.look_width, {}, {}};
    const int own = int(strand) + 7919 * p.interpolation_seed;
    look.laid = {p.wave_normal_amplitude,
                 p.wave_normal_frequency,
                 p.wave_binormal_amplitude,
                 p.wave_binormal_frequency,
                 p.curl_radius,
                 p.frizz_amount,
                 own,
                 own,
                 0.0f};
    if (!now.groom.looks.empty())
    {
        const StrandLook& l = now.groom.looks[strand];
        const int seed = int(l.own.x);
        look.root_color = l.root_color;
        look.tip_color = l.tip_color;
        look.width = l.root_color.w;
        look.laid = {l.wave.x, l.wave.y, l.wave.z, l.wave.w, l.own.y, l.own.z, seed, seed, 0.0f};
    }
    if (look.laid.curl > 0.0f)
    {
        look.laid.curl_begin = p.curl_phase * ribbon::strand_random(look.laid.own, RANDOM_CURL_PHASE);
        if (p.clump_strength > 0.0f)
        {
            look.laid.together = now.groom.drawn[strand].leader + 7919 * p.interpolation_seed;
            look.laid.curl_begin += ribbon::strand_random(look.laid.together, RANDOM_CURL_TOGETHER);
        }
    }
    if (3 * strand < now.braids.size())
        look.braid = ribbon::braid_of(now.braids[3 * strand], now.braids[3 * strand + 1], now.braids[3 * strand + 2]);
    return look;
}

// shaders/strand.geom's curve_at(), laid_on() and plaited().
static glm::vec3 curve_at(const DrawnNow& now, const ribbon::Look& look, size_t strand, const Place& place)
{
    const int nodes = now.groom.nodes, k = place.segment;
    const float t = place.t;
    const float4 *p = now.positions.as<float4>() + strand * size_t(nodes),
                 *n = now.frames.as<float4>() + strand * size_t(nodes);
    const glm::vec3 a = vec(p[k - 1]), b = vec(p[k]), c = vec(p[k + 1]), d = vec(p[std::min(k + 2, nodes - 1)]);
    const float4 w = ribbon::curve_weights(now.params.smoothing_curve, t);
    glm::vec3 at = w.x * a + w.y * b + w.z * c + w.w * d;
    const bool waved = ribbon::has_waves(look.laid), braided = look.braid.pitch > 0.0f;
    if (!waved && !braided)
        return at;
    glm::vec3 tangent = glm::mix(c - a, d - b, t);
    tangent /= std::sqrt(std::max(glm::dot(tangent, tangent), 1e-20f));
    glm::vec3 normal = glm::mix(vec(n[k]), vec(n[k + 1]), t);
    normal -= tangent * glm::dot(normal, tangent);
    normal /= std::sqrt(std::max(glm::dot(normal, normal), 1e-20f));
    const glm::vec3 binormal = glm::cross(tangent, normal);
    if (waved)
    {
        const float4 across =
            ribbon::laid_across(now.params, now.waves, look.laid, place.along, glm::mix(n[k].w, n[k + 1].w, t));
        at += ribbon::profile_at(now.params.wave_along, place.along) * (normal * across.x + binormal * across.y);
    }
    if (braided)
    {
        const float4 by = ribbon::braid_at(look.braid, place.along);
        at += by.x * normal + by.y * binormal + by.z * tangent;
    }
    return at;
}

static std::vector<Place> places_of(int nodes, int pieces)
{
    std::vector<Place> places = {{1, 0.0f, 0.0f}};
    for (int k = 1; k < nodes - 1; ++k)
        for (int i = 1; i <= pieces; ++i)
        {
            const float t = float(i) / float(pieces);
            places.push_back({k, t, (float(k - 1) + t) / float(nodes - 2)});
        }
    return places;
}

Taken taken(const Simulation& simulation, bool guides, int points)
{
    constexpr float kStray = 5e-4f; // m
    constexpr int kMostPoints = 128;
    Taken wanted{guides, points, 1};
    const int nodes = simulation.solver().groom().nodes;
    if (guides)
        return wanted;
    const DrawnNow now(simulation);
    const float4* frames = now.frames.as<float4>();
    float most = 0.0f;
    for (size_t s = 0; s < now.groom.drawn.size(); ++s)
    {
        const ribbon::Look look = look_of(now, s);
        for (int k = 1; k < nodes - 1; ++k)
        {
            const float4* n = frames + s * size_t(nodes) + size_t(k);
            const float segment = n[1].w - n[0].w, along = float(k - 1) / float(nodes - 2);
            float stray = 0.0f;
            if (ribbon::has_waves(look.laid))
                stray +=
                    ribbon::waves_stray(now.params, now.waves, look.laid, segment, along + 0.5f / float(nodes - 2));
            if (look.braid.pitch > 0.0f)
                stray += ribbon::braid_stray(look.braid, segment, along + 1.0f / float(nodes - 2));
            if (std::isfinite(stray))
                most = std::max(most, stray);
        }
    }
    wanted.pieces = std::clamp(int(std::ceil(std::sqrt(most / kStray))), 1, std::max(1, kMostPoints / (nodes - 2)));
    if (points > 0 || now.params.smoothing_curve == CURVE_CUBIC) // points at equal lengths lie on the curve
        wanted.pieces = std::max(wanted.pieces, 4);
    return wanted;
}

static size_t strands_of(const Groom& groom, bool guides) { return guides ? size_t(groom.guides) : groom.drawn.size(); }

static int points_of(const Groom& groom, const Taken& taken)
{
    return taken.points > 0 ? taken.points : (groom.nodes - 2) * taken.pieces + 1;
}

void positions_of(const Simulation& simulation, const Taken& taken, std::vector<glm::vec3>& position)
{
    const Solver& solver = simulation.solver();
    const Groom& groom = solver.groom();
    const glm::dvec3 origin = solver.head().origin;
    position.clear();
    position.reserve(strands_of(groom, taken.guides) * size_t(points_of(groom, taken)));
    std::vector<glm::vec3> strand;
    const auto take = [&]()
    {
        for (const glm::vec3& p : taken.points > 0 ? resampled(strand, taken.points) : strand)
            position.push_back(glm::vec3(origin + glm::dvec3(p)));
        strand.clear();
    };
    if (taken.guides)
    {
        const Mapped guides = solver.guide_positions();
        for (int g = 0; g < groom.guides; ++g)
        {
            for (int k = 1; k < groom.nodes; ++k)
                strand.push_back(glm::vec3(vector_at(guides.as<float>(), g, k, groom.nodes)));
            take();
        }
        return;
    }
    const DrawnNow now(simulation);
    const std::vector<Place> places = places_of(groom.nodes, taken.pieces);
    for (size_t s = 0; s < groom.drawn.size(); ++s)
    {
        const ribbon::Look look = look_of(now, s);
        for (const Place& place : places)
            strand.push_back(curve_at(now, look, s, place));
        take();
    }
}

static glm::vec2 root_uv(const glm::vec3& root, const glm::vec3& center)
{
    const glm::vec3 out = root - center;
    const float across = std::hypot(out.x, out.z);
    if (!(across > 1e-9f))
        return {0.5f, 0.5f};
    const float far = 0.5f * std::atan2(across, out.y) / std::numbers::pi_v<float>;
    return {0.5f + far * out.x / across, 0.5f - far * out.z / across};
}

// Groups by name: two regions of one name are one.
static void add_group(Curves& curves, const std::string& name)
{
    const auto known = std::ranges::find(curves.group_name, name);
    curves.group.push_back(int32_t(known - curves.group_name.begin()));
    if (known == curves.group_name.end())
        curves.group_name.push_back(name);
}

Curves curves_of(const Simulation& simulation, const Taken& taken)
{
    Curves curves;
    const Groom& groom = simulation.solver().groom();
    const size_t strands = strands_of(groom, taken.guides), points = size_t(points_of(groom, taken));
    positions_of(simulation, taken, curves.position);
    curves.count.assign(strands, uint32_t(points));
    curves.guide.assign(strands, taken.guides);
    const Scalp scalp = guide_scalp(simulation.assets().scalp, simulation.params());
    const HostParams& host = simulation.style().host;
    const Shaping shaping = shape_over(simulation.params(), host, simulation.assets().scalp, scalp);
    const bool varied = varies(host);
    const HairParams plain = device_params(simulation.params());
    const DrawnNow now(simulation);
    for (size_t s = 0; s < strands; ++s)
    {
        curves.id.push_back(int32_t(s));
        ScalpPlace place;
        glm::vec3 root;
        ribbon::Look look;
        if (taken.guides)
        {
            root = glm::vec3(vector_at(groom.root_position.data(), int(s), 0, 1));
            place = at_vertex(scalp, s);
            const HairParams own = varied ? device_params(params_at(shaping, place)) : plain;
            look = {own.look_root_color, own.look_tip_color, own.look_width, {}, {}};
            look.laid.own = int(s) + 7919 * plain.interpolation_seed;
        }
        else
        {
            const DrawnStrand& strand = groom.drawn[s];
            root = vec(strand.root);
            place = at_vertex(scalp, size_t(strand.guide0)); // as the guide that it follows most
            look = look_of(now, s);
        }
        curves.root_uv.push_back(root_uv(root, groom.center));
        const float bright = ribbon::brightness_of(plain, now.waves, look.laid.own);
        curves.brightness.push_back(bright);
        for (size_t k = 0; k < points; ++k)
        {
            const float along = float(k) / float(points - 1);
            curves.width.push_back(std::max(0.0f, ribbon::ribbon_width(plain, now.waves, look.width, along)));
            curves.color.push_back(bright * glm::mix(vec(look.root_color), vec(look.tip_color),
                                                     ribbon::profile_at(plain.look_color_along, along)));
        }
        if (host.regions.empty())
            continue;
        const Region* last = nullptr;
        for (size_t r = 0; r < host.regions.size(); ++r)
            if (region_weight(shaping, r, place) > 0.5f)
                last = &host.regions[r];
        add_group(curves, last ? last->name : kHairName);
    }
    return curves;
}

} // namespace coif

#include "sim/simulation.h"

#include "sim/error.h"
#include "sim/exchange/place.h"
#include "sim/material.h"
#include "sim/rest_shape.h"
#include "sim/scatter.h"
#include "sim/shaping.h"
#include "sim/shown.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

// m: hair does not follow hollows of less than this radius, ears above all.
static constexpr float kHollow = 0.035f;

// What is edited must do as what is read: a style that no longer opens would be lost work.
static void check_lists(const Hairstyle& style, const Scalp& scalp)
{
    for (const ParamInfo& info : param_table())
        if (info.kind == Kind::LIST)
            for (size_t i = 0; i < list_size(style.host, info); ++i)
                placed(style, fmt::format("{}[{}]", info.group, i), [&] { check_entry(style.host, info, i, scalp); });
}

Assets load_assets(const Hairstyle& style)
{
    Assets assets;
    const auto load = [&](const char* key, const std::string& written, auto&& read)
    {
        const std::filesystem::path file = named_file(style, key, written);
        return placed(style, key, [&] { return read(file); });
    };
    if (style.host.scalp_mesh.empty())
        throw fail("{}: scalp.mesh must name an OBJ",
                   style.places.contains("scalp.mesh") ? style.places.at("scalp.mesh") : style.name());
    assets.scalp = load("scalp.mesh", style.host.scalp_mesh, load_scalp);
    if (style.params.interpolation_refine > most_refinements(assets.scalp))
        placed(style, "interpolation.refine", [&] { return refined(assets.scalp, style.params.interpolation_refine); });
    if (const auto& rest = style.host.groom_rest.shapes)
        placed(style, "groom.rest", [&] { check_shapes(*rest, assets.scalp); });
    check_lists(style, assets.scalp);
    if (!style.host.groom_import.empty())
    {
        if (style.host.groom_rest.shapes)
            placed(style, "groom.rest",
                   [] { throw fail("groom.rest and groom.import both say how hair lies: take one of them out"); });
        assets.scalp.hair = load("groom.import", style.host.groom_import,
                                 [&](const std::filesystem::path& file) {
                                     return std::make_shared<const PlacedHair>(
                                         place_hair(read_hair_file(file), assets.scalp, style.params));
                                 });
    }
    if (!style.host.head_mesh.empty())
        assets.head = load("head.mesh", style.host.head_mesh,
                           [&](const std::filesystem::path& file)
                           { return upright(load_mesh(file), style.params.head_unit, style.params.head_up); });
    if (!style.host.head_spheres.empty())
        assets.spheres = load("head.spheres", style.host.head_spheres, load_colliders);
    else
        assets.spheres = {{assets.scalp.center, assets.scalp.radius, true, {}}};
    assets.lights = named_lights(style);
    return assets;
}

std::string doubtful_size(const HairParams& params, const Assets& assets)
{
    const double scalp = double(assets.scalp.extent) * double(params.head_scale);
    if (scalp > 2.0 || scalp < 0.02)
        return fmt::format("the scalp is {:.3g} m across: coif takes the OBJ's numbers for metres", scalp);
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3& p : assets.head.positions)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    if (assets.head.positions.empty())
        return {};
    const glm::vec3 size = (high - low) * params.head_mesh_scale * params.head_scale;
    const double head = double(std::max({size.x, size.y, size.z}));
    // A head alone is little larger than its scalp, a whole body ten times.
    if (head > 0.5 * scalp && head < 20.0 * scalp)
        return {};
    return fmt::format(
        "the head's mesh is {:.3g} m in size, the scalp {:.2g} m: head.unit says whether its numbers are "
        "m, cm, mm, inch or foot, where the file does not",
        head, scalp);
}

PlacedGrid head_grid(const Hairstyle& style, Assets& assets)
{
    const HairParams& p = style.params;
    if (p.head_contact != 0 || assets.head.triangles.empty())
        return {};
    if (assets.distances.empty())
        assets.distances = cached_distance_grid(assets.head, cache_folder());
    if (assets.distances.empty())
        return {};
    if (p.head_mesh_scale != assets.grid_scale)
        assets.grid = std::make_shared<const DistanceGrid>(body_grid(assets.distances, kHollow / p.head_mesh_scale));
    assets.grid_scale = p.head_mesh_scale;
    // As app/renderer_upload.cpp places the mesh.
    return {assets.grid, p.head_mesh_scale * p.head_scale,
            glm::vec3(p.head_offset.x, p.head_offset.y, p.head_offset.z) * p.head_scale};
}

std::vector<Collider> all_colliders(const Hairstyle& style, const Assets& assets, bool grid)
{
    const HairParams& p = style.params;
    const bool own = style.host.head_spheres.empty(); // fitted to the scalp: where the mesh lies does not matter
    const glm::vec3 offset = own ? glm::vec3(0.0f) : glm::vec3(p.head_offset.x, p.head_offset.y, p.head_offset.z);
    std::vector<Collider> all;
    for (Collider body : assets.spheres)
    {
        if (grid)
            break;
        body.center = (body.center + offset) * p.head_scale;
        if (body.to)
            body.to = (*body.to + offset) * p.head_scale;
        body.radius *= p.head_scale;
        body.on_head = true;
        all.push_back(body);
    }
    all.insert(all.end(), style.host.colliders.begin(), style.host.colliders.end());
    return all;
}

TieGround tie_ground(const Hairstyle& style, const Assets& assets, const PlacedGrid& grid)
{
    std::vector<Collider> spheres = all_colliders(style, assets, grid.grid != nullptr);
    spheres.resize(spheres.size() - style.host.colliders.size()); // the style's own may come and go
    return {grid, spheres};
}

Groom grown(const Hairstyle& style, Assets& assets)
{
    check_lists(style, assets.scalp);
    const Scalp scalp = guide_scalp(assets.scalp, style.params);
    const Shaping shaping = shape_over(style.params, style.host, assets.scalp, scalp);
    Groom groom = grow(shaping);
    if (style.host.ties.empty())
        return groom;
    const TieGround ground = tie_ground(style, assets, head_grid(style, assets));
    const TieRoots roots = tie_roots(groom, shaping);
    for (size_t i = 0; i < style.host.ties.size(); ++i)
        placed(style, fmt::format("tie[{}]", i), [&] { check_tie(groom, shaping, i, roots, ground); });
    tie_hair(groom, shaping, roots, ground);
    return groom;
}

std::string doubtful_ties(const Hairstyle& style, const Groom& groom)
{
    std::string said;
    for (size_t i = 0; i < groom.short_of_ring.size(); ++i)
        if (groom.short_of_ring[i] > 0)
            said +=
                fmt::format("{}tie '{}': {} simulated strands are too short to come through its ring and hang loose",
                            said.empty() ? "" : "; ", shown(style.host.ties[i].name), groom.short_of_ring[i]);
    return said;
}

static bool same_group(const char* group, const Hairstyle& a, const Hairstyle& b)
{
    return std::ranges::all_of(param_table(), [&](const ParamInfo& info)
                               { return info.group != std::string_view(group) || same_value(a, b, info); });
}

// Do the shapes or the pigments that strands are grown with differ, or is there now something to grow that there was
// not?
static bool grown_otherwise(const Hairstyle& a, const Hairstyle& b)
{
    const bool melanin = a.params.look_pigment != 0 || b.params.look_pigment != 0;
    if (melanin && varies(b.host) &&
        (a.params.look_pigment != b.params.look_pigment ||
         a.params.look_root_darkening != b.params.look_root_darkening ||
         a.params.look_azimuthal_roughness != b.params.look_azimuthal_roughness))
        return true; // each strand has dye colours of its own
    const bool waves = waves_are_shape(a.params), curls = curls_are_shape(a.params);
    return waves != waves_are_shape(b.params) || curls != curls_are_shape(b.params) ||
           ((waves || curls) && !same_group("wave", a, b)) || (curls && !same_group("curl", a, b)) ||
           has_clumps(a.params) != has_clumps(b.params);
}

Simulation::Simulation(const Device& device, Hairstyle style, Falling falling)
    : device_(device), falling_(std::move(falling)), authored_(std::move(style))
{
    assets_ = load_assets(authored_);
    style_ = lit(meet_tolerance(device_, authored_, assets_, quality_), assets_.lights);
    solver_ = std::make_unique<Solver>(device_, style_.params, grown(style_, assets_), hand_);
    set_bodies(style_);
    drape();
}

void Simulation::set_bodies(const Hairstyle& style)
{
    const PlacedGrid grid = head_grid(style, assets_);
    solver_->set_body(grid);
    solver_->set_colliders(all_colliders(style, assets_, grid.grid != nullptr));
}

// Does a file say how hair lies at rest?
static bool is_stored(const Hairstyle& style)
{
    return style.host.groom_rest.shapes || !style.host.groom_import.empty();
}

// Lets hair fall to where it rests, and begins there: nothing sags when it is first seen. First in air thick enough to
// stop it soon and on slippery bodies, so that what friction holds later it holds with some to spare; then as it is.
// What hair holds of that shape (bending.hold) it finds again with its own weight on it.
void Simulation::drape()
{
    solver_->let_blocks_sleep(true);
    if (style_.params.solver_kind != 0 || is_stored(style_)) // that is where it rests
        return;
    solver_->let_blocks_sleep(false);           // where hair comes to lie is looked for more closely
    constexpr int kLookEvery = 16, kMost = 320; // steps
    constexpr double kThick = 15.0;             // 1/s: near critical for the slowest swing of 0.2 m
    HairParams own = style_.params;
    own.solver_courant = std::max(own.solver_courant, 1.0f); // where hair rests does not hang on the substeps
    HairParams thick = own;
    thick.forces_drag = std::max(thick.forces_drag, float(kThick));
    thick.forces_friction *= 0.5f;
    const double longest = double(solver_->groom().longest); // m
    const float4& wind = own.forces_wind;
    const bool windy = wind.x != 0.0f || wind.y != 0.0f || wind.z != 0.0f;
    const bool gusts = own.forces_turbulence > 0.0f && windy;
    const double calm = (gusts ? 0.01 : 0.001) * longest; // m/s: they move it anyhow
    // Wind, or a strand that jerks between bodies, lets hair never rest: it has fallen as far as it will once it gets
    // no calmer. What falls twice its length through that air, at the same speed all the way, must not seem so; nor,
    // where no wind blows, a strand that gives way slowly under another's push and then at once.
    const double fall = 2.0 * longest * kThick / std::max(kGravity * std::abs(double(own.forces_gravity)), 1e-3); // s
    const int patience = int(std::clamp(60.0 * fall, windy ? 80.0 : 160.0, double(kMost)));
    const int falls = style_.params.bending_hold == 0.0f ? 2 : 4;
    for (int f = 0; f < falls; ++f)
    {
        solver_->set_params(f % 2 ? own : thick);
        solver_->fastest();
        double calmest = INFINITY; // m/s
        for (int i = 1, since = 0; i <= kMost && since < patience; ++i, ++since)
        {
            if (falling_ && (i - 1) % kLookEvery == 0)
                falling_((f + (i - 1.0) / kMost) / falls);
            solver_->step({{hand_, time_, 1.0f / 60.0f}});
            if (i % kLookEvery)
                continue;
            solver_->take_times(); // lets the queue's uploads go
            const double fastest = solver_->fastest();
            if (fastest < calm)
                break;
            if (fastest < 0.9 * calmest)
            {
                calmest = fastest;
                since = 0;
            }
        }
        if (f % 2 == 0)
            continue;
        Groom groom = solver_->groom();
        const Mapped position = solver_->guide_positions();
        groom.rest_position = in_head_frame(position.as<float>(), groom, hand_.turn);
        groom.rest_multiplier = solver_->multipliers();
        solver_->set_groom(groom);
    }
    solver_->set_params(style_.params);
    solver_->let_blocks_sleep(true);
    solver_->take_times();
    if (falling_)
        falling_(1.0);
}

// Does nothing differ that what a tolerance asks for hangs on?
static bool same_hair(const Hairstyle& a, const Hairstyle& b)
{
    return std::ranges::all_of(param_table(),
                               [&](const ParamInfo& info)
                               {
                                   const bool seen_only =
                                       (info.effect == Effect::VIEW && info.path() != "smoothing.subdivisions") ||
                                       info.group == std::string_view("look");
                                   return seen_only || same_value(a, b, info);
                               });
}

void Simulation::set_style(const Hairstyle& authored, bool reload)
{
    const bool meshes = reload || authored.params.head_unit != authored_.params.head_unit ||
                        authored.params.head_up != authored_.params.head_up ||
                        std::ranges::any_of(param_table(),
                                            [&](const ParamInfo& info)
                                            {
                                                const bool loaded =
                                                    (info.kind == Kind::TEXT && info.path() != "look.lights") ||
                                                    info.path().starts_with("groom.import");
                                                return loaded && !same_value(authored, authored_, info);
                                            });
    Assets fresh = meshes ? load_assets(authored) : Assets{}; // may throw; nothing has changed yet
    std::optional<LightRig> lights = meshes ? fresh.lights : assets_.lights;
    if (!meshes && authored.host.look_lights != authored_.host.look_lights)
        lights = named_lights(authored);
    Quality quality = quality_;
    Hairstyle style = authored;
    if (reload || !same_hair(authored, authored_))
    {
        thin_error_.reset(); // measured anew when it matters
        solver_->set_thin_error({});
    }
    if (reload || !same_hair(authored, authored_))
        style = meet_tolerance(device_, authored, meshes ? fresh : assets_, quality);
    else
        for (const char* kept : kTolerant)
            if (!quality_.rungs.empty())
                copy_value(style_, style, *find_param(kept));
    style = lit(std::move(style), lights);
    bool regrow = reload;
    const bool varied = varies(style.host); // then each root has its own of what may vary
    for (const ParamInfo& info : param_table())
        regrow |= !same_value(style, style_, info) && ((info.effect != Effect::LIVE && info.effect != Effect::VIEW) ||
                                                       (varied && info.scope == Scope::STRAND));
    regrow |= grown_otherwise(style, style_);
    // Held hair is laid in segments of the length that spacing gives them.
    regrow |= !style.host.ties.empty() && style.params.strand_spacing != style_.params.strand_spacing;
    bool refall = false;
    if (regrow)
    {
        Groom groom = grown(style, meshes ? fresh : assets_);
        const Groom& old = solver_->groom();
        // Strands that go on where they are begin again, if ever, where they did.
        const bool held = style.params.bending_hold > 0.0f || style_.params.bending_hold > 0.0f;
        const bool stored = is_stored(style) || is_stored(style_);
        refall = groom.guides != old.guides || groom.nodes != old.nodes ||
                 (held && style.params.solver_kind == 0 && !stored);
        if (!refall && groom.rest_position.empty())
        {
            keep_rest(groom, old);
        }
        solver_->set_groom(groom);
    }
    solver_->set_params(style.params);
    if (meshes)
        assets_ = std::move(fresh);
    assets_.lights = std::move(lights);
    set_bodies(style);
    if (style.params.solver_rate != style_.params.solver_rate)
    {
        rate_since_ = time_; // time goes on from here at the new rate
        steps_since_ = steps_;
    }
    authored_ = authored;
    style_ = style;
    quality_ = quality;
    if (refall)
    {
        solver_->reset(solver_->head());
        drape();
    }
}

void Simulation::set_view(const View& view)
{
    solver_->set_view(view);
    if (!thin_error_ && solver_->may_be_far())
        thin_error_ = measure_thin_error(device_, style_.params, *solver_);
    solver_->set_thin_error(thin_error_);
}

void Simulation::reload_lights()
{
    if (authored_.host.look_lights.empty())
        return;
    std::optional<LightRig> fresh = named_lights(authored_);
    style_ = lit(std::move(style_), fresh);
    assets_.lights = std::move(fresh);
    solver_->set_params(style_.params);
}

void Simulation::play(std::optional<Motion> motion)
{
    if (motion_)
    {
        // The head stays where the script has brought it.
        const Pose wind_free = {solver_->head().origin, solver_->head().turn, glm::dvec3(0.0)};
        hand_ = wind_free;
    }
    motion_ = std::move(motion);
    motion_time_ = 0.0;
}

double Simulation::step_seconds() const { return 1.0 / double(style_.params.solver_rate); }

void Simulation::step(const Pose& hand)
{
    const double h = step_seconds();
    const int substeps = std::max(1, int(std::ceil(h * 60.0 - 1e-6)));
    // A leap of the hand is one, however the step is cut: all of it comes in the first substep.
    const double angle = 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(hand_.turn, hand.turn))));
    const bool leap = glm::distance(hand_.origin, hand.origin) > 0.25 || angle > std::numbers::pi / 2.0;
    const auto head_at = [&, from = hand_](double share)
    {
        Pose pose;
        pose.origin = glm::mix(from.origin, hand.origin, leap ? 1.0 : share);
        pose.turn = glm::slerp(from.turn, hand.turn, leap ? 1.0 : share);
        return motion_ ? pose * pose_at(*motion_, motion_time_ + h * share) : pose;
    };
    std::vector<Substep> all;
    for (int i = 1; i <= substeps; ++i)
    {
        const double share = double(i) / substeps;
        const auto way = [&head_at, i, substeps](double within) { return head_at((i - 1 + within) / substeps); };
        all.push_back({head_at(share), time_ + h * share, float(h / substeps), way});
    }
    solver_->step(all);
    hand_ = hand;
    ++steps_;
    time_ = rate_since_ + double(steps_ - steps_since_) * h; // not summed up: a million steps must not drift
    motion_time_ += h;
    if (motion_ && motion_time_ > motion_->seconds)
        play(std::nullopt);
}

int Simulation::advance(double seconds, const Pose& hand, int most)
{
    const double h = step_seconds();
    owed_ += std::isfinite(seconds) ? std::clamp(seconds, 0.0, 3600.0) : 0.0;
    const long due = long(owed_ / h + 1e-9);
    const int taken = int(std::min<long>(due, most));
    owed_ -= double(due) * h;
    const Pose from = hand_;
    bool with_hand = true;
    for (int i = 1; i <= taken; ++i)
    {
        const bool played = playing();
        const double share = double(i) / taken;
        step(with_hand ? Pose{glm::mix(from.origin, hand.origin, share), glm::slerp(from.turn, hand.turn, share), {}}
                       : hand_);
        with_hand &= played == playing(); // a script that ends has moved the hand's frame
    }
    if (!solver_->asleep()) // steps of hair that sleeps would have been nothing
        dropped_ += due - taken;
    return taken;
}

void Simulation::settle(double seconds)
{
    const std::optional<Motion> motion = std::exchange(motion_, std::nullopt);
    for (double t = 0.0; t < seconds; t += step_seconds())
    {
        step(hand_);
        if (steps_ % 16 == 0)
            solver_->take_times(); // lets the queue's uploads go
    }
    motion_ = motion;
}

StrandShapes Simulation::shapes() const
{
    const Mapped position = solver_->guide_positions();
    StrandShapes shapes = shapes_of(in_head_frame(position.as<float>(), solver_->groom(), solver_->head().turn),
                                    solver_->groom(), style_.params.head_scale);
    shapes.position.resize(assets_.scalp.positions.size() * size_t(shapes.nodes)); // a refined scalp's own come first
    return shapes;
}

StrandShapes Simulation::rest_shapes() const
{
    StrandShapes shapes = shapes_of(solver_->rest_positions(), solver_->groom(), style_.params.head_scale);
    shapes.position.resize(assets_.scalp.positions.size() * size_t(shapes.nodes));
    return shapes;
}

void Simulation::reset() { solver_->reset(solver_->head()); }

} // namespace coif

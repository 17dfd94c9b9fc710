// What a change of the style does to hair that is alive: no slider is dead, none acts late, and a change that fails is
// none.
#include "sim/error.h"
#include "sim/health.h"
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace coif
{
namespace
{

using Bytes = std::map<std::string, std::vector<uint8_t>>;

Hairstyle busy_style()
{
    // In which every parameter has something to act on. Without the head's mesh, which hair never reads.
    Hairstyle style;
    for (const char* set : {"head.mesh=", "interpolation.strands=60", "grid.resolution=20", "grid.blur=0.05",
                            "forces.wind=[3, 0, 1]", "forces.repulsion=1", "wave.normal_amplitude=0.01",
                            "wave.binormal_amplitude=0.008", "interpolation.layer=0.01", "curl.radius=0.005",
                            "frizz.amount=0.002", "flyaway.share=0.2", "clump.strength=0.5", "clump.size=0.06"})
        assign(style, set);
    return style;
}

Bytes after_a_step(Simulation& simulation)
{
    simulation.step(simulation.hand());
    simulation.solver().draw();
    Bytes bytes;
    for (const char* name : {"position", "drawn_position", "drawn_frame", "depth"})
        bytes[name] = bytes_of(test_device(), simulation.solver().buffers().at(name));
    return bytes;
}

// The busy style with that solver, and with what else the parameter asks for.
Hairstyle style_for(const ParamInfo& info, const std::string& solver)
{
    Hairstyle style = busy_style();
    assign(style, "solver.kind=" + solver);
    if (info.path() == "bending.diameter")
        assign(style, "bending.modulus=4");
    return style;
}

// Another value that the parameter may have, far enough from what it is to be seen.
void set_other(Hairstyle& style, const ParamInfo& info)
{
    // Tension asks for some substeps anyway.
    const std::map<std::string, const char*> far = {{"solver.courant", "0.1"}, {"solver.substeps", "16"}};
    if (const auto found = far.find(info.path()); found != far.end())
        return assign(style, info.path() + "=" + found->second);
    float now[kMostNumbers];
    get_numbers(style.params, info, now);
    double other[kMostNumbers];
    for (int i = 0; i < info.components(); ++i)
        if (info.kind == Kind::INT || info.kind == Kind::CHOICE)
            other[i] = now[i] + (now[i] < info.max ? 1.0 : -1.0);
        else
        {
            const double below = now[i] - info.min, above = info.max - now[i];
            other[i] = below > 0.0 && (below < above || above == 0.0) ? now[i] - 0.5 * below : now[i] + 0.1 * above;
        }
    set_numbers(style.params, info, other);
}

TEST(Style, EverySliderActsInTheNextStepUnderTheSolversThatReadItAndUnderNoOther)
{
    // Of these this hair knows nothing: where the head's mesh is and what it is for, since there is none, how another
    // tool's file is read (tests/host/test_place_hair.cpp), and what only the shaders read of a wave. There is one way
    // yet to choose guides.
    std::set<std::string> elsewhere = read_by_shaders_only();
    elsewhere.insert({"groom.import_up", "groom.import_scale", "groom.import_offset", "groom.import_guides"});
    elsewhere.insert({"head.mesh_scale", "head.unit", "head.up", "interpolation.guides", "head.contact"});
    struct Settled
    {
        std::vector<uint8_t> position, velocity;
        Bytes unchanged;
    };
    std::map<std::pair<int, float>, Settled> settled; // by what the styles that parameters are tried in differ by
    const auto bytes_with = [&](const Hairstyle& from, const Hairstyle& style, const Settled& at)
    {
        Simulation fresh(test_device(), from);
        write(test_device(), fresh.solver().buffers().at("position"), at.position);
        write(test_device(), fresh.solver().buffers().at("velocity"), at.velocity);
        fresh.step(fresh.hand()); // fills the grid
        fresh.set_style(style);
        fresh.set_view({{0.0, 0.0, 1e4}, {0.0, 0.0, -1.0}, 1000.0}); // solver.far_tolerance is of what is far away
        return after_a_step(fresh);
    };
    int acting = 0, idle = 0;
    const auto change = [&](const ParamInfo& info, const std::string& solver)
    {
        const Hairstyle from = style_for(info, solver);
        const bool read = is_read(info, from.params);
        if (read && (info.effect == Effect::VIEW || elsewhere.contains(info.path())))
            return;
        const auto [found, fresh] = settled.try_emplace({from.params.solver_kind, from.params.bending_modulus});
        Settled& at = found->second;
        if (fresh)
        {
            Simulation simulation(test_device(), from);
            simulation.settle(0.5);
            at.position = bytes_of(test_device(), simulation.solver().buffers().at("position"));
            at.velocity = bytes_of(test_device(), simulation.solver().buffers().at("velocity"));
            at.unchanged = bytes_with(from, from, at);
            EXPECT_TRUE(bytes_with(from, from, at) == at.unchanged);
        }
        Hairstyle style = from;
        set_other(style, info);
        EXPECT_EQ(bytes_with(from, style, at) == at.unchanged, !read) << info.path() << " under " << solver;
        ++(read ? acting : idle);
    };
    for (const ParamInfo& info : param_table())
        for (const std::string& solver : param_labels(*find_param("solver.kind")))
            if (!info.on_host())
                change(info, solver);
    EXPECT_GT(acting, 60);
    EXPECT_GT(idle, 10);
    EXPECT_EQ(settled.size(), 4u);
}

TEST(Style, SlidersOfTheWholeHairKeepItsMotionWhereTheyCan)
{
    Simulation simulation(test_device(), busy_style());
    simulation.settle(1.0);
    const auto node = [&](int guide, int k)
    {
        const Mapped x = simulation.solver().guide_positions();
        return x.as<float>()[strand_value(guide, k, 1, simulation.solver().groom().nodes)];
    };
    const float before = node(100, 15);
    Hairstyle style = busy_style();
    assign(style, "root.lift=40"); // REGROW: new roots, but strands hang on from where they are
    simulation.set_style(style);
    EXPECT_EQ(node(100, 15), before);
    assign(style, "strand.nodes=12"); // REBUILD: they start anew
    simulation.set_style(style);
    EXPECT_EQ(simulation.solver().groom().nodes, 12);
    after_a_step(simulation);
    EXPECT_TRUE(std::isfinite(node(100, 11)));
}

TEST(Style, AColourChangesNothingOfTheHair)
{
    Bytes bytes[2];
    for (const bool changed : {false, true})
    {
        Simulation simulation(test_device(), busy_style());
        Hairstyle style = busy_style();
        if (changed)
            for (const char* set :
                 {"look.root_color='#102030'", "look.ambient=1", "camera.yaw=90", "smoothing.curve=linear"})
                assign(style, set);
        simulation.set_style(style);
        bytes[changed] = after_a_step(simulation);
    }
    EXPECT_TRUE(bytes[0] == bytes[1]);
}

TEST(Style, AChangeThatFailsLeavesEverythingAsItWas)
{
    for (const char* wrong :
         {"scalp.mesh='missing.obj'", "head.mesh='missing.obj'", "head.spheres='missing.toml'", "scalp.mesh=''"})
    {
        Simulation untouched(test_device(), busy_style()), tried(test_device(), busy_style());
        for (Simulation* simulation : {&untouched, &tried})
            for (int i = 0; i < 5; ++i)
                simulation->step(simulation->hand());
        Hairstyle style = busy_style();
        for (const char* set : {"strand.nodes=8", "interpolation.strands=10", "grid.resolution=8", "forces.gravity=3"})
            assign(style, set);
        assign(style, wrong);
        EXPECT_THROW(tried.set_style(style), Error) << wrong;
        EXPECT_EQ(tried.style().params.strand_nodes, 16);
        EXPECT_EQ(tried.style().host, busy_style().host);
        EXPECT_EQ(tried.assets().scalp.positions.size(), untouched.assets().scalp.positions.size());
        EXPECT_TRUE(after_a_step(tried) == after_a_step(untouched)) << wrong;
    }
}

TEST(Style, TheHeadsMeshOrItsSpheresStandForIt)
{
    const auto placed = [](std::initializer_list<const char*> sets)
    {
        Hairstyle style;
        assign(style, "interpolation.strands=60");
        for (const char* set : sets)
            assign(style, set);
        style.host.colliders = {{{1.0f, 0.0f, 0.0f}, 0.1f, false, glm::vec3(1.0f, 0.5f, 0.0f)}};
        const Simulation simulation(test_device(), style);
        return std::pair(simulation.solver().placed_colliders().size(), simulation.solver().body());
    };
    const auto [with_grid, body] = placed({"head.scale=2", "head.offset=[0.1, 0, 0]", "head.mesh_scale=0.5"});
    EXPECT_EQ(with_grid, 1u) << "the style's own only";
    ASSERT_TRUE(body.grid);
    EXPECT_EQ(body.scale, 1.0f);
    EXPECT_EQ(body.offset, glm::vec3(0.2f, 0.0f, 0.0f));
    EXPECT_LT(distance_to(body, {0.2f, 0.0f, 0.0f}), -0.05f);
    const auto [with_spheres, none] = placed({"head.contact=spheres"});
    EXPECT_EQ(with_spheres, 36u);
    EXPECT_FALSE(none.grid);
    EXPECT_EQ(placed({"head.mesh="}).first, 36u) << "no mesh to keep out of";
    EXPECT_EQ(placed({"head.mesh=", "head.spheres="}).first, 2u);

    // Changed while it lives.
    Simulation simulation(test_device(), Hairstyle{});
    Hairstyle style;
    assign(style, "head.contact=spheres");
    simulation.set_style(style);
    EXPECT_FALSE(simulation.solver().body().grid);
    EXPECT_EQ(simulation.solver().placed_colliders().size(), 35u);
    simulation.step({});
    simulation.set_style(Hairstyle{});
    EXPECT_TRUE(simulation.solver().body().grid);
    simulation.step({});
    EXPECT_EQ(simulation.solver().info().body_x, simulation.solver().body().grid->size.x);
}

TEST(Style, GuidesAndDrawnStrandsStayOutOfTheHeadWhileItMoves)
{
    Hairstyle style;
    assign(style, "strand.length=0.3");
    Simulation simulation(test_device(), style);
    Health worst;
    for (int i = 1; i <= 60; ++i)
    {
        Pose hand;
        hand.origin = {0.1 * std::sin(0.2 * i), 0.0, 0.0};
        hand.turn = glm::angleAxis(0.7 * std::sin(0.15 * i), glm::dvec3(0, 1, 0));
        simulation.step(hand);
        if (i % 5)
            continue;
        simulation.solver().draw();
        const Health health = measure_health(simulation.solver(), style.params, true);
        worst.penetration_max = std::max(worst.penetration_max, health.penetration_max);
        worst.drawn_penetration_max = std::max(worst.drawn_penetration_max, health.drawn_penetration_max);
        EXPECT_TRUE(health.finite);
    }
    EXPECT_LE(worst.penetration_max, 3e-4);
    EXPECT_LE(worst.drawn_penetration_max, 1e-4);
}

TEST(Style, CollidersComeGoAndMoveWithTheirOwner)
{
    Simulation simulation(test_device(), busy_style());
    const size_t own = simulation.solver().placed_colliders().size();
    Hairstyle style = busy_style();
    style.host.colliders = {{{0.0f, -0.3f, 0.0f}, 0.1f, false}, {{0.1f, -0.2f, 0.0f}, 0.05f, true}};
    simulation.set_style(style);
    Pose hand;
    hand.origin = {0.1, 0.0, 0.0};
    hand.turn = glm::angleAxis(0.5, glm::dvec3(0, 0, 1));
    simulation.step(hand);
    const std::vector<Capsule> placed = simulation.solver().placed_colliders();
    ASSERT_EQ(placed.size(), own + 2);
    EXPECT_NEAR(placed[own].center.x, -0.1, 1e-7) << "one in the world stays there, and the head has moved";
    EXPECT_NEAR(placed[own + 1].center.x, 0.1 * std::cos(0.5) + 0.2 * std::sin(0.5), 1e-7)
        << "one on the head turns with it";
    style.host.colliders.clear();
    simulation.set_style(style);
    simulation.step(hand);
    EXPECT_EQ(simulation.solver().placed_colliders().size(), own);
    EXPECT_EQ(simulation.solver().info().colliders, int(own));
}

} // namespace
} // namespace coif

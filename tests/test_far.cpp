// Hair that is seen from far away steps with half its nodes, and nobody sees it.
#include "kernels/thin.h"
#include "sim/health.h"
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace coif
{
namespace
{

using Vec = glm::dvec3;

Hairstyle style_of(std::initializer_list<const char*> sets)
{
    Hairstyle style;
    for (const char* set : {"interpolation.strands=60", "grid.resolution=20", "look.self_shadow=0"})
        assign(style, set);
    for (const char* set : sets)
        assign(style, set);
    return style;
}

// From straight before the head; the picture has 720 lines.
View from(double distance)
{
    return {{0.0, 0.0, distance}, {0.0, 0.0, -1.0}, 0.5 * 720.0 / std::tan(glm::radians(15.0))};
}

const View kHorizon = from(1e4); // everything is far

std::vector<Vec> nodes_of(const Simulation& simulation)
{
    return nodes_in(test_device(), simulation.solver().buffers().at("position"), simulation.solver().groom());
}

// Root mean square over the nodes that may move, m.
double apart(const std::vector<Vec>& a, const std::vector<Vec>& b, int nodes)
{
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        sum += glm::dot(a[i] - b[i], a[i] - b[i]);
    return std::sqrt(sum / double(a.size()) * nodes / (nodes - 2));
}

bool all_far(const Simulation& simulation)
{
    return simulation.solver().blocks_thin() == simulation.solver().groom().blocks;
}

void expect_sound(const Simulation& simulation, const char* when)
{
    const Health health = measure_health(simulation.solver(), simulation.params(), false);
    EXPECT_TRUE(health.finite) << when;
    EXPECT_LT(health.stretch_max, 1e-3) << when;
    EXPECT_LT(health.penetration_max, 1e-3) << when << ": a tenth of a pixel, where this hair is barely far";
    const std::vector<int> resets = simulation.solver().resets();
    EXPECT_EQ(std::ranges::count(resets, 0), std::ssize(resets)) << when;
}

TEST(Far, WithoutToleranceOrViewNothingChangesAByte)
{
    Simulation plain(test_device(), style_of({})), seen(test_device(), style_of({})),
        unseen(test_device(), style_of({"solver.far_tolerance=1"})),
        near(test_device(), style_of({"solver.far_tolerance=1"}));
    seen.set_view(kHorizon);
    near.set_view(from(0.9));
    for (Simulation* each : {&plain, &seen, &unseen, &near})
    {
        each->play(find_motion("shake"));
        for (int i = 0; i < 20; ++i)
            each->step(each->hand());
        EXPECT_EQ(each->solver().blocks_thin(), 0);
        EXPECT_FALSE(each->solver().buffers().contains("thin_position"));
        EXPECT_EQ(bytes_of(test_device(), each->solver().buffers().at("position")),
                  bytes_of(test_device(), plain.solver().buffers().at("position")));
    }
}

// The step of a thin chain is byte for byte that of a groom with so few nodes, which the plain twin vouches for
// (test_passes_direct.cpp): bodies, waves, wind and all.
TEST(Far, StepsAsAGroomOfSoManyNodes)
{
    for (const int width : {1, 8, 16})
    {
        const Device device = with_width(width);
        Random random(7);
        Groom groom = random_groom(random, 40, 12, 40);
        HairParams params;
        params.bending_droop = 8.0f;
        params.forces_wind = F4(3.0f, 0.0f, 1.0f, 0.0f);
        params.forces_repulsion = 0.0f;
        params.solver_far_tolerance = 20.0f;
        Solver few(device, params, thinned(groom), {});
        groom.bend_factor.assign(size_t(groom.blocks) * LANES, 1.5f);
        Solver all(device, params, groom, {});
        Groom thin = thinned(groom);
        thin.drawn = groom.drawn; // a groom of its own
        few.set_groom(thin);
        all.let_blocks_sleep(true);
        all.set_view(kHorizon);
        all.set_thin_error(0.0);
        double time = 0.0;
        const auto step = [&](Solver& solver, int i)
        {
            const Pose head = {
                {0.02 * std::sin(0.3 * i), 0.0, 0.0}, glm::angleAxis(0.4 * std::sin(0.2 * i), Vec(0, 1, 0)), {}};
            solver.keep_awake();
            solver.step({{head, time = i / 60.0, 1.0f / 60.0f}});
        };
        for (Solver* solver : {&few, &all})
        {
            solver->set_body({lumpy_body(), 1.0f, {}});
            solver->set_colliders({{{0.12f, -0.05f, 0.0f}, 0.05f, false, {}}});
            for (int i = 0; i < 3; ++i)
                step(*solver, i);
        }
        ASSERT_EQ(all.blocks_thin(), groom.blocks);
        const char* state[] = {"position", "velocity", "multiplier"};
        for (const char* name : state)
        {
            const cl::Buffer& to = few.buffers().at(name);
            device.queue.enqueueCopyBuffer(all.buffers().at(std::string("thin_") + name), to, 0, 0,
                                           to.getInfo<CL_MEM_SIZE>());
        }
        for (const char* name : {"pace", "tension"})
            device.queue.enqueueCopyBuffer(all.buffers().at(name), few.buffers().at(name), 0, 0,
                                           all.buffers().at(name).getInfo<CL_MEM_SIZE>());
        for (int i = 3; i < 40; ++i)
            for (Solver* solver : {&few, &all})
                step(*solver, i);
        for (const char* name : state)
            EXPECT_EQ(bytes_of(device, few.buffers().at(name)),
                      bytes_of(device, all.buffers().at(std::string("thin_") + name)))
                << name << ", width " << width;
    }
}

// Each block for itself: the near ones move as if all were near, the far ones as if all were far.
TEST(Far, EachBlockGoesItsOwnWay)
{
    for (const int width : {1, 16})
    {
        const Device device = with_width(width);
        Random random(5);
        const int nodes = 12;
        Groom groom = random_groom(random, 6 * LANES, nodes, 1);
        for (int s = 0; s < groom.guides; ++s) // every other block is short
            groom.segment_length[size_t(s)] *= s / LANES % 2 ? 0.2f : 1.0f;
        HairParams params;
        params.forces_repulsion = 0.0f;
        const double share = 0.1;
        const std::vector<FarBlock> blocks = far_blocks(params, groom);
        const View view = from(5.0);
        params.solver_far_tolerance =
            float(0.5 * (far_error(blocks[0], share, view, {}) + far_error(blocks[1], share, view, {})));
        Solver near(device, params, groom, {}), far(device, params, groom, {}), mixed(device, params, groom, {});
        far.set_view(kHorizon);
        mixed.set_view(view);
        for (Solver* each : {&near, &far, &mixed})
        {
            each->let_blocks_sleep(true);
            each->set_thin_error(share);
            each->set_body({lumpy_body(), 1.0f, {}});
            for (int i = 1; i < 20; ++i)
                each->step({{{{0.001 * i * i, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, {}}, i / 60.0, 1.0f / 60.0f}});
        }
        EXPECT_EQ(near.blocks_thin(), 0);
        EXPECT_EQ(mixed.blocks_thin(), groom.blocks / 2);
        EXPECT_EQ(far.blocks_thin(), groom.blocks);
        const size_t each = size_t(nodes) * 3 * LANES, all = size_t(groom.blocks) * each;
        const auto positions = [&](const Solver& solver)
        { return read<float>(device, solver.buffers().at("position"), all); };
        const std::vector<float> as_near = positions(near), as_far = positions(far), both = positions(mixed);
        EXPECT_NE(as_near, as_far);
        for (size_t i = 0; i < all; ++i)
            EXPECT_EQ(both[i], i / each % 2 ? as_far[i] : as_near[i]) << i;
    }
}

// Who becomes far takes the ways, speeds and tensions of every other node along; who comes near gets back what is
// linear along the strand as it was; nobody else is touched.
TEST(Far, CarriesMotionOver)
{
    for (const int width : {1, 8, 16})
    {
        const Device device = with_width(width);
        Random random(11);
        const int nodes = 12, few = thin_nodes(nodes), guides = 4 * LANES;
        const Groom groom = random_groom(random, guides, nodes, 1);
        const std::vector<int> change = {THIN_NOW, THIN_BEFORE, 0, THIN_NOW | THIN_BEFORE};
        // Linear along the strand: value and slope a node.
        std::vector<Vec> x, v, few_x, few_v;
        std::vector<float> pull(size_t(guides * nodes)), few_pull(size_t(guides * few)), tension(size_t(guides), 8.0f);
        for (int s = 0; s < guides; ++s)
        {
            const Vec root = random.vector(0.1), begin = random.vector(1.0), slope = random.vector(0.2);
            for (int k = 0; k < nodes; ++k)
            {
                x.push_back(root + 0.01 * (k - 1) * Vec(1.0, 0.1 * k, 0.0));
                v.push_back(begin + double(k) * slope);
                pull[size_t((s / LANES * nodes + k) * LANES + s % LANES)] = float(100 + 7 * k);
            }
            for (int k = 0; k < few; ++k)
            {
                few_x.push_back(root);
                few_v.push_back(begin + double(2 * k - 1) * slope);
                // Of the two segments that it is in the place of, 2 k - 2 and 2 k - 1.
                few_pull[size_t((s / LANES * few + k) * LANES + s % LANES)] = float(100 + 7 * (2 * k - 1.5)) / 4.0f;
            }
        }
        HairParams params;
        StepInfo info = {};
        info.guides = guides;
        Buffers buffers = {{"position", filled(device, to_blocks(x, guides, nodes))},
                           {"velocity", filled(device, to_blocks(v, guides, nodes))},
                           {"multiplier", filled(device, pull)},
                           {"thin_position", filled(device, to_blocks(few_x, guides, few))},
                           {"thin_velocity", filled(device, to_blocks(few_v, guides, few))},
                           {"thin_multiplier", filled(device, few_pull)},
                           {"tension", filled(device, tension)},
                           {"still", filled(device, tension)},
                           {"thinned", filled(device, change)},
                           {"segment_length", filled(device, groom.segment_length)},
                           {"params", filled(device, params)},
                           {"info", filled(device, info)}};
        // What is to be made of it must not be there already.
        const auto spoil = [&](const char* name, int block)
        {
            std::vector<float> values = read<float>(device, buffers[name], buffers[name].getInfo<CL_MEM_SIZE>() / 4);
            const size_t each = values.size() / 4;
            std::fill_n(values.begin() + long(size_t(block) * each), each, 1e9f);
            write(device, buffers[name], values);
        };
        for (const char* name : {"thin_position", "thin_velocity", "thin_multiplier"})
            spoil(name, 0);
        for (const char* name : {"velocity", "multiplier"})
            spoil(name, 1);
        Kernel kernel = load_kernel(device, "change_nodes", pass_options(device, nodes, 8));
        run(device, kernel, buffers, cl::NDRange(size_t(guides / width)), cl::NDRange(1));

        const auto vectors = [&](const char* name, int count)
        { return from_blocks(read<float>(device, buffers[name], size_t(guides * count * 3)), guides, count); };
        const std::vector<Vec> v_now = vectors("velocity", nodes), few_x_now = vectors("thin_position", few),
                               few_v_now = vectors("thin_velocity", few);
        const std::vector<float> pull_now = read<float>(device, buffers["multiplier"], pull.size()),
                                 few_pull_now = read<float>(device, buffers["thin_multiplier"], few_pull.size());
        EXPECT_EQ(vectors("position", nodes), from_blocks(to_blocks(x, guides, nodes), guides, nodes));
        for (int s = 0; s < guides; ++s)
        {
            const bool thinned_now = change[size_t(s / LANES)] == THIN_NOW;
            for (int k = 0; k < nodes; ++k)
            {
                const size_t at = size_t((s / LANES * nodes + k) * LANES + s % LANES);
                EXPECT_LT(glm::distance(v_now[size_t(s * nodes + k)], v[size_t(s * nodes + k)]), 1e-5) << s << " " << k;
                if (k > 1)
                {
                    EXPECT_NEAR(pull_now[at], pull[at], 1e-3) << s << " " << k;
                }
            }
            for (int k = 0; k < few; ++k)
            {
                const size_t i = size_t(s * few + k), at = size_t((s / LANES * few + k) * LANES + s % LANES);
                EXPECT_LT(glm::distance(few_v_now[i], few_v[i]), 1e-5) << s << " " << k;
                if (k > 1)
                {
                    EXPECT_NEAR(few_pull_now[at], few_pull[at], 1e-3) << s << " " << k;
                }
                if (!thinned_now)
                {
                    EXPECT_LT(glm::distance(few_x_now[i], few_x[i]), 1e-6);
                }
                else if (k > 1)
                {
                    const Vec way = few_x_now[i] - few_x_now[i - 1];
                    const Vec was = x[size_t(s * nodes + 2 * k - 1)] - x[size_t(s * nodes + 2 * k - 3)];
                    EXPECT_NEAR(glm::length(way), 2.0 * double(groom.segment_length[size_t(s)]), 1e-6);
                    EXPECT_LT(glm::distance(glm::normalize(way), glm::normalize(was)), 1e-4);
                }
            }
        }
        const std::vector<float> tension_now = read<float>(device, buffers["tension"], tension.size()),
                                 still = read<float>(device, buffers["still"], tension.size());
        const float tense[] = {2.0f, 32.0f, 8.0f, 8.0f}, calm[] = {0.0f, 0.0f, 8.0f, 8.0f};
        for (int s = 0; s < guides; ++s)
        {
            EXPECT_EQ(tension_now[size_t(s)], tense[s / LANES]);
            EXPECT_EQ(still[size_t(s)], calm[s / LANES]) << "who changes is awake";
        }
    }
}

// All nodes are on the cubics through those that were moved, as the plain twin has it.
TEST(Far, FillsInAsItsTwin)
{
    for (const int width : {1, 8, 16})
    {
        const Device device = with_width(width);
        Random random(3);
        const Groom groom = random_groom(random, 40, 12, 40);
        HairParams params;
        params.forces_repulsion = 0.0f;
        params.solver_far_tolerance = 20.0f;
        Solver solver(device, params, groom, {});
        solver.let_blocks_sleep(true);
        solver.set_view(kHorizon);
        solver.set_thin_error(0.0);
        for (int i = 1; i < 10; ++i)
            solver.step({{{{0.02 * i, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}, {}}, i / 60.0, 1.0f / 60.0f}});
        const Groom few = thinned(groom);
        const std::vector<Vec> x = nodes_in(device, solver.buffers().at("position"), groom),
                               thin = nodes_in(device, solver.buffers().at("thin_position"), few);
        for (int s = 0; s < groom.guides; ++s)
        {
            const std::vector<Vec> twin = filled_in({thin.begin() + s * few.nodes, thin.begin() + (s + 1) * few.nodes},
                                                    double(groom.segment_length[size_t(s)]));
            for (int k = 0; k < groom.nodes; ++k)
                EXPECT_LT(glm::distance(twin[size_t(k)], x[size_t(s * groom.nodes + k)]), 1e-6) << s << " " << k;
        }
    }
}

// Against all nodes, at several times of a shake: what a picture shows of it is below the tolerance. The eye is as near
// as it may be.
TEST(Far, ErrsByLessThanTheTolerance)
{
    for (const std::initializer_list<const char*>& sets :
         {std::initializer_list<const char*>{"solver.far_tolerance=1"},
          {"solver.far_tolerance=0.5", "strand.length=0.3", "strand.nodes=24", "forces.wind=[2, 0, 1]"},
          {"solver.far_tolerance=1", "bending.droop=5", "wave.normal_amplitude=0.005", "wave.normal_frequency=10"}})
    {
        const Hairstyle style = style_of(sets);
        const double tolerance = style.params.solver_far_tolerance;
        Simulation all(test_device(), style), far(test_device(), style);
        const int nodes = far.solver().groom().nodes;
        double distance = 0.5;
        far.play(find_motion("shake"));
        all.play(find_motion("shake"));
        // As near as the first step may be far with every block.
        while (distance < 1e3 && !all_far(far))
        {
            distance *= 1.1;
            far.set_view(from(distance));
            far.step(far.hand());
            all.step(all.hand());
        }
        ASSERT_TRUE(all_far(far));
        far.set_view(from(1.1 * distance)); // the head goes to and fro
        const double pixel = 1.1 * distance / from(0.0).pixels;
        const int guides = far.solver().groom().guides;
        std::vector<double> in_block(size_t(far.solver().groom().blocks), 0.0); // mean squares, pixels
        double sum = 0.0;
        for (int i = 1; i <= 120; ++i)
        {
            far.step(far.hand());
            all.step(all.hand());
            EXPECT_TRUE(all_far(far));
            const std::vector<Vec> thin = nodes_of(far), full = nodes_of(all);
            const double off = apart(thin, full, nodes) / pixel;
            sum += off * off;
            for (size_t k = 0; k < thin.size(); ++k)
            {
                const int block = int(k) / nodes / LANES, strands = std::min(LANES, guides - block * LANES);
                in_block[size_t(block)] +=
                    glm::dot(thin[k] - full[k], thin[k] - full[k]) / (pixel * pixel * 120.0 * strands * (nodes - 2));
            }
            if (i % 15 == 0)
            {
                EXPECT_LT(off, tolerance) << i;
                expect_sound(far, *sets.begin());
            }
        }
        EXPECT_LT(std::sqrt(*std::max_element(in_block.begin(), in_block.end())), tolerance);
        EXPECT_GT(std::sqrt(sum / 120), 0.02 * tolerance) << "else there was nothing to see";
    }
}

// To and fro in the middle of a motion: no step goes further beyond what all nodes make than the tolerance.
TEST(Far, ComesAndGoesWithoutAJump)
{
    const Hairstyle style = style_of({"solver.far_tolerance=1"});
    Simulation all(test_device(), style), far(test_device(), style);
    const int nodes = far.solver().groom().nodes;
    far.set_view(from(1.0));
    double limit = 0.0; // m: where hair is far
    for (const FarBlock& block : far_blocks(style.params, far.solver().groom()))
        limit = std::max(limit, 0.3 * block.length * from(0.0).pixels / 0.8 + block.reach + 0.3);
    const double pixel = limit / from(0.0).pixels;
    far.play(find_motion("shake"));
    all.play(find_motion("shake"));
    std::vector<Vec> before = nodes_of(far), before_all = nodes_of(all);
    int changes = 0;
    for (int i = 0; i < 180; ++i)
    {
        const bool was = far.solver().blocks_thin() > 0;
        far.set_view(from(i / 7 % 2 ? 0.7 : limit));
        far.step(far.hand());
        all.step(all.hand());
        changes += was != (far.solver().blocks_thin() > 0);
        const std::vector<Vec> now = nodes_of(far), now_all = nodes_of(all);
        // Of the difference to all nodes, what this one step has added.
        std::vector<Vec> moved, moved_all;
        for (size_t k = 0; k < now.size(); ++k)
        {
            moved.push_back(now[k] - before[k]);
            moved_all.push_back(now_all[k] - before_all[k]);
        }
        EXPECT_LT(apart(moved, moved_all, nodes), pixel) << i;
        before = now;
        before_all = now_all;
        if (i % 5 == 0)
            expect_sound(far, "to and fro");
    }
    EXPECT_GT(changes, 20);
}

// Once it is seen from near, hair comes to rest where it would have.
TEST(Far, ComesToRestWithAllNodes)
{
    const Hairstyle style = style_of({"solver.far_tolerance=1", "head.mesh=", "head.spheres="});
    Simulation all(test_device(), style), far(test_device(), style);
    const int nodes = far.solver().groom().nodes;
    far.set_view(kHorizon);
    for (Simulation* each : {&all, &far})
    {
        each->play(find_motion("nod"));
        for (int i = 0; i < 240; ++i)
            each->step(each->hand());
    }
    EXPECT_TRUE(all_far(far));
    const double thin = apart(nodes_of(far), nodes_of(all), nodes);
    far.set_view(from(0.6));
    for (Simulation* each : {&all, &far})
        for (int i = 0; i < 600; ++i)
        {
            each->solver().keep_awake();
            each->step(each->hand());
        }
    EXPECT_EQ(far.solver().blocks_thin(), 0);
    const double near = apart(nodes_of(far), nodes_of(all), nodes);
    EXPECT_LT(near, 0.002 * double(style.params.strand_length));
    EXPECT_GT(thin, 2.0 * near) << "else there was nothing to come back from";
}

// Hair that sleeps is woken by who comes near, and by nobody who goes.
TEST(Far, WhoComesNearWakesIt)
{
    Simulation simulation(test_device(), style_of({"solver.far_tolerance=1", "forces.repulsion=0"}));
    const int blocks = simulation.solver().groom().blocks;
    const auto step = [&](int steps)
    {
        for (int i = 0; i < steps; ++i)
            simulation.step(simulation.hand());
    };
    simulation.set_view(kHorizon);
    step(1);
    EXPECT_TRUE(all_far(simulation));
    for (int i = 0; i < 600 && !simulation.solver().asleep(); ++i)
        step(1);
    ASSERT_TRUE(simulation.solver().asleep());
    EXPECT_TRUE(all_far(simulation));
    const std::vector<Vec> asleep = nodes_of(simulation);
    step(3);
    EXPECT_EQ(apart(nodes_of(simulation), asleep, simulation.solver().groom().nodes), 0.0);
    simulation.set_view(from(0.6));
    step(1);
    EXPECT_FALSE(simulation.solver().asleep());
    EXPECT_EQ(simulation.solver().blocks_awake(), blocks);
    EXPECT_EQ(simulation.solver().blocks_thin(), 0);
    for (int i = 0; i < 600 && !simulation.solver().asleep(); ++i)
        step(1);
    ASSERT_TRUE(simulation.solver().asleep());
    simulation.set_view(kHorizon);
    step(1);
    EXPECT_TRUE(simulation.solver().asleep());
    EXPECT_EQ(simulation.solver().blocks_thin(), 0);
}

// Whatever is changed on the way: what cannot be thin is not, and nothing is lost.
TEST(Far, GivesWayToWhateverComes)
{
    Simulation simulation(test_device(), style_of({"solver.far_tolerance=1"}));
    simulation.set_view(kHorizon);
    simulation.play(find_motion("shake"));
    struct Change
    {
        const char* set;
        bool thin;
    };
    for (const Change& change : {Change{"solver.kind=pbd", false},
                                 {"solver.kind=direct", true},
                                 {"strand.nodes=15", false},
                                 {"strand.nodes=12", true},
                                 {"bending.droop=3", true},
                                 {"bending.droop=0.01", false},
                                 {"bending.droop=20", true},
                                 {"strand.spacing=1.2", true},
                                 {"strand.length=0.1", true},
                                 {"solver.far_tolerance=0", false},
                                 {"solver.far_tolerance=2", true},
                                 {"forces.wind=[4, 0, 0]", true},
                                 {"forces.repulsion=2", true},
                                 {"head.contact=spheres", true}})
    {
        Hairstyle style = simulation.style();
        assign(style, change.set);
        simulation.set_style(style);
        simulation.set_view(kHorizon);
        for (int i = 0; i < 10; ++i)
            simulation.step(simulation.hand());
        EXPECT_EQ(simulation.solver().blocks_thin() > 0, change.thin) << change.set;
        EXPECT_TRUE(measure_health(simulation.solver(), simulation.params(), false).finite) << change.set;
    }
    simulation.reset();
    simulation.step(simulation.hand());
    EXPECT_TRUE(all_far(simulation));
    const std::vector<int> resets = simulation.solver().resets();
    EXPECT_EQ(std::ranges::count(resets, 0), std::ssize(resets));
}

} // namespace
} // namespace coif

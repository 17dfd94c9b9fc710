// What whole steps must hold to, on grooms made for the purpose: mechanics that have closed answers.
#include "tests/oracle.h"
#include "tests/rig.h"

namespace coif
{
namespace
{

constexpr double kGravity = 9.81;

TEST_P(AnySolver, RootsAreWhereTheHeadPutsThem)
{
    Random random(1);
    HairParams params = uncoupled();
    params.strand_spacing = 1.2f;
    Rig rig(params, random_groom(random, 20, 16, 0));
    const std::vector<Vec> root = from_blocks(rig.groom.root_position, 20, 1);
    const std::vector<Vec> direction = from_blocks(rig.groom.root_direction, 20, 1);
    for (int i = 1; i <= 20; ++i)
    {
        rig.step(pose(0.1 * i * Vec(1, 0.3, -0.5), 0.1 * i, {0.3, 1, -0.2}));
        const std::vector<Vec> x = rig.positions();
        for (size_t s = 0; s < 20; ++s)
        {
            const Vec at = rig.head.turn * root[s];
            const double rest = double(rig.groom.segment_length[s]) * rig.params.strand_spacing;
            // A rotation's nine products in floats; the direct solver adds the head's way of up to a quarter of a
            // metre, and takes it off again.
            const double rounding = direct() ? 1e-7 : 5e-8;
            EXPECT_LE(glm::distance(x[s * 16 + 1], at), rounding);
            EXPECT_LE(glm::distance(x[s * 16], at - rig.head.turn * direction[s] * rest), rounding);
        }
    }
}

TEST(Sweeps, AFreeNodeFallsAsSymplecticEulerSays)
{
    HairParams params = pbd();
    params.solver_stretching = params.solver_bending = params.forces_drag = 0.0f;
    // Long segments: rubber gives no more than four times, which a second's fall must not reach.
    Rig rig(params, one_strand(4, 2.7f, {0, 0, 0}, {1, 0, 0}));
    const std::vector<Vec> start = rig.positions();
    const double h = kStep;
    for (int n = 1; n <= 60; ++n)
    {
        rig.step(rig.head);
        const std::vector<Vec> x = rig.positions();
        const double fall = kGravity * h * h * n * (n + 1) / 2.0;
        for (size_t k = 2; k < 4; ++k)
            // The speed is kept as a difference of positions over h, each rounded to a part in 2^24 of up to 5 m: after
            // n steps, n times that.
            EXPECT_LE(glm::distance(x[k], start[k] - Vec(0, fall, 0)), n * 6e-7 + 1e-7) << "step " << n;
    }
}

TEST(Sweeps, DragTakesSpeedAwayExactlyWhateverItsSize)
{
    for (const double b : {0.01, 3.0, 60.0, 100.0})
    {
        HairParams params = pbd();
        params.solver_stretching = params.solver_bending = 0.0f;
        params.forces_drag = float(b);
        Rig rig(params, one_strand(4, 0.7f, {0, 0, 0}, {1, 0, 0})); // as long, for half a second
        for (int n = 1; n <= 30; ++n)
        {
            rig.step(rig.head);
            const double expected = -kGravity * -std::expm1(-b * n * double(kStep)) / b;
            for (const Vec& v : {rig.velocities()[2], rig.velocities()[3]})
                // 60 times the rounding of positions of up to 1.5 m, and drag hands an error on for n steps at most.
                EXPECT_LE(std::abs(v.y - expected), 1e-5 * n) << "drag " << b << ", step " << n;
        }
    }
}

TEST_P(AnySolver, AStrandAtRestHangsStraightDownAndKeepsItsLength)
{
    HairParams params = uncoupled();
    params.solver_bending = 0.0f;
    params.bending_droop = 10000.0f; // so limp that it does not count
    params.solver_iterations = 40;
    params.forces_drag = 5.0f;
    Rig rig(params, one_strand(16, 0.3f, {0.1f, 0.2f, 0.0f}, {1, 0, 0}));
    rig.rest(300);
    const std::vector<Vec> x = rig.positions();
    for (size_t k = 2; k < 16; ++k)
    {
        EXPECT_NEAR(x[k].x, x[1].x, 1e-3) << "node " << k;
        EXPECT_NEAR(x[k].z, x[1].z, 1e-3) << "node " << k;
        EXPECT_LT(x[k].y, x[k - 1].y);
    }
    EXPECT_LT(rig.worst_stretch(), 0.01);
}

TEST(Sweeps, OverRelaxedSweepsStretchLessThanPlainOnesOfTheSameNumber)
{
    double stretch[2];
    for (const int sweeps : {0, 1})
    {
        HairParams params = pbd();
        params.solver_bending = 0.0f;
        params.solver_sweeps = sweeps;
        params.solver_stretching = 0.99999994f; // just under 1: sweeps alone keep lengths, without the final limit
        Rig rig(params, one_strand(16, 0.3f, {0, 0, 0}, {0.6f, 0.8f, 0}));
        rig.rest(120);
        stretch[sweeps] = rig.worst_stretch();
    }
    EXPECT_LT(stretch[0], 0.25 * stretch[1]) << "over-relaxed " << stretch[0] << ", plain " << stretch[1];
}

// Guides 0, 2, 4 and so on mirrored in x = 0 by those after them.
Groom mirrored_groom(int pairs, int nodes)
{
    Random random(5);
    Groom groom = random_groom(random, 2 * pairs, nodes, 0);
    groom.center = groom.middle = {0.0f, 0.02f, -0.01f};
    for (int s = 0; s < 2 * pairs; s += 2)
    {
        groom.segment_length[size_t(s + 1)] = groom.segment_length[size_t(s)];
        for (std::vector<float>* values : {&groom.root_position, &groom.root_direction})
            for (int axis = 0; axis < 3; ++axis)
                (*values)[size_t(strand_value(s + 1, 0, axis, 1))] =
                    (*values)[size_t(strand_value(s, 0, axis, 1))] * (axis == 0 ? -1.0f : 1.0f);
    }
    return groom;
}

TEST_P(AnySolver, AMirroredGroomMovesMirrored)
{
    for (const bool coupled : {false, true})
    {
        HairParams params = uncoupled();
        params.grid_resolution = 20;
        params.forces_repulsion = coupled ? 2.0f : 0.0f;
        params.forces_wind = F4(0.0f, 1.0f, -6.0f, 0.0f);
        params.forces_turbulence = 0.0f;
        Rig rig(params, mirrored_groom(10, 16));
        rig.solver.set_colliders({{{0.0f, 0.02f, -0.01f}, 0.1f, true}, {{0.0f, -0.2f, 0.05f}, 0.06f, true}});
        for (int i = 1; i <= (coupled ? 20 : 60); ++i)
            rig.step(pose({0.0, 0.1 * std::sin(0.1 * i), 0.0}, 0.4 * std::sin(0.2 * i), {1, 0, 0}));
        const std::vector<Vec> x = rig.positions();
        double worst = 0.0;
        for (size_t s = 0; s < 20; s += 2)
            for (size_t k = 0; k < 16; ++k)
                worst = std::max(worst, glm::distance(x[s * 16 + k], x[(s + 1) * 16 + k] * Vec(-1, 1, 1)));
        // Floats round alike on both sides of zero. The grid's weights do not, and steps carry that on; where strands
        // are squeezed between spheres, a hundredfold in a step, so that one cannot ask for long. The direct solver may
        // stop a round sooner on one side: within its tolerance, half a thousandth of 0.2 m each time.
        EXPECT_LE(worst, !coupled ? 0.0 : direct() ? 5e-4 : 1e-6) << (coupled ? "with" : "without") << " repulsion";
    }
}

TEST_P(AnySolver, NoGuideEntersACollider)
{
    Random random(2);
    Rig rig(uncoupled(), random_groom(random, 40, 16, 0));
    const std::vector<Collider> apart = {{{0.01f, 0.02f, -0.01f}, 0.1f, true},
                                         {{0.25f, 0.0f, 0.0f}, 0.06f, false},
                                         {{-0.2f, -0.1f, 0.1f}, 0.07f, true},
                                         {{0.0f, -0.25f, 0.0f}, 0.09f, false},
                                         {{0.1f, 0.25f, 0.0f}, 0.04f, true, glm::vec3(-0.1f, 0.25f, 0.1f)}};
    rig.solver.set_colliders(apart);
    double deepest = 0.0;
    for (int i = 1; i <= 150; ++i)
    {
        rig.step(pose({0.05 * std::sin(0.15 * i), 0, 0}, 0.8 * std::sin(0.1 * i)));
        if (i <= 30) // hair that starts inside is let out at half a metre a second
            continue;
        const std::vector<Vec> x = rig.positions();
        for (const Capsule& c : rig.solver.placed_colliders())
            for (size_t n = 0; n < x.size(); ++n)
                if (n % 16 > 1)
                    deepest = std::max(deepest, c.center.w - glm::distance(x[n], oracle::nearest_on_axis(c, x[n])));
    }
    EXPECT_LE(deepest, 1e-7); // a push-out's rounding
}

TEST_P(AnySolver, ALeapCarriesHairRigidlyAndKeepsItsSpeedAgainstTheHead)
{
    struct Leap
    {
        const char* name;
        Vec by;
        double angle;
        Vec axis;
        float gravity;     // turns about y alone leave gravity what it is to the hair
        bool head_on_move; // up to the leap, and not in it: a leap takes the place of the head's way in that step
    };
    for (const Leap& leap : {Leap{"5 m", {3, 0, -4}, 0.0, {0, 1, 0}, 1.0f, false},
                             Leap{"5 m on the move", {3, 0, -4}, 0.0, {0, 1, 0}, 1.0f, true},
                             Leap{"120 degrees about y", {0, 0, 0}, 2.0944, {0, 1, 0}, 1.0f, false},
                             Leap{"120 degrees about any axis", {0, 0, 0}, 2.0944, {0.4, -0.5, 0.7}, 0.0f, false},
                             Leap{"both", {1, 2, 3}, 2.5, {0.1, -0.5, 0.7}, 0.0f, false}})
    {
        HairParams params = uncoupled();
        params.forces_gravity = leap.gravity;
        Random random(3);
        const Groom groom = random_groom(random, 20, 16, 0);
        Rig stays(params, groom), leaps(params, groom);
        for (Rig* rig : {&stays, &leaps})
        {
            rig->solver.set_colliders({{groom.center, 0.1f, true}});
            for (int i = 1; i <= 20; ++i)
                rig->step(pose({0.02 * i, 0, 0}, 0.05 * i, {0.2, 1, 0.1}));
            if (!leap.head_on_move)
                rig->rest(1); // the hair still swings
        }
        const glm::dquat turn = glm::angleAxis(leap.angle, glm::normalize(leap.axis));
        for (int i = 0; i < 3; ++i)
        {
            stays.step(stays.head);
            leaps.step(i > 0 ? leaps.head : Pose{leaps.head.origin + leap.by, turn * leaps.head.turn, Vec(0.0)});
            std::vector<Vec> x = stays.positions(), v = stays.velocities();
            for (std::vector<Vec>* values : {&x, &v})
                for (Vec& value : *values)
                    value = turn * value;
            // The rounding of the turn, carried on by the sweeps.
            EXPECT_LE(farthest(leaps.positions(), x), 2e-5) << leap.name;
            EXPECT_LE(farthest(leaps.velocities(), v), 2e-5 / kStep) << leap.name;
        }
        EXPECT_LE(glm::distance(leaps.solver.jumped(), leap.by), 1e-12) << leap.name;
        EXPECT_EQ(stays.solver.jumped(), Vec(0.0));
    }
}

TEST_P(AnySolver, ABadStrandIsTheOnlyOneThatStartsAnew)
{
    Random random(4);
    const Groom groom = random_groom(random, 40, 16, 0);
    Rig sound(uncoupled(), groom), ill(uncoupled(), groom);
    const int bad = 21;
    for (Rig* rig : {&sound, &ill})
        for (int i = 1; i <= 20; ++i)
        {
            if (rig == &ill && i == 10)
            {
                std::vector<float> x = read<float>(test_device(), rig->solver.buffers().at("position"), 48 * 16 * 3);
                x[size_t(strand_value(bad, 7, 1, 16))] = NAN;
                write(test_device(), rig->solver.buffers().at("position"), x);
            }
            rig->step(pose({0.01 * i, 0, 0}, 0.05 * i));
        }
    const std::vector<Vec> a = sound.positions(), b = ill.positions();
    for (int s = 0; s < 40; ++s)
        for (int k = 0; k < 16; ++k)
        {
            const size_t i = size_t(s * 16 + k);
            EXPECT_TRUE(s == bad ? std::isfinite(b[i].x + b[i].y + b[i].z) : a[i] == b[i]) << "strand " << s;
        }
    std::vector<int> resets(40, 0);
    EXPECT_EQ(sound.solver.resets(), resets);
    resets[bad] = 1;
    EXPECT_EQ(ill.solver.resets(), resets);
    EXPECT_LT(ill.worst_stretch(), 0.5);
}

TEST_P(AnySolver, TenKilometresFromTheOriginHairMovesTheSame)
{
    HairParams params = uncoupled();
    params.forces_wind = F4(5.0f, 0.0f, 3.0f, 0.0f);
    params.forces_turbulence = 0.0f; // gusts belong to places
    Random random(6);
    const Groom groom = random_groom(random, 20, 16, 0);
    const Vec far(1e4, -1e4, 1e4);
    Rig here(params, groom), there(params, groom, pose(far));
    for (int i = 1; i <= 60; ++i)
    {
        const Vec at(0.2 * std::sin(0.1 * i), 0.1 * std::sin(0.17 * i), 0.0);
        here.step(pose(at, 0.5 * std::sin(0.1 * i)));
        there.step(pose(far + at, 0.5 * std::sin(0.1 * i)));
    }
    EXPECT_LE(farthest(here.positions(), there.positions()), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Steps, AnySolver, testing::Values(0, 1), AnySolver::name);

} // namespace
} // namespace coif

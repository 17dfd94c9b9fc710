// Steps at the ends of every range: hair stays finite, bounded and outside of bodies.
#include "tests/rig.h"

namespace coif
{
namespace
{

class Extremes : public AnySolver
{
};
INSTANTIATE_TEST_SUITE_P(Both, Extremes, testing::Values(0, 1), Extremes::name);

struct Extreme
{
    const char* name;
    std::vector<std::pair<float HairParams::*, float>> values;
    int iterations = 10;
};

TEST_P(Extremes, StayFiniteAndBounded)
{
    using P = HairParams;
    std::vector<Extreme> extremes = {
        {"drag 100", {{&P::forces_drag, 100.0f}}},
        {"no drag", {{&P::forces_drag, 0.0f}}},
        {"gravity 10", {{&P::forces_gravity, 10.0f}}},
        {"gravity -2", {{&P::forces_gravity, -2.0f}}},
        {"no gravity, no drag", {{&P::forces_gravity, 0.0f}, {&P::forces_drag, 0.0f}}},
        {"grown", {{&P::strand_spacing, 3.0f}}},
    };
    const std::vector<Extreme> sweeps = {
        {"no stretching", {{&P::solver_stretching, 0.0f}}},
        {"stiff", {{&P::solver_bending, 1.0f}}},
        {"brush", {{&P::solver_bending, 1.0f}, {&P::solver_bending_scale, 2.0f}}},
        {"brush, unattenuated",
         {{&P::solver_bending, 1.0f}, {&P::solver_bending_scale, 2.0f}, {&P::solver_bending_attenuation, 0.0f}}},
        {"shrunk", {{&P::solver_bending, 1.0f}, {&P::solver_bending_scale, 0.5f}, {&P::strand_spacing, 0.2f}}},
        {"one sweep", {}, 1},
        {"200 sweeps", {}, 200},
        {"limp, 1 sweep", {{&P::solver_bending, 0.0f}}, 1},
    };
    const std::vector<Extreme> materials = {
        {"stiffest", {{&P::bending_droop, 0.01f}}},
        {"limpest", {{&P::bending_droop, 10000.0f}}},
        {"steel wire", {{&P::bending_modulus, 100.0f}, {&P::bending_diameter, 2000.0f}}},
        {"spider's thread", {{&P::bending_modulus, 0.001f}, {&P::bending_diameter, 1.0f}}},
        {"limp tips", {{&P::bending_attenuation, 8.0f}}},
        {"shrunk and stiff", {{&P::bending_droop, 0.1f}, {&P::strand_spacing, 0.2f}}},
        {"coarse steps", {{&P::solver_courant, 1.8f}}},
        {"sticky bodies", {{&P::forces_friction, 2.0f}}},
    };
    const std::vector<Extreme>& own = direct() ? materials : sweeps;
    extremes.insert(extremes.end(), own.begin(), own.end());
    Random random(8);
    const Groom groom = random_groom(random, 17, 16, 0);
    for (const Extreme& extreme : extremes)
    {
        HairParams params = uncoupled();
        params.solver_iterations = extreme.iterations;
        for (const auto& [field, value] : extreme.values)
            params.*field = value;
        Rig rig(params, groom);
        rig.solver.set_colliders({{groom.center, 0.1f, true}, {{0.1f, -0.1f, 0.0f}, 0.08f, true}});
        for (int i = 1; i <= 60; ++i)
            rig.step(pose({0.3 * std::sin(0.3 * i), 0, 0}, 0.8 * std::sin(0.1 * i)));
        // Nothing flies further than a free fall of a second under ten g, or a whip's end.
        for (const Vec& x : rig.positions())
            ASSERT_LT(glm::length(x), extreme.values.empty() ? 1.0 : 60.0) << extreme.name; // false for NaN too
        EXPECT_EQ(rig.solver.resets(), std::vector<int>(17, 0)) << extreme.name;
        if (direct())
        {
            EXPECT_LE(rig.worst_stretch(), 1e-3) << extreme.name;
        }
    }
}

TEST_P(Extremes, WindThatIsGoneAndHairOfNoLengthAreNoTrouble)
{
    struct
    {
        const char* name;
        glm::dvec3 wind; // the motion's
        float length;
    } const cases[] = {{"no wind", {0, 0, 0}, 0.3f},
                       {"storm", {100, -100, 100}, 0.3f},
                       {"a breath", {1e-30, 0, 0}, 0.3f},
                       {"shortest hair", {10, 0, 0}, 0.002f},
                       {"hair of no length", {10, 0, 0}, 0.0f}};
    for (const auto& c : cases)
    {
        HairParams params = uncoupled();
        params.forces_turbulence = 4.0f;
        Rig rig(params, one_strand(16, c.length, {0, 0.1f, 0}, {0, 1, 0}));
        rig.solver.set_colliders({{{0, 0, 0}, 0.1f, true}});
        for (int i = 1; i <= 60; ++i)
        {
            Pose at = pose({0.02 * i, 0, 0});
            at.wind = i > 30 ? c.wind : Vec(0.0);
            rig.step(at);
        }
        for (const Vec& x : rig.positions())
            ASSERT_LT(glm::distance(x, Vec(0, 0.1, 0)), 2.0 * c.length + 0.03) << c.name;
        EXPECT_EQ(rig.solver.resets(), std::vector<int>(1, 0)) << c.name;
    }
}

TEST_P(Extremes, ANodeOnACollidersCentreFindsItsWayOut)
{
    HairParams params = uncoupled();
    Rig rig(params, one_strand(16, 0.28f, {0, 0, 0}, {0, -1, 0}));
    rig.rest(10);
    const Vec node = rig.positions()[9];
    rig.solver.set_colliders({{glm::vec3(node), 0.03f, true}});
    rig.rest(60);
    for (const Vec& x : rig.positions())
        EXPECT_GE(glm::distance(x, node), 0.03f - 1e-7);
    EXPECT_EQ(rig.solver.resets(), std::vector<int>(1, 0));
}

} // namespace
} // namespace coif

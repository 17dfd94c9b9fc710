// Strands that are not straight at rest: that they begin at rest, and keep their shape on the move.
#include "sim/lab.h"
#include "tests/rig.h"

#include <cmath>
#include <numbers>

namespace coif
{
namespace
{

// One strand of this rest shape: points one segment apart, the root first.
Groom shaped(const std::vector<Vec>& points)
{
    const int nodes = int(points.size()) + 1;
    const double rest = glm::distance(points[0], points[1]);
    const Vec direction = glm::normalize(points[1] - points[0]);
    Groom groom = one_strand(nodes, float(rest * (nodes - 2)), glm::vec3(points[0]), glm::vec3(direction));
    std::vector<Vec> all = points;
    all.insert(all.begin(), points[0] - rest * direction);
    groom.rest_position = to_blocks(all, 1, nodes);
    return groom;
}

// Half a circle: out from the root, down and back in, as a strand that was combed.
std::vector<Vec> combed(int nodes, double length)
{
    std::vector<Vec> points = {Vec(0.0)};
    const double rest = length / (nodes - 2);
    for (int k = 0; k + 2 < nodes; ++k)
    {
        const double angle = std::numbers::pi * (k + 0.5) / (nodes - 2);
        points.push_back(points.back() + rest * Vec(std::cos(angle), -std::sin(angle), 0.0));
    }
    return points;
}

// A helix about an axis that hangs down, `per_turn` segments a turn.
std::vector<Vec> ringlet(int nodes, int per_turn, double radius, double pitch)
{
    std::vector<Vec> points;
    for (int k = 0; k + 1 < nodes; ++k)
    {
        const double angle = 2.0 * std::numbers::pi * k / per_turn;
        points.push_back(Vec(radius * std::cos(angle), -pitch * k / per_turn, radius * std::sin(angle)));
    }
    return points;
}

// Mean way along the axis from a node to the one a turn on, without the first and the last turn.
double pitch_of(const std::vector<Vec>& x, int per_turn)
{
    // The axis runs through the middles of whole turns.
    const auto middle = [&](size_t from)
    {
        Vec sum(0.0);
        for (int i = 0; i < per_turn; ++i)
            sum += x[from + size_t(i)];
        return sum / double(per_turn);
    };
    double sum = 0.0;
    int count = 0;
    for (size_t i = size_t(per_turn) / 2; i + 2 * size_t(per_turn) <= x.size(); ++i, ++count)
        sum += glm::distance(middle(i), middle(i + size_t(per_turn)));
    return sum / count;
}

HairParams stiff(float droop)
{
    HairParams params = uncoupled();
    params.bending_droop = droop;
    params.forces_drag = 3.0f;
    return params;
}

TEST(RestShape, CombedHairAndRingletsDoNotSagAtTheStart)
{
    for (const float droop : {0.5f, 5.0f, 20.0f, 40.0f})
        for (const bool helix : {false, true})
        {
            const double length = 0.2;
            const std::vector<Vec> points = helix ? ringlet(33, 8, 0.006, 0.03) : combed(16, length);
            const Groom groom = shaped(points);
            Rig rig(stiff(droop), groom);
            const std::vector<Vec> start = rig.positions();
            double worst = 0.0;
            for (int i = 0; i < 600; ++i)
            {
                rig.rest(1);
                worst = std::max(worst, glm::distance(rig.positions().back(), start.back()));
            }
            EXPECT_LE(worst, 0.01 * groom.longest) << (helix ? "ringlet" : "combed") << ", droop " << droop;
        }
}

TEST(RestShape, ARingletKeepsItsPitchHangingSideways)
{
    for (const float droop : {0.5f, 5.0f, 20.0f})
    {
        const Groom groom = shaped(ringlet(33, 8, 0.006, 0.03));
        Rig rig(stiff(droop), groom);
        const double before = pitch_of(rig.positions(), 8);
        for (int i = 1; i <= 60; ++i)
            rig.step(pose({0, 0, 0}, std::numbers::pi / 2.0 * i / 60.0, {0, 0, 1}));
        rig.rest(600);
        const std::vector<Vec> x = rig.positions();
        EXPECT_NEAR(pitch_of(x, 8) / before, 1.0, 0.05) << droop;
        EXPECT_EQ(rig.solver.resets(), std::vector<int>(1, 0));
    }
}

} // namespace
} // namespace coif

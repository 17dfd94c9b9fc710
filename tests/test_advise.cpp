// What `coif advise` says of styles whose answer is known. Times are measured too: what hangs on them is tested on
// differences that are made up.
#include "app/advise/advise.h"
#include "sim/error.h"
#include "sim/source.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace coif
{
namespace
{

class Advising : public testing::Test
{
  protected:
    // A few stiff hairs, and a ball that they never touch.
    static Hairstyle small_style()
    {
        Hairstyle style;
        for (const char* set : {"strand.length=0.06", "strand.nodes=6", "bending.droop=2", "interpolation.strands=3000",
                                "grid.resolution=16", "camera.distance=0.7"})
            assign(style, set);
        style.host.colliders.push_back({glm::vec3(5.0f), 0.05f, false});
        return style;
    }
    Advice advice(const Hairstyle& style, double tolerance = 0.01)
    {
        return advise_on({test_device(), renderer, find_motion("shake"), 0.3, tolerance}, style);
    }
    static const Advised& of(const Advice& advice, const std::string& name)
    {
        const auto found = std::ranges::find(advice.features, name, [](const Advised& a) { return a.feature.name; });
        if (found == advice.features.end())
            throw fail("no feature is called {}", name);
        return *found;
    }

    // Nobody would see it go, whether the clock finds that it costs anything or not.
    static bool may_go(Verdict verdict)
    {
        return verdict == Verdict::LEAVE_OUT || verdict == Verdict::SAVES_NOTHING || verdict == Verdict::TOGETHER_NOT;
    }

    Window window{16, 16, Window::HIDDEN};
    Renderer renderer{data_folder() / "shaders"};
};

TEST_F(Advising, leaves_out_what_has_no_effect_and_keeps_what_has_much)
{
    const Hairstyle style = small_style();
    const Advice said = advice(style);
    const Advised &ball = of(said, "colliders"), &bending = of(said, "bending"), &shadow = of(said, "self-shadow");
    EXPECT_EQ(ball.difference.motion, 0.0);
    EXPECT_EQ(ball.difference.picture, 0.0);
    EXPECT_TRUE(may_go(ball.verdict));
    EXPECT_GT(bending.difference.motion, 0.1);
    EXPECT_EQ(bending.verdict, Verdict::KEEP);
    EXPECT_EQ(shadow.difference.motion, 0.0) << "it is only seen";
    EXPECT_GT(shadow.difference.picture, said.picture_tolerance);
    EXPECT_EQ(shadow.verdict, Verdict::KEEP);

    EXPECT_EQ(said.lean.host.colliders.empty(), ball.verdict == Verdict::LEAVE_OUT);
    EXPECT_EQ(said.lean.params.look_self_shadow, style.params.look_self_shadow);
    EXPECT_LE(said.together.motion, said.tolerance);
    EXPECT_LE(said.together.picture, said.picture_tolerance);
    EXPECT_GT(said.picture_tolerance, 0.0);
    EXPECT_LE(said.picture_tolerance, 0.5 * said.another_seed);

    const Advice again = advice(style);
    ASSERT_EQ(again.features.size(), said.features.size());
    for (size_t i = 0; i < said.features.size(); ++i)
    {
        const Advised &a = said.features[i], &b = again.features[i];
        EXPECT_EQ(may_go(a.verdict), may_go(b.verdict)) << a.feature.name;
        EXPECT_TRUE(may_go(a.verdict) || a.verdict == b.verdict) << a.feature.name;
        if (changes_text(a.feature.style, b.feature.style).empty()) // how far it goes is the clock's to say
        {
            EXPECT_EQ(b.difference.motion, a.difference.motion) << a.feature.name;
            EXPECT_EQ(b.difference.picture, a.difference.picture) << a.feature.name;
        }
    }
}

TEST_F(Advising, says_what_is_lacked)
{
    Hairstyle style = small_style();
    style.params.look_self_shadow = 0.0f;
    style.params.forces_repulsion = 0.0f;
    const Advice said = advice(style);
    EXPECT_EQ(of(said, "self-shadow").verdict, Verdict::LACKS);
    EXPECT_TRUE(of(said, "self-shadow").feature.lacked);
    EXPECT_EQ(said.lean.params.look_self_shadow, 0.0f) << "what is lacked is never put in";
    EXPECT_EQ(of(said, "substeps").feature.style.params.solver_courant, 1.8f) << "the one that it has";
    const std::string table = table_of(said), json = json_of(said, "");
    for (const Advised& a : said.features)
    {
        EXPECT_NE(table.find(a.feature.name), table.npos);
        EXPECT_NE(json.find("\"feature\": \"" + a.feature.name + "\""), json.npos);
    }
    EXPECT_NE(table.find("lacks"), table.npos);
    EXPECT_NE(json.find("\"written\": null"), json.npos);
    EXPECT_EQ(json.find("nan"), json.npos);
}

TEST_F(Advising, what_goes_together_saves_and_is_not_too_much)
{
    for (const double tolerance : {0.002, 0.05})
    {
        const Advice said = advice(small_style(), tolerance);
        EXPECT_LE(said.together.motion, said.tolerance);
        EXPECT_LE(said.together.picture, said.picture_tolerance);
        for (const Advised& a : said.features)
        {
            const double saving = a.difference.step_ms + a.difference.picture_ms;
            EXPECT_TRUE(a.verdict != Verdict::LEAVE_OUT || saving > 0.0) << a.feature.name;
            EXPECT_TRUE(a.verdict != Verdict::SAVES_NOTHING || saving <= 0.0) << a.feature.name;
        }
    }
}

TEST(MostSaving, gives_the_tolerance_to_what_saves_most)
{
    // Motion, picture, ms: substeps, the head's shape, the grid, a collider.
    const std::vector<Difference> each = {
        {0.010, 0.02, -0.1}, {0.020, 0.05, 0.0}, {0.025, 0.06, 3.0}, {0.001, 0.0, 0.2}};
    EXPECT_EQ(most_saving(each, 0.03, 0.07), (std::vector<size_t>{2, 3}));
    EXPECT_EQ(most_saving(each, 0.02, 0.07), (std::vector<size_t>{3})) << "the grid alone is too much";
    EXPECT_EQ(most_saving(each, 0.03, 0.05), (std::vector<size_t>{3})) << "its picture is";
    EXPECT_TRUE(most_saving(each, 0.0001, 0.07).empty());
    EXPECT_TRUE(most_saving({}, 0.03, 0.07).empty());
}

TEST(MostSaving, takes_back_what_is_worse_together)
{
    const std::vector<Difference> each = {{0.010, 0.01, 1.0}, {0.012, 0.01, 1.5}, {0.015, 0.01, 2.0}};
    EXPECT_EQ(most_saving(each, 0.022, 0.1), (std::vector<size_t>{0, 1, 2}));
    EXPECT_EQ(most_saving(each, 0.022, 0.1, 1.1), (std::vector<size_t>{1, 2}));
    EXPECT_EQ(most_saving(each, 0.022, 0.1, 1.2), (std::vector<size_t>{0, 2}));
    EXPECT_EQ(most_saving(each, 0.022, 0.1, 1.3), (std::vector<size_t>{0, 1}));
    EXPECT_EQ(most_saving(each, 0.022, 0.1, 9.0), (std::vector<size_t>{2})) << "what it does alone is known";
}

TEST_F(Advising, hair_that_nobody_sees_is_no_fault)
{
    Hairstyle style = small_style();
    style.params.interpolation_strands = 0;
    const Advice said = advice(style);
    EXPECT_TRUE(may_go(of(said, "colliders").verdict));
    EXPECT_LE(said.together.motion, said.tolerance);
}

} // namespace
} // namespace coif

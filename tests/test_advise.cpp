// What `coif advise` says of styles whose answer is known. Times are measured too, and nothing here looks at them.
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
    EXPECT_EQ(ball.verdict, Verdict::LEAVE_OUT);
    EXPECT_GT(bending.difference.motion, 0.1);
    EXPECT_EQ(bending.verdict, Verdict::KEEP);
    EXPECT_EQ(shadow.difference.motion, 0.0) << "it is only seen";
    EXPECT_GT(shadow.difference.picture, said.picture_tolerance);
    EXPECT_EQ(shadow.verdict, Verdict::KEEP);

    EXPECT_TRUE(said.lean.host.colliders.empty());
    EXPECT_EQ(said.lean.params.look_self_shadow, style.params.look_self_shadow);
    EXPECT_LE(said.together.motion, said.tolerance);
    EXPECT_LE(said.together.picture, said.picture_tolerance);
    EXPECT_GT(said.picture_tolerance, 0.0);
    EXPECT_LE(said.picture_tolerance, 0.5 * said.another_seed);

    const Advice again = advice(style);
    ASSERT_EQ(again.features.size(), said.features.size());
    EXPECT_EQ(changes_text(style, again.lean), changes_text(style, said.lean));
    for (size_t i = 0; i < said.features.size(); ++i)
    {
        EXPECT_EQ(again.features[i].verdict, said.features[i].verdict) << said.features[i].feature.name;
        EXPECT_EQ(again.features[i].difference.motion, said.features[i].difference.motion);
        EXPECT_EQ(again.features[i].difference.picture, said.features[i].difference.picture);
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

TEST_F(Advising, takes_back_what_together_is_too_much)
{
    // Each of these alone moves the hair by less than the tolerance, all of them by more.
    const Advice loose = advice(small_style(), 0.05);
    double most = 0.0;
    for (const Advised& a : loose.features)
        if (a.verdict == Verdict::LEAVE_OUT)
            most = std::max(most, a.difference.motion);
    const Advice said = advice(small_style(), std::max(1.001 * most, 1e-4));
    EXPECT_LE(said.together.motion, said.tolerance);
    EXPECT_LE(said.together.picture, said.picture_tolerance);
    for (const Advised& a : said.features)
        if (a.verdict == Verdict::LEAVE_OUT)
            for (const Advised& b : said.features)
                if (b.verdict == Verdict::TOGETHER_NOT)
                {
                    const auto taken = [&](const Difference& d)
                    { return std::max(d.motion / said.tolerance, d.picture / said.picture_tolerance); };
                    EXPECT_GE(taken(b.difference), taken(a.difference))
                        << b.feature.name << " goes before " << a.feature.name;
                }
}

TEST_F(Advising, hair_that_nobody_sees_is_no_fault)
{
    Hairstyle style = small_style();
    style.params.interpolation_strands = 0;
    const Advice said = advice(style);
    EXPECT_EQ(of(said, "colliders").verdict, Verdict::LEAVE_OUT);
    EXPECT_LE(said.together.motion, said.tolerance);
}

} // namespace
} // namespace coif

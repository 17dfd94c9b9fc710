// What `coif measure` computes and writes, without a device: rows as files, statistics, the cantilever's master curve,
// structural similarity, and which figures come of which rows.
#include "app/json.h"
#include "app/measure/cantilever.h"
#include "app/measure/geodesic.h"
#include "app/measure/plots.h"
#include "app/measure/rows.h"
#include "app/ssim.h"
#include "app/statistics.h"
#include "sim/median.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace coif
{
namespace
{

using test::Scratch;

Row some_row()
{
    Row row;
    row.scene = "A0";
    row.setting = "with, comma";
    row.metric = "a \"quoted\" one";
    row.solver = "pbd";
    row.knob = "step, ms";
    row.value = 4.0;
    row.error = 0.0125;
    row.unit = "L";
    row.reference = "two\nlines";
    row.pass = 0.02;
    row.state_of_the_art = 0.001;
    return row;
}

TEST(MeasureRows, csv_quotes_what_needs_it_and_leaves_out_what_is_not_known)
{
    const std::string csv = csv_of({some_row()});
    EXPECT_EQ(csv, "scene,setting,metric,solver,knob,value,measured,error,unit,reference,stretch_max,penetration_mm,"
                   "ns_strand_frame,ms,pass,state_of_the_art,verdict\n"
                   "A0,\"with, comma\",\"a \"\"quoted\"\" one\",pbd,\"step, ms\",4,,0.0125,L,\"two\nlines\",,,,,0.02,"
                   "0.001,pass\n");
}

TEST(MeasureRows, json_escapes_and_has_null_for_nan)
{
    const std::string json = json_of({some_row(), Row()}, "a \"device\"", true);
    EXPECT_NE(json.find("\"device\": \"a \\\"device\\\"\", \"quick\": true"), json.npos) << json;
    EXPECT_NE(json.find("\"metric\": \"a \\\"quoted\\\" one\""), json.npos);
    EXPECT_NE(json.find("\"reference\": \"two\\u000alines\""), json.npos);
    EXPECT_NE(json.find("\"stretch_max\": null"), json.npos);
    EXPECT_NE(json.find("\"verdict\": \"pass\""), json.npos);
    EXPECT_NE(json.find("\"verdict\": null"), json.npos);
    EXPECT_EQ(json.find("nan"), json.npos);
    EXPECT_EQ(json_number(INFINITY), "null");
    EXPECT_EQ(json_text("\t"), "\"\\u0009\"");
}

TEST(MeasureRows, a_bound_is_kept_from_the_right_side_and_never_by_nan)
{
    Row row = some_row();
    EXPECT_TRUE(row.judged() && row.passed() && !row.excels());
    row.error = 0.0005;
    EXPECT_TRUE(row.excels());
    row.error = 0.03;
    EXPECT_FALSE(row.passed());
    row.error = NAN;
    EXPECT_FALSE(row.passed());
    row.at_least = true;
    row.pass = 0.9;
    row.error = 1.0;
    EXPECT_TRUE(row.passed());
    row.error = 0.8;
    EXPECT_FALSE(row.passed());
    EXPECT_TRUE(Row().passed()) << "no bound";
    EXPECT_NE(table_of({row}).find("MISSED"), std::string::npos);
}

TEST(MeasureStatistics, medians_percentiles_and_orders)
{
    EXPECT_EQ(median({}), 0.0);
    EXPECT_EQ(median({3, 1, 2}), 2.0);
    EXPECT_EQ(percentile({4, 1, 3, 2, 5}, 0.5), 3.0);
    EXPECT_EQ(percentile({0, 10}, 0.95), 9.5);
    EXPECT_EQ(percentile({7}, 0.95), 7.0);
    EXPECT_NEAR(observed_order({1, 2, 4, 8}, {3, 12, 48, 192}), 2.0, 1e-12);
    EXPECT_NEAR(observed_order({1, 2, 0, 4}, {0.5, 1.0, 9.0, 2.0}), 1.0, 1e-12) << "a step of zero is left out";
    EXPECT_TRUE(std::isnan(observed_order({1}, {1})));
    EXPECT_TRUE(std::isnan(observed_order({2, 2}, {1, 3})));
    EXPECT_TRUE(std::isnan(observed_order({1, 2}, {0.0, NAN})));
}

TEST(MeasureStatistics, the_pareto_front_holds_what_nothing_beats_in_both)
{
    const std::vector<CostError> points = {{3, 1}, {1, 5}, {2, 5}, {2, 2}, {4, 1}, {NAN, 0}, {0.5, INFINITY}, {1, 6}};
    EXPECT_EQ(pareto_front(points), (std::vector<size_t>{1, 3, 0}));
    EXPECT_TRUE(pareto_front({}).empty());
    EXPECT_EQ(pareto_front({{1, 1}, {1, 1}}), std::vector<size_t>{0}) << "the first stands for its equals";
}

TEST(MeasureStatistics, interleaved_medians_take_turns)
{
    std::string order;
    double a = 0.0;
    const std::vector<double> medians = interleaved_medians({[&]
                                                             {
                                                                 order += 'a';
                                                                 return ++a;
                                                             },
                                                             [&]
                                                             {
                                                                 order += 'b';
                                                                 return 7.0;
                                                             }},
                                                            3);
    EXPECT_EQ(order, "ababab");
    EXPECT_EQ(medians, (std::vector<double>{2.0, 7.0}));
}

TEST(MeasureCantilever, the_master_curve_is_the_heavy_elasticas)
{
    // Chebyshev collocation of theta'' = -Gamma (1 - s) cos(theta), 96 and 160 points agreeing to 3e-11.
    const double known[][4] = {{0.1, 0.012498, 0.999911, 0.012500},
                               {1, 0.123471, 0.991246, 0.124562},
                               {10, 0.700200, 0.656354, 1.066802},
                               {100, 0.937524, 0.159223, 5.888105},
                               {1000, 0.981141, 0.045986, 21.335440}};
    for (const auto& k : known)
    {
        const Droop droop = droop_at(k[0]);
        EXPECT_NEAR(droop.gamma / k[0], 1.0, 1e-9);
        EXPECT_NEAR(droop.height, k[1], 1e-6);
        EXPECT_NEAR(droop.width, k[2], 1e-6);
        EXPECT_NEAR(droop.ratio() / k[3], 1.0, 5e-5);
    }
    // A beam that hardly bends: H / L = Gamma / 8; one that hardly resists: W / L = sqrt(2 / Gamma).
    EXPECT_NEAR(droop_at(1e-3).height / (1e-3 / 8.0), 1.0, 1e-6);
    EXPECT_NEAR(droop_at(1e5).width / std::sqrt(2e-5), 1.0, 0.03);
    EXPECT_EQ(master_curve(0.1, 1000.0, 7).size(), 7u);
}

// ---- SSIM
// ------------------------------------------------------------------------------------------------------------

Image grey(int width, int height, auto level)
{
    Image image{width, height, std::vector<unsigned char>(size_t(4) * size_t(width) * size_t(height), 255)};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                image.pixels[size_t(4 * (y * width + x) + c)] = static_cast<unsigned char>(level(x, y));
    return image;
}

int scene(int x, int y) { return int(128.0 + 60.0 * std::sin(0.7 * x) * std::cos(0.4 * y) + (x * 37 + y * 91) % 23); }

TEST(Ssim, the_same_picture_scores_one_and_the_order_does_not_matter)
{
    const Image a = grey(40, 30, scene), b = grey(40, 30, [](int x, int y) { return scene(x + 1, y); });
    EXPECT_NEAR(ssim(a, a), 1.0, 1e-12);
    EXPECT_NEAR(ssim(a, b), ssim(b, a), 1e-12);
    EXPECT_LT(ssim(a, b), 0.95);
}

TEST(Ssim, flat_pictures_score_by_their_means_alone)
{
    // One window: (2 m1 m2 + C1) / (m1^2 + m2^2 + C1), C1 = (0.01 * 255)^2.
    const Image a = grey(11, 11, [](int, int) { return 100; }), b = grey(11, 11, [](int, int) { return 120; });
    EXPECT_NEAR(ssim(a, b), (2.0 * 100 * 120 + 6.5025) / (100.0 * 100 + 120.0 * 120 + 6.5025), 1e-12);
}

TEST(Ssim, a_window_worked_out_by_hand)
{
    // One pixel of 255 in the middle of a black window against none: with w the middle's weight, 1 / (sum of the
    // Gaussian)^2, the mean is 255 w and the variance 255^2 w (1 - w).
    const Image a = grey(11, 11, [](int x, int y) { return x == 5 && y == 5 ? 255 : 0; });
    const Image b = grey(11, 11, [](int, int) { return 0; });
    double sum = 0.0;
    for (int d = -5; d <= 5; ++d)
        sum += std::exp(-d * d / 4.5);
    const double w = 1.0 / (sum * sum), mean = 255.0 * w, variance = 255.0 * 255.0 * w * (1.0 - w);
    const double c1 = 6.5025, c2 = 58.5225;
    EXPECT_NEAR(ssim(a, b), c1 / (mean * mean + c1) * (c2 / (variance + c2)), 1e-12);
    // Contrast turned round about the same mean is structure turned round: the score is negative.
    const Image up = grey(40, 40, [](int x, int) { return x % 2 ? 160 : 96; });
    const Image down = grey(40, 40, [](int x, int) { return x % 2 ? 96 : 160; });
    EXPECT_LT(ssim(up, down), -0.9);
}

TEST(Ssim, worse_distortions_score_worse_and_only_what_counts_is_scored)
{
    const Image a = grey(60, 40, scene);
    double before = 1.0;
    for (const int noise : {4, 12, 36, 90})
    {
        const Image b = grey(60, 40,
                             [&](int x, int y)
                             { return std::clamp(scene(x, y) + ((x * 131 + y * 57) % 17 - 8) * noise / 8, 0, 255); });
        const double score = ssim(a, b);
        EXPECT_LT(score, before) << noise;
        before = score;
    }
    // Broken on the left only.
    const Image half = grey(60, 40, [](int x, int y) { return x < 20 ? 0 : scene(x, y); });
    Mask right(60 * 40), none(60 * 40), border(60 * 40);
    for (int y = 0; y < 40; ++y)
        for (int x = 30; x < 60; ++x)
            right[size_t(y * 60 + x)] = true;
    border[0] = true;
    EXPECT_NEAR(ssim(a, half, right), 1.0, 1e-12);
    EXPECT_LT(ssim(a, half), 0.9);
    EXPECT_TRUE(std::isnan(ssim(a, half, none)));
    EXPECT_TRUE(std::isnan(ssim(a, half, border))) << "its window is not whole";
}

TEST(Ssim, changed_pixels_are_those_that_differ_enough)
{
    const Image a = grey(3, 1, [](int, int) { return 100; }), b = grey(3, 1, [](int x, int) { return 100 + 8 * x; });
    EXPECT_EQ(changed_pixels(a, b, 8), (Mask{false, true, true}));
    EXPECT_EQ(changed_pixels(a, b, 9), (Mask{false, false, true}));
}

// ---- hair on a ball
// --------------------------------------------------------------------------------------------------

TEST(Geodesic, every_root_is_the_mix_of_the_three_guides_about_it)
{
    HairParams params;
    params.root_lift_variation = params.root_sweep_variation = 0.0f;
    params.root_lift = 0.0f; // all roots point away from the centre: nothing is opposed but on coarse balls
    const Ball ball{{0.01f, -0.02f, 0.03f}, 0.1f};
    const std::vector<glm::vec3> roots = even_roots(ball, 500, 0.1f, 2.0f);
    double before = 1.0;
    for (const int frequency : {4, 6, 12, 30})
    {
        const GeodesicGroom made = geodesic_groom(params, ball, roots, frequency);
        const Groom& groom = made.groom;
        ASSERT_EQ(groom.drawn.size(), roots.size());
        EXPECT_LE(groom.guides, 10 * frequency * frequency + 2);
        EXPECT_NEAR(made.spacing, 0.12 / frequency, 0.012 / frequency);
        EXPECT_LT(made.spacing, before);
        before = made.spacing;
        for (size_t i = 0; i < roots.size(); ++i)
        {
            const DrawnStrand& s = groom.drawn[i];
            const float weights[3] = {s.weights.x, s.weights.y, s.weights.z};
            const int guides[3] = {s.guide0, s.guide1, s.guide2};
            EXPECT_NEAR(weights[0] + weights[1] + weights[2], 1.0, 1e-5);
            EXPECT_GE(std::min({weights[0], weights[1], weights[2]}), 0.0f);
            glm::vec3 mix(0.0f);
            for (int k = 0; k < 3; ++k)
            {
                const glm::vec3 at = made.scalp.positions[size_t(guides[k])];
                mix += weights[k] * (at - ball.center);
                EXPECT_LT(glm::distance(at, roots[i]), 1.3 * made.spacing) << "a guide about it";
            }
            EXPECT_LT(glm::distance(glm::normalize(mix), glm::normalize(roots[i] - ball.center)), 1e-5);
        }
    }
}

TEST(Geodesic, all_simulated_hair_stands_on_guides_of_its_own)
{
    HairParams params;
    const std::vector<glm::vec3> roots = even_roots({}, 33, 0.0f, 1.0f);
    const Groom groom = all_simulated(params, {}, roots);
    ASSERT_EQ(groom.guides, 33);
    for (size_t i = 0; i < roots.size(); ++i)
    {
        EXPECT_EQ(groom.drawn[i].guide0, int(i));
        EXPECT_EQ(groom.drawn[i].weights.x, 1.0f);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(groom.root_position[size_t(strand_value(int(i), 0, axis, 1))], roots[i][axis], 1e-7);
    }
}

// ---- figures
// ---------------------------------------------------------------------------------------------------------

// Rows as a whole suite would have them, of made-up solvers that err as 1 / cost and 1 / cost^2.
std::vector<Row> made_up_rows()
{
    std::vector<Row> rows;
    for (const int p : {1, 2})
        for (const double n : {1.0, 2.0, 4.0, 8.0, 16.0})
        {
            Row row;
            row.solver = p == 1 ? "first" : "second";
            row.scene = "A10";
            row.metric = "rms";
            row.knob = "step, ms";
            row.value = 16.7 / n;
            row.error = 0.12 * std::pow(n, -p);
            row.unit = "L";
            row.ns_strand_frame = 100.0 * p * n;
            rows.push_back(row);
            row.scene = "A8";
            row.metric = "H/W";
            row.knob = "Gamma";
            row.unit = "";
            row.value = 0.5 * n * n;
            row.measured = droop_at(row.value).ratio() * (1.0 + 0.1 / p);
            row.error = 0.1 / p;
            rows.push_back(row);
            row.scene = "courant";
            row.metric = "rms";
            row.knob = "courant";
            rows.push_back(row);
        }
    return rows;
}

TEST(MeasurePlots, each_figure_comes_of_the_rows_that_it_is_about)
{
    std::vector<std::string> names;
    for (const Plot& plot : plots_of(made_up_rows()))
        names.push_back(plot.name);
    EXPECT_EQ(names, (std::vector<std::string>{"error_cost", "order", "cantilever", "knobs"}));
    EXPECT_TRUE(plots_of({}).empty());
}

TEST(MeasurePlots, scripts_are_written_whether_or_not_gnuplot_is_there)
{
    const Scratch scratch;
    const std::vector<Plot> plots = plots_of(made_up_rows());
    const std::string trouble = write_plots(scratch.folder(), plots);
    for (const Plot& plot : plots)
    {
        EXPECT_TRUE(fs::exists(scratch / ("plots/" + plot.name + ".gp"))) << plot.name;
        if (trouble.empty())
        {
            EXPECT_NE(test::bytes_of(scratch / ("plots/" + plot.name + ".svg")).find("</svg>"), std::string::npos);
            EXPECT_EQ(test::bytes_of(scratch / ("plots/" + plot.name + ".png")).substr(1, 3), "PNG");
        }
    }
    // As on a machine without it.
    const std::string path = std::getenv("PATH");
    setenv("PATH", scratch.folder().c_str(), 1);
    const std::string missing = write_plots(scratch / "other", plots);
    setenv("PATH", path.c_str(), 1);
    EXPECT_NE(missing.find("gnuplot is not installed"), std::string::npos) << missing;
    EXPECT_NE(missing.find("apt install gnuplot"), std::string::npos);
    EXPECT_TRUE(fs::exists(scratch / "other/plots/order.gp"));
}

} // namespace
} // namespace coif

// Brushes: what a stroke does to a style, without a window.
#include "app/brush.h"
#include "sim/groom.h"
#include "sim/rest_shape.h"
#include "sim/shaping.h"
#include "sim/source.h"
#include "tests/host/scratch.h"

#include <algorithm>
#include <cmath>

namespace coif
{
namespace
{

Scalp whole_scalp() { return load_scalp(data_folder() / "assets" / "scalp.obj"); }

// All strands straight away from the scalp, 0.2 m long.
StrandShapes straight(const Scalp& scalp, int nodes = 16)
{
    StrandShapes shapes;
    shapes.nodes = nodes;
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        for (int k = 0; k < nodes; ++k)
            shapes.position.push_back(scalp.positions[v] + scalp.normals[v] * (0.2f * float(k - 1) / float(nodes - 2)));
    return shapes;
}

float value_at(const Hairstyle& style, const Scalp& scalp, size_t vertex, const char* path)
{
    float value[4];
    const Shaping shaping = shape_over(style.params, style.host, scalp, scalp);
    get_numbers(params_at(shaping, at_vertex(scalp, vertex)), *find_param(path), value);
    return value[0];
}

struct Painted
{
    BrushKind kind;
    const char* path;
    float aim;
};

const Painted kPainted[] = {{BrushKind::LENGTH, "strand.length", 0.05f},
                            {BrushKind::LIFT, "root.lift", 10.0f},
                            {BrushKind::WAVE, "wave.normal_amplitude", 0.01f},
                            {BrushKind::DENSITY, "interpolation.density", 0.2f},
                            {BrushKind::COLOR, "look.root_color", 0.9f}};

Brush brush_for(const Painted& painted)
{
    Brush brush;
    brush.kind = painted.kind;
    brush.length = brush.lift = brush.wave = brush.density = painted.aim;
    brush.color = glm::vec3(painted.aim);
    brush.strength = 1.0f;
    brush.falloff = 0.5f;
    return brush;
}

TEST(Brush, each_paints_its_own_parameter_under_it_and_nothing_elsewhere)
{
    const Scalp scalp = whole_scalp();
    const glm::vec3 at = scalp.positions[40];
    for (const Painted& painted : kPainted)
    {
        Hairstyle style;
        const Brush brush = brush_for(painted);
        EXPECT_TRUE(apply_brush(style, scalp, straight(scalp), brush, {at, {}})) << painted.path;
        EXPECT_NEAR(value_at(style, scalp, 40, painted.path), painted.aim, 1e-5f) << painted.path;
        for (size_t v = 0; v < scalp.positions.size(); ++v)
            if (glm::distance(scalp.positions[v], at) >= brush.radius)
            {
                EXPECT_EQ(value_at(style, scalp, v, painted.path), value_at({}, scalp, v, painted.path))
                    << painted.path;
            }
    }
}

TEST(Brush, strength_and_fall_off_weaken_and_strokes_converge)
{
    const Scalp scalp = whole_scalp();
    const glm::vec3 at = scalp.positions[40];
    Brush brush;
    brush.strength = 0.3f;
    brush.falloff = 1.0f;
    EXPECT_FLOAT_EQ(brush_weight(brush, at, at), 0.3f);
    EXPECT_GT(brush_weight(brush, at, at + glm::vec3(0.4f * brush.radius, 0, 0)),
              brush_weight(brush, at, at + glm::vec3(0.8f * brush.radius, 0, 0)));
    EXPECT_EQ(brush_weight(brush, at, at + glm::vec3(1.01f * brush.radius, 0, 0)), 0.0f);
    brush.falloff = 0.0f;
    EXPECT_FLOAT_EQ(brush_weight(brush, at, at + glm::vec3(0.9f * brush.radius, 0, 0)), 0.3f);
    Hairstyle style;
    brush.kind = BrushKind::LENGTH;
    brush.length = 0.1f;
    float before = value_at(style, scalp, 40, "strand.length");
    for (int i = 0; i < 60; ++i)
    {
        apply_brush(style, scalp, straight(scalp), brush, {at, {}});
        const float now = value_at(style, scalp, 40, "strand.length");
        EXPECT_LE(now, before);
        before = now;
    }
    EXPECT_NEAR(before, 0.1f, 1e-4f);
}

TEST(Brush, mirror_paints_both_sides_alike)
{
    const Scalp scalp = whole_scalp();
    Brush brush = brush_for(kPainted[0]);
    brush.mirror = true;
    brush.radius = 0.04f;
    Hairstyle style;
    const glm::vec3 at(0.07f, 0.06f, 0.0f);
    ASSERT_TRUE(apply_brush(style, scalp, straight(scalp), brush, {at, {}}));
    int left = 0, right = 0;
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        if (value_at(style, scalp, v, "strand.length") < 0.1f)
            (scalp.positions[v].x > 0.0f ? left : right) += 1;
    EXPECT_GT(left, 2);
    EXPECT_GT(right, 2);
}

TEST(Brush, mirrored_halves_are_mirror_images_wherever_the_stroke_runs)
{
    const Scalp scalp = whole_scalp();
    const size_t count = scalp.positions.size();
    std::vector<size_t> twin(count, count); // across the middle of the head
    for (size_t v = 0; v < count; ++v)
        for (size_t w = 0; w < count; ++w)
            if (glm::distance(scalp.positions[w] * glm::vec3(-1, 1, 1), scalp.positions[v]) < 1e-4f &&
                glm::distance(scalp.normals[w] * glm::vec3(-1, 1, 1), scalp.normals[v]) < 1e-3f)
                twin[v] = w;
    for (const BrushKind kind : {BrushKind::LENGTH, BrushKind::COMB})
    {
        Hairstyle style;
        Brush brush;
        brush.kind = kind;
        brush.mirror = true;
        brush.radius = 0.05f;
        // Over the crown from one side to the other.
        for (float x = -0.04f; x < 0.041f; x += 0.01f)
            apply_brush(style, scalp, straight(scalp), brush, {{x, 0.11f, 0.0f}, {0.01f, 0.0f, 0.004f}});
        int touched = 0;
        for (size_t v = 0; v < count; ++v)
        {
            if (twin[v] == count)
                continue;
            if (kind == BrushKind::LENGTH)
            {
                const float length = value_at(style, scalp, v, "strand.length");
                EXPECT_NEAR(length, value_at(style, scalp, twin[v], "strand.length"), 1e-4f) << v;
                touched += length < 0.2f;
                continue;
            }
            const StrandShapes& combed = *style.host.groom_rest.shapes;
            const glm::vec3 tip = combed.position[v * 16 + 15], other = combed.position[twin[v] * 16 + 15];
            EXPECT_LT(glm::distance(tip * glm::vec3(-1, 1, 1), other), 2e-3f) << v;
            touched += glm::distance(tip, straight(scalp).position[v * 16 + 15]) > 0.02f;
        }
        EXPECT_GT(touched, 10);
    }
}

TEST(Brush, a_region_is_painted_taken_out_and_written)
{
    const Scalp scalp = whole_scalp();
    const glm::vec3 at = scalp.positions[40];
    const auto weight = [&](const Hairstyle& style, size_t vertex)
    { return region_weight(shape_over(style.params, style.host, scalp, scalp), 0, at_vertex(scalp, vertex)); };
    Brush brush;
    brush.kind = BrushKind::REGION;
    brush.region = "mine";
    brush.strength = 1.0f;
    brush.falloff = 0.0f;
    Hairstyle style;
    brush.weight = 0.0f;
    EXPECT_FALSE(apply_brush(style, scalp, {}, brush, {at, {}})) << "nothing can be taken out of what is not there";
    EXPECT_TRUE(style.host.regions.empty());
    brush.weight = 1.0f;
    ASSERT_TRUE(apply_brush(style, scalp, {}, brush, {at, {}}));
    ASSERT_EQ(style.host.regions.size(), 1u);
    EXPECT_FALSE(apply_brush(style, scalp, {}, brush, {at, {}})) << "it belongs to it already";
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        EXPECT_EQ(weight(style, v), glm::distance(scalp.positions[v], at) < brush.radius ? 1.0f : 0.0f) << v;
    style.host.regions[0].settings.push_back({find_param("strand.length"), {0.02f, 0.0f, 0.0f, 0.0f}});
    EXPECT_FLOAT_EQ(value_at(style, scalp, 40, "strand.length"), 0.02f);

    brush.strength = 0.5f;
    brush.weight = 0.0f;
    EXPECT_TRUE(apply_brush(style, scalp, {}, brush, {at, {}}));
    EXPECT_FLOAT_EQ(weight(style, 40), 0.5f);
    const test::Scratch scratch;
    const std::vector<Region> painted = style.host.regions;
    save_hairstyle(style, scratch / "painted.toml");
    EXPECT_EQ(load_hairstyle(scratch / "painted.toml").host.regions, painted);

    Brush picked;
    pick_value(picked, style, scalp, at);
    EXPECT_EQ(picked.region, "") << "half is not more than not";
    brush.weight = 1.0f;
    apply_brush(style, scalp, {}, brush, {at, {}});
    pick_value(picked, style, scalp, at);
    EXPECT_EQ(picked.region, "mine");
}

TEST(Brush, a_region_told_by_a_rule_keeps_its_shape_when_it_is_painted)
{
    const Scalp scalp = whole_scalp();
    Hairstyle style;
    Region region;
    region.name = "sides";
    region.where = {"top", "crown"};
    region.planes = {{0.0f, 0.0f, 1.0f, -0.02f}};
    region.invert = true;
    style.host.regions = {region};
    const Shaping rule = shape_over(style.params, style.host, scalp, scalp);
    std::vector<float> before;
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        before.push_back(region_weight(rule, 0, at_vertex(scalp, v)));
    const size_t out = size_t(std::ranges::find(before, 0.0f) - before.begin());
    ASSERT_LT(out, before.size());
    Brush brush;
    brush.kind = BrushKind::REGION;
    brush.region = "sides";
    brush.radius = 0.015f;
    brush.strength = 1.0f;
    ASSERT_TRUE(apply_brush(style, scalp, {}, brush, {scalp.positions[out], {}}));
    EXPECT_TRUE(is_painted_only(style.host.regions[0]));
    const Shaping painted = shape_over(style.params, style.host, scalp, scalp);
    for (size_t v = 0; v < scalp.positions.size(); ++v)
    {
        const float now = region_weight(painted, 0, at_vertex(scalp, v));
        if (glm::distance(scalp.positions[v], scalp.positions[out]) >= brush.radius)
        {
            EXPECT_FLOAT_EQ(now, before[v]) << v;
        }
    }
    EXPECT_EQ(region_weight(painted, 0, at_vertex(scalp, out)), 1.0f) << "outside the rule too";
}

TEST(Brush, erase_takes_back_and_leaves_no_empty_maps)
{
    const Scalp scalp = whole_scalp();
    const glm::vec3 at = scalp.positions[40];
    Hairstyle style;
    for (const Painted& painted : kPainted)
        apply_brush(style, scalp, straight(scalp), brush_for(painted), {at, {}});
    ASSERT_GE(style.host.maps.size(), 5u);
    Brush eraser;
    eraser.kind = BrushKind::ERASE;
    eraser.strength = 1.0f;
    eraser.falloff = 0.0f;
    eraser.radius = 0.05f;
    EXPECT_TRUE(apply_brush(style, scalp, straight(scalp), eraser, {at, {}}));
    EXPECT_TRUE(style.host.maps.empty());
    EXPECT_FALSE(apply_brush(style, scalp, straight(scalp), eraser, {at, {}})) << "nothing is left to erase";
}

TEST(Brush, smooth_evens_out)
{
    const Scalp scalp = whole_scalp();
    Hairstyle style;
    style.host.maps.push_back({"strand.length", MAP_OFFSET, std::vector<float>(scalp.positions.size(), 0.0f), {}});
    style.host.maps[0].values[40] = 0.1f;
    Brush brush;
    brush.kind = BrushKind::SMOOTH;
    brush.strength = 0.5f;
    brush.radius = 0.1f;
    const auto spread = [&]
    {
        float most = 0.0f;
        for (const float v : style.host.maps[0].values)
            most = std::max(most, std::abs(v));
        return most;
    };
    float before = spread();
    for (int i = 0; i < 5; ++i)
    {
        EXPECT_TRUE(apply_brush(style, scalp, straight(scalp), brush, {scalp.positions[40], {}}));
        EXPECT_LT(spread(), before);
        before = spread();
    }
}

TEST(Brush, comb_turns_strands_the_way_it_goes_and_keeps_their_lengths)
{
    const Scalp scalp = whole_scalp();
    const StrandShapes start = straight(scalp);
    Hairstyle style;
    Brush brush;
    brush.strength = 1.0f;
    brush.falloff = 0.2f;
    const glm::vec3 at = scalp.positions[40], n = scalp.normals[40];
    const glm::vec3 way = glm::normalize(glm::cross(n, glm::vec3(0.3f, 0.2f, 0.9f)));
    for (int i = 0; i < 10; ++i)
        ASSERT_TRUE(apply_brush(style, scalp, start, brush, {at, way * 0.01f}));
    const StrandShapes& combed = *style.host.groom_rest.shapes;
    const glm::vec3 first = glm::normalize(combed.position[40 * 16 + 1] - combed.position[40 * 16]);
    EXPECT_GT(glm::dot(first, way), 0.25f) << "laid over";
    EXPECT_GT(glm::dot(glm::normalize(first - n * glm::dot(first, n)), way), 0.999f);
    for (size_t v = 0; v < scalp.positions.size(); ++v)
        for (size_t k = 1; k < 16; ++k)
        {
            const size_t i = v * 16 + k;
            EXPECT_NEAR(glm::distance(combed.position[i], combed.position[i - 1]), 0.2f / 14.0f, 1e-6f);
            if (glm::distance(scalp.positions[v], at) >= brush.radius)
            {
                EXPECT_EQ(combed.position[i], start.position[i]) << "the others stay";
            }
        }
    const Groom groom = grow(style.params, scalp, style.host);
    EXPECT_EQ(groom.hold, 1.0f);
    EXPECT_GT(glm::dot(glm::vec3(vector_at(groom.root_direction.data(), 40, 0, 1)), way), 0.25f) << "roots too";
}

TEST(Brush, a_straight_cut_ends_every_strand_at_the_plane)
{
    const Scalp scalp = whole_scalp();
    StrandShapes hanging;
    hanging.nodes = 16;
    for (const glm::vec3& root : scalp.positions)
        for (int k = 0; k < 16; ++k)
            hanging.position.push_back(root - glm::vec3(0, 0.25f * float(k - 1) / 14.0f, 0));
    Hairstyle style;
    ASSERT_TRUE(cut_at_plane(style, scalp, hanging, {0, -1, 0}, 0.12f));
    for (size_t v = 0; v < scalp.positions.size(); ++v)
    {
        const float reach = scalp.positions[v].y + 0.12f;
        EXPECT_NEAR(value_at(style, scalp, v, "strand.length"), std::min(0.25f, std::max(0.002f, reach)), 1e-5f);
    }
    EXPECT_FALSE(cut_at_plane(style, scalp, hanging, {0, -1, 0}, 5.0f)) << "nothing reaches so far";
}

TEST(Brush, a_picked_value_is_what_was_painted)
{
    const Scalp scalp = whole_scalp();
    Hairstyle style;
    const Brush painter = brush_for(kPainted[0]);
    apply_brush(style, scalp, straight(scalp), painter, {scalp.positions[40], {}});
    Brush brush;
    pick_value(brush, style, scalp, scalp.positions[40]);
    EXPECT_NEAR(brush.length, 0.05f, 1e-5f);
    pick_value(brush, style, scalp, scalp.positions[200]);
    EXPECT_EQ(brush.length, 0.25f);
}

TEST(Brush, any_strokes_leave_a_style_that_can_be_written_read_and_grown)
{
    const Scalp scalp = whole_scalp();
    std::mt19937 random(7);
    Hairstyle style;
    for (int i = 0; i < 200; ++i)
    {
        Brush brush;
        brush.kind = BrushKind(random() % kBrushKinds);
        brush.radius = float(test::between(random, 0.004, 0.15));
        brush.strength = float(test::between(random, 0.02, 1.0));
        brush.falloff = float(test::between(random, 0.0, 1.0));
        brush.mirror = random() % 2;
        brush.length = float(test::between(random, 0.002, 1.5));
        brush.density = float(test::between(random, 0.0, 1.0));
        brush.region = random() % 2 ? "a" : "b";
        brush.weight = float(random() % 2);
        const glm::vec3 at = scalp.positions[random() % scalp.positions.size()];
        const glm::vec3 along(test::between(random, -0.03, 0.03), test::between(random, -0.03, 0.03), 0.0);
        apply_brush(style, scalp, straight(scalp), brush, {at, along});
    }
    const Groom groom = grow(style.params, scalp, style.host);
    for (const float x : groom.rest_position)
        ASSERT_TRUE(std::isfinite(x));
    test::Scratch scratch;
    const HostParams painted = style.host;
    save_hairstyle(style, scratch / "painted.toml");
    const Hairstyle again = load_hairstyle(scratch / "painted.toml");
    EXPECT_EQ(again.host.maps, painted.maps);
    EXPECT_EQ(again.host.regions, painted.regions);
    EXPECT_FALSE(painted.regions.empty());
    ASSERT_TRUE(again.host.groom_rest.shapes);
    EXPECT_EQ(*again.host.groom_rest.shapes, *painted.groom_rest.shapes);
    EXPECT_EQ(again.host.groom_rest.file, "painted.rest");
}

} // namespace
} // namespace coif

// Hair of a file set onto a scalp: units and axes, roots, resampling, and the groom that it makes.
#include "app/import.h"
#include "sim/exchange/place.h"
#include "sim/hairstyle.h"
#include "sim/rest_shape.h"
#include "sim/scatter.h"
#include "sim/simulation.h"
#include "tests/host/scratch.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace coif
{
namespace
{

using test::bytes_of;
using test::error_of;
using test::Scratch;
using test::shipped;

const Scalp& whole_scalp()
{
    static const Scalp scalp = load_scalp(shipped("scalp.obj"));
    return scalp;
}

// So many strands of arcs that leave the scalp at its normals and fall, 10 to 20 cm long, in metres.
HairFile arcs(int strands, int points = 20)
{
    const Scalp& scalp = whole_scalp();
    HairFile file;
    file.format = "test";
    for (const Between& place : spread_places(scalp, strands, 3))
    {
        glm::vec3 root(0.0f), normal(0.0f);
        for (int k = 0; k < 3; ++k)
        {
            root += place.shares[k] * scalp.positions[place.of[k]];
            normal += place.shares[k] * scalp.normals[place.of[k]];
        }
        const float length = 0.1f + 0.1f * random01(1, int(file.curves.strands()), 50);
        glm::vec3 at = root, way = glm::normalize(normal);
        for (int k = 0; k < points; ++k)
        {
            file.curves.position.push_back(at);
            at += way * length / float(points - 1);
            way = glm::normalize(way + glm::vec3(0.0f, -1.5f / float(points), 0.0f));
        }
        file.curves.count.push_back(uint32_t(points));
    }
    return file;
}

double length_of(const std::vector<glm::vec3>& curve)
{
    double length = 0.0;
    for (size_t k = 1; k < curve.size(); ++k)
        length += double(glm::distance(curve[k], curve[k - 1]));
    return length;
}

TEST(PlaceHair, resampling_keeps_ends_lengths_and_the_curve)
{
    std::vector<glm::vec3> arc; // a half circle of 100 uneven pieces
    for (int k = 0; k <= 100; ++k)
    {
        const double t = std::pow(k / 100.0, 1.7) * 3.14159265358979;
        arc.emplace_back(0.1 * std::cos(t), 0.1 * std::sin(t), 0.0);
    }
    for (const int links : {1, 2, 3, 8, 14, 62})
    {
        SCOPED_TRACE(links);
        std::vector<glm::vec3> corners;
        const float step = resampled(arc.data(), arc.size(), links, corners);
        ASSERT_EQ(corners.size(), size_t(links) + 1);
        EXPECT_EQ(corners.front(), arc.front());
        EXPECT_LT(glm::distance(corners.back(), arc.back()), 2e-5f);
        // Chords of a circle, cut in so many.
        EXPECT_NEAR(double(step) * links, 0.2 * links * std::sin(3.14159265358979 / 2.0 / links), 1e-4);
        for (size_t k = 1; k < corners.size(); ++k)
        {
            EXPECT_NEAR(glm::distance(corners[k], corners[k - 1]), step, 2e-6f);
            EXPECT_NEAR(glm::length(corners[k]), 0.1f, 1e-4f) << "on the circle";
        }
    }
    // What is straight is as long as before, and what has as many even pieces is the same.
    const std::vector<glm::vec3> straight = {{0, 0, 0}, {0, 0.01f, 0}, {0, 0.07f, 0}, {0, 0.2f, 0}};
    std::vector<glm::vec3> corners;
    EXPECT_NEAR(resampled(straight.data(), 4, 14, corners) * 14.0f, 0.2f, 1e-6f);
    const std::vector<glm::vec3> bent = {{0, 0, 0}, {0.03f, 0, 0}, {0.03f, 0.03f, 0}, {0.03f, 0.03f, 0.03f}};
    resampled(bent.data(), 4, 3, corners);
    for (size_t k = 0; k < 4; ++k)
        EXPECT_LT(glm::distance(corners[k], bent[k]), 1e-6f);
}

TEST(PlaceHair, resampling_takes_any_curve)
{
    std::mt19937 random(11);
    for (int i = 0; i < 300; ++i)
    {
        std::vector<glm::vec3> curve;
        const size_t points = 2 + random() % 30;
        for (size_t k = 0; k < points; ++k) // loops, points in one place
            curve.push_back(k > 0 && random() % 4 == 0
                                ? curve.back()
                                : glm::vec3(test::between(random, -1, 1), test::between(random, -1, 1),
                                            test::between(random, -1, 1)));
        curve.emplace_back(2.0f, 0.0f, 0.0f);
        std::vector<glm::vec3> corners;
        const int links = 1 + int(random() % 62);
        const float step = resampled(curve.data(), curve.size(), links, corners);
        ASSERT_EQ(corners.size(), size_t(links) + 1);
        EXPECT_GT(step, 0.0f);
        EXPECT_LE(double(step) * links, length_of(curve) * 1.0002);
        for (const glm::vec3& p : corners)
            EXPECT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 2.0f);
    }
}

TEST(PlaceHair, units_and_axes_are_guessed_and_told)
{
    const PlacedHair straight = place_hair(arcs(200), whole_scalp(), {});
    EXPECT_LT(straight.farthest, 1e-6f);
    EXPECT_NE(straight.said.find("its unit is 1 m (a guess), its y axis points up (a guess)"), std::string::npos)
        << straight.said;
    const auto turned = [](float scale, HairUp up, glm::vec3 by = glm::vec3(0.0f))
    {
        HairFile file = arcs(200);
        for (glm::vec3& p : file.curves.position)
        {
            p -= by;
            p = scale * (up == HAIR_UP_Z        ? glm::vec3(p.x, -p.z, p.y)
                         : up == HAIR_UP_UNREAL ? glm::vec3(p.x, p.z, p.y)
                                                : p);
        }
        return file;
    };
    const auto same = [&](const HairFile& file, const HairParams& params)
    {
        const PlacedHair hair = place_hair(file, whole_scalp(), params);
        ASSERT_EQ(hair.position.size(), straight.position.size());
        for (size_t i = 0; i < hair.position.size(); ++i)
            ASSERT_LT(glm::distance(hair.position[i], straight.position[i]), 1e-6f);
    };
    HairParams params;
    same(turned(100.0f, HAIR_UP_Y), params); // centimetres
    same(turned(1000.0f, HAIR_UP_Y), params);
    same(turned(100.0f, HAIR_UP_Z), params);
    same(turned(1.0f, HAIR_UP_Z), params);
    same(turned(100.0f, HAIR_UP_UNREAL), params);
    params.groom_import_up = HAIR_UP_UNREAL;
    params.groom_import_scale = 0.02f;
    same(turned(50.0f, HAIR_UP_UNREAL), params);
    HairFile said = turned(5.0f, HAIR_UP_Z);
    said.unit = 0.2f;
    said.up = HAIR_UP_Z;
    same(said, {});
    // On a standing figure, and z up.
    const glm::vec3 figure(0.0f, -1.6f, 0.0f);
    params = {};
    params.groom_import_offset = F4(0.0f, -1.6f, 0.0f, 0.0f);
    same(turned(100.0f, HAIR_UP_Z, figure), params);
    const HairFile far = turned(100.0f, HAIR_UP_Y, figure);
    const std::string error = error_of([&] { place_hair(far, whole_scalp(), {}); });
    EXPECT_NE(error.find("200 of the 200 strands do not stand on this scalp"), std::string::npos) << error;
    EXPECT_NE(error.find("groom.import_offset = ["), std::string::npos) << error;
    std::string words;
    const glm::vec3 by = fitting_offset(far, hair_frame(far, whole_scalp(), {}, words), whole_scalp());
    EXPECT_LT(glm::distance(by, figure), 0.01f);
    EXPECT_EQ(fitting_offset(arcs(200), hair_frame(arcs(200), whole_scalp(), {}, words), whole_scalp()),
              glm::vec3(0.0f));
}

TEST(PlaceHair, roots_snap_to_the_scalp_and_strays_are_dropped)
{
    HairFile file = arcs(300);
    const Scalp& scalp = whole_scalp();
    for (size_t i = 0; i < file.curves.points(); ++i)
        file.curves.position[i] += 0.01f * glm::normalize(file.curves.position[i / 20 * 20] - scalp.center);
    for (size_t i = 20 * 7; i < 20 * 10; ++i) // three of them
        file.curves.position[i] += glm::vec3(0.0f, 0.5f, 0.0f);
    const PlacedHair hair = place_hair(file, scalp, {});
    EXPECT_EQ(hair.strands(), 297u);
    EXPECT_NEAR(hair.farthest, 0.01f, 1e-3f);
    ASSERT_EQ(hair.remark.size(), 1u);
    EXPECT_NE(hair.remark[0].find("3 of its strands have roots more than"), std::string::npos);
    for (size_t s = 0; s < hair.strands(); ++s)
    {
        const Between& at = hair.place[s];
        EXPECT_NEAR(at.shares.x + at.shares.y + at.shares.z, 1.0f, 1e-6f);
        EXPECT_GE(std::min({at.shares.x, at.shares.y, at.shares.z}), 0.0f);
        EXPECT_EQ(hair.position[hair.first[s]], glm::vec3(0.0f));
        EXPECT_GT(hair.length(s), 0.09f);
        EXPECT_LT(hair.length(s), 0.21f);
    }
    // The other way round they are turned.
    std::reverse(file.curves.position.begin(), file.curves.position.end());
    const PlacedHair turned = place_hair(file, scalp, {});
    EXPECT_EQ(turned.strands(), 297u);
    EXPECT_EQ(turned.remark[0], "its strands begin at their tips, and are turned round");
}

// Every guide of a style with hair of a file lies on that file's curve, from its place on.
TEST(PlaceHair, guides_lie_where_the_file_has_them)
{
    Scalp scalp = whole_scalp();
    const size_t authored = scalp.positions.size();
    HairFile file = arcs(120);
    file.curves.guide.assign(120, 1);
    scalp.hair = std::make_shared<const PlacedHair>(place_hair(file, scalp, {}));
    EXPECT_FALSE(scalp.hair->drawn);
    HairParams params;
    params.head_scale = 1.5f;
    const Groom groom = grow(params, scalp);
    ASSERT_EQ(groom.guides, int(authored) + 120);
    const RestShape rest = make_rest_shape(device_params(params), groom);
    double most = 0.0;
    for (size_t i = 0; i < 120; ++i)
    {
        const unsigned strand = scalp.hair->guides[i];
        const int g = int(authored + i);
        const glm::dvec3 root = vector_at(groom.root_position.data(), g, 0, 1);
        std::vector<glm::vec3> chain;
        for (int k = 1; k < groom.nodes; ++k)
            chain.push_back(glm::vec3(vector_at(rest.position.data(), g, k, groom.nodes)));
        const glm::vec3 tip = scalp.hair->position[scalp.hair->first[strand + 1] - 1] * 1.5f;
        most = std::max(most, double(glm::distance(chain.back() - glm::vec3(root), tip)));
        EXPECT_NEAR(length_of(chain), 1.5 * double(scalp.hair->length(strand)), 0.002);
    }
    EXPECT_LT(most, 1e-4) << "tips of 15 to 30 cm";
    EXPECT_GT(groom.drawn.size(), 3000u);
    EXPECT_EQ(groom.drawn_multi, int(groom.drawn.size()));
    for (const DrawnStrand& drawn : groom.drawn)
    {
        EXPECT_GE(drawn.guide0, int(authored));
        EXPECT_NEAR(drawn.weights.x + drawn.weights.y + drawn.weights.z, 1.0f, 1e-5f);
        EXPECT_GE(drawn.weights.x, drawn.weights.y);
    }
}

TEST(PlaceHair, of_many_strands_the_others_go_along)
{
    Scalp scalp = whole_scalp();
    const size_t authored = scalp.positions.size();
    HairParams params;
    params.groom_import_guides = 150;
    params.strand_length_variation = 0.0f;
    scalp.hair = std::make_shared<const PlacedHair>(place_hair(arcs(1000), scalp, params));
    EXPECT_TRUE(scalp.hair->drawn);
    // No root is far from a simulated one: of 150 spread evenly over 0.06 m^2 each has 0.02 m about it.
    Groom groom = grow(params, scalp);
    ASSERT_EQ(groom.guides, int(authored) + 150);
    ASSERT_EQ(groom.drawn.size(), 1000u);
    for (const DrawnStrand& drawn : groom.drawn)
    {
        const glm::vec3 root(drawn.root.x, drawn.root.y, drawn.root.z);
        const glm::vec3 guide = vector_at(groom.root_position.data(), drawn.guide0, 0, 1);
        EXPECT_LT(glm::distance(root, guide), 0.02f);
        EXPECT_GT(drawn.root.w, 0.4f);
        EXPECT_LE(drawn.root.w, 1.0f);
    }
    params.interpolation_guides = GUIDES_ALL;
    groom = grow(params, scalp);
    EXPECT_EQ(groom.guides, int(authored) + 1000);
    EXPECT_EQ(groom.drawn.size(), 1000u);
    EXPECT_EQ(groom.drawn_multi, 0);
    for (size_t i = 0; i < 1000; ++i)
        EXPECT_EQ(groom.drawn[i].guide0, int(authored + i));
}

TEST(PlaceHair, of_a_million_strands_as_many_are_taken_as_can_be_drawn)
{
    const Scalp& scalp = whole_scalp();
    HairFile file;
    for (int i = 0; i < 300000; ++i)
    {
        const glm::vec3 root = scalp.positions[size_t(i) % scalp.positions.size()];
        file.curves.count.push_back(2);
        file.curves.position.insert(file.curves.position.end(), {root, root + glm::vec3(0.0f, -0.1f, 0.0f)});
    }
    HairParams params;
    params.groom_import_guides = 3;
    const PlacedHair hair = place_hair(file, scalp, params);
    EXPECT_EQ(hair.strands(), 200000u);
    EXPECT_EQ(hair.guides.size(), 3u);
    ASSERT_EQ(hair.remark.size(), 1u);
    EXPECT_EQ(hair.remark[0], "of its 300000 strands 200000 are taken, evenly");
}

TEST(PlaceHair, a_style_names_it_and_keeps_the_name)
{
    Scratch scratch;
    const std::string bytes = bytes_of(fs::path(COIF_SOURCE_FOLDER) / "tests" / "exchange" / "groom.usda");
    const fs::path file = scratch.write("hair/nine.usda", bytes), target = scratch / "styles" / "nine.toml";
    fs::create_directories(target.parent_path());
    std::string report;
    Hairstyle style = imported_style(file, target, {}, report);
    EXPECT_NE(report.find("9 strands"), std::string::npos) << report;
    EXPECT_EQ(style.host.groom_import, "../hair/nine.usda");
    save_hairstyle(style, target);
    const Hairstyle again = load_hairstyle(target);
    EXPECT_EQ(again.host.groom_import, "../hair/nine.usda");
    EXPECT_EQ(bytes_of(target).find("interpolation"), std::string::npos) << "nine strands are guides";
    Assets assets = load_assets(again);
    ASSERT_TRUE(assets.scalp.hair);
    EXPECT_EQ(assets.scalp.hair->guides.size(), 3u) << "those that the file calls so";
    EXPECT_GT(grown(again, assets).drawn.size(), 0u);
    // Saved elsewhere it still finds the file.
    Hairstyle copy = again;
    save_hairstyle(copy, scratch / "copy.toml");
    EXPECT_EQ(copy.host.groom_import, "hair/nine.usda");
    EXPECT_TRUE(load_assets(load_hairstyle(scratch / "copy.toml")).scalp.hair);
    // Damaged and gone.
    scratch.write("hair/nine.usda", bytes.substr(0, 3000));
    EXPECT_NE(error_of([&] { load_assets(again); }).find("nine.toml:"), std::string::npos);
    EXPECT_NE(error_of([&] { load_assets(again); }).find("was not copied whole"), std::string::npos);
    fs::remove(file);
    EXPECT_NE(error_of([&] { load_assets(again); }).find("no file '../hair/nine.usda'"), std::string::npos);
}

} // namespace
} // namespace coif

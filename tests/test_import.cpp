// Hair of a file as it moves, and dropped onto the editor.
#include "app/import.h"
#include "sim/exchange/place.h"
#include "sim/scatter.h"
#include "tests/editor_window.h"
#include "tests/on_device.h"

#include <algorithm>
#include <cstring>

using namespace coif;
using namespace coif::test;

namespace
{
constexpr double kSecond = 3.0; // that a busy machine may make of one

// A .hair file of strands that leave the scalp at its normals and fall.
std::string some_hair(int strands)
{
    const Scalp scalp = load_scalp(data_folder() / "assets" / "scalp.obj");
    constexpr int kPoints = 20;
    std::string points;
    for (const Between& place : spread_places(scalp, strands, 3))
    {
        glm::vec3 at(0.0f), way(0.0f);
        for (int k = 0; k < 3; ++k)
        {
            at += place.shares[k] * scalp.positions[place.of[k]];
            way += place.shares[k] * scalp.normals[place.of[k]];
        }
        for (int k = 0; k < kPoints; ++k)
        {
            points.append(reinterpret_cast<const char*>(&at), sizeof at);
            way = glm::normalize(way + glm::vec3(0.0f, -0.1f, 0.0f));
            at += way * 0.15f / float(kPoints - 1);
        }
    }
    std::string header(128, '\0');
    const uint32_t numbers[] = {uint32_t(strands), uint32_t(strands * kPoints), 2u, kPoints - 1u};
    memcpy(header.data(), "HAIR", 4);
    memcpy(header.data() + 4, numbers, sizeof numbers);
    header.replace(40, 12, "metres, y up");
    return header + points;
}
} // namespace

TEST(Import, hair_rests_as_it_lies_in_the_file_and_moves_as_any)
{
    const fs::path folder = fs::temp_directory_path() / ("coif_import_" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "some.hair", std::ios::binary) << some_hair(400);
    for (const char* guides : {"vertices", "all"})
    {
        SCOPED_TRACE(guides);
        std::string report;
        Hairstyle style = imported_style(folder / "some.hair", folder / "some.toml", {}, report);
        assign(style, std::string("interpolation.guides=") + guides);
        assign(style, "forces.repulsion=0");
        Simulation simulation(test_device(), style);
        const PlacedHair& hair = *simulation.assets().scalp.hair;
        const std::vector<unsigned> strands = simulated_strands(hair, style.params);
        const int first = simulation.solver().groom().guides - int(strands.size()), nodes = style.params.strand_nodes;
        const auto tips_off = [&]
        {
            const Mapped position = simulation.solver().guide_positions();
            std::vector<double> off;
            for (size_t i = 0; i < strands.size(); ++i)
            {
                const int g = first + int(i);
                const glm::dvec3 root = vector_at(simulation.solver().groom().root_position.data(), g, 0, 1);
                const glm::dvec3 tip(hair.position[hair.first[strands[i] + 1] - 1]);
                off.push_back(glm::distance(vector_at(position.as<float>(), g, nodes - 1, nodes), root + tip));
            }
            std::ranges::sort(off);
            return off;
        };
        EXPECT_LT(tips_off().back(), 1e-5);
        simulation.settle(2.0);
        EXPECT_LT(tips_off().back(), 1e-5) << "m, of strands that stand up as much as they hang";
        simulation.play(find_motion("shake"));
        for (int i = 0; i < 60; ++i)
            simulation.step({});
        EXPECT_GT(tips_off()[200], 0.01) << "it moves";
    }
    fs::remove_all(folder);
}

TEST_F(EditorWindow, a_file_of_hair_that_is_dropped_makes_a_style)
{
    std::ofstream("some.hair", std::ios::binary) << some_hair(100);
    SDL_Event event = {};
    event.type = SDL_DROPFILE;
    event.drop.file = SDL_strdup((folder / "some.hair").c_str());
    SDL_PushEvent(&event);
    ASSERT_TRUE(until([&] { return editor->style().host.groom_import == "some.hair"; })) << editor->message();
    EXPECT_NE(editor->message().find("100 strands of 2000 points"), std::string::npos) << editor->message();
    EXPECT_EQ(editor->style().name(), "some");
    EXPECT_TRUE(editor->unsaved());
    EXPECT_FALSE(fs::exists("some.toml")) << "it is written when it is saved";
    const int guides = editor->simulation().solver().groom().guides;
    shoot("import");

    // Written again with more, it is read again; broken or gone, what was read of it stays.
    std::ofstream("some.hair", std::ios::binary) << some_hair(150);
    EXPECT_TRUE(within(kSecond, [&] { return editor->simulation().solver().groom().guides == guides + 50; }))
        << editor->message();
    std::ofstream("some.hair", std::ios::binary) << some_hair(150).substr(0, 5000);
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("not copied whole") != std::string::npos; }))
        << editor->message();
    EXPECT_EQ(editor->simulation().solver().groom().guides, guides + 50);
    fs::remove("some.hair");
    EXPECT_TRUE(within(kSecond, [&] { return editor->message().find("some.hair is gone") != std::string::npos; }))
        << editor->message();
    EXPECT_EQ(editor->simulation().solver().groom().guides, guides + 50);
}

TEST_F(EditorWindow, a_file_of_hair_that_cannot_be_read_changes_nothing)
{
    std::ofstream("some.abc", std::ios::binary) << "\x89HDF and more";
    editor->open(folder / "some.abc");
    EXPECT_TRUE(until([&] { return editor->message().find("export it again as Ogawa") != std::string::npos; }))
        << editor->message();
    EXPECT_TRUE(editor->style().host.groom_import.empty());
    EXPECT_EQ(editor->style().name(), "style");
}

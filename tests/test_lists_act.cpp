// Each list of a style, and its rest shape, changes the hair: where it lies, or how it looks.
#include "sim/simulation.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace coif
{
namespace
{

// Bytes of the drawn strands and of what the picture reads beside them.
std::vector<char> bytes_of(const Simulation& simulation)
{
    std::vector<char> bytes;
    const auto add = [&](const void* data, size_t size)
    { bytes.insert(bytes.end(), static_cast<const char*>(data), static_cast<const char*>(data) + size); };
    const Mapped position = simulation.solver().drawn_positions();
    add(position.as<char>(), position.bytes());
    const std::vector<StrandLook>& looks = simulation.solver().groom().looks;
    add(looks.data(), looks.size() * sizeof(StrandLook));
    return bytes;
}

std::vector<char> played(const Hairstyle& style)
{
    Simulation simulation(test_device(), style);
    simulation.settle(0.3);
    simulation.solver().draw();
    return bytes_of(simulation);
}

TEST(Lists, each_changes_the_hair)
{
    Hairstyle style;
    style.params.interpolation_strands = 300;
    style.params.strand_length = 0.35f;
    const std::vector<char> plain = played(style);
    EXPECT_EQ(plain, played(style)) << "or the test would tell nothing";
    const size_t vertices = load_assets(style).scalp.positions.size();
    for (const ParamInfo& info : param_table())
    {
        if (info.kind != Kind::LIST && info.kind != Kind::SHAPE)
            continue;
        Hairstyle changed = style;
        if (info.path() == "region")
            changed.host.regions = {
                {"all", {"top"}, {}, {}, {}, {}, false, 0.0f, {{find_param("strand.length"), glm::vec4(0.1f)}}}};
        else if (info.path() == "parting")
            changed.host.partings = {{{{0.03f, 0.07f, 0.09f}, {0.03f, 0.11f, 0.0f}}, 0.06f}};
        else if (info.path() == "map")
            changed.host.maps = {{"strand.length", MAP_FACTOR, std::vector<float>(vertices, 0.5f), {}}};
        else if (info.path() == "tie")
            changed.host.ties = {Tie{}};
        else if (info.path() == "collider")
            changed.host.colliders = {{glm::vec3(0.12f, -0.1f, 0.0f), 0.06f, true, {}}};
        else if (info.path() == "light") // the share of it that reaches each node hangs on where it stands
            changed.host.lights = {Light{"side", glm::vec3(-1.0f, 0.2f, 0.0f)}};
        else if (info.path() == "groom.rest")
        {
            Hairstyle blown = style;
            blown.params.forces_wind = F4(20.0f, 0.0f, 0.0f, 0.0f);
            Simulation simulation(test_device(), blown);
            simulation.settle(0.5);
            changed.host.groom_rest.shapes = std::make_shared<const StrandShapes>(simulation.shapes());
        }
        else
            ADD_FAILURE() << info.path() << ": a list that this test does not know";
        EXPECT_NE(plain, played(changed)) << info.path();
    }
}

// What may vary does, at the roots of a region, and elsewhere not.
TEST(Lists, each_parameter_that_may_vary_acts_in_a_region)
{
    Hairstyle style;
    style.params.interpolation_strands = 300;
    style.params.bending_modulus = 0.0f;
    style.host.regions = {{"top", {"top"}, {}, {}, {}, {}, false, 0.0f, {}}};
    const std::vector<char> plain = played(style);
    for (const ParamInfo& info : param_table())
    {
        if (info.scope != Scope::STRAND || info.on_host())
            continue;
        Hairstyle changed = style;
        float now[kMostNumbers] = {};
        get_numbers(style.params, info, now);
        if (info.path() == "bending.diameter") // of the fibre that has a modulus
            changed.params.bending_modulus = 4.0f;
        const bool pigment = info.path() == "look.eumelanin" || info.path() == "look.pheomelanin";
        if (pigment)
            changed.params.look_pigment = 1; // melanin
        const std::vector<char> before = pigment || info.path() == "bending.diameter" ? played(changed) : plain;
        glm::vec4 value(0.0f);
        for (int i = 0; i < info.components(); ++i)
            value[i] = now[i] > 0.5f * (info.min + info.max) ? now[i] * 0.5f : now[i] + 0.05f * (info.max - info.min);
        changed.host.regions[0].settings = {{&info, value}};
        EXPECT_NE(before, played(changed)) << info.path();
    }
}

} // namespace
} // namespace coif

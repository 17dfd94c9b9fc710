// What comes from outside and is wrong: in files, and in memory.
#include "app/stress/cases.h"
#include "sim/error.h"
#include "sim/health.h"

#include <cmath>

namespace coif::stress
{

Outcome bad_input(const Ground& ground)
{
    Outcome outcome;
    const auto refused = [&](const std::string& what, const std::string& word, auto&& action)
    {
        try
        {
            action();
            outcome.faults.push_back(what + " was taken");
        }
        catch (const Error& e)
        {
            expect(outcome, std::string(e.what()).find(word) != std::string::npos,
                   fmt::format("{}: '{}' does not name {}", what, e.what(), word));
        }
    };
    long tried = 0;
    for (const ParamInfo& info : param_table())
    {
        if (info.on_host())
            continue;
        for (std::string value : {"nan", "-nan", "inf", "-inf", "1e39", "-1e39", "1e400", "'x y'", "[]", "{}"})
        {
            if (info.components() > 1 && value != "[]")
                value = fmt::format("[0.0, {}, 0.0{}]", value, info.kind == Kind::PROFILE ? ", 0.0" : "");
            const std::string line = fmt::format("{} = {}", info.name, value);
            refused(info.group + (" " + line), ".toml:3:",
                    [&] { parse_hairstyle(fmt::format("# a style\n[{}]\n{}\n", info.group, line), "bad.toml"); });
            Hairstyle style;
            refused("--set " + info.path() + "=" + value, info.name, [&] { assign(style, info.path() + "=" + value); });
            expect(outcome, hairstyle_text(style, "bad.toml").empty(),
                   info.path() + " was changed by what was refused");
            ++tried;
        }
    }
    // A broken file that is read again leaves the last good state.
    Hairstyle style;
    style.params.interpolation_strands = 0;
    style.params.grid_resolution = 8;
    Simulation simulation(ground.device, style);
    Hairstyle broken = style;
    broken.host.scalp_mesh = "nowhere.obj";
    refused("a scalp that is not there", "nowhere.obj", [&] { simulation.set_style(broken); });
    simulation.step({});
    expect(outcome, measure_health(simulation.solver(), style.params, false).finite, "broken by what was refused");
    outcome.note = fmt::format("{} bad values", tried);
    return outcome;
}

// What one value that is not a number does to its strand, and must not do to the others.
Outcome injected(const Ground& ground)
{
    Outcome outcome;
    const int guides = 40, nodes = 16, bad = 19;
    const struct
    {
        const char* buffer;
        int fault;
    } buffers[] = {{"position", FAULT_POSITION}, {"velocity", FAULT_VELOCITY}, {"multiplier", FAULT_VELOCITY}};
    for (const int kind : {0, 1})
        for (const auto& [buffer, fault] : buffers)
            for (const float value : {NAN, INFINITY, -INFINITY, 3e38f})
                for (const int node : {2, 7, nodes - 1})
                {
                    if (kind == 1 && std::string(buffer) == "multiplier")
                        continue;
                    if (ground.quick && node != 7)
                        continue;
                    HairParams params = lone(kind);
                    params.forces_wind = F4(3.0f, 0.0f, 1.0f, 0.0f);
                    const std::vector<Collider> head = {{{0, 0, 0}, 0.1f, true}};
                    Trial sound(ground, params, ball(guides, nodes, 0.3), head);
                    Trial ill(ground, params, ball(guides, nodes, 0.3), head);
                    for (Trial* trial : {&sound, &ill})
                        for (int i = 1; i <= 10; ++i)
                            trial->step(pose({0.02 * i, 0, 0}, 0.05 * i));
                    const bool scalar = std::string(buffer) == "multiplier";
                    const size_t count = size_t(sound.solver.groom().blocks) * LANES * nodes * (scalar ? 1 : 3);
                    std::vector<float> values = read<float>(ground.device, ill.solver.buffers().at(buffer), count);
                    values[size_t(scalar ? (bad / LANES * nodes + node) * LANES + bad % LANES
                                         : strand_value(bad, node, 1, nodes))] = value;
                    write(ground.device, ill.solver.buffers().at(buffer), values);
                    for (Trial* trial : {&sound, &ill})
                        trial->step(pose({0.22, 0, 0}, 0.55));
                    const std::string what =
                        fmt::format("{}: {} in '{}' of node {}", kSolvers[kind], value, buffer, node);
                    std::vector<int> once(guides, 0);
                    expect(outcome, sound.solver.resets() == once, what + ": a sound strand was reset");
                    once[bad] = 1;
                    expect(outcome, ill.solver.resets() == once, what + ": not that strand alone was reset, once");
                    expect(outcome, ill.solver.faults()[bad] == fault,
                           fmt::format("{}: cause {} is told", what, ill.solver.faults()[bad]));
                    for (const char* name : {"position", "velocity"})
                    {
                        const size_t all = size_t(sound.solver.groom().blocks) * LANES * nodes * 3;
                        const std::vector<float> a = read<float>(ground.device, sound.solver.buffers().at(name), all);
                        const std::vector<float> b = read<float>(ground.device, ill.solver.buffers().at(name), all);
                        bool same = true, finite = true;
                        for (int s = 0; s < guides; ++s)
                            for (int i = 0; i < nodes * 3; ++i)
                            {
                                const size_t at = size_t(strand_value(s, i / 3, i % 3, nodes));
                                same &= s == bad || a[at] == b[at];
                                finite &= std::isfinite(b[at]);
                            }
                        expect(outcome, same, fmt::format("{}: '{}' of a neighbour changed its bits", what, name));
                        expect(outcome, finite, fmt::format("{}: '{}' is not finite after the step", what, name));
                    }
                    ill.rest(60);
                    judge(outcome, what, ill, {.resets = 1});
                }
    return outcome;
}

} // namespace coif::stress

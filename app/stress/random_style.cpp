#include "app/stress/random_style.h"

#include "sim/groom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace coif::stress
{

namespace
{
// Numbers that hang on seed, case and their order.
struct Draw
{
    int seed, number, drawn = 0;
    double unit() { return double(random01(seed, number, 1000 + drawn++)); }
    double in(double low, double high) { return low + (high - low) * unit(); }
    double wide(double low, double high) { return low * std::pow(high / low, unit()); }
    int below(int end) { return std::min(int(unit() * end), end - 1); }
    bool once_in(int times) { return below(times) == 0; }
};
} // namespace

std::string small_scalp()
{
    constexpr int kRings = 4, kAround = 8;
    std::string text = "# Half a sphere of 10 cm.\n";
    for (int r = 0; r < kRings; ++r)
        for (int i = 0; i < kAround; ++i)
        {
            const double down = 0.15 + 1.35 * r / (kRings - 1), about = 2.0 * std::numbers::pi * i / kAround;
            text += fmt::format("v {:.5f} {:.5f} {:.5f}\n", 0.1 * std::sin(down) * std::cos(about),
                                0.1 * std::cos(down), 0.1 * std::sin(down) * std::sin(about));
        }
    for (int r = 0; r + 1 < kRings; ++r)
        for (int i = 0; i < kAround; ++i)
        {
            const int a = r * kAround + i + 1, b = r * kAround + (i + 1) % kAround + 1;
            text += fmt::format("f {} {} {}\nf {} {} {}\n", a, b, a + kAround, b, b + kAround, a + kAround);
        }
    return text;
}

// One number of a parameter. A range from zero or across it counts as wide by its larger end.
static double draw_number(Draw& draw, const ParamInfo& info)
{
    const double low = info.min, high = info.max;
    if (draw.once_in(8))
        return draw.once_in(2) ? low : high;
    const bool wide = low > 0.0 ? high / low >= 100.0 : high >= 10.0 || info.effect == Effect::LIVE;
    if (!wide || draw.once_in(2))
        return draw.in(low, high);
    if (low > 0.0)
        return draw.wide(low, high);
    const double size = draw.wide(1e-4 * high, high);
    return low < 0.0 && draw.once_in(2) ? std::max(-size, low) : size;
}

Hairstyle random_style(int seed, int number, const std::string& scalp)
{
    Draw draw{seed, 2 * number};
    Hairstyle style;
    for (const ParamInfo& info : param_table())
    {
        if (info.on_host())
            continue;
        double values[kMostNumbers];
        for (int i = 0; i < std::max(3, info.components()); ++i)
        {
            values[i] = draw_number(draw, info);
            if (info.kind == Kind::INT || info.kind == Kind::CHOICE)
                values[i] = std::round(values[i]);
            values[i] = std::clamp(double(float(values[i])), double(info.min), double(info.max));
        }
        set_numbers(style.params, info, values);
    }
    // Node counts, with a grid each.
    const int kinds[][2] = {{9, 16}, {3, 8}, {24, 8}};
    const auto& [nodes, resolution] = kinds[number / 20 % 3];
    style.params.strand_nodes = nodes;
    style.params.grid_resolution = resolution;
    style.params.interpolation_strands = draw.below(65);
    // A tolerance measures for as long as a style is played, and chooses node counts and thousands of guides unless the
    // style says its own; those tell no more of a strand.
    if (!draw.once_in(10))
        style.params.quality_tolerance = 0.0f;
    style.params.interpolation_refine = style.params.quality_tolerance > 0.0f || draw.once_in(8) ? 1 : 0;
    // Coupled by the grid, or by none of its passes, as often as not.
    if (draw.once_in(2))
        style.params.forces_repulsion = style.params.look_self_shadow = 0.0f;
    if (draw.once_in(2))
        style.params.forces_wind = F4(0.0f, 0.0f, 0.0f, 0.0f);

    style.host.scalp_mesh = scalp;
    style.host.head_mesh.clear();
    if (!draw.once_in(4))
        style.host.head_spheres.clear(); // one that fits the scalp
    for (int i = draw.below(5); i > 0; --i)
    {
        Collider c;
        for (int axis = 0; axis < 3; ++axis)
            c.center[axis] = float(draw.in(-0.4, 0.4));
        c.radius = float(draw.wide(0.005, 0.3));
        c.on_head = draw.once_in(2);
        style.host.colliders.push_back(c);
    }
    return style;
}

Motion random_motion(int seed, int number)
{
    Draw draw{seed, 2 * number + 1};
    Motion motion;
    motion.seconds = 0.6;
    const auto channel = [&](int from, int to) { return Motion::Channel(from + draw.below(to - from + 1)); };
    const double turn = 2.0 * std::numbers::pi;
    for (int i = draw.below(4); i > 0; --i) // drags and shakes
        motion.oscillations.push_back(
            {channel(Motion::X, Motion::Z), draw.wide(0.01, 2.0), draw.wide(0.2, 15.0), 0.0, 1e6});
    for (int i = draw.below(3); i > 0; --i)
        motion.oscillations.push_back(
            {channel(Motion::YAW, Motion::ROLL), draw.wide(0.01, turn), draw.wide(0.2, 15.0), 0.0, 1e6});
    if (draw.once_in(4)) // up to 100 turns a second
        motion.ramps.push_back({channel(Motion::YAW, Motion::ROLL), 0.5 * turn * draw.wide(0.1, 100.0), 0.1, 0.6});
    if (draw.once_in(3))
        motion.ramps.push_back({channel(Motion::X, Motion::Z), draw.wide(0.01, 30.0), 0.1, 0.1 + draw.wide(0.02, 0.5)});
    if (draw.once_in(3)) // a jolt, or a teleport
        motion.steps.push_back({channel(Motion::X, Motion::Z), draw.wide(0.001, 1000.0), draw.in(0.0, 0.6)});
    if (draw.once_in(5))
        motion.steps.push_back({channel(Motion::YAW, Motion::ROLL), draw.in(-0.5, 0.5) * turn, draw.in(0.0, 0.6)});
    if (draw.once_in(4))
        motion.oscillations.push_back(
            {channel(Motion::WIND_X, Motion::WIND_Z), draw.wide(0.1, 200.0), draw.wide(0.2, 15.0), 0.0, 1e6});
    return motion;
}

std::string motion_text(const Motion& motion)
{
    static const char* const names[] = {"x", "y", "z", "yaw", "pitch", "roll", "wind_x", "wind_y", "wind_z"};
    const auto authored = [](Motion::Channel c, double value)
    { return c >= Motion::YAW && c <= Motion::ROLL ? value * 180.0 / std::numbers::pi : value; };
    std::string text = fmt::format("seconds = {:.17g}\n", motion.seconds);
    for (const Motion::Oscillation& o : motion.oscillations)
        text += fmt::format("[[oscillation]]\nchannel = \"{}\"\namplitude = {:.17g}\nfrequency = {:.17g}\n"
                            "begin = {:.17g}\nend = {:.17g}\n",
                            names[o.channel], authored(o.channel, o.amplitude), o.frequency, o.begin, o.end);
    for (const Motion::Ramp& r : motion.ramps)
        text += fmt::format("[[ramp]]\nchannel = \"{}\"\nby = {:.17g}\nbegin = {:.17g}\nend = {:.17g}\n",
                            names[r.channel], authored(r.channel, r.by), r.begin, r.end);
    for (const Motion::Step& s : motion.steps)
        text += fmt::format("[[step]]\nchannel = \"{}\"\nby = {:.17g}\nat = {:.17g}\n", names[s.channel],
                            authored(s.channel, s.by), s.at);
    return text;
}

} // namespace coif::stress

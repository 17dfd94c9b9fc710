#include "sim/motion.h"

#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/shown.h"
#include "sim/source.h"
#include "sim/toml_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

namespace fs = std::filesystem;

static const char* const kChannelNames[] = {"x", "y", "z", "yaw", "pitch", "roll", "wind_x", "wind_y", "wind_z"};

namespace
{
// One table of a motion file, read key by key, so that a key that nothing asks for can be told as an error.
struct Line
{
    const fs::path& file;
    const toml::table& table;
    std::vector<std::string> asked = {};

    std::string place(const toml::node& node) const { return coif::place(file, node.source()); }

    double number(const char* key, double otherwise)
    {
        asked.push_back(key);
        const toml::node* node = table.get(key);
        if (!node)
        {
            if (std::isnan(otherwise))
                throw fail("{}: this table needs '{}'", place(table), key);
            return otherwise;
        }
        const double value = node->value<double>().value_or(NAN);
        if (!node->is_number() || !(std::abs(value) <= 1e6))
            throw fail("{}: {} must be a number within a million", place(*node), key);
        return value;
    }

    Motion::Channel channel()
    {
        asked.push_back("channel");
        const toml::node* node = table.get("channel");
        if (!node)
            throw fail("{}: this table needs 'channel'", place(table));
        const std::string name = node->value<std::string>().value_or("");
        for (int c = 0; c < Motion::CHANNELS; ++c)
            if (name == kChannelNames[c])
                return Motion::Channel(c);
        throw fail("{}: channel must be one of {}", place(*node), fmt::join(kChannelNames, ", "));
    }

    void no_more() const
    {
        for (auto&& [key, value] : table)
            if (std::find(asked.begin(), asked.end(), key.str()) == asked.end())
                throw fail("{}: '{}' is not known here; known are {}", place(value), shown(key.str()),
                           fmt::join(asked, ", "));
    }
};
} // namespace

static double in_units(Motion::Channel channel, double value)
{
    const bool angle = channel == Motion::YAW || channel == Motion::PITCH || channel == Motion::ROLL;
    return angle ? value * std::numbers::pi / 180.0 : value;
}

static void read_line(Motion& motion, const std::string& kind, Line line)
{
    if (kind == "pose")
    {
        Motion::Key key = {line.number("time", NAN), {}};
        for (int c = 0; c < Motion::CHANNELS; ++c)
            key.value[c] = in_units(Motion::Channel(c), line.number(kChannelNames[c], 0.0));
        if (!motion.keys.empty() && !(key.time > motion.keys.back().time))
            throw fail("{}: the times of [[pose]] tables must grow", line.place(line.table));
        motion.keys.push_back(key);
    }
    else
    {
        const Motion::Channel channel = line.channel();
        const auto check_order = [&](double begin, double end)
        {
            if (begin > end)
                throw fail("{}: begin must not lie after end", line.place(line.table));
        };
        if (kind == "oscillation")
        {
            motion.oscillations.push_back({channel, in_units(channel, line.number("amplitude", NAN)),
                                           line.number("frequency", NAN), line.number("begin", 0.0),
                                           line.number("end", 1e6)});
            check_order(motion.oscillations.back().begin, motion.oscillations.back().end);
        }
        else if (kind == "ramp")
        {
            motion.ramps.push_back({channel, in_units(channel, line.number("by", NAN)), line.number("begin", NAN),
                                    line.number("end", NAN)});
            check_order(motion.ramps.back().begin, motion.ramps.back().end);
        }
        else
            motion.steps.push_back({channel, in_units(channel, line.number("by", NAN)), line.number("at", NAN)});
    }
    line.no_more();
}

Motion load_motion(const fs::path& file)
{
    const toml::table document = parse_toml(read_file(file, 4 << 20), file);
    if (document.empty())
        throw fail("{}: holds no motion; for a head at rest say seconds = 2.0", shown_file(file));
    Motion motion;
    motion.name = file.stem().string();
    const Line here{file, document};
    for (auto&& [key, node] : document)
    {
        const std::string kind(key.str());
        if (kind == "seconds")
        {
            motion.seconds = node.value<double>().value_or(NAN);
            if (!node.is_number() || !(motion.seconds > 0.0 && motion.seconds <= 86400.0))
                throw fail("{}: seconds must be a number above 0 and at most 86400", here.place(node));
            continue;
        }
        if (kind != "oscillation" && kind != "ramp" && kind != "step" && kind != "pose")
            throw fail("{}: expected seconds, [[oscillation]], [[ramp]], [[step]] or [[pose]], found '{}'",
                       here.place(node), shown(kind));
        const toml::array* list = node.as_array();
        if (!list || !list->is_array_of_tables())
            throw fail("{}: '{}' must be written as [[{}]]", here.place(node), kind, kind);
        for (const toml::node& entry : *list)
            read_line(motion, kind, Line{file, *entry.as_table()});
    }
    return motion;
}

static fs::path motion_folder() { return data_folder() / "assets" / "motions"; }

std::vector<std::string> motion_names()
{
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(motion_folder(), error))
        if (entry.path().extension() == ".toml")
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

fs::path motion_file(const std::string& name_or_path)
{
    std::error_code error;
    const fs::path ours = motion_folder() / (name_or_path + ".toml");
    return fs::exists(name_or_path, error) && !fs::exists(ours, error) ? fs::path(name_or_path) : ours;
}

Motion find_motion(const std::string& name_or_path)
{
    const std::vector<std::string> names = motion_names();
    if (std::find(names.begin(), names.end(), name_or_path) != names.end())
        return load_motion(motion_folder() / (name_or_path + ".toml"));
    std::error_code error;
    if (fs::exists(name_or_path, error))
        return load_motion(name_or_path);
    throw fail("'{}' is neither a file nor one of coif's motions: {}", shown(name_or_path), fmt::join(names, ", "));
}

static double smoothstep(double t)
{
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

Pose pose_at(const Motion& motion, double time)
{
    const double t = std::clamp(time, 0.0, motion.seconds);
    double v[Motion::CHANNELS] = {};
    for (const Motion::Oscillation& o : motion.oscillations)
        if (t >= o.begin)
            v[o.channel] +=
                o.amplitude * std::sin(2.0 * std::numbers::pi * o.frequency * (std::min(t, o.end) - o.begin));
    for (const Motion::Ramp& r : motion.ramps)
        v[r.channel] += r.by * (r.end > r.begin ? smoothstep((t - r.begin) / (r.end - r.begin)) : double(t >= r.begin));
    for (const Motion::Step& s : motion.steps)
        if (t >= s.at)
            v[s.channel] += s.by;
    if (!motion.keys.empty())
    {
        size_t next = 0;
        while (next < motion.keys.size() && motion.keys[next].time <= t)
            ++next;
        const Motion::Key& a = motion.keys[next > 0 ? next - 1 : 0];
        const Motion::Key& b = motion.keys[std::min(next, motion.keys.size() - 1)];
        const double share = b.time > a.time ? smoothstep((t - a.time) / (b.time - a.time)) : 0.0;
        for (int c = 0; c < Motion::CHANNELS; ++c)
            v[c] += a.value[c] + (b.value[c] - a.value[c]) * share;
    }
    Pose pose;
    pose.origin = {v[Motion::X], v[Motion::Y], v[Motion::Z]};
    pose.turn = glm::angleAxis(v[Motion::YAW], glm::dvec3(0, 1, 0)) *
                glm::angleAxis(v[Motion::PITCH], glm::dvec3(1, 0, 0)) *
                glm::angleAxis(v[Motion::ROLL], glm::dvec3(0, 0, 1));
    pose.wind = {v[Motion::WIND_X], v[Motion::WIND_Y], v[Motion::WIND_Z]};
    return pose;
}

Pose operator*(const Pose& base, const Pose& script)
{
    return {base.origin + script.origin, script.turn * base.turn, base.wind + script.wind};
}

} // namespace coif

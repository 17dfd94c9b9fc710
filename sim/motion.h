#pragma once
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace coif
{

// Where the head is and what the wind adds. Positions in double: a float loses millimetres at a kilometre.
struct Pose
{
    glm::dvec3 origin{0.0};              // m, world
    glm::dquat turn{1.0, 0.0, 0.0, 0.0}; // head to world
    glm::dvec3 wind{0.0};                // m/s^2, on top of the style's
};

// A script for head and wind, read from assets/motions/*.toml. Each line of it moves one channel; lines add up.
struct Motion
{
    enum Channel
    {
        X,
        Y,
        Z, // m
        YAW,
        PITCH,
        ROLL, // degrees in the file, radians here
        WIND_X,
        WIND_Y,
        WIND_Z, // m/s^2
        CHANNELS
    };
    struct Oscillation // amplitude * sin(2 pi frequency (t - begin)) between begin and end
    {
        Channel channel;
        double amplitude, frequency, begin, end;
    };
    struct Ramp // by `by` from begin to end, at rest at both (smoothstep)
    {
        Channel channel;
        double by, begin, end;
    };
    struct Step // by `by` at once
    {
        Channel channel;
        double by, at;
    };
    struct Key // all channels at a time; between keys as a ramp goes
    {
        double time;
        double value[CHANNELS];
    };
    std::string name;
    double seconds = 2.0; // after which it is over; the head stays where it came to
    std::vector<Oscillation> oscillations;
    std::vector<Ramp> ramps;
    std::vector<Step> steps;
    std::vector<Key> keys;
};

// Throws Error with file, line and column.
Motion load_motion(const std::filesystem::path& file);

// The file of a motion given by path, or by the name of one that coif ships, whether it is there or not.
std::filesystem::path motion_file(const std::string& name_or_path);

// A motion by path, or by the name of one that coif ships. Throws Error naming those there are.
Motion find_motion(const std::string& name_or_path);

// The names of the motions that coif ships, in alphabetical order.
std::vector<std::string> motion_names();

// The script's pose at `time` (s); before 0 as at 0, after its end as at its end. Turn is yaw about y after pitch about
// x after roll about z.
Pose pose_at(const Motion& motion, double time);

// `script` on top of `base`.
Pose operator*(const Pose& base, const Pose& script);

} // namespace coif

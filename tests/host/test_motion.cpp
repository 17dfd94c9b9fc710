// Scripts for head and wind.
#include "sim/motion.h"
#include "tests/host/scratch.h"

#include <cmath>
#include <numbers>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;

double yaw_of(const Pose& pose) { return 2.0 * std::atan2(pose.turn.y, pose.turn.w); }

Motion parsed(const std::string& text)
{
    const Scratch scratch;
    return load_motion(scratch.write("script.toml", text));
}

std::string told(const std::string& text)
{
    const Scratch scratch;
    const fs::path file = scratch.write("script.toml", text);
    std::string error = error_of([&] { load_motion(file); });
    if (error.rfind(scratch.folder().string() + "/", 0) == 0)
        error.erase(0, scratch.folder().string().size() + 1);
    return error;
}

TEST(Motion, every_shipped_one_loads_and_stays_finite)
{
    const std::vector<std::string> names = motion_names();
    for (const char* wanted : {"still", "nod", "shake", "turn", "drag", "teleport", "gust"})
        EXPECT_NE(std::find(names.begin(), names.end(), wanted), names.end()) << wanted;
    for (const std::string& name : names)
    {
        const Motion motion = find_motion(name);
        EXPECT_EQ(motion.name, name);
        for (double t = -1.0; t < motion.seconds + 1.0; t += 0.01)
        {
            const Pose pose = pose_at(motion, t);
            ASSERT_TRUE(std::isfinite(glm::dot(pose.origin, pose.origin) + glm::dot(pose.wind, pose.wind))) << name;
            ASSERT_NEAR(glm::dot(pose.turn, pose.turn), 1.0, 1e-12) << name;
        }
    }
}

TEST(Motion, shake_is_0_8_rad_of_yaw_at_1_hz)
{
    const Motion shake = find_motion("shake");
    for (double t = 0.0; t <= shake.seconds; t += 0.01)
    {
        const Pose pose = pose_at(shake, t);
        EXPECT_NEAR(yaw_of(pose), 0.8 * std::sin(2.0 * std::numbers::pi * t), 1e-9) << t;
        EXPECT_EQ(glm::length(pose.origin), 0.0);
    }
}

TEST(Motion, drag_is_half_a_metre_of_sine_at_1_hz)
{
    const Motion drag = find_motion("drag");
    for (double t = 0.0; t <= drag.seconds; t += 0.01)
        EXPECT_NEAR(pose_at(drag, t).origin.x, 0.5 * std::sin(2.0 * std::numbers::pi * t), 1e-9) << t;
}

TEST(Motion, teleport_is_five_metres_in_no_time)
{
    const Motion teleport = find_motion("teleport");
    EXPECT_EQ(pose_at(teleport, std::nextafter(1.0, 0.0)).origin.x, 0.0);
    EXPECT_EQ(pose_at(teleport, 1.0).origin.x, 5.0);
}

TEST(Motion, nothing_moves_before_its_beginning_or_after_its_end)
{
    for (const std::string& name : motion_names())
    {
        const Motion motion = find_motion(name);
        for (const double past : {1e-9, 1.0, 1e9})
        {
            EXPECT_EQ(pose_at(motion, -past).origin, pose_at(motion, 0.0).origin) << name;
            EXPECT_EQ(pose_at(motion, -past).turn, pose_at(motion, 0.0).turn) << name;
            EXPECT_EQ(pose_at(motion, motion.seconds + past).origin, pose_at(motion, motion.seconds).origin) << name;
            EXPECT_EQ(pose_at(motion, motion.seconds + past).turn, pose_at(motion, motion.seconds).turn) << name;
            EXPECT_EQ(pose_at(motion, motion.seconds + past).wind, pose_at(motion, motion.seconds).wind) << name;
        }
    }
}

TEST(Motion, an_oscillation_stops_at_its_end_where_it_is)
{
    const Motion motion = parsed("seconds = 4\n[[oscillation]]\nchannel = \"y\"\namplitude = 2\nfrequency = 1\n"
                                 "begin = 1\nend = 2.25\n");
    EXPECT_EQ(pose_at(motion, 0.99).origin.y, 0.0);
    EXPECT_NEAR(pose_at(motion, 1.25).origin.y, 2.0, 1e-12);
    EXPECT_NEAR(pose_at(motion, 2.25).origin.y, 2.0, 1e-12);
    EXPECT_NEAR(pose_at(motion, 3.5).origin.y, 2.0, 1e-12);
}

TEST(Motion, a_ramp_is_at_rest_at_both_ends_and_lines_add_up)
{
    const Motion motion = parsed("seconds = 4\n[[ramp]]\nchannel = \"x\"\nby = 2\nbegin = 1\nend = 3\n"
                                 "[[step]]\nchannel = \"x\"\nby = 10\nat = 2\n");
    EXPECT_EQ(pose_at(motion, 1.0).origin.x, 0.0);
    EXPECT_NEAR(pose_at(motion, 1.001).origin.x / 0.001, 0.0, 0.01);
    EXPECT_NEAR(pose_at(motion, 1.999).origin.x, 1.0, 0.01);
    EXPECT_NEAR(pose_at(motion, 2.0).origin.x, 11.0, 1e-12);
    EXPECT_EQ(pose_at(motion, 3.0).origin.x, 12.0);
}

TEST(Motion, keys_hold_before_the_first_pass_through_each_and_hold_after_the_last)
{
    const Motion motion = parsed("seconds = 9\n[[pose]]\ntime = 1\nx = 1\n[[pose]]\ntime = 2\nx = 3\nyaw = 90\n"
                                 "[[pose]]\ntime = 4\nx = -1\nwind_y = 8\n");
    EXPECT_EQ(pose_at(motion, 0.0).origin.x, 1.0);
    EXPECT_EQ(pose_at(motion, 1.0).origin.x, 1.0);
    EXPECT_NEAR(pose_at(motion, 1.5).origin.x, 2.0, 1e-12);
    EXPECT_EQ(pose_at(motion, 2.0).origin.x, 3.0);
    EXPECT_NEAR(yaw_of(pose_at(motion, 2.0)), std::numbers::pi / 2.0, 1e-12);
    EXPECT_NEAR(pose_at(motion, 3.0).origin.x, 1.0, 1e-12);
    EXPECT_NEAR(pose_at(motion, 3.0).wind.y, 4.0, 1e-12);
    EXPECT_EQ(pose_at(motion, 8.0).origin.x, -1.0);
}

TEST(Motion, turns_are_yaw_after_pitch_after_roll)
{
    const Motion motion = parsed("[[pose]]\ntime = 0\nyaw = 90\npitch = 90\nroll = 90\n");
    const glm::dvec3 ahead = pose_at(motion, 0.0).turn * glm::dvec3(1, 0, 0);
    // Roll takes x to y, pitch takes y to z, yaw takes z to x.
    EXPECT_NEAR(ahead.x, 1.0, 1e-12);
    EXPECT_NEAR(ahead.y, 0.0, 1e-12);
    EXPECT_NEAR(ahead.z, 0.0, 1e-12);
}

TEST(Motion, a_script_on_a_base_turns_about_the_heads_own_origin)
{
    const Pose base{{1, 2, 3}, glm::angleAxis(1.0, glm::dvec3(0, 1, 0)), {1, 0, 0}};
    const Pose script{{0, 0, 1}, glm::angleAxis(0.5, glm::dvec3(0, 1, 0)), {0, 2, 0}};
    const Pose both = base * script;
    EXPECT_EQ(both.origin, glm::dvec3(1, 2, 4));
    EXPECT_EQ(both.wind, glm::dvec3(1, 2, 0));
    EXPECT_NEAR(yaw_of(both), 1.5, 1e-12);
}

TEST(Motion, a_broken_script_is_told_with_its_place)
{
    const std::pair<std::string, std::string> cases[] = {
        {"speed = 3\n",
         "script.toml:1:9: expected seconds, [[oscillation]], [[ramp]], [[step]] or [[pose]], found 'speed'"},
        {"seconds = 0\n", "script.toml:1:11: seconds must be a number above 0 and at most 86400"},
        {"seconds = nan\n", "script.toml:1:11: seconds must be a number above 0 and at most 86400"},
        {"seconds = \"two\"\n", "script.toml:1:11: seconds must be a number above 0 and at most 86400"},
        {"ramp = 3\n", "script.toml:1:8: 'ramp' must be written as [[ramp]]"},
        {"[step]\nby = 3\n", "script.toml:1:1: 'step' must be written as [[step]]"},
        {"[[step]]\nchannel = \"x\"\nby = 1\n", "script.toml:1:1: this table needs 'at'"},
        {"[[step]]\nat = 1\nby = 1\n", "script.toml:1:1: this table needs 'channel'"},
        {"[[step]]\nchannel = \"w\"\n",
         "script.toml:2:11: channel must be one of x, y, z, yaw, pitch, roll, wind_x, wind_y, wind_z"},
        {"[[step]]\nchannel = \"x\"\nby = inf\nat = 0\n", "script.toml:3:6: by must be a number within a million"},
        {"[[step]]\nchannel = \"x\"\nby = true\nat = 0\n", "script.toml:3:6: by must be a number within a million"},
        {"[[step]]\nchannel = \"x\"\nby = 1\nat = 0\nend = 2\n",
         "script.toml:5:7: 'end' is not known here; known are channel, by, at"},
        {"[[pose]]\ntime = 1\n[[pose]]\ntime = 1\n", "script.toml:3:1: the times of [[pose]] tables must grow"},
        {"", "script.toml: holds no motion; for a head at rest say seconds = 2.0"},
        {"# nothing\n\n", "script.toml: holds no motion; for a head at rest say seconds = 2.0"},
        {"pose = []\n", "script.toml:1:8: 'pose' must be written as [[pose]]"},
        {"[[pose]]\nx = 1\n", "script.toml:1:1: this table needs 'time'"},
        {"[[ramp]]\nchannel = \"x\"\nby = 1\nbegin = 2\nend = 1\n", "script.toml:1:1: begin must not lie after end"},
        {"[[oscillation]]\nchannel = \"x\"\namplitude = 1\nfrequency = 1\nbegin = 2\nend = 1\n",
         "script.toml:1:1: begin must not lie after end"},
    };
    for (const auto& [text, error] : cases)
        EXPECT_EQ(told(text), error) << text;
    EXPECT_EQ(told("seconds = = 3\n").rfind("script.toml:1:11: not valid TOML: ", 0), 0u) << told("seconds = = 3\n");
}

TEST(Motion, a_name_that_is_none_is_told_with_those_there_are)
{
    EXPECT_EQ(error_of([] { find_motion("shakee"); }),
              "'shakee' is neither a file nor one of coif's motions: drag, gust, nod, shake, still, teleport, turn");
    const Scratch scratch;
    EXPECT_EQ(error_of([&] { load_motion(scratch.folder()); }),
              scratch.folder().string() + ": is a folder, not a regular file; name a file in it");
    const fs::path file = scratch.write("mine.toml", "seconds = 7\n");
    EXPECT_EQ(find_motion(file.string()).seconds, 7.0);
}

} // namespace
} // namespace coif

#include "app/leeway.h"

#include <gtest/gtest.h>

namespace coif
{
namespace
{

// Frames whose time is a share that hangs on the strands, one that does not, and one that light takes, ms; a finer
// volume takes that many times as long.
void drag(Leeway& leeway, int frames, double of_strands, double of_the_rest, double of_light = 0.0, double finer = 2.0)
{
    for (int i = 0; i < frames; ++i)
    {
        const double light = leeway.coarse_light ? of_light / finer : of_light;
        note_frame(leeway, of_strands * double(leeway.share()) + of_the_rest + light, light, true);
    }
}

TEST(Leeway, fewer_strands_are_drawn_until_the_hand_is_followed_and_no_fewer)
{
    Leeway leeway;
    drag(leeway, 40, 100.0, 10.0);
    EXPECT_EQ(leeway.level, 2) << "100 / 4 + 10 is below 40, 100 / 2 + 10 above";
    EXPECT_EQ(leeway_text(leeway), "while dragging: 1/4 of the strands, to keep 25 frames a second");
    drag(leeway, 400, 1e4, 0.0);
    EXPECT_EQ(leeway.level, kMostHalvings);
}

TEST(Leeway, a_thousand_strands_are_left)
{
    for (const auto& [strands, level] : {std::pair(8000, 3), {7999, 2}, {2000, 1}, {1999, 0}, {1, 0}})
    {
        Leeway leeway;
        leeway.strands = strands;
        drag(leeway, 400, 1e4, 0.0);
        EXPECT_EQ(leeway.level, level) << strands;
    }
}

TEST(Leeway, one_slow_frame_among_quick_ones_changes_nothing)
{
    Leeway leeway;
    for (int i = 0; i < 100; ++i)
        note_frame(leeway, i % 3 == 1 ? 500.0 : 20.0, 0.0, true);
    EXPECT_EQ(leeway.level, 0);
}

TEST(Leeway, where_strands_are_not_what_takes_the_time_they_are_left)
{
    Leeway leeway;
    drag(leeway, 60, 3.0, 80.0);
    EXPECT_EQ(leeway.level, 0);
    EXPECT_TRUE(leeway.in_vain);
    // With the next drag it is tried again: the view may be another.
    note_frame(leeway, 83.0, 0.0, false);
    drag(leeway, 40, 100.0, 10.0);
    EXPECT_EQ(leeway.level, 2);
}

TEST(Leeway, strands_come_back_in_steps_when_the_hand_rests)
{
    Leeway leeway;
    drag(leeway, 400, 1e4, 0.0);
    int level = leeway.level, frames = 0;
    while (leeway.level > 0 && frames < 100)
    {
        note_frame(leeway, 1000.0, 0.0, false);
        ++frames;
        EXPECT_LE(level - leeway.level, 1);
        level = leeway.level;
    }
    EXPECT_GE(frames, 2 * kMostHalvings - 1);
    EXPECT_LE(frames, 2 * kMostHalvings);
    EXPECT_EQ(leeway_text(leeway), "");
}

TEST(Leeway, light_is_given_first_where_it_takes_a_tenth_and_strands_only_as_far_as_that_is_not_enough)
{
    Leeway leeway;
    drag(leeway, 40, 10.0, 10.0, 36.0);
    EXPECT_TRUE(leeway.coarse_light);
    EXPECT_EQ(leeway.level, 0) << "10 + 10 + 36 / 2 is below 40";
    EXPECT_EQ(leeway_text(leeway), "while dragging: light half as fine, to keep 25 frames a second");

    Leeway both;
    drag(both, 60, 60.0, 10.0, 20.0);
    EXPECT_TRUE(both.coarse_light);
    EXPECT_EQ(both.level, 2);
    EXPECT_EQ(leeway_text(both), "while dragging: light half as fine, 1/4 of the strands, to keep 25 frames a second");
    for (int i = 0; i < 10; ++i)
        note_frame(both, 1000.0, 0.0, false);
    EXPECT_EQ(leeway_text(both), "");

    Leeway dark; // light that is not followed anew is not asked to give way
    drag(dark, 60, 100.0, 10.0, 5.0);
    EXPECT_FALSE(dark.coarse_light);
    EXPECT_EQ(dark.level, 2);
}

// As where the hand has not moved since the frame before.
TEST(Leeway, frames_that_light_was_not_followed_in_say_nothing_of_what_it_takes)
{
    Leeway leeway;
    for (int i = 0; i < 9; ++i)
    {
        const double light = i % 3 ? (leeway.coarse_light ? 18.0 : 36.0) : 0.0;
        note_frame(leeway, 60.0 + light, light, true);
    }
    EXPECT_TRUE(leeway.coarse_light);
    EXPECT_FALSE(leeway.light_in_vain);
}

TEST(Leeway, light_that_a_coarser_volume_hardly_quickens_is_given_back_and_strands_are_tried)
{
    Leeway leeway;
    drag(leeway, 60, 60.0, 10.0, 20.0, 1.1);
    EXPECT_FALSE(leeway.coarse_light);
    EXPECT_EQ(leeway.level, 3) << "60 / 4 + 10 + 20 is above 40";
    EXPECT_FALSE(leeway.in_vain);
}

TEST(Leeway, turned_off_it_gives_nothing_and_takes_back_what_was_given)
{
    Leeway leeway;
    drag(leeway, 40, 100.0, 10.0);
    leeway.allowed = false;
    drag(leeway, 40, 100.0, 10.0);
    EXPECT_EQ(leeway.level, 0);
}

} // namespace
} // namespace coif

#include "app/leeway.h"

#include <gtest/gtest.h>

namespace coif
{
namespace
{

// Frames whose time is a share that hangs on the strands and one that does not, ms.
void drag(Leeway& leeway, int frames, double of_strands, double of_the_rest)
{
    for (int i = 0; i < frames; ++i)
        note_frame(leeway, of_strands * double(leeway.share()) + of_the_rest, true);
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

TEST(Leeway, one_slow_frame_among_quick_ones_changes_nothing)
{
    Leeway leeway;
    for (int i = 0; i < 100; ++i)
        note_frame(leeway, i % 3 == 1 ? 500.0 : 20.0, true);
    EXPECT_EQ(leeway.level, 0);
}

TEST(Leeway, where_strands_are_not_what_takes_the_time_they_are_left)
{
    Leeway leeway;
    drag(leeway, 60, 3.0, 80.0);
    EXPECT_EQ(leeway.level, 0);
    EXPECT_TRUE(leeway.in_vain);
    // With the next drag it is tried again: the view may be another.
    note_frame(leeway, 83.0, false);
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
        note_frame(leeway, 1000.0, false);
        ++frames;
        EXPECT_LE(level - leeway.level, 1);
        level = leeway.level;
    }
    EXPECT_GE(frames, 2 * kMostHalvings - 1);
    EXPECT_LE(frames, 2 * kMostHalvings);
    EXPECT_EQ(leeway_text(leeway), "");
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

// Frames in their order, and those that are due.
#include <vector>

#include <gtest/gtest.h>

#include "viewer/timeline.h"

namespace relief::viewer {

TEST(Timeline, steps_through_the_frames_that_are_named_and_stays_at_the_ends) {
    const Timeline timeline({20, 1, 5, 9}, 24);
    EXPECT_EQ(timeline.frames(), (std::vector<int>{1, 5, 9, 20}));
    EXPECT_EQ(timeline.step(5, 1), 9);
    EXPECT_EQ(timeline.step(5, -1), 1);
    EXPECT_EQ(timeline.step(6, 1), 9);
    EXPECT_EQ(timeline.step(6, -1), 5);
    EXPECT_EQ(timeline.step(20, 1), 20);
    EXPECT_EQ(timeline.step(1, -1), 1);
    EXPECT_EQ(timeline.snap(13), 9);
    EXPECT_EQ(timeline.snap(200), 20);
}

TEST(Timeline, leaves_frames_out_that_come_late_and_begins_again_at_the_end) {
    Timeline timeline({1, 2, 3, 4, 5}, 10);
    timeline.play(100, 2);
    EXPECT_TRUE(timeline.is_playing());
    EXPECT_EQ(timeline.find_frame(100), 2);
    EXPECT_EQ(timeline.find_frame(100.25), 4);
    EXPECT_EQ(timeline.find_frame(100.45), 1);
    EXPECT_EQ(timeline.find_frame(101.05), 2);
    timeline.pause();
    EXPECT_FALSE(timeline.is_playing());
}

TEST(Timeline, plays_frames_with_gaps_as_long_as_their_numbers_say) {
    Timeline timeline({1, 5, 20}, 1);
    timeline.play(0, 1);
    EXPECT_EQ(timeline.find_frame(3.5), 1);
    EXPECT_EQ(timeline.find_frame(4.5), 5);
    EXPECT_EQ(timeline.find_frame(18.5), 5);
    EXPECT_EQ(timeline.find_frame(19.5), 20);
    EXPECT_EQ(timeline.find_frame(20.5), 1);
}

TEST(Timeline, without_a_range_steps_by_one_and_does_not_play) {
    Timeline timeline({}, 0);
    EXPECT_EQ(timeline.fps(), Timeline::kUsualFps);
    EXPECT_EQ(timeline.step(7, 1), 8);
    EXPECT_EQ(timeline.snap(7), 7);
    timeline.play(0, 1);
    EXPECT_FALSE(timeline.is_playing());
}

} // namespace relief::viewer

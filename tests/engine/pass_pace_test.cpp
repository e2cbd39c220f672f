// How long steps of passes are, with clocks that are made up.
#include "engine/pass_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

namespace relief {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr uint64_t kPixels = 1000;

/// A picture of 1000 pixels whose passes end at 1, 4, 16, 32, ... samples, and a machine whose speed changes
/// from step to step.
struct Simulation {
    PassPace pace;
    double limit_s, sample_s;
    int spp = 1 << 20, samples = 0;
    double now_s = 0;
    std::vector<int> counts{}; ///< of steps that were begun
    bool is_last_whole = true;

    int find_end() const {
        const int end = samples < 1 ? 1 : samples < 4 ? 4 : samples / 16 * 16 + 16;
        return std::min(end, spp);
    }

    void run() {
        while (samples < spp) {
            const PassRest rest{samples, find_end(), kPixels, kPixels * uint64_t(spp - samples)};
            const std::optional<int> count = pace.choose_count(rest, limit_s - now_s);
            if (!count) return;
            ASSERT_GE(*count, 1);
            ASSERT_LE(samples + *count, rest.end);
            counts.push_back(*count);
            const double speed = counts.size() % 3 == 0 ? 1.5 : 0.9;
            const double step_s = (samples == 0 ? 3 : 1) * speed * sample_s * *count;
            now_s += step_s;
            is_last_whole = now_s <= limit_s;
            if (!is_last_whole && samples > 0) return;
            pace.learn(kPixels * uint64_t(*count), step_s, samples == 0);
            samples += *count;
        }
    }
};

} // namespace

TEST(PassPace, makes_whole_passes_where_nobody_waits) {
    Simulation free{PassPace({}), kNever, 0.5};
    free.spp = 50;
    free.run();
    EXPECT_EQ(free.counts, (std::vector<int>{1, 3, 12, 16, 16, 2}));
    Simulation early{PassPace({}), 1e6, 0.5};
    early.spp = 50;
    early.run();
    EXPECT_EQ(early.counts, free.counts) << "a limit that is far away changes nothing";
}

TEST(PassPace, leaves_no_step_of_several_samples_undone_at_a_limit) {
    for (const double sample_s : {0.001, 0.1, 1.0, 7.0})
        for (int k = 1; k <= 10; ++k) {
            Simulation s{PassPace({}), 13.7 * k, sample_s};
            s.run();
            if (!s.is_last_whole && s.counts.size() > 1)
                EXPECT_EQ(s.counts.back(), 1) << sample_s << ", " << k;
            if (s.samples > 1) {
                EXPECT_GT(s.now_s, s.limit_s - 2 * 1.5 * sample_s) << "time that is left is used";
            }
        }
}

TEST(PassPace, begins_the_first_pass_and_nothing_behind_the_limit) {
    PassPace pace({});
    EXPECT_EQ(pace.choose_count({0, 1, kPixels, kPixels * 64}, -5), 1);
    EXPECT_EQ(pace.choose_count({1, 4, kPixels, kPixels * 63}, 0), std::nullopt);
    EXPECT_EQ(pace.choose_count({1, 4, kPixels, kPixels * 63}, 1), 1) << "nothing is known of the speed";
    pace.learn(kPixels, 1, false);
    EXPECT_EQ(pace.choose_count({2, 4, kPixels, kPixels * 62}, 0.9), std::nullopt);
    EXPECT_EQ(pace.choose_count({2, 4, kPixels / 2, kPixels * 31}, 0.9), 1) << "fewer pixels take less time";
    PassPace first({});
    first.learn(kPixels, 1, true);
    EXPECT_EQ(first.choose_count({1, 4, kPixels, kPixels * 63}, 0.3), 1) << "the first step is a slow one";
}

TEST(PassPace, makes_steps_of_about_the_length_that_a_spectator_waits) {
    PassPace::Config config;
    config.longest_step_s = 1;
    PassPace pace(config);
    pace.learn(kPixels, 0.12, false);
    EXPECT_EQ(pace.choose_count({16, 32, kPixels, kPixels}, kNever), 8) << "two steps of equal length";
    EXPECT_EQ(pace.choose_count({1, 4, kPixels, kPixels}, kNever), 3);
    pace.learn(kPixels, 2, false);
    EXPECT_EQ(pace.choose_count({1, 4, kPixels, kPixels}, kNever), 1);
    EXPECT_EQ(pace.choose_count({32, 48, kPixels, kPixels}, kNever), 8) << "no fewer than a quarter more";
}

TEST(PassPace, keeps_passes_whole_where_bits_depend_on_them_unless_time_is_too_short) {
    PassPace::Config config;
    config.longest_step_s = 1, config.keeps_bits = false;
    PassPace pace(config);
    pace.learn(kPixels, 1, false);
    EXPECT_EQ(pace.choose_count({16, 32, kPixels, kPixels * 48}, kNever), 16);
    EXPECT_EQ(pace.choose_count({16, 32, kPixels, kPixels * 16}, 17), 16) << "all that is lacking fits";
    EXPECT_EQ(pace.choose_count({16, 32, kPixels, kPixels * 48}, 17), 8);
}

} // namespace relief

// Passes over a picture, by a tracer that traces nothing.
#include "engine/render_passes.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

#include "engine/picture_windows.h"

namespace relief {

namespace {

constexpr Window kPicture{0, 0, 64, 48};

class EmptyTracer final : public PassTracer {
  public:
    int steps = 0;
    void start_step() override { ++steps; }
    bool keeps_bits() const override { return true; }
    void trace(Film& film, std::span<const SampleTask> tasks, PassMonitor& monitor) override {
        for (const SampleTask& task : tasks) {
            if (monitor.must_stop()) return;
            for (int y = task.window.y0; y < task.window.y1; ++y)
                for (int x = task.window.x0; x < task.window.x1; ++x)
                    for (int k = 0; k < task.count; ++k) film.add_sample(x, y, {});
            monitor.finish_task(count_pixels(task.window) * uint64_t(task.count), 1);
        }
    }
};

/// Cancels when it has been asked so many times.
class AskedCanceller final : public RenderObserver {
  public:
    explicit AskedCanceller(int most) : left_(most) {}
    void on_progress(const Progress&) override {}
    bool is_cancelled() const override { return left_-- <= 0; }

  private:
    mutable int left_;
};

Film make_empty_film() { return Film(kPicture.x1, kPicture.y1, kPicture, {}); }

ImageSettings make_samples(int spp) {
    ImageSettings image;
    image.spp = spp;
    return image;
}

} // namespace

TEST(RenderPasses, that_spent_their_time_before_make_one_sample_of_each_pixel) {
    for (const bool is_reserved : {false, true}) {
        Film film = make_empty_film();
        EmptyTracer tracer;
        ImageSettings image = make_samples(64);
        image.time_limit_s = 1000;
        if (is_reserved) image.time_reserved_s = 1000;
        RenderControl control;
        if (!is_reserved) control.spent_s = 1000;
        EXPECT_TRUE(render_passes(film, image, control, 16, tracer).is_complete);
        EXPECT_EQ(film.least_samples(), 1u);
        EXPECT_EQ(film.most_samples(), 1u);
        EXPECT_TRUE(lacks_samples(film, image));
        image.time_limit_s = 0;
        EXPECT_TRUE(render_passes(film, image, control, 16, tracer).is_complete);
        EXPECT_EQ(film.least_samples(), 64u) << "without a limit nothing ends";
        EXPECT_FALSE(lacks_samples(film, image));
    }
}

TEST(RenderPasses, that_are_cancelled_leave_samples_of_one_pass_evenly_over_the_picture) {
    for (const int asked : {20, 33, 40, 52, 71}) {
        Film film = make_empty_film();
        EmptyTracer tracer;
        AskedCanceller canceller(asked);
        RenderControl control(&canceller);
        EXPECT_FALSE(render_passes(film, make_samples(256), control, 8, tracer).is_complete);
        const int least = int(film.least_samples()), most = int(film.most_samples());
        const int pass = least == 0 ? 1 : least < 4 ? 4 : least / 16 * 16 + 16;
        EXPECT_TRUE(most == least || most == pass) << least << ", " << most;
        if (most == least) continue;
        // As many of the left half as of the right one, and of the upper as of the lower.
        int left = 0, right = 0, upper = 0, lower = 0;
        for (const Window& tile : cut_into_windows({0, 0, 64, 32}, 8)) {
            if (int(film.sample_count(tile.x0, tile.y0)) == least) continue;
            ++(tile.x0 < 32 ? left : right), ++(tile.y0 < 16 ? upper : lower);
        }
        EXPECT_NEAR(left, right, 2) << asked;
        EXPECT_NEAR(upper, lower, 2) << asked;
    }
}

TEST(RenderPasses, show_pictures_of_whole_passes) {
    Film film = make_empty_film();
    EmptyTracer tracer;
    RenderControl control;
    std::vector<std::pair<uint32_t, uint32_t>> shown;
    control.show = {0, [&] { shown.emplace_back(film.least_samples(), film.most_samples()); }};
    render_passes(film, make_samples(48), control, 8, tracer);
    ASSERT_GE(shown.size(), 5u);
    EXPECT_EQ(int(shown.size()), tracer.steps);
    EXPECT_EQ(shown.front().first, 1u);
    EXPECT_EQ(shown.back().first, 48u);
    for (const auto& [least, most] : shown) EXPECT_EQ(least, most);
}

} // namespace relief

// Which samples come next, from what a film holds.
#include "engine/sample_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "engine/picture_windows.h"
#include "math/vec.h"
#include "relief/error.h"

namespace relief {

namespace {

constexpr Window kWindow{5, 3, 45, 30};

Film make_film(ErrorEstimate error = ErrorEstimate::off) {
    return Film(64, 48, kWindow, {"depth", "P"}, error);
}

/// A sample whose radiance is 1, and noisy right of column 24.
FilmSample make_sample(int x, int y, int index) {
    FilmSample sample;
    const float noise = x < 24 ? 0.0f : float((x * 31 + y * 17 + index * 7) % 11) - 5.0f;
    sample.radiance = Vec3f{1, 1, 1} + Vec3f{0.15f, 0.15f, 0.15f} * noise;
    sample.alpha = 1, sample.id = 1, sample.depth = float(x + y), sample.position = {float(x), float(y), 0};
    return sample;
}

void trace(Film& film, const SampleTask& task) {
    for (int y = task.window.y0; y < task.window.y1; ++y)
        for (int x = task.window.x0; x < task.window.x1; ++x)
            for (int k = task.first; k < task.first + task.count; ++k) {
                ASSERT_EQ(int(film.sample_count(x, y)), k) << "samples come in order, each once";
                film.add_sample(x, y, make_sample(x, y, k));
            }
}

/// Goes on until all is done or `most` tasks are.
void trace_all(Film& film, const ImageSettings& image, int most = 1 << 30) {
    SamplePlan plan(film, image);
    while (plan.start_pass())
        for (std::vector<SampleTask> tasks = plan.list_tasks(16); !tasks.empty(); tasks = plan.list_tasks(16))
            for (const SampleTask& task : tasks) {
                if (most-- == 0) return;
                trace(film, task);
            }
}

} // namespace

TEST(SamplePlan, ends_passes_at_1_4_and_multiples_of_sixteen) {
    Film film = make_film();
    ImageSettings image;
    image.spp = 50;
    SamplePlan plan(film, image);
    std::vector<int> ends;
    while (plan.start_pass()) {
        ends.push_back(plan.target());
        const std::vector<SampleTask> tasks = plan.list_tasks(16);
        EXPECT_EQ(tasks.size(), cut_into_windows(kWindow, 16).size())
            << "whole tiles where all lack the same";
        for (const SampleTask& task : tasks) trace(film, task);
        EXPECT_TRUE(plan.list_tasks(16).empty());
    }
    EXPECT_EQ(ends, (std::vector<int>{1, 4, 16, 32, 48, 50}));
    EXPECT_EQ(film.least_samples(), 50u);
    EXPECT_EQ(film.most_samples(), 50u);
}

TEST(SamplePlan, traces_what_was_cleared_and_nothing_else) {
    Film film = make_film();
    ImageSettings image;
    image.spp = 20;
    trace_all(film, image);
    film.clear({16, 8, 24, 16});
    SamplePlan plan(film, image);
    uint64_t pixels = 0;
    while (plan.start_pass())
        for (const SampleTask& task : plan.list_tasks(16)) {
            EXPECT_EQ(task.window, (Window{16, 8, 24, 16}));
            pixels += count_pixels(task.window) * uint64_t(task.count);
            trace(film, task);
        }
    EXPECT_EQ(pixels, 64u * 20u);
}

TEST(SamplePlan, spares_blocks_of_little_noise_and_not_their_noisy_neighbours) {
    Film film = make_film(ErrorEstimate::on);
    ImageSettings image;
    image.spp = 512, image.noise = 0.05f;
    trace_all(film, image);
    EXPECT_EQ(film.sample_count(6, 10), 16u) << "far from noise, the least";
    EXPECT_GT(film.sample_count(40, 20), 32u);
    EXPECT_GT(film.sample_count(20, 20), 16u) << "beside a noisy block";
    EXPECT_LT(film.sample_count(40, 20), 512u);
    const Window noisy{24, 8, 45, 24};
    EXPECT_LT(1.57 * film.estimate_error(noisy), 0.05);
    EXPECT_EQ(film.resolve().channels.size(), 8u) << "what noise is judged by is no layer";
}

TEST(SamplePlan, goes_on_from_any_point_to_the_same_sums) {
    ImageSettings image;
    image.spp = 200, image.noise = 0.05f;
    Film whole = make_film(ErrorEstimate::on);
    trace_all(whole, image);
    for (const int tasks : {0, 1, 7, 40, 61, 62, 63, 75}) {
        Film first = make_film(ErrorEstimate::on);
        ImageSettings fewer = image;
        fewer.spp = tasks == 40 ? 20 : 200;
        trace_all(first, fewer, tasks);
        std::stringstream bytes;
        first.write(bytes, "a picture");
        Film second = make_film(ErrorEstimate::on);
        second.read(bytes, "a picture");
        trace_all(second, image);
        EXPECT_EQ(second.resolve().pixels, whole.resolve().pixels) << tasks << " tasks";
        for (const Window& block : cut_into_windows(kWindow, 8))
            EXPECT_EQ(second.sample_count(block.x0, block.y0), whole.sample_count(block.x0, block.y0));
    }
}

TEST(Film, refuses_sums_that_are_damaged_or_of_another_picture) {
    Film film = make_film();
    trace(film, {kWindow, 0, 3});
    std::stringstream stream;
    film.write(stream, "a picture");
    const std::string bytes = stream.str();
    const auto expect_refused = [](const std::string& text, const char* identity, Film other) {
        std::istringstream in(text);
        EXPECT_THROW(other.read(in, identity), Error);
    };
    expect_refused(bytes, "another picture", make_film());
    expect_refused(bytes, "a picture", make_film(ErrorEstimate::on));
    expect_refused(bytes, "a picture", Film(64, 48, {5, 3, 45, 31}, {"depth", "P"}));
    for (size_t at = 0; at < bytes.size(); at += 97) {
        std::string damaged = bytes;
        damaged[at] = char(damaged[at] ^ 0x10);
        expect_refused(damaged, "a picture", make_film());
        expect_refused(bytes.substr(0, at), "a picture", make_film());
    }
}

} // namespace relief

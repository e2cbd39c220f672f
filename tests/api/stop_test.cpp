// Cancellation in the middle of a tile.
#include <algorithm>
#include <atomic>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/scenes/peer_scenes.h"
#include "relief/render.h"
#include "relief/session.h"

namespace relief {
namespace {

/// Cancels after `limit` queries.
struct LookCanceller final : RenderObserver {
    mutable std::atomic<int> looks{0};
    int limit;
    explicit LookCanceller(int limit) : limit(limit) {}
    void on_progress(const Progress&) override {}
    bool is_cancelled() const override { return ++looks > limit; }
};

RenderSettings make_stop_settings(size_t cache_bytes) {
    RenderSettings settings;
    settings.image.width = 16, settings.image.height = 16; // one tile
    settings.image.spp = 2, settings.image.bounces = 0;
    settings.surface.level = 7;
    settings.device.threads = 1;
    settings.image.layers = {"samples"};
    settings.surface.cache_bytes = cache_bytes;
    return settings;
}

TEST(Cancellation, stops_before_the_next_tree_and_leaves_whole_samples) {
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    for (const size_t cache_bytes : {size_t(256) << 20, size_t(0)}) {
        const RenderSettings settings = make_stop_settings(cache_bytes);
        LookCanceller never(1 << 30);
        const RenderResult whole = render(rock, settings, &never);
        ASSERT_TRUE(whole.is_complete);
        ASSERT_GT(whole.statistics.bottom_built, 200u) << "nothing to stop between";
        for (const int limit : {1, 20, never.looks / 2, never.looks - 3}) {
            LookCanceller observer(limit);
            const RenderResult result = render(rock, settings, &observer);
            EXPECT_FALSE(result.is_complete) << limit;
            EXPECT_LE(result.statistics.bottom_built, uint64_t(limit));
            EXPECT_LE(observer.looks, limit + 10) << "work went on";
            const size_t samples = result.image.find_channel("samples.Y").value();
            const float count = result.image.at(0, 0, samples);
            EXPECT_LT(count, 2);
            EXPECT_EQ(result.whole_samples, int(count));
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) ASSERT_EQ(result.image.at(x, y, samples), count);
        }
    }
}

TEST(Cancellation, ends_while_the_scene_is_prepared) {
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    RenderSettings settings = make_stop_settings(size_t(256) << 20);
    LookCanceller at_once(0);
    const RenderResult result = render(rock, settings, &at_once);
    EXPECT_EQ(result.statistics.patches, 0u) << "the scene was prepared";
    EXPECT_LE(at_once.looks, 4);
    EXPECT_FALSE(result.is_complete);
    EXPECT_EQ(result.whole_samples, 0);
    EXPECT_EQ(result.image.width, 16);
    EXPECT_TRUE(result.image.metadata.contains("relief:interrupted"));
}

TEST(Cancellation, after_the_last_sample_leaves_the_picture_complete) {
    struct Late final : RenderObserver {
        std::atomic<bool> is_done{false};
        void on_progress(const Progress& progress) override { is_done = progress.fraction >= 1; }
        bool is_cancelled() const override { return is_done; }
    };
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    const RenderSettings settings = make_stop_settings(size_t(256) << 20);
    Late observer;
    const RenderResult result = render(rock, settings, &observer);
    EXPECT_TRUE(result.is_complete);
    EXPECT_EQ(result.whole_samples, settings.image.spp);
    EXPECT_TRUE(observer.is_done);
    EXPECT_FALSE(result.image.metadata.contains("relief:interrupted"));
}

struct SampleCounts {
    float least = 1e9f, most = 0;
};

SampleCounts count_samples(const Image& image) {
    SampleCounts counts;
    const size_t samples = image.find_channel("samples.Y").value();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            counts.least = std::min(counts.least, image.at(x, y, samples));
            counts.most = std::max(counts.most, image.at(x, y, samples));
        }
    return counts;
}

TEST(Cancellation, tells_whether_every_pixel_has_a_sample) {
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    RenderSettings settings = make_stop_settings(size_t(256) << 20);
    settings.image.width = 96, settings.image.height = 64, settings.image.spp = 4; // several tiles
    settings.surface.level = 3;
    LookCanceller never(1 << 30);
    ASSERT_EQ(render(rock, settings, &never).whole_samples, 4);
    bool has_part = false, has_whole = false;
    for (int limit = 0; limit < never.looks; limit += std::max(1, never.looks / 40)) {
        LookCanceller observer(limit);
        const RenderResult result = render(rock, settings, &observer);
        const SampleCounts counts = count_samples(result.image);
        ASSERT_EQ(result.whole_samples, int(counts.least)) << limit;
        has_part |= counts.least == 0 && counts.most > 0;
        has_whole |= counts.least > 0 && counts.least < 4;
    }
    EXPECT_TRUE(has_part) << "cancelled within the first pass";
    EXPECT_TRUE(has_whole) << "cancelled within a later one";
}

TEST(Cancellation, of_an_update_tells_that_pixels_are_missing) {
    Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    RenderSettings settings = make_stop_settings(size_t(256) << 20);
    settings.image.width = 96, settings.image.height = 64;
    settings.surface.level = 3;
    MapEdit edit;
    edit.displacement = rock.displacements[0].name;
    edit.texels = *rock.displacements[0].tiles[0].texture;
    for (float& value : edit.texels.floats) value *= 0.5f;
    Session session(std::move(rock), settings);
    EXPECT_EQ(session.render().whole_samples, 2);
    session.edit(edit);
    LookCanceller at_once(0);
    const RenderResult result = session.render(&at_once);
    EXPECT_FALSE(result.is_complete);
    EXPECT_EQ(count_samples(result.image).least, 0);
    EXPECT_EQ(result.whole_samples, 0);
}

TEST(Warnings, reach_the_observer_before_the_first_ray) {
    struct Listener final : RenderObserver {
        int calls = 0;
        std::vector<std::string> warnings;
        bool has_progress = false;
        void on_progress(const Progress&) override { has_progress = true; }
        void on_warnings(const std::vector<std::string>& told) override {
            EXPECT_FALSE(has_progress);
            ++calls, warnings = told;
        }
        bool is_cancelled() const override { return false; }
    };
    Scene empty;
    Listener observer;
    const RenderSettings settings = make_stop_settings(0);
    const RenderResult result = render(empty, settings, &observer);
    EXPECT_EQ(observer.calls, 1);
    EXPECT_EQ(observer.warnings, result.statistics.warnings);
    ASSERT_EQ(observer.warnings.size(), 1u);
    Session session(empty, settings);
    observer.has_progress = false;
    session.render(&observer);
    EXPECT_EQ(observer.calls, 2);
}

} // namespace
} // namespace relief

// Cancellation in the middle of a tile.
#include <atomic>

#include <gtest/gtest.h>

#include "lab/scenes/peer_scenes.h"
#include "relief/render.h"

namespace relief {
namespace {

/// Cancels after `limit` queries.
struct Canceller final : RenderObserver {
    mutable std::atomic<int> looks{0};
    int limit;
    explicit Canceller(int limit) : limit(limit) {}
    void on_progress(const Progress&) override {}
    bool is_cancelled() const override { return ++looks > limit; }
};

RenderSettings make_settings(size_t cache_bytes) {
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
        const RenderSettings settings = make_settings(cache_bytes);
        Canceller never(1 << 30);
        const RenderResult whole = render(rock, settings, &never);
        ASSERT_TRUE(whole.is_complete);
        ASSERT_GT(whole.statistics.bottom_built, 200u) << "nothing to stop between";
        for (const int limit : {1, 20, never.looks / 2, never.looks - 3}) {
            Canceller observer(limit);
            const RenderResult result = render(rock, settings, &observer);
            EXPECT_FALSE(result.is_complete) << limit;
            EXPECT_LE(result.statistics.bottom_built, uint64_t(limit));
            EXPECT_LE(observer.looks, limit + 10) << "work went on";
            const size_t samples = result.image.find_channel("samples.Y").value();
            const float count = result.image.at(0, 0, samples);
            EXPECT_LT(count, 2);
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) ASSERT_EQ(result.image.at(x, y, samples), count);
        }
    }
}

TEST(Cancellation, after_the_last_sample_leaves_the_picture_complete) {
    struct Late final : RenderObserver {
        std::atomic<bool> is_done{false};
        void on_progress(const Progress& progress) override { is_done = progress.fraction >= 1; }
        bool is_cancelled() const override { return is_done; }
    };
    const Scene rock = make_peer_scene("rock", 1, PeerWorld::constant);
    const RenderSettings settings = make_settings(size_t(256) << 20);
    Late observer;
    const RenderResult result = render(rock, settings, &observer);
    EXPECT_TRUE(result.is_complete);
    EXPECT_TRUE(observer.is_done);
    EXPECT_FALSE(result.image.metadata.contains("relief:interrupted"));
}

} // namespace
} // namespace relief

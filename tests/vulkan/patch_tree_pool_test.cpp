// The pool of patch trees: what a wave may take, and when it grows.
#include <algorithm>

#include <gtest/gtest.h>

#include "formulas/patch_tree.h"
#include "vulkan/gpu_fixture.h"
#include "vulkan/patch_tree_cache.h"

namespace relief::vulkan::tests {

namespace {

constexpr uint64_t kMebibyte = 1u << 20;
constexpr uint32_t kUnitsOfMebibyte = uint32_t(kMebibyte / (scalar::kPoolUnitWords * sizeof(uint32_t)));

class PatchTreePool : public GpuTest {
  protected:
    /// A chunk of one wave that builds as much as it may.
    scalar::CastPush fill_wave(PatchTreeCache& cache) {
        scalar::CastPush push{};
        cache.begin_chunk(trees_, commands_, bindings_);
        cache.begin_wave(push, counters_, commands_);
        commands_.run();
        scalar::CounterData done{};
        done.pool_head = push.pool_start + push.pool_budget;
        cache.end_wave(done);
        return push;
    }

    void mark_trees() { trees_.upload(std::vector<uint32_t>(trees_.byte_count() / sizeof(uint32_t), 1)); }
    bool has_marks() const { return trees_.download<uint32_t>(1).front() == 1; }

    BindingTable bindings_{device()};
    vulkan::Commands commands_{device(), bindings_};
    Buffer trees_{device(), {.name = "trees", .bytes = sizeof(scalar::TreeRecord)}};
    Buffer counters_{device(), {.name = "counters", .bytes = sizeof(scalar::CounterData)}};
};

TEST_F(PatchTreePool, gives_waves_what_no_tree_has_had_and_then_a_share) {
    PatchTreeCache cache(device(), {}, {.first_bytes = kMebibyte, .rebuilds = 1, .budget_share = 2});
    cache.bind(bindings_);
    mark_trees();
    EXPECT_EQ(fill_wave(cache).pool_budget, kUnitsOfMebibyte);
    for (int wave = 1; wave < 20; ++wave) {
        const scalar::CastPush push = fill_wave(cache);
        EXPECT_EQ(push.pool_budget, kUnitsOfMebibyte / 2);
        EXPECT_EQ(push.pool_start, kUnitsOfMebibyte + uint32_t(wave - 1) * kUnitsOfMebibyte / 2);
    }
    EXPECT_EQ(cache.byte_count(), kMebibyte); // most_bytes: it does not grow
    EXPECT_TRUE(has_marks());
}

TEST_F(PatchTreePool, grows_once_much_was_built_again_and_forgets_its_trees) {
    PatchTreeCache cache(
        device(), {},
        {.first_bytes = kMebibyte, .most_bytes = 6 * kMebibyte, .rebuilds = 2, .budget_share = 2});
    cache.bind(bindings_);
    mark_trees();
    for (int wave = 0; wave < 4; ++wave) fill_wave(cache); // 1 + 3 / 2 of it
    EXPECT_EQ(cache.byte_count(), kMebibyte);
    EXPECT_TRUE(has_marks());
    const scalar::CastPush grown = fill_wave(cache);
    EXPECT_EQ(cache.byte_count(), 4 * kMebibyte);
    EXPECT_EQ(grown.pool_start, 0u);
    EXPECT_EQ(grown.pool_capacity, 4 * kUnitsOfMebibyte);
    EXPECT_EQ(grown.pool_budget, 4 * kUnitsOfMebibyte);
    EXPECT_FALSE(has_marks());
    for (int wave = 0; wave < 40; ++wave) fill_wave(cache);
    EXPECT_EQ(cache.byte_count(), 6 * kMebibyte);
}

TEST_F(PatchTreePool, without_a_cache_gives_each_wave_all_of_itself) {
    PatchTreeCache cache(device(), {.cap_bytes = 0}, {.first_bytes = kMebibyte, .budget_share = 4});
    cache.bind(bindings_);
    for (int wave = 0; wave < 3; ++wave) {
        const scalar::CastPush push = fill_wave(cache);
        EXPECT_EQ(push.pool_budget, kUnitsOfMebibyte);
        EXPECT_EQ(push.pool_start, 0u);
        EXPECT_EQ(push.is_cached, 0u);
    }
}

TEST_F(PatchTreePool, has_the_usual_size_on_a_processor_and_room_for_large_waves_on_a_gpu) {
    const uint64_t most = std::min(device().max_buffer_bytes(), device().available_bytes() / 4);
    const PoolGrowth growth = choose_pool_growth(device(), {.tree_bytes = 4096 * kMebibyte});
    const PoolGrowth capped =
        choose_pool_growth(device(), {.cap_bytes = 3 * kMebibyte, .tree_bytes = 4096 * kMebibyte});
    EXPECT_EQ(growth.first_bytes, std::min(device().is_cpu() ? kDefaultCacheBytes : 1024 * kMebibyte, most));
    EXPECT_EQ(growth.most_bytes > 0, !device().is_cpu());
    EXPECT_EQ(capped.first_bytes, std::min(3 * kMebibyte, most));
    EXPECT_EQ(capped.most_bytes, 0u); // it keeps to its cap
}

} // namespace

} // namespace relief::vulkan::tests

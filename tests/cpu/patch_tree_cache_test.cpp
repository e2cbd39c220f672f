// Many threads over one small cache: trees are evicted, retired and freed while others walk them. The thread
// sanitizer watches the same test.
#include <gtest/gtest.h>

#include <random>
#include <thread>

#include "cpu/patch_trees/patch_tree_cache.h"
#include "cpu/tracer.h"
#include "cpu/traversal/kernels.h"
#include "formulas/levels.h"
#include "support/bodies.h"

namespace relief {

namespace {

constexpr size_t kThreads = 8;
constexpr int kRounds = 3;
constexpr size_t kBatch = 48;

/// Rays at a body of radius about 1, runs of sixteen from one point; levels are mixed, so trees of all sizes
/// are.
std::vector<cpu::TraceRay> make_mixed_rays(uint32_t count) {
    std::mt19937 random(17);
    std::normal_distribution<float> normal;
    const auto draw = [&] { return Vec3f{normal(random), normal(random), normal(random)}; };
    std::vector<cpu::TraceRay> rays;
    for (uint32_t k = 0; k < count; ++k) {
        cpu::TraceRay ray;
        ray.origin = k % 16 ? rays.back().origin : normalize(draw()) * 3.0f;
        ray.direction = draw() * 0.4f - ray.origin;
        ray.lod_bias = k / 16 % 5;
        rays.push_back(ray);
    }
    return rays;
}

std::shared_ptr<const PreparedScene> prepare_fine_torus(RenderSettings& settings, int level = 7) {
    settings.surface.level = level;
    const Displacement displacement =
        test::make_displacement(test::make_random_map(64, 64, 0.1f, 5), DisplacementSpace::tangent);
    return prepare_scene(test::make_body_scene(test::make_torus(6, 9), displacement), settings);
}

/// Traces all batches a few times, each thread in an order of its own; returns how many hits differ.
size_t count_differences(const cpu::Tracer& tracer, const std::vector<cpu::TraceRay>& rays,
                         const std::vector<cpu::TraceHit>& expected, size_t thread) {
    size_t differences = 0;
    const size_t batches = rays.size() / kBatch;
    std::vector<cpu::TraceHit> hits(kBatch);
    for (int round = 0; round < kRounds; ++round)
        for (size_t k = 0; k < batches; ++k) {
            const size_t batch = (thread % 2 ? batches - 1 - k : k + thread * batches / kThreads) % batches;
            tracer.closest_hits(std::span(rays).subspan(batch * kBatch, kBatch), hits);
            for (size_t r = 0; r < kBatch; ++r) {
                const cpu::TraceHit &a = hits[r], &b = expected[batch * kBatch + r];
                differences += a.t != b.t || a.patch != b.patch || a.u != b.u || a.v != b.v;
            }
        }
    return differences;
}

class PatchTreeCache : public testing::TestWithParam<size_t> {};

TEST_P(PatchTreeCache, gives_the_same_hits_to_many_threads_that_evict_each_others_trees) {
    RenderSettings settings;
    const auto prepared = prepare_fine_torus(settings);
    const std::vector<cpu::TraceRay> rays = make_mixed_rays(20 * kBatch);
    settings.surface.cache_bytes = 0;
    std::vector<cpu::TraceHit> expected(rays.size());
    cpu::Tracer(prepared, settings).closest_hits(rays, expected);

    settings.surface.cache_bytes = GetParam();
    const cpu::Tracer tracer(prepared, settings);
    std::vector<size_t> differences(kThreads);
    std::vector<std::thread> threads;
    for (size_t k = 0; k < kThreads; ++k)
        threads.emplace_back([&, k] { differences[k] = count_differences(tracer, rays, expected, k); });
    for (std::thread& thread : threads) thread.join();

    for (size_t k = 0; k < kThreads; ++k) EXPECT_EQ(differences[k], 0u) << "thread " << k;
    Statistics statistics;
    tracer.add_statistics(statistics);
    EXPECT_LE(statistics.bottom_cache_bytes, GetParam());
    EXPECT_GT(statistics.bottom_reused, 0u);
    // 54 patches of 4 tiles at the full level, and fewer at each bias: more were built than there are.
    EXPECT_GT(statistics.bottom_built, 54u * (4 + 4));
}

/// Asks for the trees of `count` tiles in turn, a few rounds, of a cache within the limits.
cpu::TraceCounters visit_tiles(cpu::CacheLimits limits, uint32_t count, int rounds, size_t* peak = nullptr) {
    RenderSettings settings;
    const auto prepared = prepare_fine_torus(settings);
    cpu::PatchTreeCache cache(limits, cpu::find_kernels(Isa::best)->build_tree);
    for (int round = 0; round < rounds; ++round)
        for (uint32_t k = 0; k < count; ++k) {
            cpu::TraceContext& context = cache.acquire();
            const cpu::TreeKey key{0, k / 4, k % 4, scalar::pack_uniform_level(7)};
            cache.find_or_build_tree(context, prepared->surfaces[0], key);
            cache.release(context);
        }
    if (peak) *peak = cache.peak_byte_count();
    return cache.sum_counters();
}

constexpr size_t kTreeBytes = cpu::PatchTree::size_bytes(cpu::kTileLevel);

TEST(PatchTreeCacheLimits, a_cache_grows_until_no_tree_is_built_again) {
    const cpu::TraceCounters fixed = visit_tiles({10 * kTreeBytes, 10 * kTreeBytes}, 40, 20);
    EXPECT_EQ(fixed.built, 800u); // the clock hand meets in turn what is asked for in turn
    EXPECT_GT(fixed.rebuilt, 700u);

    size_t peak = 0;
    const cpu::TraceCounters grown = visit_tiles({10 * kTreeBytes, 1000 * kTreeBytes}, 40, 20, &peak);
    EXPECT_LT(grown.built, 200u);
    EXPECT_LE(peak, 81 * kTreeBytes);
    EXPECT_EQ(grown.built, 40 + grown.rebuilt);
}

TEST(PatchTreeCacheLimits, many_small_trees_find_slots_while_there_is_room) {
    RenderSettings settings;
    const auto prepared = prepare_fine_torus(settings);
    const auto count_rebuilt = [&](size_t patch_count) {
        constexpr size_t kBytes = size_t(1) << 20;
        cpu::PatchTreeCache cache({kBytes, kBytes, patch_count}, cpu::find_kernels(Isa::best)->build_tree);
        for (int round = 0; round < 2; ++round)
            for (uint32_t k = 0; k < 2000; ++k) { // as many as patches of a mesh that is much finer
                cpu::TraceContext& context = cache.acquire();
                const cpu::TreeKey key{k / 50, k % 50, 0, scalar::pack_uniform_level(0)};
                cache.find_or_build_tree(context, prepared->surfaces[0], key);
                cache.release(context);
            }
        return cache.sum_counters().rebuilt;
    };
    EXPECT_LT(count_rebuilt(2000), 100u);
    EXPECT_GT(count_rebuilt(0), 500u) << "a slot for 4096 bytes";
}

/// Neighbours in memory make way together.
TEST(PatchTreeCacheLimits, a_large_tree_finds_room_in_a_cache_full_of_small_ones) {
    RenderSettings settings;
    const auto prepared = prepare_fine_torus(settings);
    constexpr size_t kBytes = size_t(1) << 20;
    cpu::PatchTreeCache cache({kBytes, kBytes}, cpu::find_kernels(Isa::best)->build_tree);
    cpu::TraceContext& context = cache.acquire();
    const auto find = [&](uint32_t patch, uint32_t surface, uint32_t level) {
        cache.refresh(context);
        cache.find_or_build_tree(context, prepared->surfaces[0],
                                 {surface, patch, 0, scalar::pack_uniform_level(level)});
    };
    for (uint32_t k = 0; k < 20000; ++k) {
        find(k % 50, k / 50 % 100, 3 + k % 2);
        for (uint32_t look = 0; k % 100 == 99 && look < 6; ++look) find(k % 50, k / 50, cpu::kTileLevel);
    }
    const cpu::TraceCounters counters = cache.sum_counters();
    EXPECT_GT(counters.built_at_level[3], 9000u) << "small ones come and go";
    EXPECT_LT(counters.built_at_level[cpu::kTileLevel], 350u) << "of 1200 look-ups for 200 trees";
    cache.release(context);
}

/// A patch of the finest level has 16,384 quarters of tiles.
TEST(PatchTreeCacheLimits, a_ray_into_a_fine_patch_makes_its_way_alone) {
    RenderSettings settings;
    const auto prepared = prepare_fine_torus(settings, kMaxLevel);
    const cpu::Tracer tracer(prepared, settings);
    const std::vector<cpu::TraceRay> rays(1, {{0, 5, 1}, 0, {0, -1, 0}});
    std::vector<cpu::TraceHit> hits(1);
    Statistics before, after;
    tracer.add_statistics(before);
    tracer.closest_hits(rays, hits);
    tracer.add_statistics(after);
    EXPECT_TRUE(hits[0].is_hit());
    EXPECT_LT(after.bottom_cache_bytes - before.bottom_cache_bytes, 16 * kTreeBytes);
}

/// Look-ups go on to the next slot without a look at the tree of another key.
TEST(PatchTreeSlot, holds_a_tree_beside_bits_of_its_hash) {
    cpu::CachedTree tree;
    constexpr uint64_t kHash = 0x123456789abcdef0, kOther = kHash ^ uint64_t(1) << 63;
    const cpu::TreeSlot slot(&tree, kHash), zero(&tree, 0), empty;
    EXPECT_EQ(slot.tree(), &tree);
    EXPECT_EQ(empty.tree(), nullptr);
    EXPECT_TRUE(slot.may_hold(kHash));
    EXPECT_FALSE(slot.may_hold(kOther));
    EXPECT_TRUE(zero.may_hold(0));
    EXPECT_FALSE(empty.may_hold(0)) << "an empty slot is of no key";
}

TEST(PatchTreeCacheLimits, new_trees_alone_do_not_make_a_cache_grow) {
    size_t peak = 0;
    const cpu::TraceCounters once = visit_tiles({10 * kTreeBytes, 1000 * kTreeBytes}, 200, 1, &peak);
    EXPECT_EQ(once.built, 200u);
    EXPECT_EQ(once.rebuilt, 0u);
    EXPECT_LE(peak, 10 * kTreeBytes);
}

INSTANTIATE_TEST_SUITE_P(Caps, PatchTreeCache,
                         testing::Values(size_t(60000), size_t(250000), size_t(1000000)));

} // namespace

} // namespace relief

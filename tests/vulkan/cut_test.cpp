// However the work is cut, into rounds, chunks, waves or launches: no pair of ray and patch and no tree is
// lost, and the hits stay. The tracer itself counts what its kernels finish and throws when anything is
// missing; here the counts of differently cut casts are compared as well.
#include <iterator>

#include "cast_fixture.h"

namespace relief::vulkan::tests {
namespace {

/// What is cut small.
struct Cut {
    const char* name;
    BottomForm bottom = BottomForm::split;
    uint32_t rays_a_chunk = 1u << 14;
    size_t cache_bytes = size_t(64) << 20;
    uint32_t groups = 0, jobs_a_group = 0; ///< of the fused form
    uint32_t collected = 0;
};

const Cut kCuts[] = {
    {.name = "many chunks", .rays_a_chunk = 64},
    {.name = "many waves", .cache_bytes = 1},
    {.name = "no cache", .rays_a_chunk = 500, .cache_bytes = 0},
    {.name = "fused", .bottom = BottomForm::fused},
    {.name = "one fused group", .bottom = BottomForm::fused, .groups = 1, .jobs_a_group = 7},
    {.name = "fused, waves, chunks", .bottom = BottomForm::fused, .rays_a_chunk = 500, .cache_bytes = 1},
};

RenderSettings make_settings(int level, const Cut& cut) {
    RenderSettings settings;
    settings.surface.level = level;
    settings.image.height = 60;
    settings.experiment.bottom = cut.bottom;
    settings.surface.cache_bytes = cut.cache_bytes;
    return settings;
}

class CutTest : public GpuTest {
  protected:
    void prepare(int level) {
        level_ = level;
        scene_ = prepare_scene(make_scene(DisplacementSpace::object), make_settings(level, {}));
        expected_ = cast_on_cpu(scene_, make_settings(level, {}), rays_);
    }

    /// Casts, compares the hits, and tells what was counted.
    Statistics check(const Cut& cut, uint32_t slots) const {
        SCOPED_TRACE(cut.name);
        TracerConfig config;
        config.slots = slots;
        config.pair_capacity = cut.rays_a_chunk * config.slots;
        config.collected = cut.collected;
        config.fused_group_count = cut.groups;
        config.fused_jobs_per_group = cut.jobs_a_group;
        const CastAnswers found =
            cast_on_device(device(), *scene_, make_settings(level_, cut), rays_, config);
        expect_same(found, expected_, rays_);
        EXPECT_LE(found.statistics.pairs_with_hit, found.statistics.pairs_emitted);
        return found.statistics;
    }

    const std::vector<cpu::TraceRay> rays_ = make_rays(1200, 11);
    std::shared_ptr<const PreparedScene> scene_;
    CpuAnswers expected_;
    int level_ = 0;
};

TEST_F(CutTest, changes_neither_hits_nor_the_number_of_pairs) {
    prepare(4);
    const Statistics whole = check({.name = "whole"}, 4);
    EXPECT_GT(whole.pairs_emitted, rays_.size());
    EXPECT_GT(whole.bottom_built, 0u);
    for (const Cut& cut : kCuts) {
        const Statistics found = check(cut, 4);
        EXPECT_EQ(found.pairs_emitted, whole.pairs_emitted) << cut.name;
        EXPECT_GE(found.bottom_built, whole.bottom_built) << cut.name;
    }
}

TEST_F(CutTest, into_rounds_of_any_size_loses_no_pair) {
    prepare(3);
    for (const uint32_t slots : {1u, 2u, 8u}) {
        const Statistics whole = check({.name = "whole"}, slots), cut = check(kCuts[0], slots);
        EXPECT_EQ(cut.pairs_emitted, whole.pairs_emitted) << slots << " a round";
    }
}

/// Rays that offer one candidate a round and then all that they have left cast more pairs: those behind the
/// hit.
TEST_F(CutTest, a_round_that_collects_offers_all_that_is_left) {
    prepare(4);
    const Statistics sorted = check({.name = "sorted", .rays_a_chunk = 1u << 18}, 1);
    const Statistics collecting =
        check({.name = "collecting", .rays_a_chunk = 1u << 18, .collected = 127}, 1);
    EXPECT_GT(collecting.pairs_emitted, sorted.pairs_emitted);
}

// Tiles at one distance are offered in the order of their numbers, which follow the order that rays asked in.
// So their pairs are not counted here: which of two comes first may spare a ray the other.
TEST_F(CutTest, changes_no_hit_among_tiles) {
    prepare(6);
    for (const uint32_t slots : {1u, 2u, 4u, 8u}) check(kCuts[0], slots);
    check(kCuts[std::size(kCuts) - 1], 4);
}

} // namespace
} // namespace relief::vulkan::tests

// Every structure and traversal that can be chosen by name finds what the wide trees find, bit for bit.
#include <gtest/gtest.h>

#include "lab/walk_trees.h"
#include "support/casts.h"
#include "support/choices.h"

namespace relief {
namespace {

using test::Choice;

class Traversals : public testing::TestWithParam<Choice> {
  protected:
    static void expect_same_hits(const Scene& scene, RenderSettings settings) {
        const auto prepared = prepare_scene(scene, settings);
        const std::vector<cpu::TraceRay> rays = test::make_rays(1500, 5);
        const test::CpuAnswers expected = test::cast_on_cpu(prepared, settings, rays);
        settings.experiment.structure = GetParam().structure,
        settings.experiment.traversal = GetParam().traversal;
        const test::CpuAnswers found = test::cast_on_cpu(prepared, settings, rays);
        EXPECT_EQ(found.occluded, expected.occluded);
        size_t hit_count = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            const cpu::TraceHit &a = found.closest[k], &b = expected.closest[k];
            ASSERT_EQ(a.instance, b.instance) << "ray " << k;
            if (!b.is_hit()) continue;
            ++hit_count;
            ASSERT_EQ(a.t, b.t) << "ray " << k;
            ASSERT_EQ(a.patch, b.patch) << "ray " << k;
            ASSERT_TRUE(a.i == b.i && a.j == b.j && a.is_upper == b.is_upper) << "ray " << k;
            ASSERT_TRUE(a.u == b.u && a.v == b.v && a.levels == b.levels && a.lod_bias == b.lod_bias)
                << "ray " << k;
        }
        EXPECT_GT(hit_count, rays.size() / 3);
    }
};

TEST_P(Traversals, find_the_hits_of_the_wide_trees) {
    RenderSettings settings;
    settings.surface.level = 4;
    expect_same_hits(test::make_crowd(), settings);
}

TEST_P(Traversals, find_them_in_tiles_and_at_mixed_levels) {
    RenderSettings settings;
    settings.image.width = 2000, settings.image.height = 1000;
    settings.surface.pixel_error = 4;
    settings.surface.lod = LodRule::ray;
    expect_same_hits(test::make_scene(DisplacementSpace::object), settings);
}

TEST_P(Traversals, find_them_in_polygons) {
    Scene scene = test::make_crowd();
    for (Object& object : scene.objects) object.displacement = kNoIndex;
    expect_same_hits(scene, {});
}

/// Pairs of rays and patches: a box around each keeps most rays out, whatever leaf it is found in.
uint64_t count_pairs(const Choice& choice) {
    RenderSettings settings;
    settings.surface.level = 4;
    settings.experiment.structure = choice.structure, settings.experiment.traversal = choice.traversal;
    const auto prepared = prepare_scene(test::make_crowd(), settings);
    const std::vector<cpu::TraceRay> rays = test::make_rays(1500, 5);
    std::vector<cpu::TraceHit> hits(rays.size());
    const cpu::Tracer tracer(prepared, settings);
    tracer.closest_hits(rays, hits);
    Statistics statistics;
    tracer.add_statistics(statistics);
    return statistics.pairs_emitted;
}

TEST_P(Traversals, enter_few_more_patches_than_the_stack_does) {
    const uint64_t least = count_pairs({StructureKind::bvh, TraversalKind::stack});
    EXPECT_GT(least, 1500u);
    // Skip links do not go from front to back.
    const double most = GetParam().traversal == TraversalKind::skip_link ? 2 : 1.2;
    EXPECT_LT(double(count_pairs(GetParam())), most * double(least));
}

TEST_P(Traversals, find_hits_in_trees_that_are_deeper_than_words_are_long) {
    const Scene scene = test::make_deep_polygons(2000);
    RenderSettings settings;
    const auto prepared = prepare_scene(scene, settings);
    settings.experiment.structure = GetParam().structure,
    settings.experiment.traversal = GetParam().traversal;
    if (settings.experiment.structure == StructureKind::lbvh) {
        EXPECT_GT(make_walk_trees(*prepared, settings, EngineKind::cpu).depth, 35);
    }
    const std::vector<cpu::TraceRay> rays = test::make_rays_at_polygons(scene.meshes[0], 500);
    const test::CpuAnswers expected = test::cast_on_cpu(prepared, {}, rays);
    const test::CpuAnswers found = test::cast_on_cpu(prepared, settings, rays);
    EXPECT_EQ(found.occluded, expected.occluded);
    for (size_t k = 0; k < rays.size(); ++k) {
        ASSERT_TRUE(expected.closest[k].is_hit()) << "ray " << k;
        ASSERT_EQ(found.closest[k].patch, expected.closest[k].patch) << "ray " << k;
        ASSERT_EQ(found.closest[k].t, expected.closest[k].t) << "ray " << k;
    }
}

/// The choices whose trees are built by costs that the settings name.
class TraversalsWithCosts : public Traversals {
  public:
    static std::vector<Choice> list() {
        std::vector<Choice> choices = test::list_choices(EngineKind::cpu);
        std::erase_if(choices, [](const Choice& choice) {
            return choice.traversal == TraversalKind::wide || choice.structure == StructureKind::lbvh;
        });
        return choices;
    }
};

TEST_P(TraversalsWithCosts, find_them_in_trees_of_the_costs_asked_for) {
    Scene scene = test::make_crowd();
    for (Object& object : scene.objects) object.displacement = kNoIndex;
    RenderSettings settings;
    settings.experiment.sah_costs = SahCosts{};
    expect_same_hits(scene, settings);
    settings.experiment.structure = GetParam().structure,
    settings.experiment.traversal = GetParam().traversal;
    const auto prepared = prepare_scene(scene, settings);
    const size_t bytes = make_walk_trees(*prepared, settings, EngineKind::cpu).byte_count();
    settings.experiment.sah_costs = SahCosts{0.01f, 1.0f};
    EXPECT_LT(bytes, make_walk_trees(*prepared, settings, EngineKind::cpu).byte_count());
}

INSTANTIATE_TEST_SUITE_P(All, TraversalsWithCosts, testing::ValuesIn(TraversalsWithCosts::list()),
                         [](const auto& info) { return test::name_choice(info.param); });
INSTANTIATE_TEST_SUITE_P(All, Traversals, testing::ValuesIn(test::list_choices(EngineKind::cpu)),
                         [](const auto& info) { return test::name_choice(info.param); });

TEST(TraversalsOfAnEmptyScene, find_nothing) {
    for (const Choice& choice : test::list_choices(EngineKind::cpu)) {
        RenderSettings settings;
        settings.experiment.structure = choice.structure, settings.experiment.traversal = choice.traversal;
        const auto prepared = prepare_scene(Scene{}, settings);
        const test::CpuAnswers found = test::cast_on_cpu(prepared, settings, test::make_rays(20, 1));
        for (const cpu::TraceHit& hit : found.closest) EXPECT_FALSE(hit.is_hit());
        EXPECT_EQ(found.occluded, std::vector<uint8_t>(20, 0));
    }
}

} // namespace
} // namespace relief

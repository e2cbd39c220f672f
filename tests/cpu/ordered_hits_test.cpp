// Rays in the order of patches: the same hits, and no tree is built twice.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "cpu/cpu_engine.h"
#include "cpu/ordered_hits.h"
#include "cpu/tracer.h"
#include "support/bodies.h"

namespace relief::cpu {

namespace {

constexpr size_t kCap = size_t(5) << 20;
constexpr uint32_t kPatches = 54, kTiles = 4; ///< of the torus at level 7

std::vector<TraceRay> make_incoherent_rays(size_t count) {
    std::mt19937 random(23);
    std::normal_distribution<float> normal;
    const auto draw = [&] { return Vec3f{normal(random), normal(random), normal(random)}; };
    std::vector<TraceRay> rays(count);
    for (TraceRay& ray : rays) {
        ray.origin = normalize(draw()) * 3.0f;
        ray.direction = draw() * 0.4f - ray.origin;
    }
    rays[5].direction = {}, rays[7].t_max = 0.1f;
    return rays;
}

Scene make_torus_scene() {
    return test::make_body_scene(
        test::make_torus(6, 9),
        test::make_displacement(test::make_random_map(64, 64, 0.1f, 5), DisplacementSpace::tangent));
}

/// Beside the torus a part of it again, and a body without displacement that crosses it.
Scene make_mixed_scene() {
    Scene scene = make_torus_scene();
    Object again = scene.objects[0];
    again.world_from_object = compose(make_rotation_degrees({70, 0, 20}), make_scale({0.6f, 0.7f, 0.8f}));
    again.visibility_mask = 2;
    Object plain = scene.objects[0];
    plain.mesh = uint32_t(scene.meshes.size()), plain.displacement = kNoIndex;
    plain.world_from_object = make_scale({0.9f, 0.9f, 0.9f});
    scene.meshes.push_back(test::make_cube_sphere(4));
    scene.objects.push_back(again), scene.objects.push_back(plain);
    return scene;
}

std::shared_ptr<const PreparedScene> prepare(const Scene& scene, RenderSettings& settings) {
    settings.surface.level = 7;
    return prepare_scene(scene, settings);
}

bool are_equal(const TraceHit& a, const TraceHit& b) {
    return a.t == b.t && a.instance == b.instance && a.patch == b.patch && a.u == b.u && a.v == b.v &&
           a.i == b.i && a.j == b.j && a.is_upper == b.is_upper && a.levels == b.levels;
}

uint64_t count_built(const Tracer& tracer) {
    Statistics statistics;
    tracer.add_statistics(statistics);
    return statistics.bottom_built;
}

TEST(OrderedHits, are_those_of_single_rays_in_a_scene_of_all_kinds) {
    for (const uint32_t mask : {kVisibleToAll, 1u}) {
        RenderSettings settings;
        const auto scene = prepare(make_mixed_scene(), settings);
        const std::vector<TraceRay> rays = make_incoherent_rays(8000);
        std::vector<TraceHit> expected(rays.size()), found(rays.size());
        Tracer(scene, settings).closest_hits(rays, expected, 0, mask);
        settings.surface.cache_bytes = kCap;
        const Tracer tracer(scene, settings);
        with_threads(4, [&] { ASSERT_TRUE(tracer.ordered_hits(rays, found, OrderedQuery::closest, mask)); });
        size_t hits = 0, plain = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            ASSERT_TRUE(are_equal(found[k], expected[k])) << k << " mask " << mask;
            hits += found[k].is_hit(), plain += found[k].instance == 2;
        }
        EXPECT_GT(hits, 3000u);
        EXPECT_GT(plain, 300u);
    }
}

TEST(OrderedHits, build_no_tree_twice_where_single_rays_build_most_again) {
    RenderSettings settings;
    const auto scene = prepare(make_torus_scene(), settings);
    settings.surface.cache_bytes = kCap;
    const std::vector<TraceRay> rays = make_incoherent_rays(8000);
    std::vector<TraceHit> hits(rays.size());
    const Tracer single(scene, settings), ordered(scene, settings);
    single.closest_hits(rays, hits);
    EXPECT_GT(count_built(single), 4 * kPatches * kTiles);
    with_threads(
        4, [&] { ASSERT_TRUE(ordered.ordered_hits(rays, hits, OrderedQuery::closest, kVisibleToAll)); });
    EXPECT_LE(count_built(ordered), kPatches * kTiles);
    EXPECT_GT(count_built(ordered), kPatches * kTiles / 2);
}

TEST(OrderedHits, say_which_rays_are_occluded) {
    for (const uint32_t mask : {kVisibleToAll, 1u}) {
        RenderSettings settings;
        const auto scene = prepare(make_mixed_scene(), settings);
        std::vector<TraceRay> rays = make_incoherent_rays(8000);
        for (size_t k = 0; k < rays.size(); k += 3) rays[k].t_max = 0.7f;
        std::vector<uint8_t> expected(rays.size());
        std::vector<TraceHit> found(rays.size());
        Tracer(scene, settings).any_hits(rays, expected, 0, mask);
        settings.surface.cache_bytes = kCap;
        const Tracer tracer(scene, settings);
        with_threads(4, [&] { ASSERT_TRUE(tracer.ordered_hits(rays, found, OrderedQuery::any, mask)); });
        size_t occluded = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            ASSERT_EQ(found[k].is_hit(), expected[k] != 0) << k << " mask " << mask;
            occluded += expected[k];
        }
        EXPECT_GT(occluded, 2500u);
        EXPECT_LT(occluded, 7500u);
    }
}

/// Of an Intersector with a small cache, and how many trees it built for rays of both kinds.
uint64_t count_built_for_occlusion(const Scene& scene, size_t rays) {
    RenderSettings settings;
    const auto prepared = prepare(scene, settings);
    settings.surface.cache_bytes = kCap;
    const std::unique_ptr<Engine> engine = make_cpu_engine(prepared, settings);
    std::vector<Ray> batch;
    for (const TraceRay& ray : make_incoherent_rays(rays))
        batch.push_back({ray.origin, ray.t_min, ray.direction, ray.t_max});
    std::vector<uint8_t> hits(rays);
    with_threads(4, [&] { engine->any_hits(batch, hits, kVisibleToAll); });
    Statistics statistics;
    engine->add_statistics(statistics);
    return statistics.bottom_built;
}

TEST(OrderedHits, build_no_tree_twice_for_rays_that_ask_for_any) {
    EXPECT_GT(count_built_for_occlusion(make_torus_scene(), 3000), 2 * kPatches * kTiles); // too few to order
    const uint64_t built = count_built_for_occlusion(make_torus_scene(), 8000);
    EXPECT_LE(built, kPatches * kTiles);
    EXPECT_GT(built, kPatches * kTiles / 2);
}

TEST(OrderedHits, are_not_made_where_all_trees_fit_or_rays_are_few) {
    RenderSettings settings;
    const auto scene = prepare(make_torus_scene(), settings);
    const std::vector<TraceRay> rays = make_incoherent_rays(8000);
    std::vector<TraceHit> hits(rays.size());
    EXPECT_FALSE(Tracer(scene, settings).ordered_hits(rays, hits, OrderedQuery::closest, kVisibleToAll));
    settings.surface.cache_bytes = kCap;
    const Tracer small(scene, settings);
    EXPECT_FALSE(small.ordered_hits(std::span(rays).first(100), std::span(hits).first(100),
                                    OrderedQuery::closest, kVisibleToAll));
    // All of one patch or two.
    std::vector<TraceRay> narrow(8000, rays[0]);
    narrow[0].direction = narrow[0].origin * -1.0f;
    std::ranges::fill(narrow, narrow[0]);
    EXPECT_FALSE(small.ordered_hits(narrow, hits, OrderedQuery::closest, kVisibleToAll));
}

} // namespace

} // namespace relief::cpu

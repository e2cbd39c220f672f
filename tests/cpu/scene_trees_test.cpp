// Scene trees made twice: boxes of vertices are the smallest that hold them, and no hit changes with them.
#include "cpu/scene_trees.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "support/casts.h"
#include "support/isas.h"

namespace relief::cpu {

namespace {

uint32_t find_highest_level(const PreparedScene& scene, uint32_t surface, uint32_t patch) {
    uint32_t level = 0;
    for (const Instance& instance : scene.instances)
        if (instance.surface == surface) level = std::max<uint32_t>(level, instance.levels->at(patch).patch);
    return level;
}

Box find_vertex_box(const Surface& surface, uint32_t patch, const PatchLevels& levels) {
    const uint32_t side = 1u << levels.patch;
    Box box;
    for (uint32_t j = 0; j <= side; ++j)
        for (uint32_t i = 0; i <= side; ++i) box.extend(evaluate_vertex(surface, patch, levels, i, j));
    return box;
}

PatchLevels make_uniform_levels(uint32_t level) {
    const auto l = uint8_t(level);
    return {l, {l, l, l, l}};
}

void expect_equal(const Box& a, const Box& b, uint32_t patch) {
    EXPECT_EQ(a.lower, b.lower) << "patch " << patch;
    EXPECT_EQ(a.upper, b.upper) << "patch " << patch;
}

/// By the kernels of every instruction set: the boxes of a surface hold what its instances show of it, and no
/// more than its vertices.
void expect_smallest_boxes(const PreparedScene& scene, uint32_t surface_index) {
    const Surface& surface = scene.surfaces[surface_index];
    std::vector<Box> expected;
    for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
        const uint32_t highest = find_highest_level(scene, surface_index, patch);
        const Box box = find_vertex_box(surface, patch, make_uniform_levels(highest));
        expected.push_back(box);
        for (const Instance& instance : scene.instances)
            for (uint32_t bias = 0; bias <= highest && instance.surface == surface_index; ++bias)
                EXPECT_TRUE(
                    box.contains(find_vertex_box(surface, patch, instance.levels->at(patch).biased(bias))))
                    << "patch " << patch << ", bias " << bias;
    }
    for (const Isa isa : test::machine_isas()) {
        const PatchBoxes boxes(scene, *find_kernels(isa), BoxSource::vertices);
        const std::vector<Box> found = boxes.find_all(surface_index);
        ASSERT_EQ(found.size(), expected.size());
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            expect_equal(found[patch], expected[patch], patch);
            expect_equal(boxes.find(surface_index, patch), expected[patch], patch);
        }
    }
}

/// One displaced body twice, of which the first or the second is much nearer to the camera.
std::shared_ptr<const PreparedScene> prepare_near_and_far(DisplacementSpace space, bool is_first_near,
                                                          SubdivisionScheme scheme) {
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(2), test::make_displacement(test::make_random_map(96, 64, 0.15f, 3), space));
    scene.meshes[0].subdivision.scheme = scheme, scene.meshes[0].subdivision.level = 1;
    scene.objects.push_back(scene.objects[0]);
    scene.objects[is_first_near ? 1 : 0].world_from_object = make_translation({-12, 0, 0});
    scene.camera.from = {2.5f, 0.4f, 0.6f}, scene.camera.to = {0, 0, 0};
    RenderSettings settings;
    settings.image.height = 40;
    return prepare_scene(std::move(scene), settings);
}

std::shared_ptr<const PreparedScene> prepare_with_level(int level) {
    RenderSettings settings;
    settings.surface.level = level;
    return prepare_scene(test::make_scene(DisplacementSpace::tangent), settings);
}

TEST(PatchBoxes, hold_all_instances_at_any_bias_and_touch_their_vertices) {
    for (const DisplacementSpace space : {DisplacementSpace::tangent, DisplacementSpace::object})
        for (const bool is_first_near : {true, false})
            for (const SubdivisionScheme scheme : {SubdivisionScheme::none, SubdivisionScheme::catmark}) {
                const auto scene = prepare_near_and_far(space, is_first_near, scheme);
                ASSERT_EQ(scene->surfaces.size(), 1u);
                const int first = scene->instances[0].levels->max_level();
                const int second = scene->instances[1].levels->max_level();
                ASSERT_TRUE(is_first_near ? first > second : second > first);
                expect_smallest_boxes(*scene, 0);
            }
}

TEST(PatchBoxes, touch_the_vertices_of_every_level_that_is_evaluated_as_a_whole) {
    for (int level = 0; level <= kTileLevel; ++level) {
        const auto scene = prepare_with_level(level);
        expect_smallest_boxes(*scene, 0);
        const uint64_t side = (1u << level) + 1;
        EXPECT_EQ(PatchBoxes(*scene, *find_kernels(Isa::best), BoxSource::vertices).count_vertices(),
                  scene->surfaces[0].patch_count() * side * side);
    }
}

TEST(PatchBoxes, are_those_of_the_map_where_patches_are_finer) {
    const auto scene = prepare_with_level(kTileLevel + 1);
    const PatchBoxes boxes(*scene, *find_kernels(Isa::best), BoxSource::vertices);
    EXPECT_EQ(boxes.count_vertices(), 0u);
    for (uint32_t patch = 0; patch < scene->surfaces[0].patch_count(); ++patch)
        expect_equal(boxes.find(0, patch), compute_patch_box(scene->surfaces[0], patch), patch);
}

TEST(SceneTreeHolder, makes_smaller_trees_once_rays_enough_have_come) {
    const auto scene = prepare_with_level(3);
    const Kernels& kernels = *find_kernels(Isa::best);
    std::vector<PolygonTree> polygon_trees;
    for (const Surface& surface : scene->surfaces)
        polygon_trees.push_back(surface.has_displacement ? PolygonTree{} : build_polygon_tree(surface));
    SceneTreeHolder holder(*scene, kernels, polygon_trees);
    const std::shared_ptr<const SceneTrees> first = holder.current();
    EXPECT_EQ(first->source, BoxSource::bounds);
    holder.count_rays(1);
    holder.rebuild_if_worthwhile();
    EXPECT_EQ(holder.current(), first);
    holder.count_rays(1000000);
    EXPECT_EQ(holder.current(), first) << "not while rays are traced";
    holder.rebuild_if_worthwhile();
    const std::shared_ptr<const SceneTrees> second = holder.current();
    EXPECT_EQ(second->source, BoxSource::vertices);
    EXPECT_FALSE(first->surfaces[0].nodes.empty()) << "still walked by others";
    const Box &wide = first->surfaces[0].bounds, &narrow = second->surfaces[0].bounds;
    EXPECT_TRUE(wide.contains(narrow));
    EXPECT_FALSE(narrow.contains(wide));
    EXPECT_TRUE(first->instances.bounds.contains(second->instances.bounds));
    holder.count_rays(1000000);
    holder.rebuild_if_worthwhile();
    EXPECT_EQ(holder.current(), second);
}

void expect_same_hits(const std::vector<TraceHit>& a, const std::vector<TraceHit>& b) {
    for (size_t k = 0; k < a.size(); ++k) {
        ASSERT_EQ(a[k].t, b[k].t) << k;
        ASSERT_EQ(a[k].instance, b[k].instance) << k;
        ASSERT_EQ(a[k].patch, b[k].patch) << k;
        ASSERT_EQ(std::pair(a[k].u, a[k].v), std::pair(b[k].u, b[k].v)) << k;
        ASSERT_EQ(std::pair(a[k].i, a[k].j), std::pair(b[k].i, b[k].j)) << k;
        ASSERT_EQ(std::pair(a[k].is_upper, a[k].levels), std::pair(b[k].is_upper, b[k].levels)) << k;
    }
}

uint64_t count_pairs(const Tracer& tracer) {
    Statistics statistics;
    tracer.add_statistics(statistics);
    return statistics.pairs_emitted;
}

TEST(SceneTreeHolder, hits_are_the_same_after_the_change) {
    RenderSettings settings;
    settings.surface.level = 3;
    const auto scene = prepare_with_level(settings.surface.level);
    const size_t enough =
        4 * PatchBoxes(*scene, *find_kernels(Isa::best), BoxSource::vertices).count_vertices();
    const std::vector<TraceRay> rays = test::make_rays(1600, 29);
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const Tracer tracer(scene, settings);
        std::vector<TraceHit> before(rays.size()), after(rays.size());
        std::vector<uint8_t> occluded_before(rays.size()), occluded_after(rays.size());
        tracer.closest_hits(rays, before);
        const uint64_t pairs_before = count_pairs(tracer);
        tracer.any_hits(rays, occluded_before);
        for (size_t traced = 0; traced < enough; traced += rays.size()) tracer.closest_hits(rays, after);
        tracer.rebuild_if_worthwhile();
        const uint64_t pairs_between = count_pairs(tracer);
        tracer.closest_hits(rays, after);
        EXPECT_LT(count_pairs(tracer) - pairs_between, pairs_before) << "the trees are those of the start";
        tracer.any_hits(rays, occluded_after);
        expect_same_hits(before, after);
        EXPECT_EQ(occluded_before, occluded_after);
        EXPECT_GT(
            std::count_if(before.begin(), before.end(), [](const TraceHit& hit) { return hit.is_hit(); }),
            400);
    }
}

} // namespace

} // namespace relief::cpu

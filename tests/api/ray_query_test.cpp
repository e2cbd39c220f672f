// Hit attributes and visibility masks of an Intersector.
#include <algorithm>

#include <gtest/gtest.h>

#include "relief/error.h"
#include "support/choices.h"
#include "support/ray_queries.h"

namespace relief {
namespace {

constexpr RayQuery kEverything{.attributes = kShadingNormal | kTextureUv | kDerivatives};

/// Rays that lie close enough for several to meet one micro-triangle.
std::vector<Ray> make_dense_rays() {
    std::vector<Ray> rays;
    for (int k = 0; k < 10000; ++k)
        rays.push_back({{float(k % 100) * 0.012f - 0.6f, float(k / 100) * 0.012f - 0.6f, 4}, 0, {0, 0, -1}});
    return rays;
}

void expect_attributes(const Scene& scene, int level) {
    IntersectorSettings settings;
    settings.surface.level = level;
    const Intersector intersector(scene, settings);
    const std::vector<Ray> rays = make_dense_rays();
    std::vector<RayHit> hits(rays.size());
    std::vector<HitAttributes> attributes(rays.size());
    intersector.closest_hits(rays, hits, kEverything, attributes);
    size_t pairs = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
        if (hits[k].object == kNoIndex) continue;
        const HitAttributes& at = attributes[k];
        ASSERT_NEAR(length(at.shading_normal), 1, 1e-4f) << k;
        ASSERT_GE(dot(at.shading_normal, hits[k].normal), 0) << k;
        ASSERT_GT(at.texture_uv.x + at.texture_uv.y, 0) << k;
        const bool has_next = k > 0 && hits[k - 1].object == hits[k].object &&
                              hits[k - 1].patch == hits[k].patch && attributes[k - 1].dp_du == at.dp_du &&
                              attributes[k - 1].dp_dv == at.dp_dv && hits[k - 1].normal == hits[k].normal;
        if (!has_next) continue;
        // On one micro-triangle: the derivatives lead from one hit to the other.
        ++pairs;
        const auto place = [&](size_t i) { return rays[i].origin + rays[i].direction * hits[i].t; };
        const Vec2f step{hits[k].uv.x - hits[k - 1].uv.x, hits[k].uv.y - hits[k - 1].uv.y};
        const Vec3f expected = at.dp_du * step.x + at.dp_dv * step.y;
        ASSERT_LT(length(place(k) - place(k - 1) - expected), 1e-5f) << k;
    }
    EXPECT_GT(pairs, 500u);
}

TEST(RayQuery, gives_attributes_of_displaced_surfaces) {
    expect_attributes(test::make_scene(DisplacementSpace::tangent), 4);
}

TEST(RayQuery, gives_attributes_of_polygons) {
    Scene scene = test::make_scene(DisplacementSpace::tangent);
    for (Object& object : scene.objects) object.displacement = kNoIndex;
    expect_attributes(scene, 0);
}

TEST(RayQuery, leaves_out_what_is_not_named) {
    const Intersector intersector(test::make_scene(DisplacementSpace::tangent), {});
    const std::vector<Ray> rays = make_dense_rays();
    std::vector<RayHit> plain(rays.size()), hits(rays.size());
    std::vector<HitAttributes> attributes(rays.size());
    intersector.closest_hits(rays, plain);
    intersector.closest_hits(rays, hits, {.attributes = kShadingNormal}, attributes);
    for (size_t k = 0; k < rays.size(); ++k) {
        ASSERT_EQ(hits[k].t, plain[k].t);
        ASSERT_EQ(hits[k].normal, plain[k].normal);
        ASSERT_EQ(attributes[k].dp_du, Vec3f{});
        ASSERT_EQ(attributes[k].texture_uv, Vec2f{});
        if (plain[k].object == kNoIndex) ASSERT_EQ(attributes[k].shading_normal, Vec3f{});
    }
    EXPECT_THROW(intersector.closest_hits(rays, hits, {.attributes = kTextureUv}), Error);
    EXPECT_THROW(intersector.closest_hits(rays, hits, {}, attributes), Error);
}

TEST(RayQuery, of_one_ray_finds_what_spans_find) {
    const Intersector intersector(test::make_masked_crowd(), {});
    const std::vector<Ray> rays = test::make_query_rays(64);
    std::vector<RayHit> hits(rays.size());
    std::vector<uint8_t> any(rays.size());
    intersector.closest_hits(rays, hits, {.visibility_mask = 2});
    intersector.any_hits(rays, any, 2);
    for (size_t k = 0; k < rays.size(); ++k) {
        const RayHit hit = intersector.closest_hit(rays[k], 2);
        ASSERT_EQ(hit.t, hits[k].t) << k;
        ASSERT_EQ(hit.object, hits[k].object) << k;
        ASSERT_EQ(hit.normal, hits[k].normal) << k;
        ASSERT_EQ(intersector.any_hit(rays[k], 2), any[k] != 0) << k;
    }
}

TEST(VisibilityMask, hides_objects_from_rays_that_travel_alone_and_together) {
    for (const uint32_t mask : {1u, 2u, 6u, 0x80000000u | 4u}) test::expect_masked_hits({}, mask);
}

TEST(VisibilityMask, hides_objects_from_every_traversal) {
    for (const test::Choice& choice : test::list_choices(EngineKind::cpu)) {
        SCOPED_TRACE(test::name_choice(choice));
        IntersectorSettings settings;
        settings.experiment.structure = choice.structure, settings.experiment.traversal = choice.traversal;
        test::expect_masked_hits(settings, 2);
    }
}

TEST(VisibilityMask, hides_an_only_object) {
    Scene scene = test::make_scene(DisplacementSpace::tangent);
    scene.objects.resize(1);
    scene.objects[0].visibility_mask = 4;
    for (const TraversalKind traversal : {TraversalKind::automatic, TraversalKind::stack}) {
        IntersectorSettings settings;
        settings.experiment.traversal = traversal;
        const Intersector intersector(scene, settings);
        const Ray ray{{0, 0, 4}, 0, {0, 0, -1}};
        EXPECT_TRUE(intersector.any_hit(ray, 12));
        EXPECT_EQ(intersector.closest_hit(ray, 12).object, 0u);
        EXPECT_FALSE(intersector.any_hit(ray, 3));
        EXPECT_EQ(intersector.closest_hit(ray, 3).object, kNoIndex);
    }
}

TEST(VisibilityMask, of_zero_is_refused) {
    Scene scene = test::make_scene(DisplacementSpace::tangent);
    scene.objects[2].visibility_mask = 0, scene.objects[2].name = "ghost";
    try {
        const Intersector intersector(std::move(scene), {});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::bad_input);
        EXPECT_EQ(error.where(), "ghost");
    }
}

TEST(Intersector, tells_what_its_scene_is_warned_of) {
    Scene scene = test::make_scene(DisplacementSpace::tangent);
    scene.warnings = {"a reader's"};
    scene.lights.clear(), scene.environment.reset();
    const Intersector intersector(std::move(scene), {});
    ASSERT_EQ(intersector.warnings().size(), 2u);
    EXPECT_EQ(intersector.warnings()[0], "a reader's");
    EXPECT_NE(intersector.warnings()[1].find("nothing in the scene gives light"), std::string::npos);
}

} // namespace
} // namespace relief

// Bounce rays in two parts: every hit is the one that the parts have alone, and no coarse surface is met from
// within.
#include "cpu/bounce_rays.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "relief/render.h"
#include "support/bodies.h"

namespace relief::cpu {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A rough torus: M_0 and M_3 lie apart by a good part of its thickness.
std::shared_ptr<const PreparedScene> prepare_rough_torus(RenderSettings& settings) {
    settings.surface.level = 5;
    const Displacement displacement =
        test::make_displacement(test::make_random_map(64, 64, 0.15f, 5), DisplacementSpace::tangent);
    return prepare_scene(test::make_body_scene(test::make_torus(6, 9), displacement), settings);
}

struct Bounces {
    std::vector<TraceRay> rays;
    std::vector<float> coarse_from;
};

/// From outside of the body into it; most change surfaces close to it.
Bounces make_bounces(const Tracer& tracer, size_t count) {
    std::mt19937 random(11);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> unit(0, 1);
    const auto draw = [&] { return Vec3f{normal(random), normal(random), normal(random)}; };
    Bounces bounces;
    for (size_t k = 0; k < count; ++k) {
        TraceRay ray;
        ray.origin = normalize(draw()) * 4.0f;
        ray.direction = normalize(draw() * 0.5f - ray.origin);
        bounces.rays.push_back(ray);
    }
    std::vector<TraceHit> hits(count);
    tracer.closest_hits(bounces.rays, hits);
    for (size_t k = 0; k < count; ++k) {
        const float t = hits[k].is_hit() ? hits[k].t : 4.0f;
        bounces.coarse_from.push_back(k % 16 == 0 ? kInfinity : t + 0.2f * (unit(random) - 0.7f));
    }
    return bounces;
}

TraceHit trace_part(const Tracer& tracer, TraceRay ray, float from, float to, uint32_t lod_bias) {
    ray.t_min = from, ray.t_max = to, ray.lod_bias = lod_bias;
    TraceHit hit;
    tracer.closest_hits({&ray, 1}, {&hit, 1});
    return hit;
}

bool is_met_from_within(const Tracer& tracer, const TraceHit& hit, const TraceRay& ray) {
    return dot(tracer.make_surface_point(hit).geometric_normal, ray.direction) > 0;
}

TEST(BounceRays, see_the_near_surface_then_the_coarse_one_but_not_from_within) {
    RenderSettings settings;
    const auto scene = prepare_rough_torus(settings);
    const Tracer tracer(scene, settings);
    constexpr size_t kCount = 4000;
    const Bounces bounces = make_bounces(tracer, kCount);
    std::vector<TraceRay> rays = bounces.rays;
    std::vector<TraceHit> hits(kCount);
    BounceScratch scratch;
    PointScratch points;
    closest_bounce_hits(tracer, rays, bounces.coarse_from, hits, 1, scratch, points);
    size_t near = 0, far = 0, returned = 0;
    for (size_t k = 0; k < kCount; ++k) {
        const TraceRay& ray = bounces.rays[k];
        const float end = bounces.coarse_from[k];
        TraceHit expected = trace_part(tracer, ray, 0, end, 0);
        if (!expected.is_hit() && end < kInfinity) {
            expected = trace_part(tracer, ray, end, kInfinity, scalar::kBounceBias);
            const bool is_inner = expected.is_hit() && is_met_from_within(tracer, expected, ray);
            if (is_inner) expected = trace_part(tracer, ray, end, kInfinity, 0);
            ++(is_inner ? returned : far);
        } else {
            ++near;
        }
        ASSERT_EQ(hits[k].t, expected.t) << k;
        ASSERT_EQ(hits[k].patch, expected.patch) << k;
        if (!hits[k].is_hit()) continue;
        ASSERT_EQ(hits[k].lod_bias, expected.lod_bias) << k;
        ASSERT_EQ(rays[k].lod_bias, expected.lod_bias) << k;
        // Folds of the fine surface may be turned over.
        if (hits[k].lod_bias != 0) ASSERT_FALSE(is_met_from_within(tracer, hits[k], ray)) << k;
    }
    EXPECT_GT(near, 500u);
    EXPECT_GT(far, 500u);
    EXPECT_GT(returned, 20u);
}

TEST(BounceRays, see_a_coarser_surface_where_their_cone_is_as_wide_as_its_cells) {
    const scalar::BounceLod lod{{0, 0, 0}, 0.001f};
    const float wide = scalar::find_coarse_distance(lod, {0, 0, 2}, 0, 0.25f);
    EXPECT_FLOAT_EQ(wide * scalar::kBounceCone / std::sqrt(0.25f), 8 * 0.002f);
    EXPECT_FLOAT_EQ(scalar::find_coarse_distance(lod, {0, 0, 4}, 0, 0.25f), 2 * wide);
    EXPECT_FLOAT_EQ(scalar::find_coarse_distance(lod, {0, 0, 2}, 0, 25), 10 * wide);
    EXPECT_EQ(scalar::find_coarse_distance(lod, {0, 0, 2}, 0, kInfinity), kInfinity); // a mirror
    EXPECT_EQ(scalar::find_coarse_distance(lod, {0, 0, 2}, scalar::kBounceBias, 1), kInfinity);
    EXPECT_EQ(scalar::find_coarse_distance({}, {0, 0, 2}, 0, 1), kInfinity);
}

} // namespace

} // namespace relief::cpu

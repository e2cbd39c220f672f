// Direct tracing against brute force over the same micro-triangles, for every instruction set, leaf and
// level.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>

#include "cpu/tracer.h"
#include "math/affine.h"
#include "support/bodies.h"
#include "support/isas.h"

namespace relief {

namespace {

struct Triangle {
    Vec3f a, b, c;
};

/// Every micro-triangle of an instance at bias k, in world space.
std::vector<Triangle> list_triangles(const PreparedScene& scene, uint32_t bias) {
    std::vector<Triangle> triangles;
    for (const Instance& instance : scene.instances) {
        const Surface& surface = scene.surfaces[instance.surface];
        for (uint32_t patch = 0; patch < surface.patch_count(); ++patch) {
            const PatchLevels levels = instance.levels->at(patch).biased(bias);
            const uint32_t side = 1u << levels.patch;
            const auto vertex = [&](uint32_t i, uint32_t j) {
                return transform_point(instance.world_from_object,
                                       evaluate_vertex(surface, patch, levels, i, j));
            };
            for (uint32_t j = 0; j < side; ++j)
                for (uint32_t i = 0; i < side; ++i) {
                    const Vec3f p00 = vertex(i, j), p10 = vertex(i + 1, j), p11 = vertex(i + 1, j + 1),
                                p01 = vertex(i, j + 1);
                    triangles.push_back({p00, p10, p11});
                    triangles.push_back({p00, p11, p01});
                }
        }
    }
    return triangles;
}

/// Nearest t by Moeller and Trumbore in double precision; `margin` is how far the closest edge is, in
/// barycentrics.
double intersect_all(const std::vector<Triangle>& triangles, const cpu::TraceRay& ray, double& margin) {
    double best = INFINITY;
    margin = 1;
    const double o[3] = {ray.origin.x, ray.origin.y, ray.origin.z},
                 d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    for (const Triangle& triangle : triangles) {
        const double a[3] = {triangle.a.x, triangle.a.y, triangle.a.z};
        const double e1[3] = {triangle.b.x - a[0], triangle.b.y - a[1], triangle.b.z - a[2]};
        const double e2[3] = {triangle.c.x - a[0], triangle.c.y - a[1], triangle.c.z - a[2]};
        const double p[3] = {d[1] * e2[2] - d[2] * e2[1], d[2] * e2[0] - d[0] * e2[2],
                             d[0] * e2[1] - d[1] * e2[0]};
        const double det = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
        if (det == 0) continue;
        const double s[3] = {o[0] - a[0], o[1] - a[1], o[2] - a[2]};
        const double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det;
        const double q[3] = {s[1] * e1[2] - s[2] * e1[1], s[2] * e1[0] - s[0] * e1[2],
                             s[0] * e1[1] - s[1] * e1[0]};
        const double v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / det;
        const double t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
        const double inside = std::min({u, v, 1 - u - v});
        if (t > ray.t_min && t < best * (1 + 1e-4)) margin = std::min(margin, std::fabs(inside));
        if (inside >= 0 && t > ray.t_min && t < ray.t_max) best = std::min(best, t);
    }
    return best;
}

std::vector<cpu::TraceRay> make_rays(uint32_t count, uint32_t bias, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<cpu::TraceRay> rays;
    for (uint32_t k = 0; k < count; ++k) {
        cpu::TraceRay ray;
        // Every second run of sixteen starts at one point and is a narrow bundle, so that packets are met
        // too.
        if (k / 16 % 2 == 0 || k % 16 == 0) {
            const Vec3f from = normalize(Vec3f{normal(random), normal(random), normal(random)}) * 4.0f;
            const Vec3f to{normal(random) * 0.5f, normal(random) * 0.5f, normal(random) * 0.5f};
            ray.origin = from;
            ray.direction = to - from;
        } else {
            ray = rays[k / 16 * 16];
            ray.direction += Vec3f{normal(random), normal(random), normal(random)} * 0.2f;
        }
        ray.lod_bias = bias;
        rays.push_back(ray);
    }
    return rays;
}

struct TracerCase {
    const char* name;
    DisplacementSpace space;
    int level;
    uint32_t bias;
    SubdivisionScheme scheme = SubdivisionScheme::none;
    MapFilter filter = MapFilter::none;
};

void PrintTo(const TracerCase& c, std::ostream* stream) { *stream << c.name; }

class TracerTest : public testing::TestWithParam<TracerCase> {};

TEST_P(TracerTest, gives_the_hits_of_brute_force_on_every_instruction_set) {
    const TracerCase& c = GetParam();
    RenderSettings settings;
    settings.surface.level = c.level;
    settings.image.height = 60;
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(2), test::make_displacement(test::make_random_map(64, 48, 0.15f, 3), c.space));
    scene.meshes[0].subdivision.scheme = c.scheme;
    scene.meshes[0].subdivision.level = 1;
    scene.displacements[0].filter = c.filter;
    scene.camera.from = {2.5f, 0.4f, 0.6f};
    scene.camera.to = {0, 0, 0};
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
    const std::vector<Triangle> triangles = list_triangles(*prepared, c.bias);
    const std::vector<cpu::TraceRay> rays = make_rays(c.level >= 5 ? 160 : 480, c.bias, 7);
    std::vector<double> expected(rays.size()), margin(rays.size(), 0);
    for (size_t k = 0; k < rays.size(); ++k) expected[k] = intersect_all(triangles, rays[k], margin[k]);
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const cpu::Tracer tracer(prepared, settings);
        std::vector<cpu::TraceHit> hits(rays.size());
        std::vector<uint8_t> occluded(rays.size());
        tracer.closest_hits(rays, hits);
        tracer.any_hits(rays, occluded);
        int hit_count = 0;
        for (size_t k = 0; k < rays.size(); ++k) {
            EXPECT_EQ(occluded[k], uint8_t(hits[k].is_hit())) << k;
            if (margin[k] < 1e-4) continue;
            ASSERT_EQ(hits[k].is_hit(), std::isfinite(expected[k])) << "ray " << k << " isa " << int(isa);
            if (!hits[k].is_hit()) continue;
            ++hit_count;
            EXPECT_NEAR(hits[k].t, expected[k], 1e-5 * expected[k]) << k;
            const Vec3f p = rays[k].origin + rays[k].direction * hits[k].t;
            const cpu::SurfacePoint point = tracer.make_surface_point(hits[k]);
            EXPECT_LT(std::fabs(dot(point.position - p, point.geometric_normal)), 2e-5f * 4) << k;
            EXPECT_LT(length(point.position - p), 0.01f) << k; // within its triangle: leave_edges
        }
        EXPECT_GT(hit_count, 40);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Levels, TracerTest,
    testing::Values(TracerCase{"object0", DisplacementSpace::object, 0, 0},
                    TracerCase{"object1", DisplacementSpace::object, 1, 0},
                    TracerCase{"object2", DisplacementSpace::object, 2, 0},
                    TracerCase{"tangent3", DisplacementSpace::tangent, 3, 0},
                    TracerCase{"object4", DisplacementSpace::object, 4, 0},
                    TracerCase{"tangent5", DisplacementSpace::tangent, 5, 0},
                    TracerCase{"object6", DisplacementSpace::object, 6, 0},
                    TracerCase{"object7", DisplacementSpace::object, 7, 0},
                    TracerCase{"tangent8", DisplacementSpace::tangent, 8, 0},
                    TracerCase{"tangent7_bias2", DisplacementSpace::tangent, 7, 2},
                    TracerCase{"tangent_auto", DisplacementSpace::tangent, kAutoLevel, 0},
                    TracerCase{"object_auto_bias1", DisplacementSpace::object, kAutoLevel, 1},
                    TracerCase{"smooth_tangent2", DisplacementSpace::tangent, 2, 0,
                               SubdivisionScheme::catmark},
                    TracerCase{"smooth_object_auto_bias1", DisplacementSpace::object, kAutoLevel, 1,
                               SubdivisionScheme::catmark},
                    TracerCase{"cubic_tangent5", DisplacementSpace::tangent, 5, 0, SubdivisionScheme::none,
                               MapFilter::cubic},
                    TracerCase{"bspline_object7_bias2", DisplacementSpace::object, 7, 2,
                               SubdivisionScheme::catmark, MapFilter::bspline}),
    [](const testing::TestParamInfo<TracerCase>& info) { return std::string(info.param.name); });

std::shared_ptr<const PreparedScene> prepare_torus(const RenderSettings& settings) {
    return prepare_scene(test::make_body_scene(test::make_torus(6, 9),
                                               test::make_displacement(test::make_random_map(64, 64, 0.1f, 5),
                                                                       DisplacementSpace::tangent)),
                         settings);
}

TEST(Tracer, gives_the_same_bits_without_a_cache_and_with_a_tiny_one) {
    RenderSettings settings;
    settings.surface.level = 7;
    const auto prepared = prepare_torus(settings);
    const std::vector<cpu::TraceRay> rays = make_rays(800, 0, 11);
    std::vector<std::vector<cpu::TraceHit>> results;
    for (const size_t cap : {size_t(256) << 20, size_t(0), size_t(200000)}) {
        settings.surface.cache_bytes = cap;
        const cpu::Tracer tracer(prepared, settings);
        results.emplace_back(rays.size());
        tracer.closest_hits(rays, results.back());
        Statistics statistics;
        tracer.add_statistics(statistics);
        EXPECT_LE(statistics.bottom_cache_bytes, std::max(cap, size_t(1)) + 1);
        EXPECT_GT(statistics.bottom_built, 0u);
    }
    for (size_t k = 0; k < rays.size(); ++k)
        for (size_t other = 1; other < results.size(); ++other) {
            EXPECT_EQ(results[0][k].t, results[other][k].t);
            EXPECT_EQ(results[0][k].patch, results[other][k].patch);
            EXPECT_EQ(results[0][k].u, results[other][k].u);
            EXPECT_EQ(results[0][k].v, results[other][k].v);
        }
}

TEST(Tracer, box_leaves_hold_every_exact_hit) {
    RenderSettings settings;
    settings.surface.level = 4;
    const auto prepared = prepare_torus(settings);
    const std::vector<cpu::TraceRay> rays = make_rays(800, 0, 11);
    std::vector<cpu::TraceHit> exact(rays.size()), box(rays.size());
    cpu::Tracer(prepared, settings).closest_hits(rays, exact);
    settings.surface.leaf = LeafKind::box;
    cpu::Tracer(prepared, settings).closest_hits(rays, box);
    int closer = 0;
    for (size_t k = 0; k < rays.size(); ++k)
        if (exact[k].is_hit()) {
            ASSERT_TRUE(box[k].is_hit());
            EXPECT_LE(box[k].t, exact[k].t * 1.00001f);
            closer += box[k].t < exact[k].t * 0.9999f;
        }
    EXPECT_GT(closer, 100);
}

TEST(Tracer, tessellated_surfaces_give_the_hits_of_direct_ones) {
    RenderSettings settings;
    settings.image.height = 200;
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(3),
        test::make_displacement(test::make_random_map(128, 96, 0.1f, 8), DisplacementSpace::object));
    scene.camera.from = {3, 1, 2};
    scene.camera.to = {0, 0, 0};
    Object second = scene.objects[0];
    second.world_from_object = compose(make_translation({1, 0.2f, -0.5f}), make_scale({0.5f, 0.7f, 0.6f}));
    scene.objects.push_back(second);
    for (const MapFilter filter : {MapFilter::none, MapFilter::cubic, MapFilter::bspline}) {
        scene.displacements[0].filter = filter;
        settings.surface.mode = SurfaceMode::direct;
        const auto direct = prepare_scene(scene, settings);
        settings.surface.mode = SurfaceMode::tessellated;
        const auto tessellated = prepare_scene(scene, settings);
        const std::vector<cpu::TraceRay> rays = make_rays(3200, 0, 13);
        std::vector<cpu::TraceHit> a(rays.size()), b(rays.size());
        cpu::Tracer(direct, settings).closest_hits(rays, a);
        cpu::Tracer(tessellated, settings).closest_hits(rays, b);
        for (size_t k = 0; k < rays.size(); ++k) {
            EXPECT_EQ(a[k].is_hit(), b[k].is_hit());
            EXPECT_EQ(a[k].t, b[k].t);
            EXPECT_EQ(a[k].instance, b[k].instance);
        }
    }
}

TEST(Tracer, hits_are_those_of_single_rays_in_any_batch) {
    RenderSettings settings;
    settings.image.height = 150;
    Scene scene = test::make_body_scene(
        test::make_torus(6, 9),
        test::make_displacement(test::make_random_map(128, 128, 0.12f, 5), DisplacementSpace::tangent));
    scene.camera.from = {2, 1, 2};
    const auto prepared = prepare_scene(scene, settings);
    const cpu::Tracer tracer(prepared, settings);
    std::vector<cpu::TraceRay> rays = make_rays(200000, 0, 17);
    std::vector<cpu::TraceHit> hits(rays.size()), shuffled_hits(rays.size());
    tracer.closest_hits(rays, hits);
    std::vector<uint32_t> order(rays.size());
    for (uint32_t k = 0; k < order.size(); ++k) order[k] = k;
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    std::vector<cpu::TraceRay> shuffled;
    for (const uint32_t k : order) shuffled.push_back(rays[k]);
    tracer.closest_hits(shuffled, shuffled_hits);
    for (size_t k = 0; k < order.size(); ++k) {
        ASSERT_EQ(hits[order[k]].t, shuffled_hits[k].t) << order[k];
        ASSERT_EQ(hits[order[k]].patch, shuffled_hits[k].patch) << order[k];
        ASSERT_EQ(hits[order[k]].u, shuffled_hits[k].u) << order[k];
    }
}

TEST(Tracer, a_level_a_ray_gives_points_on_the_ray) {
    RenderSettings settings;
    settings.image.height = 150;
    settings.surface.lod = LodRule::ray;
    settings.surface.pixel_error = 8;
    Scene scene = test::make_body_scene(
        test::make_cube_sphere(3),
        test::make_displacement(test::make_random_map(256, 256, 0.12f, 5), DisplacementSpace::object));
    scene.camera.from = {1.5f, 1, 1};
    const auto prepared = prepare_scene(scene, settings);
    const cpu::Tracer tracer(prepared, settings);
    const std::vector<cpu::TraceRay> rays = make_rays(800, 0, 19);
    std::vector<cpu::TraceHit> hits(rays.size());
    tracer.closest_hits(rays, hits);
    size_t coarser = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
        if (!hits[k].is_hit()) continue;
        const Vec3f p = rays[k].origin + rays[k].direction * hits[k].t;
        EXPECT_LT(length(tracer.make_surface_point(hits[k]).position - p), 1e-4f) << k;
        coarser +=
            unpack_levels(hits[k].levels).patch < prepared->instances[0].levels->at(hits[k].patch).patch;
    }
    EXPECT_GT(coarser, 20u);
}

TEST(Tracer, rays_that_leave_a_surface_do_not_meet_it_where_they_start) {
    // Modelled far from its own origin and moved back: rounding is that of the object's coordinates.
    RenderSettings settings;
    settings.surface.level = 3;
    Mesh mesh = test::make_cube_sphere(3);
    for (Vec3f& p : mesh.positions) p = p + Vec3f{300, -200, 100};
    Scene scene =
        test::make_body_scene(std::move(mesh), test::make_displacement(test::make_random_map(64, 64, 0.0f, 5),
                                                                       DisplacementSpace::object));
    scene.objects[0].world_from_object = make_translation({-300, 200, -100});
    const auto prepared = prepare_scene(scene, settings);
    const cpu::Tracer tracer(prepared, settings);
    const std::vector<cpu::TraceRay> rays = make_rays(1600, 0, 23);
    std::vector<cpu::TraceHit> hits(rays.size());
    tracer.closest_hits(rays, hits);
    std::vector<cpu::TraceRay> spawned;
    for (size_t k = 0; k < rays.size(); ++k) {
        if (!hits[k].is_hit()) continue;
        // The body is convex up to its facets: a ray outward must leave it.
        const cpu::SurfacePoint point = tracer.make_surface_point(hits[k]);
        cpu::TraceRay ray;
        ray.direction = normalize(point.position);
        ray.origin = tracer.offset_origin(point, ray.direction);
        spawned.push_back(ray);
    }
    std::vector<uint8_t> occluded(spawned.size());
    tracer.any_hits(spawned, occluded);
    EXPECT_EQ(std::count(occluded.begin(), occluded.end(), 1), 0);
    EXPECT_GT(spawned.size(), 400u);
}

} // namespace

} // namespace relief

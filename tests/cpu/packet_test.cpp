// Sixteen rays that are near each other are traced as one packet: each has the hit that it has alone.
#include "cpu/tracer.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "support/bodies.h"
#include "support/casts.h"
#include "support/isas.h"

namespace relief::cpu {

namespace {

constexpr size_t kPacketWidth = 16;

enum class Kind { around_axes, along_axes, with_a_nan_in_a_ray, with_a_nan_reach };

/// Packets whose first ray has one of few directions, the others some degrees off, from places of their own.
std::vector<TraceRay> make_packets(Kind kind, uint32_t count) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    const Vec3f directions[] = {{1, 0, 0},  {0, -1, 0},          {0, 0, 1},
                                {-1, 1, 0}, {0.5f, -0.6f, 0.7f}, {0, 1, -1}};
    std::vector<TraceRay> rays;
    for (uint32_t packet = 0; packet < count; ++packet) {
        const Vec3f direction = normalize(directions[packet % std::size(directions)]);
        for (uint32_t lane = 0; lane < kPacketWidth; ++lane) {
            const auto draw = [&](float size) {
                return Vec3f{normal(random), normal(random), normal(random)} * size;
            };
            TraceRay ray;
            ray.direction = kind == Kind::along_axes ? direction : direction + draw(0.05f);
            ray.origin = draw(0.5f) - direction * 4.0f;
            if (lane == packet % kPacketWidth && kind == Kind::with_a_nan_in_a_ray)
                set_component(ray.origin, int(packet % 3), NAN);
            if (lane == packet % kPacketWidth && kind == Kind::with_a_nan_reach)
                (packet % 2 == 0 ? ray.t_min : ray.t_max) = NAN;
            rays.push_back(ray);
        }
    }
    return rays;
}

TEST(Packets, rays_have_the_hits_that_they_have_alone) {
    RenderSettings settings;
    settings.surface.level = 3;
    const auto scene = prepare_scene(test::make_scene(DisplacementSpace::object), settings);
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const Tracer tracer(scene, settings);
        for (const Kind kind :
             {Kind::around_axes, Kind::along_axes, Kind::with_a_nan_in_a_ray, Kind::with_a_nan_reach}) {
            const std::vector<TraceRay> rays = make_packets(kind, 60);
            std::vector<TraceHit> together(rays.size()), alone(1);
            std::vector<uint8_t> occluded_together(rays.size()), occluded_alone(1);
            tracer.closest_hits(rays, together);
            tracer.any_hits(rays, occluded_together);
            size_t hit_count = 0;
            for (size_t k = 0; k < rays.size(); ++k) {
                const std::span<const TraceRay> one = std::span(rays).subspan(k, 1);
                tracer.closest_hits(one, alone);
                tracer.any_hits(one, occluded_alone);
                ASSERT_EQ(together[k].t, alone[0].t) << int(isa) << ", kind " << int(kind) << ", ray " << k;
                ASSERT_EQ(together[k].instance, alone[0].instance) << k;
                ASSERT_EQ(together[k].patch, alone[0].patch) << k;
                ASSERT_EQ(occluded_together[k], occluded_alone[0]) << k;
                hit_count += alone[0].is_hit();
            }
            EXPECT_GT(hit_count, rays.size() / 3) << int(kind);
        }
    }
}

/// A flat square of side 1 at z = 0, of n x n quads.
Mesh make_square(uint32_t n) {
    Mesh mesh;
    mesh.name = "square";
    for (uint32_t j = 0; j <= n; ++j)
        for (uint32_t i = 0; i <= n; ++i) {
            mesh.positions.push_back({float(i) / float(n), float(j) / float(n), 0});
            mesh.uvs.push_back({float(i) / float(n), float(j) / float(n)});
        }
    for (uint32_t j = 0; j < n; ++j)
        for (uint32_t i = 0; i < n; ++i) {
            mesh.face_sizes.push_back(4);
            const uint32_t v = j * (n + 1) + i;
            for (const uint32_t corner : {v, v + 1, v + n + 2, v + n + 1})
                mesh.position_indices.push_back(corner);
        }
    mesh.uv_indices = mesh.position_indices;
    return mesh;
}

/// Rays that do not move along an axis on which they start exactly where boxes end, far from each other, so
/// that they leave the packet and go on alone.
TEST(Packets, rays_within_the_faces_of_boxes_meet_what_lies_there) {
    constexpr uint32_t kQuads = 8, kCells = 8, kPlaces = kQuads * kCells + 1;
    RenderSettings settings;
    settings.surface.level = 3;
    const auto scene = prepare_scene(
        test::make_body_scene(make_square(kQuads), test::make_displacement(test::make_random_map(8, 8, 0, 1),
                                                                           DisplacementSpace::object)),
        settings);
    std::mt19937 random(3);
    std::vector<TraceRay> rays(kPacketWidth * 64);
    for (TraceRay& ray : rays) {
        const auto draw = [&] { return float(random() % kPlaces) / float(kPlaces - 1); };
        ray.origin = {draw(), draw(), 1};
        ray.direction = {0, 0, -1};
    }
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const Tracer tracer(scene, settings);
        std::vector<TraceHit> hits(rays.size());
        std::vector<uint8_t> occluded(rays.size());
        tracer.closest_hits(rays, hits);
        tracer.any_hits(rays, occluded);
        for (size_t k = 0; k < rays.size(); ++k) {
            ASSERT_EQ(hits[k].t, 1) << int(isa) << ", ray " << k << " at " << rays[k].origin.x << ", "
                                    << rays[k].origin.y;
            ASSERT_TRUE(occluded[k]) << int(isa) << ", ray " << k;
        }
    }
}

/// Of a bundle; and of what other trees are walked by.
TEST(Packets, a_ray_with_a_nan_hits_nothing_and_leaves_the_hits_of_others) {
    RenderSettings settings;
    settings.surface.level = 3;
    const auto scene = prepare_scene(test::make_scene(DisplacementSpace::object), settings);
    std::vector<TraceRay> rays(256);
    for (size_t k = 0; k < rays.size(); ++k) {
        rays[k].origin = {4, 0, 0};
        rays[k].direction = {-1, 0.04f * (float(k % 16) - 8), 0.04f * (float(k / 16) - 8)};
    }
    std::vector<TraceRay> broken = rays;
    broken[100].direction.y = NAN, broken[150].direction.z = INFINITY, broken[200].t_max = NAN;
    for (const TraversalKind traversal :
         {TraversalKind::automatic, TraversalKind::stack, TraversalKind::backtrack}) {
        settings.experiment.traversal = traversal;
        settings.experiment.structure =
            traversal == TraversalKind::backtrack ? StructureKind::kdtree : StructureKind::bvh;
        const Tracer tracer(scene, settings);
        std::vector<TraceHit> whole(rays.size()), found(rays.size());
        tracer.closest_hits(rays, whole);
        tracer.closest_hits(broken, found);
        for (size_t k = 0; k < rays.size(); ++k)
            ASSERT_EQ(found[k].t, k == 100 || k == 150 || k == 200 ? INFINITY : whole[k].t) << k;
    }
}

} // namespace

} // namespace relief::cpu

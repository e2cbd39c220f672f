// Points of the surface and random numbers as shading takes them: many at once by SIMD, and one by one.
#include <gtest/gtest.h>
#include <numeric>

#include <vector>

#include "cpu/shading/shading_kernels.h"
#include "cpu/tracer.h"
#include "formulas/camera.h"
#include "formulas/sobol.h"
#include "formulas/warp.h"
#include "support/bodies.h"
#include "support/isas.h"

namespace relief {
namespace {

/// Triangles and quads side by side; with normals that are not those of their planes and texture coordinates,
/// or with nothing but positions.
Mesh make_polygons(bool is_bare) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0.2f}, {1, 1, -0.3f}, {0, 1, 0}, {2, 0, 0}, {2, 1.5f, 0.5f}};
    mesh.face_sizes = {4, 3, 3};
    mesh.position_indices = {0, 1, 2, 3, 1, 4, 2, 4, 5, 2};
    if (is_bare) return mesh;
    for (uint32_t k = 0; k < 6; ++k) {
        const Vec3f tilt = scalar::square_to_sphere(scalar::sobol_pair(5, k, 0));
        mesh.normals.push_back(normalize(Vec3f{0, 0, 1} + tilt * 0.7f));
        mesh.uvs.push_back({0.3f * float(k), 1 - 0.1f * float(k * k)});
    }
    mesh.uv_indices = mesh.normal_indices = mesh.position_indices;
    return mesh;
}

/// A displaced torus with a seam along either circle, the same one mirrored, a sphere whose patches nearly
/// all touch one, plain quads, a smooth base, and polygons.
Scene make_scene(const Displacement& displacement) {
    Scene scene = test::make_body_scene(test::make_torus(4, 6), displacement);
    scene.meshes.push_back(test::make_cube_sphere(2));
    scene.objects.push_back(scene.objects[0]);
    scene.objects.back().world_from_object.rows = {Vec3f{-1, 0, 0}, Vec3f{0, 0.5f, 1}, Vec3f{0, -1, 0.5f}};
    scene.objects.back().world_from_object.translation = {3, 1, -2};
    scene.objects.push_back({"sphere", 1, 0, kNoIndex, {}});
    scene.objects.push_back({"plain", 1, kNoIndex, kNoIndex, {}});
    scene.meshes.push_back(test::make_cube_sphere(2));
    scene.meshes.back().subdivision.scheme = SubdivisionScheme::catmark;
    scene.meshes.back().subdivision.level = 1;
    scene.objects.push_back({"smooth", 2, 0, kNoIndex, {}});
    for (const bool is_bare : {false, true}) {
        scene.objects.push_back({"polygons", uint32_t(scene.meshes.size()), kNoIndex, kNoIndex,
                                 scene.objects[1].world_from_object});
        scene.meshes.push_back(make_polygons(is_bare));
    }
    return scene;
}

/// Hits all over the scene, near and at the borders of patches above all; edges coarser than their patch.
std::vector<cpu::TraceHit> make_hits(const PreparedScene& scene, uint32_t count) {
    const PatchLevels levels[] = {
        {0, {0, 0, 0, 0}}, {2, {2, 1, 0, 2}}, {3, {3, 1, 2, 0}}, {4, {2, 4, 3, 4}}, {5, {5, 5, 5, 5}}};
    std::vector<cpu::TraceHit> hits(count);
    for (uint32_t k = 0; k < count; ++k) {
        auto draw = [&, n = 0u](uint32_t end) mutable { return scalar::hash_combine(k, ++n) % end; };
        cpu::TraceHit& hit = hits[k];
        hit.instance = draw(uint32_t(scene.instances.size()));
        const Surface& surface = scene.surfaces[scene.instances[hit.instance].surface];
        hit.patch = draw(surface.patch_count());
        const PatchLevels& at = surface.has_displacement ? levels[draw(5)] : levels[0];
        const uint32_t side = 1u << at.patch;
        hit.levels = pack_levels(at);
        hit.i = uint16_t(draw(2) ? draw(side) : draw(2) * (side - 1));
        hit.j = uint16_t(draw(2) ? draw(side) : draw(2) * (side - 1));
        const float x = float(draw(101)) / 100, y = float(draw(101)) / 100;
        hit.is_upper = y > x;
        hit.u = (float(hit.i) + x) / float(side), hit.v = (float(hit.j) + y) / float(side);
        hit.t = 1;
    }
    return hits;
}

void expect_same(const cpu::SurfacePoint& a, const cpu::SurfacePoint& b) {
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.geometric_normal, b.geometric_normal);
    EXPECT_EQ(a.shading_normal, b.shading_normal);
    EXPECT_EQ(a.uv, b.uv);
    EXPECT_EQ(a.area_per_uv, b.area_per_uv);
    EXPECT_EQ(a.position_error, b.position_error);
    EXPECT_EQ(a.instance, b.instance);
    EXPECT_EQ(a.patch, b.patch);
}

void expect_same_points(const Scene& scene) {
    RenderSettings settings;
    settings.surface.level = 5;
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(scene, settings);
    const std::vector<cpu::TraceHit> hits = make_hits(*prepared, 437);
    for (const Isa isa : test::machine_isas()) {
        settings.device.isa = isa;
        const cpu::Tracer tracer(prepared, settings);
        cpu::PointScratch scratch;
        std::vector<cpu::SurfacePoint> points(hits.size());
        tracer.make_surface_points(hits, points, scratch);
        for (size_t k = 0; k < hits.size(); ++k) {
            const cpu::TraceHit& hit = hits[k];
            expect_same(points[k], tracer.make_surface_point(hit));
            ASSERT_FALSE(testing::Test::HasFailure())
                << tracer.shading_kernels().name << " hit " << k << " instance " << hit.instance;
        }
    }
}

void expect_same_points(const Displacement& displacement) { expect_same_points(make_scene(displacement)); }

TEST(SurfacePoints, are_the_same_many_at_once_and_one_by_one) {
    for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent})
        for (const WrapMode wrap : {WrapMode::clamp, WrapMode::repeat, WrapMode::mirror, WrapMode::black}) {
            Displacement displacement =
                test::make_displacement(test::make_random_map(64, 48, 0.15f, 3), space);
            displacement.wrap = wrap;
            displacement.midlevel = {0.01f, -0.02f, 0.03f};
            displacement.flip_v = wrap == WrapMode::repeat;
            expect_same_points(displacement);
            if (testing::Test::HasFailure()) return;
        }
}

TEST(SurfacePoints, are_the_same_in_scenes_of_many_surfaces) {
    const Displacement displacement =
        test::make_displacement(test::make_random_map(64, 48, 0.15f, 3), DisplacementSpace::object);
    Scene scene = make_scene(displacement);
    for (uint32_t k = 0; k < 20; ++k) {
        scene.objects.push_back({"one of many", uint32_t(scene.meshes.size()), 0, kNoIndex, {}});
        scene.meshes.push_back(test::make_torus(4, 3 + k % 5));
    }
    expect_same_points(scene);
}

TEST(SurfacePoints, are_the_same_on_filtered_maps_with_detail_in_the_normals) {
    for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent})
        for (const bool has_autobump : {false, true}) {
            Displacement displacement =
                test::make_displacement(test::make_random_map(640, 480, 0.15f, 3), space);
            displacement.filter = MapFilter::mip, displacement.autobump = has_autobump;
            expect_same_points(displacement);
            if (testing::Test::HasFailure()) return;
        }
}

TEST(SurfacePoints, are_the_same_on_smooth_maps) {
    for (const DisplacementSpace space : {DisplacementSpace::object, DisplacementSpace::tangent})
        for (const MapFilter filter : {MapFilter::cubic, MapFilter::bspline}) {
            Displacement displacement =
                test::make_displacement(test::make_random_map(64, 48, 0.15f, 3), space);
            displacement.filter = filter;
            displacement.wrap = filter == MapFilter::cubic ? WrapMode::clamp : WrapMode::repeat;
            expect_same_points(displacement);
            if (testing::Test::HasFailure()) return;
        }
}

TEST(SurfacePoints, are_the_same_through_derivatives) {
    Displacement displacement =
        test::make_displacement(test::make_random_map(64, 48, 0.02f, 3), DisplacementSpace::tangent);
    displacement.lengths = FrameLengths::relative;
    expect_same_points(displacement);
}

TEST(SurfacePoints, are_the_same_where_a_tile_has_no_map) {
    Displacement displacement =
        test::make_displacement(test::make_random_map(40, 30, 0.1f, 9), DisplacementSpace::tangent);
    displacement.is_udim = true;
    displacement.tiles[0].udim = 1002;
    expect_same_points(displacement);
}

TEST(CameraRays, are_the_same_many_at_once_and_one_by_one) {
    const scalar::CameraFrame camera =
        scalar::make_camera_frame({1, 2, 3}, {-4, 0.5f, 0.25f}, {0.1f, 1, 0}, 0.7f, {640, 360});
    scalar::CameraFrame nowhere = camera; // a direction of length 0 at pixel (0, 0)
    nowhere.corner = {0, 0, 0};
    std::vector<Vec2f> positions = {{0, 0}};
    for (uint32_t k = 0; k < 40; ++k)
        positions.push_back(
            {float(scalar::hash_uint(k) % 6400) * 0.1f, float(scalar::hash_uint(~k) % 3600) * 0.1f});
    for (const Isa isa : test::machine_isas()) {
        RenderSettings settings;
        settings.device.isa = isa, settings.surface.level = 0;
        const auto map = test::make_random_map(4, 4, 0.1f, 1);
        const cpu::Tracer tracer(
            prepare_scene(make_scene(test::make_displacement(map, DisplacementSpace::object)), settings),
            settings);
        for (const scalar::CameraFrame& frame : {camera, nowhere})
            for (const size_t count : {size_t(1), size_t(15), size_t(16), size_t(17), positions.size()}) {
                cpu::TraceRay used;
                used.t_min = 7, used.t_max = 8, used.lod_bias = 9;
                std::vector<cpu::TraceRay> rays(count + 1, used);
                tracer.shading_kernels().aim_rays(frame, positions.data(), count, rays.data());
                for (size_t k = 0; k < count; ++k) {
                    const scalar::CameraRay expected = scalar::make_pinhole_ray(frame, positions[k]);
                    ASSERT_EQ(rays[k].origin, expected.origin) << tracer.shading_kernels().name << " " << k;
                    ASSERT_EQ(rays[k].direction, expected.direction)
                        << tracer.shading_kernels().name << " " << k;
                    ASSERT_EQ(rays[k].t_min, 0.0f);
                    ASSERT_EQ(rays[k].t_max, cpu::TraceRay().t_max);
                    ASSERT_EQ(rays[k].lod_bias, 0u);
                }
                EXPECT_EQ(rays[count].lod_bias, used.lod_bias) << "one ray too many";
            }
    }
}

TEST(RandomPairs, are_the_same_many_at_once_and_one_by_one) {
    std::vector<uint32_t> seeds;
    for (uint32_t k = 0; k < 53; ++k) seeds.push_back(scalar::hash_uint(k));
    std::vector<Vec2f> drawn(seeds.size());
    for (const Isa isa : test::machine_isas())
        for (const uint32_t first : {0u, 60u, 0xffffffd0u}) {
            std::vector<uint32_t> samples(seeds.size());
            std::iota(samples.begin(), samples.end(), first);
            RenderSettings settings;
            settings.device.isa = isa;
            settings.surface.level = 0;
            const auto map = test::make_random_map(4, 4, 0.1f, 1);
            const cpu::Tracer tracer(
                prepare_scene(make_scene(test::make_displacement(map, DisplacementSpace::object)), settings),
                settings);
            tracer.shading_kernels().sample_2d({seeds.data(), samples.data(), seeds.size()}, 5, drawn.data());
            for (size_t k = 0; k < seeds.size(); ++k)
                ASSERT_EQ(drawn[k], scalar::sobol_pair(seeds[k], samples[k], 5))
                    << tracer.shading_kernels().name << " " << k;
        }
}

} // namespace
} // namespace relief

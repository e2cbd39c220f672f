// Watertight: from inside a closed displaced body every ray hits, whatever the levels, biases, frames and
// transforms. Many of the rays aim at vertices and edges of the micro-mesh, many go in packets.
// RELIEF_LEAK_RAYS sets how many rays in all. Misses are decided in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <ostream>

#include "base/parallel.h"
#include "cpu/leak_rays.h"
#include "cpu/tracer.h"
#include "math/affine.h"
#include "prepare/scene_edit.h"
#include "support/bodies.h"
#include "support/exact_hits.h"
#include "surface/smooth_shapes.h"

namespace relief {

namespace {

constexpr uint64_t kRaysABatch = 4096;

enum class Body { sphere, torus, creased };
enum class Uvs { everywhere, missing_on_some_faces, in_two_tiles, across_tiles };
enum class Placement { single, instances };
enum class BaseLevels { fixed, automatic };

struct LeakCase {
    const char* name;
    Body body;
    DisplacementSpace space;
    int level;
    Placement placement;
    SubdivisionScheme scheme = SubdivisionScheme::none;
    FrameKind frame = FrameKind::mikk;
    FrameLengths lengths = FrameLengths::absolute;
    MapFilter filter = MapFilter::none;
    Uvs uvs = Uvs::everywhere;
    BaseLevels base = BaseLevels::fixed;
};

void PrintTo(const LeakCase& c, std::ostream* stream) { *stream << c.name; }

const LeakCase kLeakCases[] = {
    {"sphere_object_level5", Body::sphere, DisplacementSpace::object, 5, Placement::single},
    {"sphere_object_auto", Body::sphere, DisplacementSpace::object, kAutoLevel, Placement::single},
    {"sphere_tangent_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel, Placement::single},
    {"sphere_tangent_auto_instances", Body::sphere, DisplacementSpace::tangent, kAutoLevel,
     Placement::instances},
    {"torus_tangent_level3", Body::torus, DisplacementSpace::tangent, 3, Placement::single},
    {"torus_tangent_auto", Body::torus, DisplacementSpace::tangent, kAutoLevel, Placement::single},
    {"torus_object_auto_instances", Body::torus, DisplacementSpace::object, kAutoLevel, Placement::instances},
    {"torus_object_level6", Body::torus, DisplacementSpace::object, 6, Placement::single},
    {"torus_tangent_level7", Body::torus, DisplacementSpace::tangent, 7, Placement::single},
    {"smooth_sphere_tangent_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::catmark},
    {"smooth_sphere_object_auto_instances", Body::sphere, DisplacementSpace::object, kAutoLevel,
     Placement::instances, SubdivisionScheme::catmark},
    {"smooth_torus_tangent_level3", Body::torus, DisplacementSpace::tangent, 3, Placement::single,
     SubdivisionScheme::catmark},
    {"creased_cube_tangent_auto", Body::creased, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::catmark},
    {"creased_cube_object_level4", Body::creased, DisplacementSpace::object, 4, Placement::single,
     SubdivisionScheme::catmark},
    {"sphere_with_hard_edges_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::none, FrameKind::file},
    {"sphere_relative_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::none, FrameKind::mikk, FrameLengths::relative},
    {"filtered_sphere_tangent_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::none, FrameKind::mikk, FrameLengths::absolute, MapFilter::mip},
    {"filtered_torus_object_auto_instances", Body::torus, DisplacementSpace::object, kAutoLevel,
     Placement::instances, SubdivisionScheme::none, FrameKind::mikk, FrameLengths::absolute, MapFilter::mip},
    {"sphere_with_faces_without_uvs_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel,
     Placement::single, SubdivisionScheme::none, FrameKind::mikk, FrameLengths::relative, MapFilter::none,
     Uvs::missing_on_some_faces},
    {"smooth_torus_with_faces_without_uvs_auto", Body::torus, DisplacementSpace::object, kAutoLevel,
     Placement::single, SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute, MapFilter::mip,
     Uvs::missing_on_some_faces},
    {"cubic_sphere_tangent_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::none, FrameKind::mikk, FrameLengths::absolute, MapFilter::cubic},
    {"cubic_torus_object_auto_instances", Body::torus, DisplacementSpace::object, kAutoLevel,
     Placement::instances, SubdivisionScheme::none, FrameKind::mikk, FrameLengths::absolute,
     MapFilter::cubic},
    {"cubic_torus_object_level6", Body::torus, DisplacementSpace::object, 6, Placement::single,
     SubdivisionScheme::none, FrameKind::mikk, FrameLengths::absolute, MapFilter::cubic},
    {"bspline_creased_cube_tangent_auto", Body::creased, DisplacementSpace::tangent, kAutoLevel,
     Placement::single, SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute,
     MapFilter::bspline},
    {"cubic_torus_in_two_tiles_auto", Body::torus, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::none, FrameKind::mikk, FrameLengths::absolute, MapFilter::cubic, Uvs::in_two_tiles},
    {"cubic_torus_with_faces_without_uvs_auto", Body::torus, DisplacementSpace::tangent, kAutoLevel,
     Placement::single, SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute, MapFilter::cubic,
     Uvs::missing_on_some_faces},
    {"automatic_sphere_tangent_auto", Body::sphere, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute, MapFilter::none, Uvs::everywhere,
     BaseLevels::automatic},
    {"automatic_creased_cube_tangent_auto", Body::creased, DisplacementSpace::tangent, kAutoLevel,
     Placement::single, SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute, MapFilter::none,
     Uvs::everywhere, BaseLevels::automatic},
    {"automatic_torus_object_auto_instances", Body::torus, DisplacementSpace::object, kAutoLevel,
     Placement::instances, SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute,
     MapFilter::none, Uvs::everywhere, BaseLevels::automatic},
    {"automatic_torus_with_faces_without_uvs_auto", Body::torus, DisplacementSpace::tangent, kAutoLevel,
     Placement::single, SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute, MapFilter::none,
     Uvs::missing_on_some_faces, BaseLevels::automatic},
    {"torus_across_tiles_auto", Body::torus, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::none, FrameKind::mikk, FrameLengths::absolute, MapFilter::none, Uvs::across_tiles},
    {"cubic_torus_across_tiles_auto", Body::torus, DisplacementSpace::tangent, kAutoLevel, Placement::single,
     SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute, MapFilter::cubic,
     Uvs::across_tiles},
    {"automatic_torus_in_two_tiles_auto", Body::torus, DisplacementSpace::tangent, kAutoLevel,
     Placement::single, SubdivisionScheme::catmark, FrameKind::mikk, FrameLengths::absolute, MapFilter::cubic,
     Uvs::in_two_tiles, BaseLevels::automatic},
};

Vec3f make_inner_point(Body body, test::LeakRandom& random) {
    if (body != Body::torus) return random.direction() * (0.3f * random.uniform());
    const float angle = 6.2831853f * random.uniform();
    return Vec3f{std::cos(angle), 0, -std::sin(angle)} + random.direction() * (0.1f * random.uniform());
}

/// A vertex of the micro-mesh, or a point of one of its edges, in world space.
Vec3f make_target(const PreparedScene& scene, const Instance& instance, uint32_t bias,
                  test::LeakRandom& random) {
    const Surface& surface = scene.surfaces[instance.surface];
    const uint32_t patch = uint32_t(random.uniform() * float(surface.patch_count()));
    const PatchLevels levels = instance.levels->at(patch).biased(bias);
    const uint32_t side = 1u << levels.patch;
    uint32_t i = uint32_t(random.uniform() * float(side + 1)),
             j = uint32_t(random.uniform() * float(side + 1));
    if (random.uniform() < 0.5f) (random.uniform() < 0.5f ? i : j) = random.uniform() < 0.5f ? 0 : side;
    const Vec3f a = evaluate_vertex(surface, patch, levels, i, j);
    const Vec3f b = evaluate_vertex(surface, patch, levels, std::min(i + 1, side), j);
    const float s = random.uniform() < 0.5f ? 0 : random.uniform();
    return transform_point(instance.world_from_object, a * (1 - s) + b * s);
}

Scene make_scene(const LeakCase& c) {
    const bool is_smooth = c.scheme != SubdivisionScheme::none;
    Mesh mesh = c.body == Body::sphere    ? test::make_cube_sphere(is_smooth ? 2 : 4)
                : c.body == Body::creased ? test::make_shape(test::Shape::tangled_cube)
                                          : test::make_torus(8, 14);
    if (c.uvs == Uvs::missing_on_some_faces) test::remove_uvs(mesh, 5);
    if (c.uvs == Uvs::in_two_tiles)
        for (Vec2f& uv : mesh.uvs) uv.x *= 2;
    if (c.uvs == Uvs::across_tiles) // the third tile has no file
        for (Vec2f& uv : mesh.uvs) uv = {2 * uv.x + 0.05f, uv.y + 0.03f};
    mesh.subdivision.scheme = c.scheme;
    mesh.subdivision.level = c.base == BaseLevels::automatic ? kAutoSubdivisionLevel
                             : c.body == Body::sphere        ? 1
                             : c.body == Body::creased       ? 2
                                                             : 0;
    Scene scene = test::make_body_scene(
        std::move(mesh),
        test::make_displacement(test::make_random_map(256, 192, c.body == Body::torus ? 0.06f : 0.12f, 21),
                                c.space));
    scene.displacements[0].filter = c.filter;
    if (c.uvs == Uvs::in_two_tiles || c.uvs == Uvs::across_tiles) {
        scene.displacements[0].is_udim = true;
        scene.displacements[0].tiles.push_back({1002, test::make_random_map(160, 224, 0.06f, 22)});
    }
    test::set_frames(scene, c.frame, c.lengths);
    // Close to one side: levels differ from patch to patch, and many edges are coarser than their patches.
    scene.camera.from = c.body == Body::torus ? Vec3f{1.2f, 0.1f, 0.1f} : Vec3f{0.75f, 0.1f, 0.2f};
    if (c.placement == Placement::instances)
        for (int k = 1; k <= 2; ++k) {
            Object copy = scene.objects[0];
            copy.world_from_object = compose(make_translation({float(5 * k), 1, -2}),
                                             compose(make_rotation_degrees({20.0f * float(k), 35, 50}),
                                                     make_scale({k == 1 ? -1.2f : 0.8f, 0.7f, 1.3f})));
            scene.objects.push_back(copy);
        }
    return scene;
}

/// Auto levels are worth a test only where patches differ and edges are coarser than their patches.
void expect_mixed_levels(const PreparedScene& scene, const LeakCase& c) {
    if (c.level != kAutoLevel) return;
    int lowest = kMaxLevel, highest = 0, coarse_edges = 0;
    for (const Instance& instance : scene.instances)
        for (uint32_t patch = 0; patch < scene.surfaces[instance.surface].patch_count(); ++patch) {
            const PatchLevels levels = instance.levels->at(patch);
            lowest = std::min<int>(lowest, levels.patch), highest = std::max<int>(highest, levels.patch);
            for (const uint8_t edge : levels.edge) coarse_edges += edge < levels.patch;
        }
    EXPECT_GE(highest - lowest, 2);
    EXPECT_GT(coarse_edges, 20);
}

/// Rays from inside the body that hit nothing though something is there.
uint64_t count_leaks(const PreparedScene& prepared, const cpu::Tracer& tracer, Body body,
                     uint64_t first_batch, uint64_t batches) {
    std::atomic<uint64_t> leaks{0};
    const test::ExactScene exact(prepared);
    parallel_for("leaks", batches, 1, [&](size_t begin, size_t end) {
        std::vector<cpu::TraceRay> rays(kRaysABatch);
        std::vector<cpu::TraceHit> hits(kRaysABatch);
        for (size_t batch = first_batch + begin; batch < first_batch + end; ++batch) {
            test::LeakRandom random{batch * 0x9e3779b97f4a7c15ull + 1};
            for (size_t k = 0; k < kRaysABatch; ++k) {
                const Instance& instance = prepared.instances[batch % prepared.instances.size()];
                rays[k].lod_bias = uint32_t(k / 1024);
                rays[k].origin = transform_point(instance.world_from_object, make_inner_point(body, random));
                if (k / 16 % 2 == 1 && k % 16 > 0) {
                    // Every other run of sixteen is a narrow bundle: a packet.
                    rays[k] = rays[k - k % 16];
                    rays[k].direction += random.direction() * (0.1f * length(rays[k].direction));
                } else {
                    rays[k].direction =
                        k % 2 ? make_target(prepared, instance, rays[k].lod_bias, random) - rays[k].origin
                              : random.direction();
                }
            }
            tracer.closest_hits(rays, hits);
            for (size_t k = 0; k < kRaysABatch; ++k) {
                if (hits[k].is_hit() || !exact.hits(rays[k])) continue;
                if (leaks++ < 5)
                    ADD_FAILURE() << "batch " << batch << " ray " << k << " bias " << rays[k].lod_bias;
            }
        }
    });
    return leaks;
}

RenderSettings make_leak_settings(int level) {
    RenderSettings settings;
    settings.surface.level = level;
    settings.image.height = 96;
    settings.surface.pixel_error = 12; // coarse enough that the view, not the map, decides the levels
    return settings;
}

class LeakTest : public testing::TestWithParam<LeakCase> {};

TEST_P(LeakTest, every_ray_from_inside_hits) {
    const LeakCase& c = GetParam();
    const RenderSettings settings = make_leak_settings(c.level);
    const std::shared_ptr<const PreparedScene> prepared = prepare_scene(make_scene(c), settings);
    expect_mixed_levels(*prepared, c);
    const uint64_t batches = (test::leak_ray_count() / std::size(kLeakCases) + kRaysABatch - 1) / kRaysABatch;
    EXPECT_EQ(count_leaks(*prepared, cpu::Tracer(prepared, settings), c.body, 0, batches), 0u);
    RecordProperty("rays", std::to_string(batches * kRaysABatch));
}

/// Motion blur: bodies turn, stretch and change their relief, whose scale and texels are between two times'.
TEST(MotionLeak, every_ray_from_inside_hits_at_any_time) {
    constexpr uint64_t kTimes = 100;
    const LeakCase c{"moving", Body::torus, DisplacementSpace::tangent, kAutoLevel, Placement::instances};
    const Scene start = make_scene(c);
    const Texture& texels = *start.displacements[0].tiles[0].texture;
    const RenderSettings settings = make_leak_settings(kAutoLevel);
    SceneEditor editor(start, settings, SessionUse::scenes);
    cpu::Tracer tracer(editor.scene(), settings);
    test::LeakRandom random{7};
    const uint64_t batches = (test::leak_ray_count() / kTimes + kRaysABatch - 1) / kRaysABatch;
    uint64_t leaks = 0;
    for (uint64_t time = 0; time < kTimes; ++time) {
        Scene scene = start;
        scene.meshes[0] = {};
        scene.meshes[0].name = start.meshes[0].name;
        for (Object& object : scene.objects)
            object.world_from_object = compose(
                compose(object.world_from_object, make_rotation_degrees({0, 90 * random.uniform(), 0})),
                make_scale({1, 0.6f + random.uniform(), 1}));
        scene.displacements[0].scale = {random.uniform(), random.uniform(), random.uniform()};
        if (time % 3 == 0) {
            auto blend = std::make_shared<Texture>(texels);
            const float weight = random.uniform();
            for (float& value : blend->floats) value *= weight;
            scene.displacements[0].tiles[0].texture = std::move(blend);
        }
        const auto changes = editor.change_scene(std::move(scene), settings);
        ASSERT_TRUE(changes && tracer.change_scene(*changes));
        leaks += count_leaks(*editor.scene(), tracer, c.body, time * batches, batches);
    }
    EXPECT_EQ(leaks, 0u);
    RecordProperty("rays", std::to_string(kTimes * batches * kRaysABatch));
}

INSTANTIATE_TEST_SUITE_P(Bodies, LeakTest, testing::ValuesIn(kLeakCases),
                         [](const testing::TestParamInfo<LeakCase>& info) {
                             return std::string(info.param.name);
                         });

} // namespace

} // namespace relief
